"""The fewest poses of a recorded motion through which a smooth motion stays near all of them."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ....geometry.mesh import TriMesh
from ....geometry.validation import Floats, Ints
from ...document.easing import end_velocities
from ...document.keyframes import Keyframe
from ..pose_spline import Interval, PoseSpline


class TakePose(NamedTuple):
    """A pose (n, 2) of a take at a time in seconds, with its crossings (s, 2).

    is_jump: whether it appears at once, as after an undo, instead of being moved to.
    """

    time: float
    positions: Floats
    crossings: Ints
    is_jump: bool = False


class Simplification:
    """Chooses keyframes among the poses of a take, one after the other, each where the motion is most off.

    Between the chosen ones the drawing moves smoothly, as `PoseSpline` does. So the choice depends on the
    take only; a lower tolerance adds to it. Poses must have ascending times; ends and jumps are always kept.
    error: pixels by which a vertex is most off with the poses chosen so far; infinite until it is known.
    """

    def __init__(self, mesh: TriMesh, poses: Sequence[TakePose]) -> None:
        self._poses, self._spline = poses, PoseSpline(mesh)
        fixed = {0, len(poses) - 1}
        for number in range(1, len(poses)):
            if poses[number].is_jump:
                fixed |= {number - 1, number}
        self._kept = sorted(fixed)
        self._worst: dict[
            int, tuple[float, int]
        ] = {}  # error and number of the pose, by the first of an interval
        self._added: list[tuple[float, int]] = []  # the errors before poses were added, and their numbers
        self.error = float("inf")

    def refine(self, tolerance: float) -> Iterator[None]:
        """Add poses until no vertex is off by more than ``tolerance`` pixels; yields after each try."""
        while True:
            for start, end in pairwise(self._kept):
                if start not in self._worst:
                    yield from self._measure(start, end)
            self.error, number = max(self._worst.values(), key=lambda each: (each[0], -each[1]))
            if self.error <= tolerance:
                return
            self._added.append((self.error, number))
            self._insert(number)

    def count(self, tolerance: float) -> int | None:
        """The number of keyframes for a tolerance; None until `refine` has come so far."""
        numbers = self._numbers(tolerance)
        return None if numbers is None else len(numbers)

    def keyframes(self, tolerance: float, start: float = 0.0) -> list[Keyframe]:
        """The keyframes for a tolerance, the first at the time ``start``; `refine` must have come so far."""
        numbers = self._numbers(tolerance)
        assert numbers is not None, "expected a refined take"
        shift = start - self._poses[0].time
        chosen = [self._poses[number] for number in numbers]
        eases = ["hold" if after.is_jump else "smooth" for after in chosen[1:]] + ["smooth"]
        return [
            Keyframe(pose.time + shift, pose.positions, ease, pose.crossings)
            for pose, ease in zip(chosen, eases, strict=True)
        ]

    def _numbers(self, tolerance: float) -> list[int] | None:
        added = []
        for error, number in self._added:
            if error <= tolerance:
                break
            added.append(number)
        else:
            if self.error > tolerance:
                return None
        later = {number for _, number in self._added[len(added) :]}
        return [number for number in self._kept if number not in later]

    def _insert(self, number: int) -> None:
        """Keep a pose. The intervals beside it, and their neighbors, whose ends flow on into them, change."""
        at = int(np.searchsorted(self._kept, number))
        self._kept.insert(at, number)
        for start in self._kept[max(at - 2, 0) : at + 2]:
            self._worst.pop(start, None)
        self.error = float("inf")

    def _measure(self, start: int, end: int) -> Iterator[None]:
        """Find the pose between two kept ones that the motion misses most."""
        worst = 0.0, start
        at = self._kept.index(start)
        before = self._interval(at - 1) if at > 0 else None
        interval = self._interval(at)
        after = self._interval(at + 1) if at + 2 < len(self._kept) else None
        for number in range(start + 1, end):
            pose = self._poses[number]
            share = (pose.time - self._poses[start].time) / interval.seconds
            offsets = self._spline.pose(before, interval, after, share) - pose.positions
            error = float(np.sqrt((offsets**2).sum(axis=1).max()))
            if error > worst[0]:
                worst = error, number
            yield
        self._worst[start] = worst

    def _interval(self, at: int) -> Interval:
        start, end = (self._poses[number] for number in self._kept[at : at + 2])
        velocity = end_velocities("hold" if end.is_jump else "smooth")
        return Interval(start.positions, end.positions, end.time - start.time, velocity)
