"""The animation of keyframes, looked at at any time, played, and changed."""

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from ...deform.pose_interpolation import InterpolationCache
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats
from ..document.depth import face_order
from ..document.document import Document
from ..document.keyframes import MAX_KEYFRAME_TIME, NO_ANIMATION, Animation, as_keyframe_time
from ..document.pin_angles import pins_fixed_at_pose
from ..editor import Editor
from ..session.edits import DeleteKeyframes, MoveKeyframes, SetEasing, SetKeyframe, SetLoop
from ..session.edits.keyframes import KeyframeEdit
from ..session.session import Session
from .frames import Frame
from .playback import Playback
from .time_view import VisibleRange

GAP = 0.5  # seconds between a keyframe and one that is put after it without a time
STEP = 0.05  # seconds: what times snap to, and what keys move by
MOST_SKINS = 6  # of the onion skin, on each side
SHORTEST_VIEW = 2.0  # seconds on the timeline, where it shows all

Edge = Literal["keyframes", "frames"]


@dataclass
class OnionSkin:
    """Neighbors of the pose that is seen, shown translucently.

    of: whether keyframes before and after, or moments a ``step`` of seconds apart; count: on each side.
    """

    shown: bool = False
    of: Edge = "keyframes"
    count: int = 2
    step: float = 0.1


