"""Outlines of a drawing: polygons with holes around what is visible in its alpha channel."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from ..geometry.validation import Floats, as_channel, as_number, as_points, freeze
from ..words import tr
from .contours import contours

MIN_PART_AREA = 10.0  # square pixels; a smaller part is a speck
MIN_PART_SHARE = 2e-5  # of the area of all parts; a smaller part is a speck, too
MIN_HOLE_AREA = 10.0  # square pixels; smaller holes are filled
MAX_LENGTH = 1e5  # pixels that an outline can be moved or simplified by
MIN_STROKE_WIDTH = 1.5  # pixels; thinner strokes grow by half of that on each side
_MIN_PIECE_AREA = 1.0  # square pixels; smaller pieces, left by clipping and notches, are dropped
_FIRST_SIMPLIFICATION = 0.2  # share of the tolerance spent first; all later steps take a tenth of the time
_GRID = 1 / 64  # pixels: nearer points are merged, because Triangle fails on points that are too close
_NOTCH = 0.5  # pixels: half the side of the square cut out where rings meet in a point

Polygons = NDArray[np.object_]  # of shapely polygons


class NoOutlineError(InputError):
    """Nothing of a picture is large and opaque enough to be cut out."""


@dataclass(frozen=True, eq=False)
class Outline:
    """The outline of one part of a drawing, in pixels.

    outer: (p, 2) float64 polygon; holes: (q, 2) float64 polygons. The first point is not repeated at the end.
    Raises InputError for a ring of fewer than three points.
    """

    outer: Floats
    holes: tuple[Floats, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "outer", _ring(self.outer, "outer"))
        object.__setattr__(self, "holes", tuple(_ring(hole, "holes") for hole in self.holes))

    @property
    def polygon(self) -> shapely.Polygon:
        """The outline as a shapely polygon."""
        return shapely.Polygon(self.outer, self.holes)


@dataclass(frozen=True)
class CutOut:
    """The outlines of a picture's parts, largest first.

    specks: number of parts that were left out as too small; speck_area: their total area in square pixels.
    """

    parts: tuple[Outline, ...]
    specks: int
    speck_area: float

    @property
    def points(self) -> int:
        """The number of points of all rings."""
        return sum(len(part.outer) + sum(map(len, part.holes)) for part in self.parts)

    @property
    def holes(self) -> int:
        """The number of holes of all parts."""
        return sum(len(part.holes) for part in self.parts)


def outlines(
    alpha: NDArray[np.uint8], threshold: float = 0.5, expand: float = 2.0, tolerance: float = 0.5
) -> list[Outline]:
    """The outlines of a picture's parts, largest first; arguments as in `cut_out`. Raises InputError."""
    return list(cut_out(alpha, threshold, expand, tolerance).parts)


def cut_out(
    alpha: NDArray[np.uint8],
    threshold: float = 0.5,
    expand: float = 2.0,
    tolerance: float = 0.5,
    max_points: float = np.inf,
) -> CutOut:
    """Find the outlines of a picture's visible parts.

    alpha: (h, w) uint8; the contour is its sub-pixel iso-line, pixel centers at half-integers.
    threshold: share of full opacity at which the picture ends, in (0, 1).
    expand: pixels by which outlines move outwards, so that the soft edge is inside and near parts join, but
    never beyond the frame of the picture.
    tolerance: pixels by which outlines may be simplified.
    max_points: if all outlines together have more points, they are simplified further, and moved outwards so
    that the picture stays inside, as long as no parts join and no hole larger than about 1/6 of the area per
    point closes.

    Strokes thinner than `MIN_STROKE_WIDTH` become thicker. Parts smaller than `MIN_PART_AREA` or
    `MIN_PART_SHARE` are left out, unless the expansion joins them to others; holes smaller than
    `MIN_HOLE_AREA` are filled. Rings never meet, not even in a point.
    Raises NoOutlineError if nothing is visible, or for arguments out of range.
    """
    alpha = as_channel(alpha, "alpha")
    check_lengths(threshold, expand, tolerance)
    height, width = alpha.shape
    rings = contours(alpha, 255 * threshold)
    if not rings:
        raise NoOutlineError(
            tr(
                "the picture is fully transparent: expected a drawing, but none of its {width}×{height} "
                "pixels is more than {threshold:.0%} opaque",
                width=width,
                height=height,
                threshold=threshold,
            )
        )
    # An expansion by r closes every hole of at most π r² square pixels.
    drawn = polygons_of(rings, max(MIN_HOLE_AREA, np.pi * expand**2))
    specks = _specks(drawn, 2 * expand)
    if specks.all():
        raise NoOutlineError(
            tr(
                "the picture is too small to bend: expected a part of at least {least:g} square pixels, "
                "got {width}×{height} pixels with {sum} of them visible, "
                "in {count} pieces",
                least=MIN_PART_AREA,
                width=width,
                height=height,
                sum=int((alpha > 255 * threshold).sum()),
                count=len(drawn),
            )
        )
    visible = drawn[~specks]
    frame = shapely.box(0, 0, width, height)
    left_out = int(specks.sum()), float(shapely.area(drawn[specks]).sum())
    cut = CutOut(_parts(visible, expand, tolerance, frame), *left_out)
    slack = max(tolerance, 0.5)
    while cut.points > max_points and slack < max(alpha.shape) / 8:
        slack *= 1.4
        coarser = CutOut(_parts(visible, max(expand, slack), slack, frame), *left_out)
        if _topology(coarser, max_points) != _topology(cut, max_points):
            break
        cut = coarser
    return cut


