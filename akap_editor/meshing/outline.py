"""From an alpha channel to polygons: the cut-out of a drawing."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from ..geometry.validation import Floats, as_channel, as_points, freeze
from .contours import contours

SMALLEST_PART = 10.0  # square pixels; anything less is a speck
SMALLEST_SHARE = 2e-5  # of the whole drawing; anything less is a speck, too
SMALLEST_HOLE = 10.0  # square pixels; anything less is filled
SCRAP = 1.0  # square pixels: what cutting apart may leave over
THINNEST = 1.5  # pixels: a thinner stroke is made thicker by half of that on each side
SKETCH = 0.2  # share of the tolerance used up at first: all that follows takes a tenth of the time
GRID = 1 / 64  # pixels: nearer points are one point, so that no two are too near for Triangle
BITE = 0.5  # pixels: half the side of what is cut out where rings meet in a point

Polygons = NDArray[np.object_]  # of shapely polygons


@dataclass(frozen=True, eq=False)
class Outline:
    """One part of a drawing: outer (p, 2) and holes (each (q, 2)) float64 polygons in pixels.

    The first point is not repeated at the end. Raises InputError on fewer than three points.
    """

    outer: Floats
    holes: tuple[Floats, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "outer", _ring(self.outer, "outer"))
        object.__setattr__(self, "holes", tuple(_ring(hole, "holes") for hole in self.holes))

    @property
    def polygon(self) -> shapely.Polygon:
        """The same as a shapely polygon."""
        return shapely.Polygon(self.outer, self.holes)


@dataclass(frozen=True)
class CutOut:
    """The parts of a picture, largest first, and what was left out as too small.

    specks: islands left out; speck_area: their area in square pixels.
    """

    parts: tuple[Outline, ...]
    specks: int
    speck_area: float

    @property
    def points(self) -> int:
        """Number of points of all rings."""
        return sum(len(part.outer) + sum(map(len, part.holes)) for part in self.parts)

    @property
    def holes(self) -> int:
        """Number of holes of all parts."""
        return sum(len(part.holes) for part in self.parts)


def outlines(
    alpha: NDArray[np.uint8], threshold: float = 0.5, expand: float = 2.0, tolerance: float = 0.5
) -> list[Outline]:
    """The parts of a picture as polygons with holes, largest first; see `cut_out`."""
    return list(cut_out(alpha, threshold, expand, tolerance).parts)


def cut_out(
    alpha: NDArray[np.uint8],
    threshold: float = 0.5,
    expand: float = 2.0,
    tolerance: float = 0.5,
    most_points: float = np.inf,
) -> CutOut:
    """Cut a picture out along its alpha.

    alpha: (h, w) uint8; threshold: share of full opacity at which the picture ends, in (0, 1); expand: pixels
    by which the outline moves outwards, so that the soft rim is inside and near parts join (never past the
    picture's frame); tolerance: pixels by which the contour may be simplified; most_points: where all
    outlines together have more, they are simplified further, and moved out so far that the picture stays
    inside, as long as no parts join and no hole larger than some 1/6 of the area per point closes.
    The contour is the sub-pixel iso-line of alpha, pixel centers at half-integers. Strokes thinner than
    `THINNEST` are made thicker. Islands below `SMALLEST_PART` or `SMALLEST_SHARE` are left out, unless the
    expansion joins them to others; holes below `SMALLEST_HOLE` are filled.
    Rings never meet, not even in a point. Raises InputError where the picture has no visible part.
    """
    alpha = as_channel(alpha, "alpha")
    _check(threshold, expand, tolerance)
    height, width = alpha.shape
    rings = contours(alpha, 255 * threshold)
    if not rings:
        raise InputError(
            f"the picture is fully transparent: expected a drawing, but none of its {width}×{height} pixels "
            f"is more than {threshold:.0%} opaque"
        )
    # An expansion by r closes every hole of at most π r² square pixels.
    drawn = polygons_of(rings, max(SMALLEST_HOLE, np.pi * expand**2))
    specks = _specks(drawn, 2 * expand)
    if specks.all():
        raise InputError(
            f"the picture is too small to bend: expected a part of at least {SMALLEST_PART:g} square pixels, "
            f"got {width}×{height} pixels with {int((alpha > 255 * threshold).sum())} of them visible, "
            f"in {len(drawn)} pieces"
        )
    kept = drawn[~specks]
    frame = shapely.box(0, 0, width, height)
    left_out = int(specks.sum()), float(shapely.area(drawn[specks]).sum())
    cut = CutOut(_parts(kept, expand, tolerance, frame), *left_out)
    slack = max(tolerance, 0.5)
    while cut.points > most_points and slack < max(alpha.shape) / 8:
        slack *= 1.4
        coarser = CutOut(_parts(kept, max(expand, slack), slack, frame), *left_out)
        if _shape_of(coarser, most_points) != _shape_of(cut, most_points):
            break
        cut = coarser
    return cut


def _shape_of(cut: CutOut, most_points: float) -> tuple[int, int]:
    """Number of parts, and of the holes that so few points can show."""
    areas = [shapely.Polygon(hole).area for part in cut.parts for hole in part.holes]
    smallest = sum(part.polygon.area for part in cut.parts) / (6 * most_points)
    return len(cut.parts), int((np.array(areas) > smallest).sum())


def _check(threshold: float, expand: float, tolerance: float) -> None:
    if not 0 < threshold < 1:
        raise InputError(f"threshold: expected a share between 0 and 1, got {threshold:g}")
    for name, value in (("expand", expand), ("tolerance", tolerance)):
        if not 0 <= value < np.inf:
            raise InputError(f"{name}: expected a number of pixels, at least 0, got {value:g}")


def visible_polygons(alpha: NDArray[np.uint8], threshold: float) -> Polygons:
    """All that is more opaque than ``threshold``, exactly along the iso-line, as polygons with holes."""
    return polygons_of(contours(alpha, 255 * threshold))


def polygons_of(rings: list[Floats], smallest_hole: float = 0.0) -> Polygons:
    """Polygons with holes from rings that never meet, smallest first.

    rings: (p, 2) each, outer ones with a positive signed area (y down), holes with a negative one, as of
    `contours`; smallest_hole: holes of at most that many square pixels are filled.
    """
    if not rings:
        return np.zeros(0, dtype=np.object_)
    lengths = [len(ring) for ring in rings]
    lines = shapely.linearrings(np.concatenate(rings), indices=np.repeat(np.arange(len(rings)), lengths))
    outer = shapely.is_ccw(lines)
    filled = shapely.polygons(lines)
    polygons = filled[outer]
    order = np.argsort(shapely.area(polygons), kind="stable")
    polygons = polygons[order]
    holes = np.flatnonzero(~outer)
    holes = holes[shapely.area(filled[holes]) > smallest_hole]
    if not len(holes):
        return polygons
    shapely.prepare(polygons)
    points = np.array([rings[hole][0] for hole in holes])
    hole, owner = shapely.STRtree(polygons).query(shapely.points(points))
    inside = shapely.contains_xy(polygons[owner], *points[hole].T)
    owners = np.full(len(holes), len(polygons))
    np.minimum.at(owners, hole[inside], owner[inside])  # the smallest around it
    for number in np.unique(owners):
        rim = shapely.get_exterior_ring(polygons[number])
        polygons[number] = shapely.polygons(rim, lines[holes[owners == number]])
    return polygons


def _specks(polygons: Polygons, reach: float) -> NDArray[np.bool_]:
    """Which polygons are too small, taken together with all that are within reach."""
    count = len(polygons)
    pairs = shapely.STRtree(polygons).query(polygons, predicate="dwithin", distance=reach)
    links = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(count, count))
    _, group = connected_components(links, directed=False)
    areas = np.bincount(group, shapely.area(polygons))
    return (areas < max(SMALLEST_PART, SMALLEST_SHARE * areas.sum()))[group]


def _parts(drawn: Polygons, expand: float, tolerance: float, frame: shapely.Polygon) -> tuple[Outline, ...]:
    """Expanded, simplified, clipped and taken apart, largest first."""
    # Simplified ring by ring, which may make rings cross: `_expanded` takes that.
    sketch = shapely.simplify(drawn, SKETCH * tolerance, preserve_topology=False)
    shape = _expanded(sketch, expand).simplify((1 - SKETCH) * tolerance)
    shape = shapely.set_precision(shape.intersection(frame), GRID)
    parts = [part for part in _polygons(_apart(shape)) if part.area >= SCRAP]
    parts.sort(key=lambda part: -part.area)
    return tuple(_outline(part) for part in parts)


def _expanded(drawn: Polygons, expand: float) -> shapely.Geometry:
    """One valid shape, larger by ``expand`` on all sides, no stroke thinner than `THINNEST`."""
    if expand > 0:
        shape = shapely.union_all(shapely.buffer(drawn, expand, quad_segs=4))
    else:
        shape = shapely.union_all(shapely.make_valid(drawn))
    half = THINNEST / 2
    if expand < half:
        thin = shape.difference(shape.buffer(-half).buffer(1.01 * half))
        strokes = [part for part in _polygons(thin) if part.area > half**2]  # less is a corner
        shape = shapely.union_all([shape, *shapely.buffer(strokes, half, quad_segs=4)])
    return shape


def _polygons(shape: shapely.Geometry) -> list[shapely.Polygon]:
    return [part for part in shapely.get_parts(shape) if part.geom_type == "Polygon"]


def _apart(shape: shapely.Geometry) -> shapely.Geometry:
    """The shape with a bite out wherever its rings meet: parts joined in a point could turn about it."""
    while True:
        rings = shapely.get_rings(_polygons(shape))
        points = np.concatenate([np.zeros((0, 2)), *(shapely.get_coordinates(ring)[:-1] for ring in rings)])
        points, counts = np.unique(points, axis=0, return_counts=True)
        x, y = points[counts > 1].T
        if not len(x):
            return shape
        bites = shapely.union_all(shapely.box(x - BITE, y - BITE, x + BITE, y + BITE))
        shape = shapely.set_precision(shape.difference(bites), GRID)


def _outline(polygon: shapely.Polygon) -> Outline:
    holes = [ring for ring in polygon.interiors if shapely.Polygon(ring).area >= SMALLEST_HOLE]
    return Outline(
        np.array(polygon.exterior.coords)[:-1], tuple(np.array(ring.coords)[:-1] for ring in holes)
    )


def _ring(points: ArrayLike, name: str) -> Floats:
    ring = as_points(points, name)
    if len(ring) < 3:
        raise InputError(f"{name}: expected at least 3 points, got {len(ring)}")
    return freeze(ring)
