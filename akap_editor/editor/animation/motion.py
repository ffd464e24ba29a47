"""A recording as a motion: a pose at any time, not only at the recorded ones."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from ...deform.deformer import StepResult
from ...deform.follow_through import STEP_SECONDS, FollowThrough, SwingState
from ...deform.pose_interpolation import InterpolationCache
from ...geometry.validation import Floats, as_number
from ..document.crossings import crossings_in_pose, draw_order
from ..document.document import EditState
from ..document.drawing import Drawing
from ..session.recording import MAX_TIME, Recording
from ..session.replay import ReplayedEvent
from .frames import Frame
from .loose_motion import Crossed, Swings, shown_frame

_SAME_TIME = 1e-6  # seconds
MAX_MOVE_SECONDS = 0.25  # a motion between two recorded times takes at most this long


def shorten_pauses(recording: Recording, longest: float) -> Recording:
    """Shorten the pauses between events to ``longest`` seconds. Raises InputError."""
    as_number(longest, "longest pause", 0, MAX_TIME)
    events, previous, time = [], 0.0, 0.0
    for event in recording.events:
        time += min(event["t"] - previous, longest)
        previous = event["t"]
        events.append({**event, "t": time})
    return replace(recording, events=events)


class _TimedStep(NamedTuple):
    """A step with the pose (n, 2) before it and its share of a segment's time."""

    pose: Floats
    result: StepResult
    share: float


@dataclass(frozen=True, eq=False)
class _Segment:
    """The motion between two recorded times.

    Until ``start`` the frame is ``before``, then ``steps`` lead to ``after`` at ``end``. A step takes a share
    of the time that is proportional to how far it moves. previous, state: those at ``start`` and ``end``.
    """

    start: float
    end: float
    before: Frame
    steps: tuple[_TimedStep, ...]
    after: Frame
    previous: EditState | None
    state: EditState | None

    def state_at(self, time: float) -> EditState | None:
        """The state whose pins and loose parts count: that at the end once the motion to it has begun."""
        return self.state if time > self.start or time >= self.end else self.previous


def _state_frame(drawing: Drawing, state: EditState, pose: Floats) -> Frame:
    """The frame of a pose (n, 2) near that of a state, with the parts in front that are so in the state."""
    mesh, crossings = drawing.mesh, state.crossings
    if pose is not state.positions:
        crossings = crossings_in_pose(mesh, state.pins, state.positions, crossings, pose)
    return Frame(drawing, pose, draw_order(drawing, state.pins, pose, crossings))


class Motion:
    """The frames of a recording that is replayed on a drawing, at ascending times.

    Between two recorded times the drawing moves along its trajectories (`StepResult.at`); with methods that
    have none, each edge rotates and grows at a constant rate (`PoseInterpolation`). So a few recorded steps a
    second play as many frames along arcs. A pose that no step led to appears at once, and so does another
    mesh.
    """

    def __init__(self, drawing: Drawing, events: Iterable[ReplayedEvent]) -> None:
        self._drawing = drawing
        self._groups = (list(group) for _, group in groupby(events, key=attrgetter("time")))
        rest = Frame(drawing, drawing.mesh.vertices)
        self._segment = _Segment(0.0, 0.0, rest, (), rest, None, None)
        self._interpolation = InterpolationCache()
        self._swings, self._next_step = Swings(), 0
        self._swing: tuple[FollowThrough | None, SwingState | None] = None, None

    def frames(self, times: Iterable[float]) -> Iterator[Frame]:
        """The frame at each of ``times``, in seconds, ascending; loose parts swing from the first one on."""
        for time in times:
            while self._next_step * STEP_SECONDS < time - _SAME_TIME:
                self._swing_to(self._next_step * STEP_SECONDS)
                self._next_step += 1
            self._go_to(time)
            yield self._swinging(self._frame(time), time)

    def _go_to(self, time: float) -> None:
        """Replay until the segment of a time."""
        while time > self._segment.end and (group := next(self._groups, None)) is not None:
            self._segment = self._next_segment(group)

    def _swing_to(self, time: float) -> None:
        """Let loose parts swing to the next step."""
        self._go_to(time)
        state_then = self._segment.state_at(time)
        if state_then is None or state_then.loose is None:
            self._swing = None, None
            return
        frame = self._frame(time)
        follow = self._swings.of(frame.drawing.mesh, state_then)
        before, state = self._swing
        if follow is None or follow is not before or state is None:
            self._swing = follow, None if follow is None else follow.start(frame.pose)
        else:
            self._swing = follow, follow.step(state, frame.pose)

    def _swinging(self, frame: Frame, time: float) -> Frame:
        """A frame with its loose parts where they are at its time, which is less than a step after theirs."""
        (follow, swing), state = self._swing, self._segment.state_at(time)
        if follow is None or swing is None or state is None:
            return frame
        if follow is not self._swings.of(frame.drawing.mesh, state):
            return frame
        swing = follow.step(swing, frame.pose, time - (self._next_step - 1) * STEP_SECONDS)
        if swing.is_settled:
            return frame
        crossed = Crossed(state.pins, state.positions, state.crossings)
        return shown_frame(frame.drawing, crossed, follow.shown(swing, frame.pose))

    def _next_segment(self, group: list[ReplayedEvent]) -> _Segment:
        """The segment to a group of events that have the same time."""
        before, last = self._segment.after, group[-1]
        drawing = last.state.drawing or self._drawing
        after = _state_frame(drawing, last.state, last.state.positions)
        if drawing is not before.drawing or any(event.is_jump for event in group):
            return _Segment(last.time, last.time, before, (), after, self._segment.state, last.state)
        pose = before.pose
        moves: list[tuple[Floats, StepResult, float]] = []
        for event in group:
            if event.step is not None:
                moves.append((pose, event.step, float(np.abs(event.state.positions - pose).max())))
            pose = event.state.positions
        total = sum(length for *_, length in moves)
        steps = tuple(_TimedStep(pose, step, length / total) for pose, step, length in moves if length)
        start = max(self._segment.end, last.time - MAX_MOVE_SECONDS) if steps else last.time
        return _Segment(start, last.time, before, steps, after, self._segment.state, last.state)

    def _frame(self, time: float) -> Frame:
        segment = self._segment
        if time >= segment.end:
            return segment.after
        if time <= segment.start:
            return segment.before
        drawing, state = segment.after.drawing, segment.state
        assert state is not None
        share = (time - segment.start) / (segment.end - segment.start)
        for step in segment.steps:
            if share <= step.share:
                break
            share -= step.share
        progress = min(share / step.share, 1.0)
        if step.result.flow is not None:
            return _state_frame(drawing, state, step.result.at(progress))
        pose = self._interpolation.pose(drawing.mesh, step.pose, step.result.positions, progress)
        return _state_frame(drawing, state, pose)
