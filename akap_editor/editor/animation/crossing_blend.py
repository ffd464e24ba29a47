"""Which part passes in front between two poses that may disagree about it."""

from collections.abc import Callable, Sequence

import numpy as np

from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from ...overlap.common_area import common_areas
from ...overlap.overlaps import Overlaps, next_overlaps
from ..document.crossings import following_overlaps, overlaps_of, remember_overlaps
from ..document.keyframes import Keyframe
from ..document.named_poses import NamedPose
from ..document.pin import Pin

_SAMPLES = 12  # poses among which the one is found that overlaps least
_STILL = 1e-6  # share by which areas differ if nothing moves, at most
_MAX_CACHED = 64  # pairs of poses whose time of change is kept


class CrossingBlend:
    """Crossings between two poses: both decide, and what they disagree on changes at one moment.

    That is the moment where the areas they disagree on are smallest, so that the change is seen least; if the
    drawing holds still, it is the end.
    """

    def __init__(self) -> None:
        # The share of the way at which the change is, by the identity of both poses and their crossings.
        self._changes: dict[tuple[int, ...], tuple[tuple[object, ...], float]] = {}

    def crossings(
        self,
        mesh: TriMesh,
        pins: Sequence[Pin],
        start: Keyframe | NamedPose,
        end: Keyframe | NamedPose,
        share: float,
        pose_at: Callable[[float], Floats],
    ) -> tuple[Floats, Ints]:
        """The pose (n, 2) at a ``share`` of the way, 0 to 1, and its crossings (s, 2).

        pose_at: gives the pose at each share.
        """
        pose = pose_at(share)
        first, second = (overlaps_of(mesh, pins, key.positions, key.crossings) for key in (start, end))
        if not len(first) and not len(second):
            overlaps = following_overlaps(mesh, pins, first, pose)
        else:
            is_late = (
                len(first) > 0
                and len(second) > 0
                and share >= self._change(mesh, start, end, first, second, pose_at)
            )
            if is_late or not len(first):
                first, second = second, first
            overlaps = following_overlaps(mesh, pins, first, pose, other=second)
        remember_overlaps(mesh, pose, overlaps)
        return pose, overlaps.crossings

    def _change(
        self,
        mesh: TriMesh,
        start: Keyframe | NamedPose,
        end: Keyframe | NamedPose,
        first: Overlaps,
        second: Overlaps,
        pose_at: Callable[[float], Floats],
    ) -> float:
        things = mesh, start.positions, start.crossings, end.positions, end.crossings
        key = tuple(map(id, things))
        if key not in self._changes:
            least, most, change = np.inf, 0.0, 0.0
            for share in ((np.arange(_SAMPLES) + 0.5) / _SAMPLES).tolist():
                area = _disputed_area(mesh, pose_at(share), first, second)
                if area < least:
                    least, change = area, share
                most = max(most, area)
                if area == 0:  # less is not possible
                    break
            if least > (1 - _STILL) * most:
                change = 1.0
            while len(self._changes) >= _MAX_CACHED:
                del self._changes[next(iter(self._changes))]
            self._changes[key] = things, change
        return self._changes[key][1]


def _disputed_area(mesh: TriMesh, pose: Floats, first: Overlaps, second: Overlaps) -> float:
    """Area of a pose (n, 2) in square pixels on which two overlaps lead to different decisions."""
    a, b = (next_overlaps(mesh, pose, overlaps) for overlaps in (first, second))
    if not len(a) or len(a) != len(b):
        return 0.0
    disputed = np.flatnonzero(a.signs != b.signs)
    pairs = a.pairs.first[disputed], a.pairs.second[disputed]
    return float(common_areas(pose, mesh.faces, *pairs).sum())
