"""What commands do with the keyframes of the timeline."""

from collections.abc import Callable

from ...editor.animation.keyframe_playback import STEP
from ..app_state import Workspace


def shown(space: Workspace) -> bool:
    """Whether there are keyframes, and the timeline shows them."""
    keyed = space.document is not None and space.show_timeline and space.timeline == "keyframes"
    return keyed and bool(space.key_player.animation.keys)


def has_chosen(space: Workspace) -> bool:
    """Whether some of them are chosen."""
    return shown(space) and bool(space.key_player.chosen)


def keyframe_here(space: Workspace) -> None:
    """Keep what is seen as a keyframe; the timeline opens where it is not seen."""
    session, player = space.editor.session, space.key_player
    seen = session.state.positions if session is not None and session.visiting else None
    player.watch()
    if not (space.show_timeline and space.timeline == "keyframes"):
        space.show_in_timeline("keyframes")
        space.show_timeline = True
    player.put(positions=seen)


def toggle_onion(space: Workspace) -> None:
    """Show the neighbors of the pose, or not."""
    space.key_player.onion.shown = not space.key_player.onion.shown


def nudging(by: float) -> Callable[[Workspace], None]:
    """Brings the chosen keyframes forward or back by seconds."""
    return lambda space: space.key_player.nudge(by)


def choose_all(space: Workspace) -> None:
    """Select every keyframe, to be moved together."""
    space.key_player.chosen = frozenset(space.key_player.kept_times)


def going(by: float) -> Callable[[Workspace], None]:
    """Looks so many seconds later, or earlier; at keyframes, where the mouse would stop, too."""

    def go(space: Workspace) -> None:
        moment = space.transport.position + by
        space.transport.look(snapped(moment) if space.timeline == "keyframes" else moment)

    return go


def snapped(time: float) -> float:
    """The nearest of the times that a drag of keyframes goes to."""
    return round(time / STEP) * STEP


def play(space: Workspace) -> None:
    """Play what the timeline shows, or stop."""
    space.show_timeline = True
    space.transport.play()


def can_play(space: Workspace) -> bool:
    """Whether there is something that moves."""
    start, end = space.transport.range
    return space.document is not None and end > start
