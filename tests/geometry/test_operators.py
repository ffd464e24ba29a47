"""Differential operators on functions whose derivatives are known."""

import numpy as np

from akap_editor.geometry.operators import (
    gradient_matrices,
    hat_gradients,
    to_complex,
    to_points,
)


def test_complex_and_points_are_the_same_numbers():
    points = np.array([[1.0, 2.0], [3.0, -4.0]])
    assert to_complex(points).tolist() == [1 + 2j, 3 - 4j]
    assert to_points(to_complex(points)).tolist() == points.tolist()
    assert to_points(to_complex(points[:, ::-1])).tolist() == points[:, ::-1].tolist()


def test_gradients_of_linear_functions(mesh):
    gx, gy = gradient_matrices(mesh)
    values = mesh.vertices @ [3.0, -2.0] + 7.0
    assert np.abs(gx @ values - 3.0).max() < 1e-11
    assert np.abs(gy @ values + 2.0).max() < 1e-11


def test_hat_gradients_sum_to_zero_and_areas_are_those_of_the_faces(mesh):
    dx, dy, areas = hat_gradients(mesh.vertices, mesh.faces)
    assert np.abs(dx.sum(axis=1)).max() < 1e-14
    assert np.abs(dy.sum(axis=1)).max() < 1e-14
    assert areas.tolist() == mesh.rest_areas.tolist()


def test_gradients_of_affine_maps(mesh):
    matrix = np.array([[0.8, -0.3], [1.2, 0.5]])
    pose = mesh.vertices @ matrix.T + [100.0, -30.0]
    gx, gy = gradient_matrices(mesh)
    assert np.abs(np.stack([gx @ pose, gy @ pose], axis=2) - matrix).max() < 1e-11
