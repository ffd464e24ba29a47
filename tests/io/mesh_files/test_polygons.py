"""Polygons of mesh files as triangles."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.mesh_files.polygons import MAX_POLYGON_CORNERS, triangulate_polygons

L_SHAPE = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)]
FLAT_CORNERS = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)]
COMB = [*((k + k % 2 * 0.9, k % 2 * 5) for k in range(11, -1, -1)), (-1, 9), (13, 9)]


def star(corners, seed):
    rng = np.random.default_rng(seed)
    angles = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    return rng.uniform(0.2, 1, (corners, 1)) * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def areas(points, triangles):
    a, b, c = points[triangles].transpose(1, 2, 0)
    return ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]) / 2


@pytest.mark.parametrize("shape", [L_SHAPE, FLAT_CORNERS, COMB, star(5, 1), star(40, 2), star(41, 3)])
@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("first", [0, 3])
def test_triangles_fill_a_polygon_once_and_keep_its_orientation(shape, clockwise, first):
    points = np.array(shape, dtype=float)
    x, y = points.T
    area = float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()) / 2
    order = np.roll(np.arange(len(points)), first)[:: -1 if clockwise else 1]
    triangles = triangulate_polygons(points, [order.tolist()])
    signed = areas(points, triangles)
    assert len(triangles) == len(points) - 2
    assert (np.sign(signed) == np.sign(area) * (-1 if clockwise else 1)).all()
    assert np.abs(signed).sum() == pytest.approx(abs(area))


def test_convex_polygons_become_fans_in_the_order_of_the_file():
    points = np.array([(0, 0), (2, 0), (2, 2), (1, 3), (0, 2.0)])
    triangles = triangulate_polygons(points, [[0, 1, 2, 3, 4], [2, 1, 0]])
    assert triangles.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 1, 0]]


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_polygons_in_space(axis):
    points = np.insert(np.array(L_SHAPE, dtype=float), axis, np.linspace(0, 0.1, 6), axis=1)
    triangles = triangulate_polygons(points, [[3, 4, 5, 0, 1, 2]])
    flat = np.delete(points, axis, axis=1)
    assert areas(flat, triangles).min() > 0
    assert areas(flat, triangles).sum() == pytest.approx(7)


def test_a_polygon_that_crosses_itself_and_one_that_is_flat_end():
    points = np.array([(0, 0), (2, 2), (2, 0), (0, 2), (4, 4), (6, 6.0)])
    assert len(triangulate_polygons(points, [[0, 1, 2, 3], [0, 1, 4, 5]])) == 4


def test_too_many_corners_are_refused():
    points = star(MAX_POLYGON_CORNERS + 1, 4)
    with pytest.raises(
        InputError, match="expected at most 5000 corners of a face that is not convex, got 5001"
    ):
        triangulate_polygons(points, [list(range(len(points)))])
