"""Slits: lines along which the mesh of a picture comes apart, for limbs that touch or overlap in it.

A slit is a line of the planar graph, so that faces meet along it. Afterwards each of its vertices becomes
one vertex on either side: two lips at the same place, between which nothing shows at rest.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from ..geometry.mesh import signed_areas
from ..geometry.validation import Floats, Ints, as_points
from ..words import tr

Cut = tuple[tuple[float, float], ...]  # points of a stroke, pixels of the picture

MAX_CUTS, MAX_CUT_POINTS = 200, 2000
_TOLERANCE = 0.5  # pixels by which a stroke is simplified
_GRID = 1 / 64  # pixels: nearer points are one, as in outlines
_SNAP = 0.75  # pixels: a slit ends in a corner of the outline that is nearer than this
_SHORTEST = 1.0  # pixels; shorter pieces of strokes are left out
_OVERSHOOT = 4 * _GRID  # pixels beyond the outline, so that they meet
_NO_AREA = 1e-4  # square pixels
_ON_LINE = 1e-6  # pixels from a line within which a vertex is on it


def check_cuts(cuts: Sequence[Sequence[Sequence[float]]]) -> tuple[Cut, ...]:
    """Strokes as tuples of points. Raises InputError on too many, too long or bad ones."""
    if len(cuts) > MAX_CUTS:
        raise InputError(tr("cuts: expected at most {most}, got {count}", most=MAX_CUTS, count=len(cuts)))
    result = []
    for cut in cuts:
        if not 2 <= len(cut) <= MAX_CUT_POINTS:
            raise InputError(
                tr("cuts: expected 2 to {most} points, got {count}", most=MAX_CUT_POINTS, count=len(cut))
            )
        points = as_points(cut, "cuts", len(cut))
        result.append(tuple((float(x), float(y)) for x, y in points.tolist()))
    return tuple(result)


def simplified_cut(points: Sequence[Sequence[float]]) -> Cut | None:
    """A stroke with few points, rounded to hundredths of a pixel; None if it is too short to cut."""
    line = shapely.LineString(points) if len(points) > 1 else shapely.LineString()
    if line.length < _SHORTEST:
        return None
    coordinates = np.round(np.array(line.simplify(_TOLERANCE).coords), 2)
    return tuple((float(x), float(y)) for x, y in coordinates[:MAX_CUT_POINTS].tolist())


@dataclass(frozen=True, eq=False)
class SlitGraph:
    """The outline of a picture and slits in it, as lines that meet in common points only.

    outline: shapely lines; slits: a shapely MultiLineString.
    """

    outline: tuple[shapely.LineString, ...]
    slits: shapely.MultiLineString

    def planar_graph(self, edge: float) -> dict[str, np.ndarray]:
        """Points (p, 2) and segments (s, 2) no longer than ``edge``; "slits" (s,): which belong to slits."""
        numbers: dict[tuple[float, float], int] = {}
        segments: list[tuple[int, int]] = []
        slits = shapely.get_parts(self.slits)
        for line in (*self.outline, *slits):
            points = np.array(shapely.segmentize(line, edge).coords).tolist()
            index = [numbers.setdefault((x, y), len(numbers)) for x, y in points]
            segments += pairwise(index)
        of_outline = sum(len(shapely.segmentize(line, edge).coords) - 1 for line in self.outline)
        return {
            "vertices": np.array(list(numbers), dtype=np.float64),
            "segments": np.array(segments, dtype=np.int32),
            "slits": np.arange(len(segments)) >= of_outline,
        }


def slit_graph(shape: shapely.Geometry, cuts: Sequence[Cut], reach: float) -> SlitGraph | None:
    """The graph of a shape with the slits of strokes; None if no stroke cuts it.

    reach: a stroke that ends nearer to the outline than this, pixels, is lengthened to it: the outline is
    outside of what is visible.
    """
    rim = shape.boundary
    pieces = [
        _lengthened(line, rim, reach)
        for cut in cuts
        if len(set(cut)) > 1
        for line in _lines(shapely.intersection(shapely.LineString(cut), shape))
        if line.length >= _SHORTEST
    ]
    if not pieces:
        return None
    corners = shapely.MultiPoint(shapely.get_coordinates(rim))
    snapped = shapely.snap(shapely.union_all(pieces), corners, _SNAP)
    noded = shapely.get_parts(shapely.union_all([rim, snapped], grid_size=_GRID))
    middles = shapely.line_interpolate_point(noded, 0.5, normalized=True)
    near_rim = shapely.distance(middles, rim) <= _GRID
    on_rim = near_rim & ~_dangles(noded, near_rim)
    is_inside = ~near_rim & shapely.contains(shape, middles)
    if not is_inside.any():
        return None
    return SlitGraph(tuple(noded[on_rim]), shapely.MultiLineString(list(noded[is_inside])))


def _dangles(lines: NDArray[np.object_], chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which lines have an end where no other chosen line begins: an outline has none of these."""
    ends = np.stack([shapely.get_coordinates(shapely.get_point(lines, index)) for index in (0, -1)], axis=1)
    _, place = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    place = place.reshape(-1, 2)
    degree = np.bincount(place[chosen].ravel(), minlength=int(place.max()) + 1)
    dangling: NDArray[np.bool_] = (degree[place] == 1).any(axis=1) & (place[:, 0] != place[:, 1])
    return dangling


