"""As-Killing-as-possible fields: their energies, fields they reproduce, and a dense implementation."""

import numpy as np
import pytest

from akap_editor.deform.akap.killing_field import KillingSystem
from akap_editor.errors import SolverError
from akap_editor.geometry.mesh import NO_POINTS, MeshPoints, TriMesh
from akap_editor.geometry.operators import to_complex, to_points
from tests.support import dense, shapes
from tests.support.dense import killing_energy

WEIGHT = 30.0


def fields(mesh, positions, points, velocities, weight=WEIGHT):
    """U_opt and U°, (n, 2) each."""
    system = KillingSystem(mesh, weight)
    system.set_pins(points)
    system.prepare(positions)
    optimal, smooth = system.field(to_complex(velocities))
    return to_points(optimal), to_points(smooth)


def bent(mesh):
    """A pose without flips that is no rigid motion of the rest pose."""
    x, y = mesh.vertices.T
    return np.stack([x + 8 * np.sin(y / 40), 1.1 * y - 6 * np.cos(x / 50)], axis=1)


def random_velocities(points, seed):
    return np.random.default_rng(seed).normal(scale=5.0, size=(len(points), 2))


@pytest.fixture(params=[1, 2])
def case(request, mesh):
    """Pose, pins and velocities."""
    points = shapes.random_pins(mesh, request.param)
    return bent(mesh), points, random_velocities(points, request.param)


def test_agrees_with_the_dense_implementation(mesh, case):
    positions, points, velocities = case
    optimal, smooth = fields(mesh, positions, points, velocities)
    expected = dense.smooth_field(mesh, positions, points, velocities, WEIGHT)
    size = np.abs(expected).max()
    assert np.abs(smooth - expected).max() < 1e-8 * size
    assert np.abs(optimal - dense.dirichlet_field(mesh, positions, expected)).max() < 1e-8 * size


def energy_with_pins(mesh, positions, points, velocities, field):
    """The function that (3) minimizes, λ on the row."""
    off = mesh.evaluate(points, field) - velocities
    return killing_energy(positions, mesh.faces, field) + WEIGHT**2 * (off**2).sum()


def test_first_field_minimizes_energy_and_pin_error(mesh, case):
    positions, points, velocities = case
    _, smooth = fields(mesh, positions, points, velocities)
    least = energy_with_pins(mesh, positions, points, velocities, smooth)
    rng = np.random.default_rng(3)
    for size in (1e-3, 0.1, 10.0):
        other = smooth + size * rng.normal(size=smooth.shape)
        assert energy_with_pins(mesh, positions, points, velocities, other) > least


def test_second_field_minimizes_energy_with_the_boundary_fixed(mesh, case):
    positions, points, velocities = case
    optimal, smooth = fields(mesh, positions, points, velocities)
    rim = dense.boundary_vertices(mesh)
    assert optimal[rim].tolist() == smooth[rim].tolist()
    least = killing_energy(positions, mesh.faces, optimal)
    assert least <= killing_energy(positions, mesh.faces, smooth) * (1 + 1e-12)
    rng = np.random.default_rng(4)
    for size in (1e-3, 0.1, 10.0):
        change = size * rng.normal(size=optimal.shape)
        change[rim] = 0.0
        assert killing_energy(positions, mesh.faces, optimal + change) >= least * (1 - 1e-12)


def test_second_solve_changes_nothing_where_all_pins_sit_on_the_boundary(mesh):
    rng = np.random.default_rng(5)
    rim = np.array(dense.boundary_vertices(mesh))
    chosen = np.concatenate(
        [rng.choice(rim[mesh.component[rim] == c], 3, replace=False) for c in set(mesh.component)]
    )
    points = shapes.vertex_pins(mesh, chosen)
    velocities = random_velocities(points, 5)
    optimal, smooth = fields(mesh, bent(mesh), points, velocities)
    assert optimal.tolist() == smooth.tolist()
    expected = dense.dirichlet_field(mesh, bent(mesh), smooth)
    assert np.abs(expected - smooth).max() < 1e-9 * np.abs(smooth).max()


