"""Cuts the polygons of a mesh file into triangles, also those that are not convex."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...geometry.validation import Floats, Ints
from ...words import tr

MAX_POLYGON_CORNERS = 5000  # of a polygon that is not convex: the time grows with the square


def triangulate_polygons(points: Floats, polygons: Sequence[Sequence[int]]) -> Ints:
    """Cut polygons, rows of indices of points (n, 2) or (n, 3), into triangles (m, 3) with their orientation.

    A convex polygon becomes a fan around its first corner; others are cut by ear clipping (Meisters 1975).
    Polygons in space are projected along the axis nearest to their normal. Raises InputError on a polygon
    that is not convex and has more than `MAX_POLYGON_CORNERS`.
    """
    if points.shape[1] == 3 and len(points) and points[:, 2].min() == points[:, 2].max():
        points = points[:, :2]
    triangles: list[tuple[int, int, int]] = []
    for polygon, is_fan in zip(polygons, _are_fans(points, polygons), strict=True):
        if is_fan:
            triangles += [(polygon[0], b, c) for b, c in pairwise(polygon[1:])]
        else:
            triangles += _cut(_project(points[list(polygon)]), polygon)
    return np.array(triangles, dtype=np.int32).reshape(-1, 3)


def _are_fans(points: Floats, polygons: Sequence[Sequence[int]]) -> NDArray[np.bool_]:
    """Whether the fan around its first corner triangulates each polygon; of those in space only triangles."""
    sizes = np.array([len(polygon) for polygon in polygons], dtype=np.int64)
    result = sizes <= 3
    for size in np.unique(sizes[~result]).tolist() if points.shape[1] == 2 else []:
        rows = np.flatnonzero(sizes == size)
        corners = points[np.array([polygons[row] for row in rows.tolist()])]
        doubled_areas = _cross(corners[:, :1], corners[:, 1:-1], corners[:, 2:])
        result[rows] = (doubled_areas > 0).all(axis=1) | (doubled_areas < 0).all(axis=1)
    return np.asarray(result)


def _cut(corners: Floats, polygon: Sequence[int]) -> list[tuple[int, int, int]]:
    """Triangles of a polygon with corners (k, 2), with its orientation."""
    order = list(polygon)
    if _shoelace(corners) >= 0:
        return [(order[a], order[b], order[c]) for a, b, c in _clip_ears(corners)]
    order.reverse()
    return [(order[a], order[c], order[b]) for a, b, c in _clip_ears(corners[::-1])]


def _project(corners: Floats) -> Floats:
    """Corners (k, 2 or 3) as (k, 2): without the axis along which the polygon's shadow is largest."""
    if corners.shape[1] == 2:
        return corners
    axes = [(1, 2), (2, 0), (0, 1)]
    largest = max(axes, key=lambda pair: abs(_shoelace(corners[:, list(pair)])))
    return corners[:, list(largest)]


def _shoelace(corners: Floats) -> float:
    """Twice the signed area of a polygon (k, 2)."""
    x, y = (corners - corners[0]).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def _cross(a: Floats, b: Floats, c: Floats) -> Floats:
    """Twice the signed areas of triangles with corners (..., 2)."""
    u, v = b - a, c - a
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def _clip_ears(corners: Floats) -> list[tuple[int, int, int]]:
    """Triangles, as indices of a counterclockwise polygon's corners (k, 2).

    Clips the ear with the largest smallest angle first, so that flat corners find a neighbor. A polygon that
    crosses itself, or is flat, ends in a fan with faces that other checks refuse.
    """
    if len(corners) > MAX_POLYGON_CORNERS:
        raise InputError(
            tr(
                "expected at most {most} corners of a face that is not convex, got {count}",
                most=MAX_POLYGON_CORNERS,
                count=len(corners),
            )
        )
    ring = np.arange(len(corners))
    quality = np.array([_ear_quality(corners, ring, place) for place in range(len(ring))])
    triangles = []
    while len(ring) > 3:
        if quality.max() <= 0:  # corners that were blocked by one that is gone
            quality = np.array([_ear_quality(corners, ring, place) for place in range(len(ring))])
            if quality.max() <= 0:
                break
        place = int(np.argmax(quality))
        triangles.append((int(ring[place - 1]), int(ring[place]), int(ring[(place + 1) % len(ring)])))
        ring, quality = np.delete(ring, place), np.delete(quality, place)
        for neighbor in ((place - 1) % len(ring), place % len(ring)):
            quality[neighbor] = _ear_quality(corners, ring, neighbor)
    first, *others = ring.tolist()
    return [*triangles, *((first, b, c) for b, c in pairwise(others))]


def _ear_quality(corners: Floats, ring: Ints, place: int) -> float:
    """Twice the area of the triangle at a corner, divided by its longest squared side; 0 if it is no ear."""
    indices = ring[[place - 1, place, (place + 1) % len(ring)]]
    a, b, c = corners[indices]
    area = float(_cross(a, b, c))
    if area <= 0:
        return 0.0
    others = corners[ring]
    inside = (_cross(a, b, others) >= 0) & (_cross(b, c, others) >= 0) & (_cross(c, a, others) >= 0)
    if (others[inside][:, None] != corners[indices]).any(axis=2).all(axis=1).any():
        return 0.0
    longest = max(float(((p - q) ** 2).sum()) for p, q in ((a, b), (b, c), (c, a)))
    return area / longest
