"""The poses of an animation between its keyframes, by the easing of each interval."""

from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ...deform.pose_interpolation import InterpolationCache
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from ...layers.layer_view import LayerView
from ..document.drawing import Drawing
from ..document.easing import end_velocities
from ..document.keyframes import Animation, Keyframe
from ..document.pin import Pin
from .crossing_blend import CrossingBlend
from .frames import POSE_TOLERANCE
from .pose_spline import Interval, PoseSpline

_MAX_MOMENTS = 8  # that are kept


class Moment(NamedTuple):
    """A time between two keyframes.

    share: of the motion from ``start`` to ``end`` that is over, 0 to 1 unless a curve overshoots; pose_at:
    the pose (n, 2) at a share.
    """

    start: Keyframe
    end: Keyframe
    share: float
    pose_at: Callable[[float], Floats]

    @property
    def pose(self) -> Floats:
        """The pose (n, 2)."""
        return self.pose_at(self.share)


class KeyframePoses:
    """Gives the poses of animations, and keeps what was prepared for the last mesh."""

    def __init__(self) -> None:
        self._interpolation = InterpolationCache()
        self._mesh: TriMesh | None = None
        self._spline: PoseSpline | None = None
        self._drawing: Drawing | None = None
        self._views: dict[LayerView | None, Drawing] = {}  # of the drawing
        # By the identity of a mesh and an animation, which keep their ids meanwhile, and the time.
        self._moments: OrderedDict[tuple[int, int, float], tuple[TriMesh, Animation, Moment]] = OrderedDict()

    def drawing(self, drawing: Drawing, animation: Animation, time: float) -> Drawing:
        """The drawing with the layers that are visible at a time; the same object for the same ones."""
        if drawing is not self._drawing:
            self._drawing, self._views = drawing, {}
        view = animation.layer_view_at(time) if drawing.layers else None
        if view not in self._views:
            self._views[view] = drawing.with_layer_view(view)
        return self._views[view]

    def moment(self, mesh: TriMesh, animation: Animation, time: float) -> Moment:
        """The moment of an animation of a mesh at a time in seconds; there must be keyframes.

        The last moments are kept with their poses.
        """
        key = id(mesh), id(animation), time
        if key not in self._moments:
            self._moments[key] = mesh, animation, self._new_moment(mesh, animation, time)
            if len(self._moments) > _MAX_MOMENTS:
                self._moments.popitem(last=False)
        return self._moments[key][2]

    def _new_moment(self, mesh: TriMesh, animation: Animation, time: float) -> Moment:
        start, end, share = animation.keyframes_around(time)
        if start is end or animation.easing_after(start) != "smooth":

            def pose_at(share: float) -> Floats:
                return self._interpolation.pose(mesh, start.positions, end.positions, share)

        else:
            before, interval, after = _intervals_around(animation, start)
            spline = self._spline_of(mesh)

            def pose_at(share: float) -> Floats:
                return spline.pose(before, interval, after, share)

        return Moment(start, end, share, _remembering(pose_at, share))

    def _spline_of(self, mesh: TriMesh) -> PoseSpline:
        if self._spline is None or mesh is not self._mesh:
            self._mesh, self._spline = mesh, PoseSpline(mesh)
        return self._spline


def animation_crossings(
    poses: KeyframePoses,
    blend: CrossingBlend,
    mesh: TriMesh,
    pins: Sequence[Pin],
    animation: Animation,
    time: float,
) -> tuple[Floats, Ints]:
    """The pose (n, 2) of an animation at a time and its crossings (s, 2); there must be keyframes."""
    start, end, share, pose_at = poses.moment(mesh, animation, time)
    pins = animation.pins_at(pins, time)
    return blend.crossings(mesh, pins, start, end, share, pose_at)


def _remembering(pose_at: Callable[[float], Floats], share: float) -> Callable[[float], Floats]:
    """The same function; the pose at ``share`` is computed once."""
    kept: list[Floats] = []

    def pose(other: float) -> Floats:
        if other != share:
            return pose_at(other)
        if not kept:
            kept.append(pose_at(share))
        return kept[0]

    return pose


def _intervals_around(
    animation: Animation, start: Keyframe
) -> tuple[Interval | None, Interval, Interval | None]:
    """The intervals before, at and after that from the keyframe ``start``; None where the motion rests."""
    keyframes = animation.keyframes
    index, last = keyframes.index(start), len(keyframes) - 2
    flows_on = period_of(animation) is not None
    before = index - 1 if index > 0 else last if flows_on else None
    after = index + 1 if index < last else 0 if flows_on else None
    sides = [None if each is None else _interval(animation, each) for each in (before, after)]
    return sides[0], _interval(animation, index), sides[1]


def _interval(animation: Animation, index: int) -> Interval:
    start, end = animation.keyframes[index : index + 2]
    velocity = end_velocities(animation.easing_after(start))
    return Interval(start.positions, end.positions, end.time - start.time, velocity)


def period_of(animation: Animation) -> float | None:
    """Seconds after which an animation begins anew without a seam; None if it does not."""
    if not animation.loop or len(animation.keyframes) < 2:
        return None
    first, last = animation.keyframes[0], animation.keyframes[-1]
    is_seamless = first.time == 0 and np.allclose(
        first.positions, last.positions, rtol=0.0, atol=POSE_TOLERANCE
    )
    return animation.duration if is_seamless else None