def test_second_solve_smooths_around_an_interior_pin():
    mesh = shapes.SHAPES["disc 2"]
    inner = np.setdiff1d(np.arange(len(mesh.vertices)), mesh.boundary_vertices)[[3, 60]]
    points = shapes.vertex_pins(mesh, inner)
    optimal, smooth = fields(mesh, mesh.vertices, points, np.array([[5.0, 0.0], [-5.0, 0.0]]))
    energies = [killing_energy(mesh.vertices, mesh.faces, field) for field in (optimal, smooth)]
    assert energies[0] < 0.9 * energies[1]


@pytest.mark.parametrize("each", [2, 5])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_lemma_1_rigid_velocities_are_reproduced(mesh, seed, each):
    points = shapes.random_pins(mesh, seed, each)
    positions = bent(mesh)
    rng = np.random.default_rng(seed)
    turn, shift = rng.normal(), rng.normal(scale=20.0, size=2)
    rigid = positions @ [[0.0, turn], [-turn, 0.0]] + shift
    for field in fields(mesh, positions, points, mesh.evaluate(points, rigid)):
        assert np.abs(field - rigid).max() < 1e-9 * np.abs(rigid).max()


def test_field_is_linear_in_the_velocities(mesh, case):
    positions, points, velocities = case
    other = random_velocities(points, 9)
    total, _ = fields(mesh, positions, points, 2 * velocities - other)
    parts = [fields(mesh, positions, points, v)[0] for v in (velocities, other)]
    assert np.abs(total - (2 * parts[0] - parts[1])).max() < 1e-9 * np.abs(total).max()


def test_larger_weight_follows_the_pins_better():
    mesh = shapes.SHAPES["disc 1"]
    points = shapes.random_pins(mesh, 1)
    velocities = random_velocities(points, 1)
    errors = []
    for weight in (1.0, 10.0, 100.0, 1000.0):
        _, smooth = fields(mesh, mesh.vertices, points, velocities, weight)
        errors.append(np.abs(mesh.evaluate(points, smooth) - velocities).max())
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 1e-4


def test_without_pins_nothing_moves(mesh):
    for field in fields(mesh, bent(mesh), NO_POINTS, np.zeros((0, 2))):
        assert not field.any()


def test_one_pin_translates_its_part_alone(mesh):
    points = MeshPoints([len(mesh.faces) // 3], [[0.2, 0.3, 0.5]])
    own = mesh.component == mesh.component[mesh.faces[points.faces[0], 0]]
    for field in fields(mesh, bent(mesh), points, np.array([[3.0, -4.0]])):
        assert np.abs(field[own] - [3.0, -4.0]).max() < 1e-9
        assert not field[~own].any()


def test_pins_at_one_place_do_not_leave_their_part_free_to_turn(mesh):
    weights = [[0.2, 0.3, 0.5]] * 2
    face = len(mesh.faces) // 2
    velocities = np.array([[3.0, -4.0], [1.0, 2.0]])
    one, _ = fields(mesh, bent(mesh), MeshPoints([face] * 2, weights), velocities)
    own = mesh.component == mesh.component[mesh.faces[face, 0]]
    assert np.abs(one[own] - [2.0, -1.0]).max() < 1e-9  # the mean
    other, _ = fields(mesh, bent(mesh), MeshPoints([face] * 2, weights), velocities[::-1])
    assert np.abs(one - other).max() < 1e-9


def test_pins_of_two_faces_that_share_a_vertex_count_as_one_place():
    mesh = shapes.SHAPES["square"]
    faces = np.flatnonzero((mesh.faces == 7).any(axis=1))[:2]
    points = MeshPoints(faces, (mesh.faces[faces] == 7).astype(float))
    field, _ = fields(mesh, bent(mesh), points, np.array([[3.0, -4.0]] * 2))
    assert np.abs(field - [3.0, -4.0]).max() < 1e-9


def test_collapsed_pose_is_a_solver_error(mesh):
    points = shapes.random_pins(mesh, 1)
    with pytest.raises(SolverError), np.errstate(all="ignore"):
        fields(mesh, np.zeros_like(mesh.vertices), points, np.zeros((len(points), 2)))


def test_size_of_the_drawing_does_not_matter(mesh, case):
    positions, points, velocities = case
    optimal, _ = fields(mesh, positions, points, velocities)
    for scale in (1e-2, 1e3):
        larger = TriMesh(scale * mesh.vertices, mesh.faces)
        scaled, _ = fields(larger, scale * positions, points, scale * velocities)
        assert np.abs(scaled / scale - optimal).max() < 1e-9 * np.abs(optimal).max()
