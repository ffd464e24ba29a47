"""Pins that hold an angle: the energies, and steps of `AkapDeformer` with angles."""

import numpy as np
import pytest

from akap_editor.deform.akap.pin_rotation import PinRotationConstraints
from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.killing_matrix import KillingMatrix
from akap_editor.geometry.mesh import MeshPoints
from akap_editor.geometry.operators import to_complex, to_points
from tests.support import shapes
from tests.support.deformers import akap_with_pins

FREE = np.nan
MEMORIES = pytest.mark.parametrize("memory", [0.0, 1.0])


def constraints_on(mesh, points):
    return PinRotationConstraints(mesh, points, np.ones(len(points), dtype=bool))


# -- the terms -----------------------------------------------------------------------------------------------


def test_energy_of_a_field_is_that_of_the_matrix(mesh):
    rotation = constraints_on(mesh, shapes.random_pins(mesh, 1, 2))
    pose = mesh.vertices @ [[1.1, 0.2], [-0.1, 0.9]]
    rotation.set_pose(pose)
    killing = KillingMatrix(mesh)
    weights, z = rotation.rotation_weights, to_complex(pose)
    difference = killing.nonzeros(z, rotation_weights=weights) - killing.nonzeros(z)
    matrix = np.zeros((2 * len(pose),) * 2)
    matrix[killing.blocks.rows, killing.blocks.columns] = difference
    matrix += np.tril(matrix, -1).T
    field = np.random.default_rng(1).normal(size=pose.shape)
    assert rotation.energy(to_complex(field)) == pytest.approx(
        field.ravel() @ matrix @ field.ravel(), rel=1e-9
    )


def test_energy_and_force_of_a_rotation(mesh):
    """A rotation at the rate ω costs c A ω², and the force for ω̃ does the work c A ω ω̃ on it."""
    rotation = constraints_on(mesh, shapes.random_pins(mesh, 1, 2))
    field = 0.3j * (to_complex(mesh.vertices) - 7.0)
    rotation.set_pose(mesh.vertices)
    area = mesh.rest_areas[rotation.faces].sum()
    assert rotation.energy(field) == pytest.approx(1e4 * area * 0.09, rel=1e-9)
    force = rotation.pin_force(np.full(len(rotation.faces), 0.5))
    assert np.vdot(force, field).real == pytest.approx(1e4 * area * 0.3 * 0.5, rel=1e-9)


def test_residual_energy_and_its_gradient(mesh):
    rotation = constraints_on(mesh, shapes.random_pins(mesh, 2, 2))
    pose = to_complex(mesh.vertices @ [[1.1, 0.2], [-0.1, 0.9]])
    goal = np.exp(0.4j)
    gradient = 2 * rotation.residual_gradient(rotation.face_rotations(pose) - goal)
    change = to_complex(np.random.default_rng(3).normal(size=mesh.vertices.shape))
    ahead, behind = (
        rotation.residual_energy(rotation.face_rotations(pose + step * change) - goal)
        for step in (1e-4, -1e-4)
    )
    assert np.vdot(gradient, change).real == pytest.approx((ahead - behind) / 2e-4, rel=1e-6)


@pytest.mark.parametrize("angle", [-3.0, -0.5, 0.0, 1.0, 3.1])
def test_angles_are_those_of_the_surroundings(mesh, angle):
    points = shapes.random_pins(mesh, 1, 2)
    pose = to_points(np.exp(1j * angle) * to_complex(mesh.vertices))
    assert akap_with_pins(mesh, points).angles(pose) == pytest.approx(np.full(len(points), angle))


# -- steps ---------------------------------------------------------------------------------------------------


