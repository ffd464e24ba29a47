"""Interpolation of a sequence of poses whose speed is continuous where one interval follows another."""

from collections import OrderedDict
from math import cos, pi, sin
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...deform.pose_interpolation import PoseInterpolation
from ...geometry.area_bounds import bound_face_areas, worst_area_factor
from ...geometry.mesh import TriMesh
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats

_T = TypeVar("_T", Floats, Complexes)
_MAX_PAIRS = 64  # of poses, for which what was prepared is kept
_MAX_MOTIONS = 4  # intervals between their neighbors, for which what was prepared is kept
_STATIONARY = 1e-3  # share of √area: vertices that move less count as stationary, all with the same weight
_NO_CENTER = 1e-6  # |1 − eˢ| below which s is a translation: no center to rotate about
_STEEPEST = 2.0  # times the mean slope of an interval: with steeper ends, `_curve` may not be monotone
_BLEND = 0.25  # share of an interval over which the weights of its ends fade

Velocity = tuple[float, float]  # at the start and the end of an interval, in units of its mean velocity


class Interval(NamedTuple):
    """The motion from one pose (n, 2) to the next.

    seconds: its length; velocity: None if it joins its neighbors smoothly, else what its easing prescribes.
    """

    start: Floats
    end: Floats
    seconds: float
    velocity: Velocity | None = None


class _Path(NamedTuple):
    """What is prepared for two poses a and b (n,).

    edges: (e,) of a; rates: (e,) s of each edge, see `PoseInterpolation`; vertex_rates: (n,) their means;
    distances: (n,) of the vertices in both poses, squared; max_factor: the worst area factor of both.
    """

    a: Complexes
    b: Complexes
    edges: Complexes
    rates: Complexes
    vertex_rates: Complexes
    distances: Floats
    max_factor: float


class _Slopes(NamedTuple):
    """Speeds at a key.

    rates, vertex_rates: of the edges (e,) and the vertices (n,), 1/s; velocities: of the vertices (n,), px/s.
    """

    rates: Complexes
    vertex_rates: Complexes
    velocities: Complexes


class _Curve(NamedTuple):
    """A line plus half a wave from 0 to a rise, with given slopes at both ends; see `_curve`.

    mean: of the slopes; rest: the rise without it; difference: of the slopes.
    """

    mean: Complexes
    rest: Complexes
    difference: Complexes

    def at(self, t: float) -> Complexes:
        """The values (n,) at a share of the time."""
        wave = self.rest * (1 - cos(pi * t)) / 2 + self.difference * sin(pi * t) / (2 * pi)
        return np.asarray(t * self.mean + wave)


class _Motion(NamedTuple):
    """What is prepared for an interval between its neighbors.

    logs: (e,) of what the edges are multiplied by; vertex_logs: (n,) their means; has_center: (n,) whether
    a vertex rotates about one; totals: (n,) e to its rate, minus 1; corrections: (n,) of its place on its
    spiral; weights: (n,) of the vertices that place the pose, without and with the neighbor before and after.
    """

    path: _Path
    logs: _Curve
    vertex_logs: _Curve
    has_center: NDArray[np.bool_]
    totals: Complexes
    corrections: _Curve
    weights: tuple[Floats, Floats | None, Floats | None]


