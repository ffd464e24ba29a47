"""Quality triangulation of polygons by one of the `meshers`."""

import reprlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from ..errors import InputError
from ..geometry.mesh import TriMesh, signed_areas
from ..geometry.validation import Floats, Ints, as_number
from ..words import tr
from .mesher_process import MESHER_PROCESS, Refinement
from .meshers import PYTHONCDT, check_mesher
from .outline import Outline
from .slits import Cut, SlitGraph, check_cuts, open_slits, slit_graph

MIN_ANGLE = 28.0  # degrees; meshers provably terminate up to 20.7, and in practice up to 33
COARSE_MIN_ANGLE = 26.0  # degrees, of PythonCDT where the outline leaves few vertices for good angles
MIN_VERTICES, MAX_VERTICES = 20, 200_000
COUNT_TOLERANCE = 0.05  # share by which the number of vertices may differ from the requested one
MAX_TRIES = 6  # runs of the mesher for one mesh
COARSE_TRIES = 3  # more runs of PythonCDT
EDGE_TRIES = 3  # the first runs, which vary the edge length
INTERIOR_EDGE_FACTOR = 2.0  # edges inside are this much longer than on the outline, see docs/meshing.md


@dataclass(frozen=True, eq=False)
class _Try:
    """One run of the mesher.

    edge: edge length on the outline; max_area: of a face; on_outline: number of vertices passed in; count:
    number of vertices that came out; result: vertices (count, 2) and faces (m, 3).
    """

    edge: float
    max_area: float
    on_outline: int
    count: int
    result: tuple[Floats, Ints]


def triangulate(
    parts: Sequence[Outline],
    vertices: int = 2000,
    mesher: str | None = None,
    cuts: Sequence[Cut] = (),
    reach: float = 0.0,
) -> TriMesh:
    """Make a graded Delaunay mesh of polygons with holes; only the outline can force angles below 28°.

    parts: polygons that do not touch one another; vertices: the requested number, met within a few percent
    unless the outline alone needs more; mesher: "triangle", "pythoncdt", or None for the default one; cuts:
    strokes along which the mesh is open, and reach: pixels to the outline that they need not reach, see
    `slit_graph`. Faces are in an order for drawing, see `_limbs_last`.
    Raises InputError for unusable outlines, a number out of range, a mesher that is not installed, or if it
    fails.
    """
    as_number(vertices, "vertices", MIN_VERTICES, MAX_VERTICES)
    mesher = check_mesher(mesher)
    shape = _union(parts)
    slits = slit_graph(shape, check_cuts(cuts), reach)
    corners = sum(_count_corners(ring) for part in parts for ring in (part.outer, *part.holes))
    slit_length = 0.0 if slits is None else 2 * slits.slits.length
    model = _EdgeLengthModel(shape.area, shape.length + slit_length, corners, vertices)
    tries: list[_Try] = []
    edge = model.edge()
    max_area = _equilateral_area(INTERIOR_EDGE_FACTOR * edge)
    for number in range(1, MAX_TRIES + 1):
        job = _planar_graph(parts, shape, edge, slits)
        result = _opened(MESHER_PROCESS.run(job, Refinement(mesher, MIN_ANGLE, max_area)), slits)
        tries.append(_Try(edge, max_area, len(job["vertices"]), len(result[0]), result))
        if abs(tries[-1].count - vertices) <= COUNT_TOLERANCE * vertices or max_area > shape.area:
            break
        if number < EDGE_TRIES:
            model.fit(tries[-1].count)
            edge = model.edge()
            max_area = _equilateral_area(INTERIOR_EDGE_FACTOR * edge)
        else:  # sides of equal length are all cut at once, so that the count jumps: vary the inside alone
            below = [run for run in tries if run.on_outline < run.count < vertices]
            if not below:
                break
            nearest = max(below, key=lambda run: run.count)
            edge = nearest.edge
            above = [run.max_area for run in tries if run.edge == edge and run.count > vertices]
            scaled = nearest.max_area * (nearest.count - nearest.on_outline) / (vertices - nearest.on_outline)
            max_area = np.sqrt(nearest.max_area * max(above)) if above else max(scaled, nearest.max_area / 3)
    best = min(tries, key=lambda run: abs(run.count - vertices))
    if mesher == PYTHONCDT and best.count > (1 + COUNT_TOLERANCE) * vertices:
        best = _coarser(parts, shape, best, vertices, slits)
    return _oriented_mesh(*best.result, is_cut=slits is not None)


def _opened(result: tuple[Floats, Ints], slits: SlitGraph | None) -> tuple[Floats, Ints]:
    return result if slits is None else open_slits(*result, slits.slits)


def _coarser(
    parts: Sequence[Outline],
    shape: shapely.Geometry,
    best: _Try,
    vertices: int,
    slits: SlitGraph | None,
) -> _Try:
    """Mesh a detailed outline with few vertices by PythonCDT, which by itself would need many more."""
    tries = [best]
    scale = 1.0
    for _ in range(COARSE_TRIES):
        edge, max_area = scale * best.edge, scale**2 * best.max_area
        job = _planar_graph(parts, shape, edge, slits)
        refinement = Refinement(PYTHONCDT, COARSE_MIN_ANGLE, max_area, vertices)
        result = _opened(MESHER_PROCESS.run(job, refinement), slits)
        tries.append(_Try(edge, max_area, len(job["vertices"]), len(result[0]), result))
        if abs(tries[-1].count - vertices) <= COUNT_TOLERANCE * vertices:
            break
        scale *= 2.0 if tries[-1].count > vertices else 0.5
    return min(tries, key=lambda run: abs(run.count - vertices))


