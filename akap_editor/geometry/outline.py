"""From an alpha channel to polygons: the cut-out of a drawing."""

from dataclasses import dataclass
from itertools import pairwise

import contourpy
import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError
from .checks import Floats, as_points, frozen

SMALLEST_PART = 12.0  # square pixels; anything less is a speck
GRID = 1 / 64  # pixels: nearer points are one point, so that no two are too near for Triangle
BITE = 0.5  # pixels: half the side of what is cut out where rings meet in a point


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


def outlines(
    alpha: NDArray[np.uint8], threshold: float = 0.5, expand: float = 2.0, tolerance: float = 0.5
) -> list[Outline]:
    """The parts of a picture as polygons with holes, largest first.

    alpha: (h, w) uint8; threshold: share of full opacity at which the picture ends, in (0, 1); expand: pixels
    by which the outline moves outwards, so that the soft rim is inside and near parts join (never past the
    picture's frame); tolerance: pixels by which the contour may be simplified.
    The contour is the sub-pixel iso-line of alpha, pixel centers at half-integers.
    Rings never meet, not even in a point. Raises InputError where the picture has no visible part.
    """
    alpha = np.asarray(alpha)
    if alpha.ndim != 2 or alpha.dtype != np.uint8 or not alpha.size:
        raise InputError(f"alpha: expected shape (h, w) uint8, got {alpha.shape} {alpha.dtype}")
    if not 0 < threshold < 1:
        raise InputError(f"threshold: expected a share between 0 and 1, got {threshold:g}")
    for name, value in (("expand", expand), ("tolerance", tolerance)):
        if not 0 <= value < np.inf:
            raise InputError(f"{name}: expected a number of pixels, at least 0, got {value:g}")
    height, width = alpha.shape
    if not (alpha > 255 * threshold).any():
        raise InputError(
            f"the picture is fully transparent: expected a drawing, but none of its {width}×{height} pixels "
            f"is more than {threshold:.0%} opaque"
        )
    shape = shapely.union_all([_polygon(*part) for part in _contours(alpha, threshold)])
    shape = shape.buffer(expand, quad_segs=4).simplify(tolerance)
    shape = shapely.set_precision(shape.intersection(shapely.box(0, 0, width, height)), GRID)
    parts = [part for part in _polygons(_apart(shape)) if part.area >= SMALLEST_PART]
    if not parts:
        raise InputError(
            f"the picture is too small to bend: expected a part of at least {SMALLEST_PART:g} square pixels, "
            f"got {width}×{height} pixels with {int((alpha > 255 * threshold).sum())} of them visible"
        )
    parts.sort(key=lambda part: -part.area)
    return [_outline(part) for part in parts]


def _contours(alpha: NDArray[np.uint8], threshold: float) -> list[tuple[Floats, list[int]]]:
    """Points and ring offsets of each filled part, in pixels."""
    level = 255 * threshold
    padded = np.pad(alpha, 1).astype(np.float32)
    generator = contourpy.contour_generator(z=padded, fill_type=contourpy.FillType.OuterOffset)
    points, offsets = generator.filled(level, 1000.0)
    # sample (i, j) of the padded array is the center of pixel (i - 1, j - 1)
    return [
        (part.astype(np.float64) - 0.5, ends.tolist()) for part, ends in zip(points, offsets, strict=True)
    ]


def _polygon(points: Floats, offsets: list[int]) -> shapely.Geometry:
    rings = [points[a:b] for a, b in pairwise(offsets)]
    return shapely.make_valid(shapely.Polygon(rings[0], rings[1:]))


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
    holes = [ring for ring in polygon.interiors if shapely.Polygon(ring).area >= SMALLEST_PART]
    return Outline(
        np.array(polygon.exterior.coords)[:-1], tuple(np.array(ring.coords)[:-1] for ring in holes)
    )


def _ring(points: ArrayLike, name: str) -> Floats:
    ring = as_points(points, name)
    if len(ring) < 3:
        raise InputError(f"{name}: expected at least 3 points, got {len(ring)}")
    return frozen(ring)
