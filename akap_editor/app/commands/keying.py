"""What commands do with the keyframes of the timeline."""

from collections.abc import Callable

from ...editor.animation.keyframe_playback import TIME_STEP
from ..app_state import AppState


def shown(state: AppState) -> bool:
    """Whether there are keyframes, and the timeline shows them."""
    keyed = state.document is not None and state.timeline.is_shown and state.timeline.mode == "keyframes"
    return keyed and bool(state.timeline.keyframe_playback.animation.keyframes)


def has_chosen(state: AppState) -> bool:
    """Whether some of them are chosen."""
    return shown(state) and bool(state.timeline.keyframe_playback.selected)


def keyframe_here(state: AppState) -> None:
    """Keep what is seen as a keyframe; the timeline opens where it is not seen."""
    session, playback = state.editor.session, state.timeline.keyframe_playback
    shown = session.state if session is not None and session.is_previewing else None
    playback.update()
    if not (state.timeline.is_shown and state.timeline.mode == "keyframes"):
        state.timeline.set_mode("keyframes")
        state.timeline.is_shown = True
    if shown is None:
        playback.set_keyframe()
    else:
        playback.set_keyframe(None, shown.positions, shown.crossings)


def toggle_onion(state: AppState) -> None:
    """Show the neighbors of the pose, or not."""
    state.timeline.keyframe_playback.onion_skin.is_shown = (
        not state.timeline.keyframe_playback.onion_skin.is_shown
    )


def nudging(by: float) -> Callable[[AppState], None]:
    """Brings the chosen keyframes forward or back by seconds."""
    return lambda state: state.timeline.keyframe_playback.shift_keyframes(by)


def choose_all(state: AppState) -> None:
    """Select every keyframe, to be moved together."""
    state.timeline.keyframe_playback.selected = frozenset(
        state.timeline.keyframe_playback.stored_animation.times
    )


def going(by: float) -> Callable[[AppState], None]:
    """Looks so many seconds later, or earlier; at keyframes, where the mouse would stop, too."""

    def go(state: AppState) -> None:
        moment = state.timeline.playback.playhead + by
        state.timeline.playback.stop_at(snapped(moment) if state.timeline.mode == "keyframes" else moment)

    return go


def snapped(time: float) -> float:
    """The nearest of the times that a drag of keyframes goes to."""
    return round(time / TIME_STEP) * TIME_STEP


def play(state: AppState) -> None:
    """Play what the timeline shows, or stop."""
    state.timeline.is_shown = True
    state.timeline.playback.toggle_playing()


def can_play(state: AppState) -> bool:
    """Whether there is something that moves."""
    start, end = state.timeline.playback.played_range
    return state.document is not None and end > start
