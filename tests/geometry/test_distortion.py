"""Distortion on maps whose singular values are known."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import TriMesh
from tests.support.shapes import renumbered

TURN = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])


def close(value):
    return pytest.approx(value, rel=1e-11)


@pytest.mark.parametrize("matrix", [np.eye(2), TURN, -np.eye(2)])
def test_rigid_motions_have_none(mesh, matrix):
    result = distortion(mesh, mesh.vertices @ matrix.T + [50.0, 3.0])
    assert (result.area, result.angle, result.flipped) == (close(2), close(2), 0)


@pytest.mark.parametrize("scale", [0.25, 1.5, 8.0])
def test_scaling_changes_area_alone(mesh, scale):
    result = distortion(mesh, scale * mesh.vertices)
    assert (result.area, result.angle) == (close(scale**2 + scale**-2), close(2))


@pytest.mark.parametrize("scale", [0.25, 1.5, 8.0])
def test_stretching_in_one_direction(mesh, scale):
    result = distortion(mesh, mesh.vertices @ np.diag([scale, 1.0]) @ TURN)
    assert (result.area, result.angle) == (close(scale + 1 / scale), close(scale + 1 / scale))


def test_opposite_stretches_change_angles_alone(mesh):
    result = distortion(mesh, mesh.vertices @ TURN @ np.diag([2.0, 0.5]))
    assert (result.area, result.angle) == (close(2), close(4.25))


def test_mirrored_faces_are_counted_and_measured_by_size(mesh):
    result = distortion(mesh, mesh.vertices * [-2.0, 1.0])
    assert (result.area, result.angle, result.flipped) == (close(2.5), close(2.5), len(mesh.faces))


def test_means_are_weighted_by_rest_area():
    vertices = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [10.0, 0.0], [13.0, 0.0], [10.0, 1.0]])
    mesh = TriMesh(vertices, [[0, 1, 2], [3, 4, 5]])
    pose = np.concatenate([vertices[:3], vertices[3:] * [1.0, 2.0]])
    result = distortion(mesh, pose)
    assert result.face_area == pytest.approx([2, 2.5])
    assert result.area == close((2 * 1 + 2.5 * 3) / 4)


def test_face_values_are_those_of_the_singular_values(mesh):
    pose = mesh.vertices + np.random.default_rng(8).normal(scale=2.0, size=mesh.vertices.shape)
    result = distortion(mesh, pose)
    for face, (a, b, c) in enumerate(mesh.faces):
        rest = np.stack([mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]], axis=1)
        now = np.stack([pose[b] - pose[a], pose[c] - pose[a]], axis=1)
        big, small = np.linalg.svd(now @ np.linalg.inv(rest), compute_uv=False)
        assert result.face_area[face] == pytest.approx(big * small + 1 / (big * small), rel=1e-9)
        assert result.face_angle[face] == pytest.approx(big / small + small / big, rel=1e-9)


@pytest.mark.parametrize("matrix", [np.diag([1.0, 0.0]), np.zeros((2, 2))])
@pytest.mark.filterwarnings("error")
def test_collapsed_faces_are_infinitely_distorted(mesh, matrix):
    result = distortion(mesh, mesh.vertices @ matrix)
    assert (result.area, result.angle, result.flipped) == (np.inf, np.inf, len(mesh.faces))


def test_renumbering_changes_nothing(mesh):
    pose = mesh.vertices + np.random.default_rng(9).normal(scale=3.0, size=mesh.vertices.shape)
    other, order, _ = renumbered(mesh, 1)
    before, after = distortion(mesh, pose), distortion(other, pose[order])
    assert (after.area, after.angle, after.flipped) == (
        close(before.area),
        close(before.angle),
        before.flipped,
    )


def test_pose_of_another_mesh_is_refused(mesh):
    n = len(mesh.vertices)
    with pytest.raises(InputError, match=rf"positions: expected shape \({n}, 2\), got \({n + 1}, 2\)"):
        distortion(mesh, np.zeros((n + 1, 2)))