class PoseSpline(PoseInterpolation):
    """Interpolates a sequence of poses; every edge rotates and grows by a monotone function of time.

    Between two poses an edge is multiplied by e^L(t), where L rises from 0 to s, see `PoseInterpolation`.
    Both components of L are a straight line plus half a wave. Their slope at a key is that of the parabola
    through the key and both of its neighbors, at most twice the lower of the mean slopes on both sides, and 0
    where these have opposite signs, as in Fritsch and Carlson, “Monotone Piecewise Cubic Interpolation”, SIAM
    J. Numer. Anal. 1980. So the speed is continuous, nothing overshoots a pose, and full turns are kept. Half
    a wave instead of their cubic, because the latter jerks where the motion turns back: there its second
    derivative is twice its median and more, that of a wave 1.4 times.
    """

    def __init__(self, mesh: TriMesh) -> None:
        super().__init__(mesh)
        self._paths: OrderedDict[tuple[int, int], tuple[Floats, Floats, _Path]] = OrderedDict()
        self._motions: OrderedDict[object, tuple[tuple[Interval | None, ...], _Motion]] = OrderedDict()

    def pose(
        self, before: Interval | None, interval: Interval, after: Interval | None, share: float
    ) -> Floats:
        """The pose (n, 2) at a share of the time of ``interval``: at 0 its start itself, at 1 its end itself.

        before, after: the neighbors in time; None if the motion starts or ends at rest there.
        """
        if share <= 0 or interval.start is interval.end:
            return interval.start
        if share >= 1:
            return interval.end
        motion = self._motion(before, interval, after)
        path = motion.path
        fitted = self._fit(path.edges * np.exp(motion.logs.at(share)))
        offsets = _targets(motion, share) - fitted
        offsets *= _weights_at(motion, share)
        component = self._mesh.component
        shift = np.bincount(component, offsets.real) + 1j * np.bincount(component, offsets.imag)
        placed = to_points(fitted + shift[component])
        finite = np.isfinite(path.max_factor)
        return bound_face_areas(self._mesh, placed, path.max_factor) if finite else placed

    def _path(self, interval: Interval) -> _Path:
        pair = id(interval.start), id(interval.end)
        if pair not in self._paths:
            a, b = to_complex(interval.start), to_complex(interval.end)
            rates = self._rates(a, b)
            factors = (worst_area_factor(self._mesh, pose) for pose in interval[:2])
            distances = np.asarray(np.abs(b - a) ** 2)
            path = _Path(a, b, self._edges_of(a), rates, self._mean @ rates, distances, max(factors))
            self._paths[pair] = interval.start, interval.end, path
            if len(self._paths) > _MAX_PAIRS:
                self._paths.popitem(last=False)
        self._paths.move_to_end(pair)
        return self._paths[pair][2]

    def _motion(self, before: Interval | None, interval: Interval, after: Interval | None) -> _Motion:
        """What is prepared for an interval; kept for the last ones."""
        intervals = before, interval, after
        key = tuple(None if each is None else (id(each.start), id(each.end), *each[2:]) for each in intervals)
        if key not in self._motions:
            self._motions[key] = intervals, self._new_motion(*intervals)  # the intervals keep their ids
            if len(self._motions) > _MAX_MOTIONS:
                self._motions.popitem(last=False)
        self._motions.move_to_end(key)
        return self._motions[key][1]

    def _new_motion(self, before: Interval | None, interval: Interval, after: Interval | None) -> _Motion:
        path, seconds = self._path(interval), interval.seconds
        first, last = self._slopes(before, interval), self._slopes(interval, after)
        logs = _curve(path.rates, seconds * first.rates, seconds * last.rates)
        slopes = seconds * first.vertex_rates, seconds * last.vertex_rates
        totals = np.expm1(path.vertex_rates)
        has_center = np.abs(totals) > _NO_CENTER
        totals = np.where(has_center, totals, 1.0)
        at_start = np.where(has_center, slopes[0] / totals, 1.0)
        at_end = np.where(has_center, slopes[1] * np.exp(path.vertex_rates) / totals, 1.0)
        way = path.b - path.a
        corrections = seconds * first.velocities - at_start * way, seconds * last.velocities - at_end * way
        first_weights, last_weights = (
            None if each is None else self._stillness(path.distances + self._path(each).distances)
            for each in (before, after)
        )
        return _Motion(
            path,
            logs,
            _curve(path.vertex_rates, *slopes),
            has_center,
            totals,
            _curve(0 * way, *corrections),
            (self._stillness(path.distances), first_weights, last_weights),
        )

    def _slopes(self, left: Interval | None, right: Interval | None) -> _Slopes:
        """The speeds at the key between two intervals, at least one of which joins its neighbors smoothly."""
        if left is None or right is None:
            path = self._path(left or right)  # type: ignore[arg-type]
            return _Slopes(0 * path.rates, 0 * path.vertex_rates, 0 * path.a)
        first, second = self._path(left), self._path(right)
        h = left.seconds, right.seconds
        speeds = [
            (first.rates / h[0], second.rates / h[1]),
            (first.vertex_rates / h[0], second.vertex_rates / h[1]),
            (_end_velocity(first, 1) / h[0], _end_velocity(second, 0) / h[1]),
        ]
        if left.velocity is None and right.velocity is None:
            rates, vertex_rates = (_passing_components(*pair, h) for pair in speeds[:2])
            return _Slopes(rates, vertex_rates, _passing(*speeds[2], h))
        fixed, factor = (0, left.velocity[1]) if left.velocity is not None else (1, right.velocity[0])  # type: ignore[index]
        rates, vertex_rates = (
            _limited_components(factor * pair[fixed], pair[1 - fixed]) for pair in speeds[:2]
        )
        return _Slopes(rates, vertex_rates, _limited(factor * speeds[2][fixed], speeds[2][1 - fixed]))

    def _stillness(self, distances: Floats) -> Floats:
        """Weights (n,) with the sum 1 in each component; what moves by less, squared pixels, weighs more."""
        weights = 1.0 / (distances + (_STATIONARY * self._mesh.length) ** 2)
        component = self._mesh.component
        return np.asarray(weights / np.bincount(component, weights)[component])