class KeyframePlayback(Playback):
    """Shows the keyframes of an editor's drawing at the moment ``at``; see `Session.visit`.

    Looking edits nothing. The next gesture takes the pose that is seen, and then it is the present one, until
    another moment is looked at. chosen: times of the keyframes that are selected; view: the part of the time
    that the timeline shows.
    """

    def __init__(self, editor: Editor, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(clock)
        self.onion = OnionSkin()
        self._editor = editor
        self._ways = InterpolationCache()
        self._session: Session | None = None
        self._forget()

    def _forget(self) -> None:
        self.at: float = 0.0
        self.cut = self._played = None
        self.chosen: frozenset[float] = frozenset()
        self.view = VisibleRange(SHORTEST_VIEW)
        self._moved: tuple[dict[float, float], bool] | None = None  # of a drag: times to times, as copies
        self._beneath: Floats | None = None  # the present pose while another one is followed

    # -- what is there -------------------------------------------------------------------------------------

    @property
    def animation(self) -> Animation:
        """As a drag of keyframes would leave it."""
        kept = NO_ANIMATION if self._editor.session is None else self._editor.session.present.animation
        return kept if self._moved is None else kept.with_moved_keyframes(*self._moved)

    @property
    def duration(self) -> float:
        """Seconds from 0 to the last keyframe."""
        return self.animation.duration

    @property
    def loop(self) -> bool:
        """Whether playing starts over; kept with the keyframes."""
        return self.animation.loop

    @loop.setter
    def loop(self, loop: bool) -> None:
        self._edit("Play over and over" if loop else "Play once", SetLoop(loop))

    @property
    def following(self) -> bool:
        """Whether the moment is shown, and not the present pose."""
        return self._beneath is not None

    @property
    def held(self) -> bool:
        """Whether keyframes are being dragged."""
        return self._moved is not None

    @property
    def kept_times(self) -> tuple[float, ...]:
        """Of all keyframes, without a drag."""
        return () if self._editor.session is None else self._editor.session.present.animation.times

    @property
    def shown_chosen(self) -> frozenset[float]:
        """Where the chosen keyframes are during a drag."""
        if self._moved is None:
            return self.chosen
        return frozenset(self._moved[0].get(time, time) for time in self.chosen)

    def pose(self, moment: float) -> Floats | None:
        """The pose (n, 2) at a time; None without keyframes."""
        session, animation = self._editor.session, self.animation
        if session is None or not animation.keyframes:
            return None
        return pose_at(self._ways, session.drawing.mesh, animation, moment)

    def frame(self, moment: float) -> Frame:
        """What is seen at a time; there must be keyframes."""
        session, pose = self._editor.session, self.pose(moment)
        assert session is not None
        assert pose is not None, "expected keyframes"
        return Frame(session.drawing, pose, face_order(session.drawing.mesh, session.present.pins))

    def neighbors(self) -> tuple[list[Floats], list[Floats]]:
        """Poses before and after the moment, the nearest ones first, as the onion skin is to show them."""
        animation, onion = self.animation, self.onion
        if self.playing or not onion.shown or not animation.keyframes:
            return [], []
        if onion.of == "keyframes":
            here = as_keyframe_time(self.at)
            before = [key.positions for key in reversed(animation.keyframes) if key.time < here]
            after = [key.positions for key in animation.keyframes if key.time > here]
            return before[: onion.count], after[: onion.count]
        steps = [onion.step * (number + 1) for number in range(onion.count)]
        earlier = (self.pose(self.at - step) for step in steps if self.at - step >= -1e-9)
        later = (self.pose(self.at + step) for step in steps if self.at + step <= self.duration + 1e-9)
        return [each for each in earlier if each is not None], [each for each in later if each is not None]

    # -- looking -------------------------------------------------------------------------------------------

    def watch(self) -> None:
        """Take notice of what was edited; to be called once a frame."""
        session = self._editor.session
        if session is not self._session:
            self._session = session
            self._forget()
        if session is None:
            return
        self.chosen &= set(self.kept_times)
        if not self.held:
            self.view.fit(max(SHORTEST_VIEW, 1.2 * self.duration, self.at))
        if self._beneath is None or session.is_previewing or session.history.is_open:
            return
        if session.state.positions is self._beneath:  # what was edited is no pose
            self._show()
        else:
            self._beneath = self._played = None

    def scrub(self, moment: float) -> None:
        """Look at a moment, also after the last keyframe; without keyframes the present pose stays."""
        self.at = min(max(moment, 0.0), MAX_KEYFRAME_TIME)
        self.view.reveal(self.at)
        self._show()

    def _show(self) -> None:
        session, pose = self._editor.session, self.pose(self.at)
        if session is None or session.history.is_open:
            return
        if pose is None:
            self.leave()
            return
        present = session.present
        self._beneath = present.positions
        pins = pins_fixed_at_pose(session.drawing.mesh, present.pins, pose)
        session.preview(replace(present, positions=pose, pins=pins), takes_pose=True)

    def leave(self) -> None:
        """Show the present pose."""
        self._beneath = self._played = None
        if self._editor.session is not None and not self._editor.session.history.is_open:
            self._editor.session.end_preview()

    def step(self, forward: bool) -> None:
        """Look at the next keyframe, or the one before."""
        here, times = as_keyframe_time(self.at), self.animation.times
        if forward:
            there = next((time for time in times if time > here), None)
        else:
            there = next((time for time in reversed(times) if time < here), None)
        if there is not None:
            self.chosen = frozenset({there})
            self.scrub(there)

    # -- keyframes -----------------------------------------------------------------------------------------

    def put(self, moment: float | None = None, positions: Floats | None = None) -> None:
        """A keyframe of what is seen, or of a pose (n, 2), at a moment, by default where one looks."""
        session = self._editor.session
        if session is None or self._editor.busy:
            return
        time = as_keyframe_time(self.at if moment is None else moment)
        if positions is None and self.following:
            positions = session.state.positions
        label = "Change keyframe" if time in self.animation.times else "Add keyframe"
        self._edit(label, SetKeyframe(time, positions))
        self.chosen, self.at = frozenset({time}), time

    def remove(self) -> None:
        """Take away the chosen keyframes, or the one where one looks."""
        gone = self._meant()
        if gone:
            self._edit(_counted("Remove", gone), DeleteKeyframes(gone))
            self.chosen = frozenset()

    def duplicate(self) -> None:
        """Copies of the chosen keyframes, or of the one where one looks, after the last one."""
        meant = self._meant()
        if meant:
            by = self.duration + GAP - meant[0]
            self._place(
                {time: as_keyframe_time(min(time + by, MAX_KEYFRAME_TIME)) for time in meant}, copy=True
            )

    def nudge(self, by: float) -> None:
        """Bring the chosen keyframes forward or back in time; the first stays at 0 or later."""
        meant = self._meant()
        if meant:
            by = max(by, -meant[0])
            self._place({time: as_keyframe_time(min(time + by, MAX_KEYFRAME_TIME)) for time in meant})

    def set_time(self, old: float, new: float) -> None:
        """Another time for one keyframe."""
        self._place({old: as_keyframe_time(min(max(new, 0.0), MAX_KEYFRAME_TIME))})

    def ease(self, ease: str | None, general: bool = False) -> None:
        """How it goes on from the chosen keyframes; general: wherever nothing else is said."""
        times = None if general else self._meant()
        if general or times:
            self._edit("Change easing", SetEasing(times, ease))

    def _meant(self) -> list[float]:
        """Times of the chosen keyframes, or of the one where one looks."""
        return sorted(self.chosen) or [
            time for time in self.animation.times if time == as_keyframe_time(self.at)
        ]

    # -- keyframes that are dragged ------------------------------------------------------------------------

    def drag(self, moves: Mapping[float, float], copy: bool = False) -> None:
        """Show the animation with keyframes at other times; nothing is edited before `drop`."""
        moves = {old: as_keyframe_time(min(max(new, 0.0), MAX_KEYFRAME_TIME)) for old, new in moves.items()}
        self._moved = moves, copy
        if self.following:
            self._show()

    def drop(self, keep: bool = True) -> None:
        """End the drag; its keyframes stay where they are, or return."""
        if self._moved is None:
            return
        (moves, copy), self._moved = self._moved, None
        if keep and any(old != new for old, new in moves.items()):
            self._place(moves, copy)
        elif self.following:
            self._show()

    def _place(self, moves: Mapping[float, float], copy: bool = False) -> None:
        label = _counted("Duplicate" if copy else "Move", moves)
        self._edit(label, MoveKeyframes(dict(moves), copy))
        if self.chosen or copy:
            self.chosen = frozenset(moves.get(time, time) for time in self.chosen or moves)
        if not copy and as_keyframe_time(self.at) in moves:
            self.at = moves[as_keyframe_time(self.at)]

    def _edit(self, label: str, edit: KeyframeEdit) -> None:
        session = self._editor.session
        if session is None or self._editor.busy:
            return
        session.end_preview()
        self._editor.apply(label, edit)
        if self.following:
            self._show()


def pose_at(ways: InterpolationCache, mesh: TriMesh, animation: Animation, moment: float) -> Floats:
    """The pose (n, 2) of an animation of a mesh at a time; there must be keyframes."""
    start, end, share = animation.keyframes_around(moment)
    return ways.pose(mesh, start.positions, end.positions, share)


def keyed_frame(document: Document, ways: InterpolationCache, moment: float) -> Frame:
    """What is seen of a document's keyframes at a time; there must be some."""
    pose = pose_at(ways, document.drawing.mesh, document.state.animation, moment)
    return Frame(document.drawing, pose, document.face_order)


def stretched(times: Iterable[float], dragged: float, to: float) -> dict[float, float]:
    """New times of keyframes when the one at ``dragged`` moves, and the first or the last one stays."""
    ordered = sorted(times)
    fixed = ordered[-1] if dragged == ordered[0] else ordered[0]
    span = dragged - fixed
    share = (to - fixed) / span if span else 1.0
    least = STEP / max(abs(span), STEP)
    return {time: fixed + max(share, least) * (time - fixed) for time in ordered}


def _counted(verb: str, keys: Mapping[float, float] | list[float]) -> str:
    return f"{verb} keyframe" if len(keys) == 1 else f"{verb} {len(keys)} keyframes"