def _topology(cut: CutOut, max_points: float) -> tuple[int, int]:
    """The number of parts, and of the holes that are large enough to show with ``max_points`` points."""
    areas = [shapely.Polygon(hole).area for part in cut.parts for hole in part.holes]
    smallest = sum(part.polygon.area for part in cut.parts) / (6 * max_points)
    return len(cut.parts), int((np.array(areas) > smallest).sum())


def check_lengths(threshold: float, expand: float, tolerance: float = 0.0) -> None:
    """Raise InputError if lengths in pixels or a threshold are out of range."""
    if as_number(threshold, "threshold", 0, 1) in (0, 1):
        raise InputError(
            tr("threshold: expected a share between 0 and 1, got {threshold:g}", threshold=threshold)
        )
    for name, value in (("expand", expand), ("tolerance", tolerance)):
        as_number(value, name, 0, MAX_LENGTH)


def visible_polygons(alpha: NDArray[np.uint8], threshold: float) -> Polygons:
    """The pixels of alpha (h, w) above ``threshold``, exactly along the iso-line, as polygons with holes."""
    return polygons_of(contours(alpha, 255 * threshold))


def polygons_of(rings: list[Floats], max_filled_area: float = 0.0) -> Polygons:
    """Build polygons with holes from rings that do not meet, smallest first.

    rings: (p, 2) each, outer ones with a positive signed area (y down), holes with a negative one, as
    `contours` returns them; max_filled_area: holes up to this area, in square pixels, are filled.
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
    holes = holes[shapely.area(filled[holes]) > max_filled_area]
    if not len(holes):
        return polygons
    shapely.prepare(polygons)
    points = np.array([rings[hole][0] for hole in holes])
    hole, owner = shapely.STRtree(polygons).query(shapely.points(points))
    inside = shapely.contains_xy(polygons[owner], *points[hole].T)
    owners = np.full(len(holes), len(polygons))
    np.minimum.at(owners, hole[inside], owner[inside])  # of nested polygons the smallest
    for number in np.unique(owners):
        exterior = shapely.get_exterior_ring(polygons[number])
        polygons[number] = shapely.polygons(exterior, lines[holes[owners == number]])
    return polygons


def _specks(polygons: Polygons, reach: float) -> NDArray[np.bool_]:
    """Which polygons are too small, (p,), counted together with those closer than ``reach`` pixels."""
    count = len(polygons)
    pairs = shapely.STRtree(polygons).query(polygons, predicate="dwithin", distance=reach)
    links = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(count, count))
    _, group = connected_components(links, directed=False)
    areas = np.bincount(group, shapely.area(polygons))
    return (areas < max(MIN_PART_AREA, MIN_PART_SHARE * areas.sum()))[group]


def _parts(drawn: Polygons, expand: float, tolerance: float, frame: shapely.Polygon) -> tuple[Outline, ...]:
    """Expand, simplify and clip polygons, and split them where rings meet; largest part first."""
    # Ring by ring, which may make rings cross: `_expand` repairs that.
    simplified = shapely.simplify(drawn, _FIRST_SIMPLIFICATION * tolerance, preserve_topology=False)
    shape = _expand(simplified, expand).simplify((1 - _FIRST_SIMPLIFICATION) * tolerance)
    shape = shapely.set_precision(shape.intersection(frame), _GRID)
    parts = [part for part in _polygons(_cut_notches(shape)) if part.area >= _MIN_PIECE_AREA]
    parts.sort(key=lambda part: -part.area)
    return tuple(_outline(part) for part in parts)


def _expand(drawn: Polygons, expand: float) -> shapely.Geometry:
    """Merge polygons to a valid shape, larger by ``expand``, without strokes below `MIN_STROKE_WIDTH`."""
    if expand > 0:
        shape = shapely.union_all(shapely.buffer(drawn, expand, quad_segs=4))
    else:
        shape = shapely.union_all(shapely.make_valid(drawn))
    half = MIN_STROKE_WIDTH / 2
    if expand < half:
        thin = shape.difference(shape.buffer(-half).buffer(1.01 * half))
        strokes = [part for part in _polygons(thin) if part.area > half**2]  # smaller: a corner
        shape = shapely.union_all([shape, *shapely.buffer(strokes, half, quad_segs=4)])
    return shape


def _polygons(shape: shapely.Geometry) -> list[shapely.Polygon]:
    return [part for part in shapely.get_parts(shape) if part.geom_type == "Polygon"]


def _cut_notches(shape: shapely.Geometry) -> shapely.Geometry:
    """Cut a notch wherever rings meet in a point: parts joined there could rotate freely about it."""
    while True:
        rings = shapely.get_rings(_polygons(shape))
        points = np.concatenate([np.zeros((0, 2)), *(shapely.get_coordinates(ring)[:-1] for ring in rings)])
        points, counts = np.unique(points, axis=0, return_counts=True)
        x, y = points[counts > 1].T
        if not len(x):
            return shape
        notches = shapely.union_all(shapely.box(x - _NOTCH, y - _NOTCH, x + _NOTCH, y + _NOTCH))
        shape = shapely.set_precision(shape.difference(notches), _GRID)


def _outline(polygon: shapely.Polygon) -> Outline:
    holes = [ring for ring in polygon.interiors if shapely.Polygon(ring).area >= MIN_HOLE_AREA]
    return Outline(
        np.array(polygon.exterior.coords)[:-1], tuple(np.array(ring.coords)[:-1] for ring in holes)
    )


def _ring(points: ArrayLike, name: str) -> Floats:
    ring = as_points(points, name)
    if len(ring) < 3:
        raise InputError(tr("{name}: expected at least 3 points, got {count}", name=name, count=len(ring)))
    return freeze(ring)
