import numpy as np
import pytest
from scipy.sparse import coo_array

from akap_editor.deform.akap import AkapDeformer
from akap_editor.deform.cholesky import SymmetricPattern
from akap_editor.deform.reuse import ReusedCholesky
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.operators import element_pattern, killing_elements, to_complex, to_points

TOLERANCE = 1e-6


class System:
    """K + I of a mesh, which is positive definite without pins."""

    def __init__(self, mesh):
        self.mesh, self.size = mesh, 2 * len(mesh.vertices)
        rows, columns = element_pattern(mesh.faces)
        every = np.arange(self.size)
        self.rows, self.columns = np.append(rows, every), np.append(columns, every)
        self.pattern = SymmetricPattern(self.rows, self.columns, self.size)

    def nonzeros(self, positions):
        ones = np.ones(self.size)
        return self.pattern.summed(np.append(killing_elements(positions, self.mesh.faces), ones))

    def matrix(self, positions):
        rows, columns = self.pattern.rows, self.pattern.columns
        lower = coo_array((self.nonzeros(positions), (rows, columns)), shape=(self.size, self.size)).toarray()
        return lower + lower.T - np.diag(lower.diagonal())


def bent(mesh, angle):
    """The mesh bent to an arc, and how far each vertex is turned by that."""
    x, y = mesh.vertices.T
    share = (x - x.min()) / np.ptp(x)
    radius = np.ptp(x) / angle - (y - y.mean())
    turn = angle * share
    return np.stack([radius * np.sin(turn), -radius * np.cos(turn)], axis=1), np.exp(1j * turn)


def energy_norm(matrix, values):
    flat = to_points(values).ravel()
    return np.sqrt(flat @ matrix @ flat)


@pytest.fixture(scope="module")
def system(shapes):
    return System(shapes.SHAPES["bar"])


def right_side(system, seed):
    generator = np.random.default_rng(seed)
    return to_complex(generator.normal(size=(system.size // 2, 2)))


def test_solutions_at_later_poses_are_as_near_as_stated(system):
    solver = ReusedCholesky(system.pattern, exact=False, tolerance=TOLERANCE)
    rest = system.nonzeros(system.mesh.vertices)
    for seed, angle in enumerate([0.05, 0.1, 0.2, 0.4, 0.8]):
        positions, frame = bent(system.mesh, angle)
        solver.prepare(system.nonzeros(positions), frame, rest)
        matrix, right = system.matrix(positions), right_side(system, seed)
        expected = to_complex(np.linalg.solve(matrix, to_points(right).ravel()).reshape(-1, 2))
        assert energy_norm(matrix, solver.solve(right) - expected) < 2 * TOLERANCE
    assert solver.factorizations == 1


def test_a_turned_drawing_costs_one_iteration(system):
    solver = ReusedCholesky(system.pattern, exact=False, tolerance=TOLERANCE)
    ones = np.ones(system.size // 2, dtype=complex)
    rest = system.nonzeros(system.mesh.vertices)
    turn = np.exp(1.3j)
    positions = to_points(turn * to_complex(system.mesh.vertices))
    solver.prepare(system.nonzeros(positions), turn * ones, rest)
    solver.solve(right_side(system, 1))
    assert solver.factorizations == 1
    assert solver.iterations <= 2  # the second one finds that nothing is left


def test_a_pose_too_far_away_is_factorized(system):
    solver = ReusedCholesky(system.pattern, exact=False, tolerance=TOLERANCE)
    ones = np.ones(system.size // 2, dtype=complex)
    rest = system.nonzeros(system.mesh.vertices)
    positions = system.mesh.vertices * [1.0, 0.01]
    solver.prepare(system.nonzeros(positions), ones, rest)
    right = right_side(system, 2)
    found = solver.solve(right)
    assert solver.factorizations == 2
    expected = np.linalg.solve(system.matrix(positions), to_points(right).ravel()).reshape(-1, 2)
    assert np.abs(to_points(found) - expected).max() < 1e-8


def test_exact_factorizes_every_matrix(system):
    solver = ReusedCholesky(system.pattern, exact=True, tolerance=TOLERANCE)
    for angle in (0.1, 0.2, 0.3):
        positions, frame = bent(system.mesh, angle)
        nonzeros = system.nonzeros(positions)
        solver.prepare(nonzeros, frame, nonzeros)
    assert solver.factorizations == 3


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_a_bend_is_the_same_with_few_factorizations_as_with_many(shapes, memory):
    """Each step within a hundredth of a pixel of the exact one on a drawing of a million square pixels."""
    mesh = shapes.SHAPES["bar"]
    points = shapes.random_pins(mesh, 4, 3)
    start = mesh.evaluate(points, mesh.vertices)
    exact, reusing = (AkapDeformer(mesh, memory=memory, exact=on) for on in (True, False))
    exact.set_pins(points)
    reusing.set_pins(points)
    visible = 0.01 * np.sqrt(mesh.rest_areas.sum()) / 1000
    goal = start.copy()
    pose = other = mesh.vertices
    for share in np.linspace(0, 1, 31)[1:]:
        goal[-1] = start[-1] + share * np.array([-0.2, 0.3]) * np.ptp(mesh.vertices, axis=0).max()
        found = reusing.step(pose, goal).positions
        if memory == 0:  # the memory step follows the factors at hand, and is equal only where it ends
            assert np.abs(found - exact.step(pose, goal).positions).max() < visible
        pose, other = found, exact.step(other, goal).positions
    for _ in range(40):
        pose, other = reusing.step(pose, goal).positions, exact.step(other, goal).positions
    ours, theirs = distortion(mesh, pose), distortion(mesh, other)
    assert ours.area == pytest.approx(theirs.area, abs=5e-5)
    assert ours.angle == pytest.approx(theirs.angle, abs=5e-5)