def _targets(motion: _Motion, share: float) -> Complexes:
    """Where each vertex (n,) would be on its own spiral, with its velocities at the ends."""
    path, logs = motion.path, motion.vertex_logs.at(share)
    progress = np.where(motion.has_center, np.expm1(logs) / motion.totals, share)
    return np.asarray(path.a + progress * (path.b - path.a) + motion.corrections.at(share))


def _weights_at(motion: _Motion, share: float) -> Floats:
    """Weights (n,) of the vertices that place the pose, with the sum 1 in each component.

    Those that move least in this interval weigh most. At its ends, those that move least in both adjacent
    intervals do: there the weights, too, are continuous.
    """
    weights, *with_neighbors = motion.weights
    for both, distance in zip(with_neighbors, (share, 1 - share), strict=True):
        fade = max(1 - distance / _BLEND, 0.0) ** 2
        if both is not None and fade:
            weights = weights + fade * (both - weights)
    return weights


def _end_velocity(path: _Path, end: int) -> Complexes:
    """Velocities (n,) at the start (0) or the end (1) of a path that takes a second at constant rates."""
    rates, total = path.vertex_rates, np.expm1(path.vertex_rates)
    has_center = np.abs(total) > _NO_CENTER
    factor = np.where(has_center, rates * np.exp(end * rates) / np.where(has_center, total, 1.0), 1.0)
    return np.asarray(factor * (path.b - path.a))


def _curve(rise: Complexes, first: Complexes, last: Complexes) -> _Curve:
    """A line plus half a wave from 0 to ``rise``, with the slopes ``first`` at 0 and ``last`` at 1.

    It is monotone if both slopes are from 0 to twice ``rise``.
    """
    mean = (first + last) / 2
    return _Curve(mean, rise - mean, first - last)


def _passing_components(left: Complexes, right: Complexes, seconds: tuple[float, float]) -> Complexes:
    """The slope at a key by those on both sides, for real and imaginary parts; see `PoseSpline`."""

    def slope(a: Floats, b: Floats) -> Floats:
        most = _STEEPEST * np.minimum(np.abs(a), np.abs(b))
        return np.where(a * b > 0, np.clip(_parabola_slope(a, b, seconds), -most, most), 0.0)

    return np.asarray(slope(left.real, right.real) + 1j * slope(left.imag, right.imag))


def _passing(left: Complexes, right: Complexes, seconds: tuple[float, float]) -> Complexes:
    """As `_passing_components` for vectors: 0 where they do not point to the same side."""
    a, b = np.abs(left), np.abs(right)
    cosine = (left * right.conj()).real / np.where(a * b > 0, a * b, 1.0)
    velocity = _parabola_slope(left, right, seconds)
    most, size = _STEEPEST * np.minimum(a, b), np.abs(velocity)
    return np.asarray(
        np.clip(cosine, 0, 1) * np.minimum(1.0, most / np.where(size > 0, size, 1.0)) * velocity
    )


def _parabola_slope(left: _T, right: _T, seconds: tuple[float, float]) -> _T:
    """The slope at the middle one of three points on a parabola, from the mean slopes on both sides."""
    return (left * seconds[1] + right * seconds[0]) / sum(seconds)


def _limited_components(slope: Complexes, mean: Complexes) -> Complexes:
    """A slope that is prescribed, as far as a curve of this mean slope stays monotone with it."""

    def limited(a: Floats, b: Floats) -> Floats:
        return np.where(a * b > 0, np.sign(b) * np.minimum(np.abs(a), _STEEPEST * np.abs(b)), 0.0)

    return np.asarray(limited(slope.real, mean.real) + 1j * limited(slope.imag, mean.imag))


def _limited(velocity: Complexes, mean: Complexes) -> Complexes:
    """As `_limited_components` for vectors: 0 where they do not point to the same side."""
    a, b = np.abs(velocity), np.abs(mean)
    factor = np.minimum(1.0, _STEEPEST * b / np.where(a > 0, a, 1.0))
    return np.asarray(np.where((velocity * mean.conj()).real > 0, factor * velocity, 0.0))
