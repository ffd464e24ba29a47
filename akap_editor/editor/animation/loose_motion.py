"""Follow-through of loose parts in a motion, at any of its times, and on the canvas while it is edited."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import ceil, floor
from typing import NamedTuple

import numpy as np

from ...deform.follow_through import STEP_SECONDS, FollowThrough, SwingState
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from ..document.crossings import crossings_in_pose, draw_order
from ..document.document import Document, EditState
from ..document.drawing import Drawing
from ..document.pin import Pin
from .crossing_blend import CrossingBlend
from .frames import Frame
from .keyframe_poses import KeyframePoses, animation_crossings, period_of

_CHUNK = 240  # steps that are computed from one beginning at rest
_FADED = 1e-3  # share of a swing: what was before it does not matter
_MOST_STEPS_BEHIND = 8  # of the canvas: a window that was slower than that lets loose parts swing slower
_CACHED_CHUNKS = 24
_KEPT_SWINGS = 8


class Instant(NamedTuple):
    """What a motion shows at a time, without follow-through.

    positions: (n, 2); state: with the pins, joints and loose parts; its own pose does not matter.
    """

    drawing: Drawing
    state: EditState
    positions: Floats


class Crossed(NamedTuple):
    """A pose (n, 2) with its pins and crossings (s, 2), which decide on poses near it."""

    pins: tuple[Pin, ...]
    positions: Floats
    crossings: Ints


class Swings:
    """The `FollowThrough` of states; kept for the last ones that have other loose parts, pins or joints."""

    def __init__(self) -> None:
        self._known: dict[tuple[object, ...], FollowThrough] = {}

    def of(self, mesh: TriMesh, state: EditState) -> FollowThrough | None:
        """What swings in a state; None if nothing does."""
        loose = state.loose
        if loose is None or len(loose.faces) != len(mesh.faces):
            return None
        anchors = [pin.face for pin in state.pins]
        anchors += [face for joint in state.joints for face in joint.faces]
        key = mesh, loose, tuple(anchors)
        follow = self._known.get(key)
        if follow is None:
            faces = np.array(anchors, dtype=np.int64)
            follow = FollowThrough(mesh, loose.faces, faces, loose.speed, loose.bounce)
            self._known[key] = follow
            while len(self._known) > _KEPT_SWINGS:
                del self._known[next(iter(self._known))]
        return None if follow.is_empty else follow


def shown_frame(drawing: Drawing, crossed: Crossed, positions: Floats) -> Frame:
    """The frame of a drawing whose loose parts are where a pose (n, 2) has them."""
    pins = crossed.pins
    crossings = crossings_in_pose(drawing.mesh, pins, crossed.positions, crossed.crossings, positions)
    return Frame(drawing, positions, draw_order(drawing, pins, positions, crossings))


@dataclass
class _Chunk:
    """States of some steps in a row; each with what swings and the pose before."""

    first: int
    states: list[tuple[FollowThrough | None, SwingState | None]] = field(default_factory=list)


class LooseMotion:
    """The poses of a motion with follow-through, at any times and in any order.

    at: the motion itself, from 0 s on; period: seconds after which it begins anew without a seam, None if it
    does not. Steps of 1/60 s are computed from a moment so long before that nothing of a swing would be left,
    in a loop also before its beginning, so that a pose depends on its time only; they are kept.
    """

    def __init__(self, at: Callable[[float], Instant], period: float | None = None) -> None:
        self._motion, self._period = at, period
        self._swings = Swings()
        self._chunks: dict[int, _Chunk] = {}

    def pose(self, time: float) -> Floats | None:
        """The pose (n, 2) that is shown at a time in seconds; None if nothing swings then.

        Nothing does after the end of a loop.
        """
        if self._period is not None:
            if time > self._period:
                return None
            time %= self._period
        instant = self._at(time)
        current = self._swings.of(instant.drawing.mesh, instant.state)
        if current is None:
            return None
        step = max(floor(time / STEP_SECONDS + 1e-6), 0)
        follow, state = self._state(step)
        if current is not follow or state is None:
            return None
        rest = time - step * STEP_SECONDS
        if rest > 1e-6:
            state = current.step(state, instant.positions, rest)
        return None if state.is_settled else current.shown(state, instant.positions)

    def _at(self, time: float) -> Instant:
        return self._motion(time if self._period is None else time % self._period)

    def _state(self, step: int) -> tuple[FollowThrough | None, SwingState | None]:
        """What swings after a step, and how."""
        number = step // _CHUNK
        chunk = self._chunks.get(number)
        if chunk is None:
            instant = self._at(number * _CHUNK * STEP_SECONDS)
            first = number * _CHUNK - _fading_steps(instant.state)
            chunk = self._chunks[number] = _Chunk(first if self._period is not None else max(first, 0))
            while len(self._chunks) > _CACHED_CHUNKS:
                del self._chunks[next(iter(self._chunks))]
        while chunk.first + len(chunk.states) <= step:
            chunk.states.append(self._next(chunk))
        return chunk.states[step - chunk.first]

    def _next(self, chunk: _Chunk) -> tuple[FollowThrough | None, SwingState | None]:
        instant = self._at((chunk.first + len(chunk.states)) * STEP_SECONDS)
        follow = self._swings.of(instant.drawing.mesh, instant.state)
        if follow is None:
            return None, None
        before, state = chunk.states[-1] if chunk.states else (None, None)
        if before is not follow or state is None:
            return follow, follow.start(instant.positions)
        return follow, follow.step(state, instant.positions)


def _fading_steps(state: EditState) -> int:
    """After how many steps nothing is left of a swing."""
    if state.loose is None:
        return 0
    half_swings = np.log(_FADED) / np.log(np.clip(state.loose.bounce, _FADED, 0.999))
    return ceil(half_swings / (2 * state.loose.speed * STEP_SECONDS))


class LooseCanvas:
    """Lets loose parts on the canvas swing while their drawing moves; to be updated once a frame.

    is_moving: whether something swings, so that another frame is due.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._swings = Swings()
        self._follow: FollowThrough | None = None
        self._state: SwingState | None = None
        self._time = 0.0
        self._discontinuities = 0
        self._shown: tuple[Floats, Floats] | None = None  # the document's pose, and what is shown for it
        self.is_moving = False

    def pose(self, drawing: Drawing, state: EditState, discontinuities: int = 0) -> Floats:
        """The pose (n, 2) that is shown now for a state.

        discontinuities: number of changes of the pose, such as undo, after which nothing is to swing.
        """
        now, pose = self._clock(), state.positions
        follow = self._swings.of(drawing.mesh, state)
        if follow is None:
            self._follow, self._state, self.is_moving = None, None, False
            return pose
        if follow is not self._follow or self._state is None or discontinuities != self._discontinuities:
            self._follow, self._state, self.is_moving = follow, follow.start(pose), False
            self._discontinuities = discontinuities
        if not self.is_moving:
            self._time = now - STEP_SECONDS
        steps = int((now - self._time) / STEP_SECONDS + 1e-6)
        for _ in range(min(steps, _MOST_STEPS_BEHIND)):
            self._state = follow.step(self._state, pose)
        self._time = now if steps > _MOST_STEPS_BEHIND else self._time + steps * STEP_SECONDS
        self.is_moving = not self._state.is_settled
        if not self.is_moving:
            return pose
        if steps or self._shown is None or self._shown[0] is not pose:
            self._shown = pose, follow.shown(self._state, pose)
        return self._shown[1]