def _lines(shape: shapely.Geometry) -> list[shapely.LineString]:
    return [part for part in shapely.get_parts(shapely.line_merge(shape)) if part.geom_type == "LineString"]


def _lengthened(line: shapely.LineString, rim: shapely.Geometry, reach: float) -> shapely.LineString:
    """A line with its ends beyond the outline, where they are near to it."""
    points = list(line.coords)
    for index, inner in ((0, 1), (len(points), -2)):
        end = shapely.Point(points[min(index, len(points) - 1)])
        distance = end.distance(rim)
        if distance > reach:
            continue
        start = points[inner] if distance <= _GRID else end.coords[0]
        x, y = shapely.get_coordinates(shapely.shortest_line(end, rim))[1] - start
        share = 1 + _OVERSHOOT / max(float(np.hypot(x, y)), _OVERSHOOT)
        points.insert(index, (start[0] + share * float(x), start[1] + share * float(y)))
    return shapely.LineString(points)


def open_slits(vertices: Floats, faces: Ints, slits: shapely.Geometry) -> tuple[Floats, Ints]:
    """Vertices (n, 2) and faces (m, 3) of a mesh that is open along slits.

    A vertex on a slit becomes one for each of its sides, at the same place, so that the two lips have the
    same pixels. The first vertices stay.
    """
    shapely.prepare(slits)
    on_slit = shapely.dwithin(slits, shapely.points(vertices), _ON_LINE)
    # Where strokes form a needle, a mesher leaves faces between them that have no area.
    faces = faces[~(on_slit[faces].all(axis=1) & (np.abs(signed_areas(vertices, faces)) < _NO_AREA))]
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    can_be = np.flatnonzero(on_slit[start] & on_slit[end])
    middles = 0.5 * (vertices[start[can_be]] + vertices[end[can_be]])
    is_open = np.zeros(len(start), dtype=bool)
    is_open[can_be[shapely.dwithin(slits, shapely.points(middles), _ON_LINE)]] = True
    # Corners of faces are joined with those of the face across an edge, unless the edge is open.
    keys = np.minimum(start, end).astype(np.int64) * len(vertices) + np.maximum(start, end)
    order = np.argsort(keys, kind="stable")
    twins = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    a, b = order[twins], order[twins + 1]
    closed = ~is_open[a]
    a, b = a[closed], b[closed]
    corner_after = np.arange(len(start)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    pairs = np.concatenate([np.stack([a, corner_after[b]]), np.stack([corner_after[a], b])], axis=1)
    links = coo_array((np.ones(pairs.shape[1], dtype=bool), tuple(pairs)), shape=(len(start), len(start)))
    _, fan = connected_components(links, directed=False)
    fans, first = np.unique(fan, return_index=True)
    owner = start[first]  # the vertex of each fan
    by_owner = np.lexsort((first, owner))
    is_first = np.diff(owner[by_owner], prepend=-1) != 0
    numbers = np.empty(len(fans), dtype=np.int64)
    numbers[by_owner[is_first]] = owner[by_owner[is_first]]
    extra = by_owner[~is_first]
    numbers[extra] = len(vertices) + np.arange(len(extra))
    opened = numbers[fan].reshape(-1, 3).astype(np.int32)
    return np.concatenate([vertices, vertices[owner[extra]]]), opened
