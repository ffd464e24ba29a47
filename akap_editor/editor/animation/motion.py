"""A recording as a motion: a pose for every time, not only for those that were recorded."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from operator import attrgetter

import numpy as np

from ...deform.deformer import StepResult
from ...deform.pose_interpolation import InterpolationCache
from ...geometry.validation import Floats, as_number
from ..document.depth import face_order
from ..document.drawing import Drawing
from ..session.recording import MAX_TIME, Recording
from ..session.replay import ReplayedEvent
from .frames import Frame

LONGEST_MOVE = 0.25  # seconds: what moved after a longer pause moved in the last of it


def shorten_pauses(recording: Recording, longest: float) -> Recording:
    """The same, but where nothing was done for more than ``longest`` seconds, that long only."""
    as_number(longest, "longest pause", 0, MAX_TIME)
    events, before, now = [], 0.0, 0.0
    for event in recording.events:
        now += min(event["t"] - before, longest)
        before = event["t"]
        events.append({**event, "t": now})
    return replace(recording, events=events)


@dataclass(frozen=True, eq=False)
class _Segment:
    """From ``start``, where ``steps`` begin, to ``end``, where it is ``after``; earlier it is ``before``.

    steps: each with the pose that it began with, and with the share of the time that it takes, which is that
    of the way.
    """

    start: float
    end: float
    before: Frame
    steps: tuple[tuple[Floats, StepResult, float], ...]
    after: Frame


class Motion:
    """What is seen of a recording of ``drawing`` that is done again, at times that do not fall.

    Between two recorded times the drawing moves along its trajectories (`StepResult.at`); of methods that
    know none, each edge turns at a constant rate (`PoseInterpolation`). So a few recorded steps a second play
    as many frames along arcs. A pose that was set, and not reached by steps, comes at once, and so does
    another mesh.
    """

    def __init__(self, drawing: Drawing, moments: Iterable[ReplayedEvent]) -> None:
        self._drawing = drawing
        self._groups = (list(group) for _, group in groupby(moments, key=attrgetter("time")))
        rest = Frame(drawing, drawing.mesh.vertices)
        self._stretch = _Segment(0.0, 0.0, rest, (), rest)
        self._ways = InterpolationCache()

    def frames(self, times: Iterable[float]) -> Iterator[Frame]:
        """Drawing and pose at each of ``times``, in seconds, ascending."""
        for time in times:
            while time > self._stretch.end and (group := next(self._groups, None)) is not None:
                self._stretch = self._next(group)
            yield self._frame(time)

    def _next(self, group: list[ReplayedEvent]) -> _Segment:
        before, last = self._stretch.after, group[-1]
        drawing, pose, _ = before
        bent = last.state.drawing or self._drawing
        after = Frame(bent, last.state.positions, face_order(bent.mesh, last.state.pins))
        if bent is not drawing or any(moment.jumped for moment in group):
            return _Segment(last.time, last.time, before, (), after)
        moved: list[tuple[Floats, StepResult, float]] = []
        for moment in group:
            if moment.step is not None:
                moved.append((pose, moment.step, float(np.abs(moment.state.positions - pose).max())))
            pose = moment.state.positions
        way = sum(length for *_, length in moved)
        steps = tuple((began, step, length / way) for began, step, length in moved if length)
        start = max(self._stretch.end, last.time - LONGEST_MOVE) if steps else last.time
        return _Segment(start, last.time, before, steps, after)

    def _frame(self, time: float) -> Frame:
        stretch = self._stretch
        if time >= stretch.end:
            return stretch.after
        if time <= stretch.start:
            return stretch.before
        local = (time - stretch.start) / (stretch.end - stretch.start)
        drawing, order = stretch.after.drawing, stretch.after.order
        for began, step, share in stretch.steps:  # noqa: B007
            if local <= share:
                break
            local -= share
        local = min(local / share, 1.0)
        if step.flow is not None:
            return Frame(drawing, step.at(local), order)
        return Frame(drawing, self._ways.pose(drawing.mesh, began, step.positions, local), order)