class AnimationFrames:
    """The frames of a document's keyframes, with follow-through."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._poses, self._blend = KeyframePoses(), CrossingBlend()
        self._loose = LooseMotion(self._instant, period_of(document.state.animation))

    def frame(self, time: float) -> Frame:
        """The frame at a time in seconds; there must be keyframes."""
        drawing, crossed = self.crossed(time)
        return Frame(drawing, crossed.positions, draw_order(drawing, *crossed))

    def crossed(self, time: float) -> tuple[Drawing, Crossed]:
        """The drawing, with the layers that are visible at a time in seconds, and its pose."""
        document = self._document
        mesh, animation = document.drawing.mesh, document.state.animation
        pose, crossings = animation_crossings(
            self._poses, self._blend, mesh, document.state.pins, animation, time
        )
        pins = animation.pins_at(document.state.pins, time)
        swinging = None if document.state.loose is None else self._loose.pose(time)
        if swinging is not None:
            crossings = crossings_in_pose(mesh, pins, pose, crossings, swinging)
            pose = swinging
        return self._poses.drawing(document.drawing, animation, time), Crossed(pins, pose, crossings)

    def _instant(self, time: float) -> Instant:
        document = self._document
        moment = self._poses.moment(document.drawing.mesh, document.state.animation, time)
        return Instant(document.drawing, document.state, moment.pose)