def _count_corners(ring: Floats) -> int:
    """The number of corners of a ring (p, 2); a repeated point counts once."""
    return int((ring != np.roll(ring, 1, axis=0)).any(axis=1).sum())


def _equilateral_area(edge: float) -> float:
    """The area of an equilateral triangle."""
    return float(np.sqrt(3) / 4 * edge**2)


class _EdgeLengthModel:
    """Predicts the edge length on the outline that gives the requested number of vertices.

    Measured, the number of vertices is close to a / e² + b / e + c at edge length e, where a follows from the
    area, b from the length of the outline and c from its corners; each run of the mesher corrects c.
    The factors belong to `MIN_ANGLE` and `INTERIOR_EDGE_FACTOR`.
    """

    def __init__(self, area: float, length: float, corners: int, requested: int) -> None:
        self._area, self._length, self._requested = 0.44 * area, 0.8 * length, requested
        self._constant = min(1.2 * corners, 0.5 * requested)
        self._longest = 2 * np.sqrt(area)

    def edge(self) -> float:
        """The edge length to try next."""
        rest = max(self._requested - self._constant, 0.0)
        root = np.sqrt(self._length**2 + 4 * self._area * rest)
        inverse = (root - self._length) / (2 * self._area)
        return float(min(1 / max(inverse, 1e-12 / self._longest), self._longest))

    def fit(self, count: int) -> None:
        """Correct the model by the number of vertices at the last edge length."""
        edge = self.edge()
        self._constant = count - self._area / edge**2 - self._length / edge


def _union(parts: Sequence[Outline]) -> shapely.Geometry:
    """The parts as one shape. Raises InputError if a polygon is not simple, or if rings meet."""
    if not isinstance(parts, Sequence) or not all(isinstance(part, Outline) for part in parts):
        raise InputError(
            tr("outlines: expected a sequence of outlines, got {value}", value=reprlib.repr(parts))
        )
    if not parts:
        raise InputError(tr("outlines: expected at least one part, got none"))
    polygons = [part.polygon for part in parts]
    for polygon in polygons:
        if not polygon.is_valid:
            raise InputError(
                tr(
                    "outlines: expected simple polygons, got {reason}",
                    reason=shapely.is_valid_reason(polygon),
                )
            )
    shape = shapely.union_all(polygons)
    rings = shapely.get_rings(polygons)
    pairs = shapely.STRtree(rings).query(rings, predicate="intersects")
    if pairs.shape[1] > len(rings) or len(shapely.get_parts(shape)) < len(parts):
        raise InputError(tr("outlines: expected parts and holes apart from one another, but some touch"))
    return shape


def _oriented_mesh(points: Floats, faces: Ints, is_cut: bool) -> TriMesh:
    """Make a mesh without unused vertices, faces oriented to positive area and in `_limbs_last` order."""
    used, faces = np.unique(faces, return_inverse=True)
    points, faces = points[used], faces.reshape(-1, 3).astype(np.int32)
    flipped = signed_areas(points, faces) < 0
    faces[flipped] = faces[flipped][:, ::-1]
    return TriMesh(points, faces[_limbs_last(points, faces)], is_cut=is_cut)


def _limbs_last(points: Floats, faces: Ints) -> Ints:
    """The order of faces by their distance, along edges, from the middle of their part.

    Faces are drawn in this order: a limb that is bent over the body passes in front of it as a whole.
    """
    i, j = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).T  # each direction of an edge occurs at most once
    lengths = np.linalg.norm(points[i] - points[j], axis=1)
    graph = csr_array((lengths, (i, j)), shape=(len(points), len(points)))
    count, part = connected_components(graph, directed=False)
    middles = []
    for label in range(count):
        members = np.flatnonzero(part == label)
        offsets = points[members] - points[members].mean(axis=0)
        middles.append(members[np.argmin((offsets**2).sum(axis=1))])
    distance = dijkstra(graph, directed=False, indices=middles, min_only=True)
    return np.argsort(distance[faces].mean(axis=1), kind="stable")


def _planar_graph(
    parts: Sequence[Outline], shape: shapely.Geometry, edge: float, slits: SlitGraph | None
) -> dict[str, np.ndarray]:
    """The input of a mesher: points, segments no longer than ``edge``, and one point in each hole."""
    if slits is not None:
        return {**slits.planar_graph(edge), "holes": _hole_points(parts, shape)}
    rings = [ring for part in parts for ring in (part.outer, *part.holes)]
    points, segments, count = [], [], 0
    for ring in rings:
        line = shapely.segmentize(shapely.LinearRing(ring), edge)
        dense = np.array(line.coords)[:-1]
        index = np.arange(len(dense))
        points.append(dense)
        segments.append(np.stack([index, np.roll(index, -1)], axis=1) + count)
        count += len(dense)
    return {
        "vertices": np.concatenate(points),
        "segments": np.concatenate(segments).astype(np.int32),
        "holes": _hole_points(parts, shape),
    }


def _hole_points(parts: Sequence[Outline], shape: shapely.Geometry) -> Floats:
    """A point in each hole of the parts, (h, 2)."""
    holes = []
    for part in parts:
        for hole in part.holes:
            for gap in shapely.get_parts(shapely.Polygon(hole).difference(shape)):
                if gap.area > 0:
                    inside = gap.representative_point()
                    holes.append((inside.x, inside.y))
    return np.array(holes, dtype=np.float64).reshape(-1, 2)