@MEMORIES
@pytest.mark.parametrize("dirichlet", [True, False])
def test_part_with_one_pin_rotates_with_it_as_a_whole(mesh, memory, dirichlet):
    points = MeshPoints([len(mesh.faces) // 2], [[0.2, 0.3, 0.5]])
    own = mesh.component == mesh.component[mesh.faces[points.faces[0], 0]]
    deformer, pose = akap_with_pins(mesh, points, memory=memory, dirichlet=dirichlet), mesh.vertices
    place = mesh.evaluate(points, pose)
    for angle in np.linspace(0, 4.0, 30)[1:]:
        pose = deformer.step(pose, place, [angle]).positions
    center = to_complex(place)[0]
    expected = center + np.exp(4j) * (to_complex(mesh.vertices) - center)
    assert np.abs(to_complex(pose) - expected)[own].max() < 1e-6
    assert pose[~own].tolist() == mesh.vertices[~own].tolist()


@MEMORIES
def test_pin_rotates_to_its_angle_and_others_stay(memory):
    mesh = shapes.SHAPES["bar"]
    points = mesh.locate([[10.0, 30.0], [150.0, 30.0], [290.0, 30.0]])
    places = mesh.evaluate(points, mesh.vertices)
    deformer, pose = akap_with_pins(mesh, points, memory=memory), mesh.vertices
    for angle in np.linspace(0, 0.8, 20)[1:].tolist() + [0.8] * 10:
        result = deformer.step(pose, places, [FREE, angle, FREE])
        pose = result.positions
    assert deformer.angles(pose)[1] == pytest.approx(0.8, abs=0.02)
    assert result.report.pin_error < 0.25
    assert distortion(mesh, pose).flipped == 0
    middle = mesh.evaluate(mesh.locate([[150.0, 24.0], [150.0, 36.0]]), pose)
    slope = np.arctan2(*(middle[1] - middle[0])[::-1]) - np.pi / 2
    assert slope == pytest.approx(0.8, abs=0.1)


def test_pin_holds_its_angle_while_another_is_dragged():
    """Without an angle, the end of the bar would rotate."""
    mesh = shapes.SHAPES["bar"]
    points = mesh.locate([[10.0, 30.0], [290.0, 30.0]])
    places = mesh.evaluate(points, mesh.vertices)
    ends = []
    for held in (FREE, 0.0):
        deformer, pose = akap_with_pins(mesh, points, memory=1.0), mesh.vertices
        for y in np.linspace(0, 80, 30)[1:].tolist() + [80.0] * 20:
            pose = deformer.step(pose, places + np.array([[0.0, 0.0], [-y / 4, y]]), [held, FREE]).positions
        ends.append(abs(deformer.angles(pose)[0]))
    assert ends[0] > 0.2
    assert ends[1] < 0.05


def test_angle_where_a_pin_is_moves_nothing(mesh):
    points = shapes.random_pins(mesh, 3)
    places = mesh.evaluate(points, mesh.vertices)
    for memory in (0.0, 1.0):
        result = akap_with_pins(mesh, points, memory=memory).step(
            mesh.vertices, places, np.zeros(len(points))
        )
        assert np.abs(result.positions - mesh.vertices).max() < 1e-6


def test_large_rotation_is_divided_into_substeps():
    mesh = shapes.SHAPES["square"]
    points = mesh.locate([mesh.vertices.mean(axis=0)])
    result = akap_with_pins(mesh, points).step(mesh.vertices, mesh.evaluate(points, mesh.vertices), [1.0])
    assert result.report.substeps == 10
    assert akap_with_pins(mesh, points).angles(result.positions)[0] == pytest.approx(1.0, abs=1e-6)


def test_all_free_is_no_angle_at_all(mesh):
    points = shapes.random_pins(mesh, 3)
    goals = mesh.evaluate(points, mesh.vertices) + 3.0
    expected = akap_with_pins(mesh, points).step(mesh.vertices, goals).positions
    used = akap_with_pins(mesh, points)
    used.step(mesh.vertices, goals, np.zeros(len(points)))  # angles of an earlier step leave no trace
    found = used.step(mesh.vertices, goals, np.full(len(points), FREE)).positions
    assert np.abs(found - expected).max() < 1e-5 * mesh.length


@pytest.mark.parametrize("angles", [[0.0, 1.0], [np.inf], ["left"], 1.0])
def test_bad_angles_are_refused(angles):
    mesh = shapes.SHAPES["triangle"]
    deformer = akap_with_pins(mesh, MeshPoints([0], [[1.0, 0.0, 0.0]]))
    with pytest.raises(InputError, match=r"^angles: expected 1 "):
        deformer.step(mesh.vertices, [[0.0, 0.0]], angles)
