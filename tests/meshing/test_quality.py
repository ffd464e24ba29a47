"""Measures of meshes whose values are known."""

import numpy as np
import pytest

from akap_editor.geometry.mesh import TriMesh
from akap_editor.meshing.outline import Outline
from akap_editor.meshing.picture_mesh import mesh_picture
from akap_editor.meshing.quality import mesh_polygons, mesh_quality, smallest_angles
from akap_editor.meshing.triangulate import triangulate


def box(width, height, x0, y0, x1, y1):
    """An opaque box in a transparent picture."""
    alpha = np.zeros((height, width), dtype=np.uint8)
    alpha[y0:y1, x0:x1] = 255
    return alpha


def test_smallest_angles():
    mesh = TriMesh(
        [[0, 0], [1, 0], [0, 1], [5, 0], [9, 0], [7, 12**0.5], [-3, 0]], [[0, 1, 2], [3, 4, 5], [2, 6, 0]]
    )
    assert smallest_angles(mesh) == pytest.approx([45, 60, np.degrees(np.arctan(1 / 3))])


def test_half_of_a_box_is_covered():
    alpha = box(100, 80, 10, 10, 70, 50)
    half = triangulate([Outline([[10, 10], [40, 10], [40, 50], [10, 50]])], 100)
    quality = mesh_quality(half, alpha)
    assert quality.covered == pytest.approx(0.5, abs=1e-3)  # the contour cuts corners
    assert quality.outside == pytest.approx(0, abs=1e-3)
    assert (quality.parts, quality.holes) == (1, 0)
    assert (quality.vertices, quality.faces) == (len(half.vertices), len(half.faces))


def test_what_is_outside():
    alpha = box(100, 80, 10, 10, 70, 50)
    whole = triangulate([Outline([[0, 0], [100, 0], [100, 80], [0, 80]])], 100)
    quality = mesh_quality(whole, alpha)
    assert quality.covered == pytest.approx(1)
    assert quality.outside == pytest.approx(1 - 60 * 40 / 8000, abs=1e-3)


def test_parts_and_holes_of_rings_in_rings():
    alpha = box(120, 120, 5, 5, 115, 115)
    alpha[20:100, 20:100] = 0
    alpha[35:85, 35:85] = 255
    alpha[50:70, 50:70] = 0
    mesh = mesh_picture(alpha, 400).mesh
    quality = mesh_quality(mesh, alpha)
    assert (quality.parts, quality.holes) == (2, 2)
    assert quality.covered == pytest.approx(1)
    assert sum(polygon.area for polygon in mesh_polygons(mesh)) == pytest.approx(mesh.rest_areas.sum())


def test_angles_are_the_worst_and_nearly_the_worst():
    mesh = mesh_picture(box(100, 80, 10, 10, 70, 50), 500).mesh
    quality = mesh_quality(mesh, box(100, 80, 10, 10, 70, 50))
    assert quality.worst_angle == smallest_angles(mesh).min()
    assert (smallest_angles(mesh) <= quality.low_angle).mean() == pytest.approx(0.01, abs=0.005)
