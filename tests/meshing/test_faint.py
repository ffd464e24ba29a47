"""Faint drawings, and what a threshold cuts off."""

import numpy as np
import pytest

from akap_editor.meshing.faint import faint_share, fitting_threshold
from akap_editor.meshing.picture_mesh import mesh_picture


def box(value, size=60, margin=15):
    alpha = np.zeros((size, size), np.uint8)
    alpha[margin:-margin, margin:-margin] = value
    return alpha


@pytest.mark.parametrize(
    ("most", "threshold"), [(255, 0.5), (128, 0.5), (127, 0.249), (51, 0.1), (12, 0.024), (5, 0.5), (0, 0.5)]
)
def test_the_threshold_of_a_faint_drawing_is_half_of_its_greatest_opacity(most, threshold):
    assert fitting_threshold(box(most)) == threshold


@pytest.mark.parametrize("most", [127, 51, 12])
def test_a_faint_drawing_is_meshed_whole(most):
    alpha = box(most)
    threshold = fitting_threshold(alpha)
    mesh = mesh_picture(alpha, 200, threshold=threshold).mesh
    assert mesh.rest_areas.sum() >= 30 * 30
    assert faint_share(alpha, mesh, threshold) == 0


def test_a_glow_that_is_left_out_is_measured():
    alpha = np.maximum(box(255, margin=20), box(60, margin=5))
    mesh = mesh_picture(alpha, 200).mesh
    kept = 24 * 24  # the box of 20 pixels, and the margin of 2
    assert faint_share(alpha, mesh, 0.5) == pytest.approx((50 * 50 - kept) / (50 * 50), abs=0.03)
    assert faint_share(box(255), mesh_picture(box(255), 200).mesh, 0.5) == 0
    assert faint_share(np.zeros((60, 60), np.uint8), mesh, 0.5) == 0


def test_a_glow_inside_a_hole_is_left_out_too():
    alpha = box(255, margin=10)
    alpha[20:40, 20:40] = 50
    mesh = mesh_picture(alpha, 200).mesh
    assert faint_share(alpha, mesh, 0.5) == pytest.approx(16 * 16 / (40 * 40), abs=0.04)
