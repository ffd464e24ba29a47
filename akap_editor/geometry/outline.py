"""From an alpha channel to polygons: the cut-out of a drawing."""

from dataclasses import dataclass

import contourpy
import numpy as np
import shapely
from numpy.typing import NDArray

from ..errors import InputError
from .checks import Floats, as_points, frozen

SMALLEST_PART = 12.0  # square pixels; anything less is a speck
GRID = 1 / 64  # pixels: nearer points are one point, so that no two are too near for Triangle


@dataclass(frozen=True, eq=False)
class Outline:
    """One part of a drawing: outer (p, 2) and holes (each (q, 2)) float64 polygons in pixels, not closed twice."""

    outer: Floats
    holes: tuple[Floats, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "outer", frozen(as_points(self.outer, "outer")))
        holes = tuple(frozen(as_points(hole, "holes")) for hole in self.holes)
        object.__setattr__(self, "holes", holes)

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
    Raises InputError where the picture has no visible part.
    """
    alpha = np.asarray(alpha)
    if alpha.ndim != 2 or alpha.dtype != np.uint8 or not alpha.size:
        raise InputError(f"alpha: expected shape (h, w) uint8, got {alpha.shape} {alpha.dtype}")
    if not 0 < threshold < 1:
        raise InputError(f"threshold: expected a share between 0 and 1, got {threshold:g}")
    height, width = alpha.shape
    if not (alpha > 255 * threshold).any():
        raise InputError(
            f"the picture is fully transparent: expected a drawing, but none of its {width}×{height} pixels "
            f"is more than {threshold:.0%} opaque"
        )
    shape = shapely.union_all([_polygon(*part) for part in _contours(alpha, threshold)])
    shape = shape.buffer(expand, quad_segs=4).simplify(tolerance)
    shape = shapely.set_precision(shape.intersection(shapely.box(0, 0, width, height)), GRID)
    parts = [p for p in shapely.get_parts(shape) if p.geom_type == "Polygon" and p.area >= SMALLEST_PART]
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
    return [(ring.astype(np.float64) - 0.5, offset.tolist()) for ring, offset in zip(points, offsets, strict=True)]


def _polygon(points: Floats, offsets: list[int]) -> shapely.Geometry:
    rings = [points[a:b] for a, b in zip(offsets[:-1], offsets[1:], strict=True)]
    return shapely.make_valid(shapely.Polygon(rings[0], rings[1:]))


def _outline(polygon: shapely.Polygon) -> Outline:
    holes = [ring for ring in polygon.interiors if shapely.Polygon(ring).area >= SMALLEST_PART]
    return Outline(
        np.array(polygon.exterior.coords)[:-1], tuple(np.array(ring.coords)[:-1] for ring in holes)
    )
