"""Bounds on face areas: few corners move, and all faces end within the bounds."""

import numpy as np
import pytest

from akap_editor.geometry.area_bounds import bound_face_areas, grow_faces, worst_area_factor
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import signed_areas
from akap_editor.geometry.operators import to_complex, to_points
from tests.support.shapes import blocks


@pytest.fixture(scope="module")
def mesh():
    """A bar of unit squares, two faces each."""
    return blocks("########################################", 4, 4)


def squeezed(mesh):
    """The rest pose with one inner vertex moved, its index, and the ratios of the face areas."""
    vertex = int(np.argmin(np.abs(mesh.vertices - [8.0, 1.0]).sum(axis=1)))
    pose = mesh.vertices.copy()
    pose[vertex] += [0.9, 0.0]
    return pose, vertex


def ratios(mesh, pose):
    return distortion(mesh, pose).face_determinant


def test_bounding_moves_little_and_only_what_is_beyond(mesh):
    np.testing.assert_array_equal(bound_face_areas(mesh, mesh.vertices, 1.5), mesh.vertices)
    pose, vertex = squeezed(mesh)
    assert ratios(mesh, pose).min() < 0.5
    bounded = bound_face_areas(mesh, pose, 2.0)
    assert ratios(mesh, bounded).min() >= 0.99 / 2
    assert ratios(mesh, bounded).max() <= 2 * 1.01
    far = np.abs(mesh.vertices - mesh.vertices[vertex]).max(axis=1) > 3
    assert far.sum() > 100
    np.testing.assert_array_equal(bounded[far], pose[far])


def test_worst_factor_counts_growth_and_shrinkage_alike(mesh):
    assert worst_area_factor(mesh, mesh.vertices) == pytest.approx(1.0)
    assert worst_area_factor(mesh, 2 * mesh.vertices) == pytest.approx(4.0)
    assert worst_area_factor(mesh, 0.5 * mesh.vertices) == pytest.approx(4.0)
    pose, _ = squeezed(mesh)
    assert worst_area_factor(mesh, pose) == pytest.approx(1 / ratios(mesh, pose).min())
    assert worst_area_factor(mesh, mesh.vertices * [-1.0, 1.0]) == np.inf


def test_a_face_alone_grows_by_its_missing_area_to_first_order(mesh):
    pose, corners = to_complex(mesh.vertices), mesh.faces[:1]
    grown = grow_faces(pose, corners, np.array([1e-4]), np.zeros(1))
    gain = signed_areas(to_points(grown), corners) - signed_areas(mesh.vertices, corners)
    assert gain == pytest.approx(1.5e-4, rel=1e-3)  # times the relaxation
