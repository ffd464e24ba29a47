"""The Killing matrix against dense ones, and sums over faces with the same nonzeros."""

import numpy as np
import pytest

from akap_editor.geometry.killing_matrix import KillingMatrix, VertexBlocks, add_face
from akap_editor.geometry.operators import to_complex
from tests.support import dense
from tests.support.dense import killing_energy


def filled(blocks, nonzeros):
    """A symmetric matrix by its nonzeros, as a dense one."""
    size = blocks.columns.max() + 1
    matrix = np.zeros((size, size))
    matrix[blocks.rows, blocks.columns] = nonzeros
    return matrix + np.tril(matrix, -1).T


def assembled(mesh, positions, **weights):
    """The Killing matrix at a pose as a dense one."""
    killing = KillingMatrix(mesh)
    return filled(killing.blocks, killing.nonzeros(to_complex(positions), **weights))


def test_killing_matrix_is_that_of_the_stacked_rows(mesh):
    rows = dense.killing_rows(mesh.vertices, mesh.faces)
    assert np.abs(assembled(mesh, mesh.vertices) - rows.T @ rows).max() < 1e-11


def test_killing_matrix_at_a_pose(mesh):
    pose = mesh.vertices @ [[1.1, 0.3], [-0.2, 0.8]] + 2 * np.sin(mesh.vertices[:, ::-1] / 20)
    rows = dense.killing_rows(pose, mesh.faces)
    assert np.abs(assembled(mesh, pose) - rows.T @ rows).max() < 1e-11


def test_nonzeros_are_in_the_order_of_columns_and_those_of_neighbors(mesh):
    blocks = VertexBlocks(mesh)
    keys = blocks.columns.astype(int) * 2 * len(mesh.vertices) + blocks.rows
    assert (np.diff(keys) > 0).all()
    coupled = np.eye(len(mesh.vertices), dtype=bool)
    coupled[mesh.edges[:, 0], mesh.edges[:, 1]] = coupled[mesh.edges[:, 1], mesh.edges[:, 0]] = True
    expected = np.argwhere(np.tril(np.kron(coupled, np.ones((2, 2)))))
    assert sorted(zip(blocks.rows, blocks.columns, strict=True)) == list(map(tuple, expected))


def test_matrices_of_faces_add_up(mesh):
    """As in a loop over dense ones."""
    blocks, rng = VertexBlocks(mesh), np.random.default_rng(5)
    nonzeros, expected = np.zeros(len(blocks.rows)), np.zeros((2 * len(mesh.vertices),) * 2)
    for number, corners in enumerate(mesh.faces):
        half = rng.normal(size=(6, 6))
        matrix = half + half.T
        add_face(nonzeros, number, corners, matrix, blocks.slots)
        unknowns = (2 * corners[:, None] + np.arange(2)).ravel()
        expected[np.ix_(unknowns, unknowns)] += matrix
    assert np.abs(filled(blocks, nonzeros) - expected).max() < 1e-12


def test_stiff_faces_count_more(mesh):
    stiffness = np.random.default_rng(3).uniform(0.5, 100, len(mesh.faces))
    rows = dense.killing_rows(mesh.vertices, mesh.faces) * np.sqrt(stiffness).repeat(3)[:, None]
    expected = rows.T @ rows
    found = assembled(mesh, mesh.vertices, stiffness=stiffness)
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()


def test_turning_costs_by_its_rate_whatever_the_stiffness(mesh):
    rng = np.random.default_rng(4)
    stiffness, rotation = rng.uniform(0.5, 100, (2, len(mesh.faces)))
    plain = assembled(mesh, mesh.vertices, stiffness=stiffness)
    both = assembled(mesh, mesh.vertices, stiffness=stiffness, rotation_weights=rotation)
    for turn, move in [(0.3, 0.0), (-2.0, 5.0)]:
        field = mesh.vertices @ [[0.0, turn], [-turn, 0.0]] + move
        cost = field.ravel() @ (both - plain) @ field.ravel()
        assert cost == pytest.approx(turn**2 * (rotation @ mesh.rest_areas), rel=1e-9)


def test_null_space_is_the_rigid_motions_of_each_part(mesh):
    parts = mesh.component.max() + 1
    spectrum = np.linalg.eigvalsh(assembled(mesh, mesh.vertices))
    assert (spectrum < 1e-10 * spectrum[-1]).sum() == 3 * parts
    assert spectrum[3 * parts] > 1e-6 * spectrum[-1]


def test_killing_energy_is_the_quadratic_form(mesh):
    field = np.random.default_rng(6).normal(size=mesh.vertices.shape)
    matrix = assembled(mesh, mesh.vertices)
    energy = killing_energy(mesh.vertices, mesh.faces, field)
    assert energy == pytest.approx(field.ravel() @ matrix @ field.ravel(), rel=1e-12)


def test_flipped_faces_count_by_their_size(mesh):
    """A pose from elsewhere may have flipped faces: a mirrored one has the mirrored energy."""
    mirrored = mesh.vertices * [-1.0, 1.0]
    field = np.random.default_rng(7).normal(size=mirrored.shape)
    energy = killing_energy(mesh.vertices, mesh.faces, field)
    assert killing_energy(mirrored, mesh.faces, field * [-1.0, 1.0]) == pytest.approx(energy, rel=1e-12)
    rows = dense.killing_rows(mirrored, mesh.faces)
    assert np.abs(assembled(mesh, mirrored) - rows.T @ rows).max() < 1e-11


@pytest.mark.parametrize("turn", [0.0, 1.0, -3.0])
def test_rigid_fields_have_no_energy(mesh, turn):
    field = mesh.vertices @ [[0.0, turn], [-turn, 0.0]] + [4.0, 9.0]
    assert killing_energy(mesh.vertices, mesh.faces, field) < 1e-20 * mesh.rest_areas.sum()


@pytest.mark.parametrize(
    ("jacobian", "density"),
    [
        ([[1, 0], [0, 0]], 4),  # ‖J + Jᵀ‖² of stretch in x, of stretch in both, of shear, of a mixture
        ([[1, 0], [0, 1]], 8),
        ([[0, 1], [0, 0]], 2),
        ([[2, 3], [-1, 0.5]], 16 + 2 * 4 + 1),
    ],
)
def test_energy_of_linear_fields(mesh, jacobian, density):
    field = mesh.vertices @ np.transpose(jacobian)
    expected = pytest.approx(density * mesh.rest_areas.sum(), rel=1e-12)
    assert killing_energy(mesh.vertices, mesh.faces, field) == expected
    assert field.ravel() @ assembled(mesh, mesh.vertices) @ field.ravel() == expected
