"""Conjugate gradients preconditioned by earlier factors: exact results, few factorizations."""

import threading
import time

import numpy as np
import pytest
from scipy.sparse import coo_array

from akap_editor.deform.akap import preconditioned_cholesky
from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.deform.akap.preconditioned_cholesky import PreconditionedCholesky
from akap_editor.deform.cholesky import CholeskyFactors, SymmetricPattern
from akap_editor.errors import SolverError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.killing_matrix import KillingMatrix
from akap_editor.geometry.operators import to_complex, to_points
from tests.support import shapes

TOLERANCE = 1e-6


class System:
    """K + I of a mesh, which is positive definite without pins."""

    def __init__(self, mesh):
        self.mesh, self.size = mesh, 2 * len(mesh.vertices)
        self.killing = KillingMatrix(mesh)
        self.groups = np.append(np.arange(0, len(mesh.vertices), 7), len(mesh.vertices))
        self.pattern = SymmetricPattern(self.killing.blocks.rows, self.killing.blocks.columns, self.size)

    def nonzeros(self, positions):
        return self.killing.nonzeros(to_complex(positions)) + (self.pattern.rows == self.pattern.columns)

    def matrix(self, positions):
        rows, columns = self.pattern.rows, self.pattern.columns
        lower = coo_array((self.nonzeros(positions), (rows, columns)), shape=(self.size, self.size)).toarray()
        return lower + lower.T - np.diag(lower.diagonal())


def bent(mesh, angle):
    """The mesh bent to an arc, (n, 2), and the rotation of each vertex, (n,) complex."""
    x, y = mesh.vertices.T
    share = (x - x.min()) / np.ptp(x)
    radius = np.ptp(x) / angle - (y - y.mean())
    turn = angle * share
    return np.stack([radius * np.sin(turn), -radius * np.cos(turn)], axis=1), np.exp(1j * turn)


@pytest.fixture(scope="module")
def system():
    return System(shapes.SHAPES["bar"])


def right_side(system, seed):
    generator = np.random.default_rng(seed)
    return to_complex(generator.normal(size=(system.size // 2, 2)))


def solved(system, positions, right):
    """By a dense matrix."""
    return to_complex(np.linalg.solve(system.matrix(positions), to_points(right).ravel()).reshape(-1, 2))


def prepared(system, exact=False):
    """A solver with the factorization of the rest pose."""
    solver = PreconditionedCholesky(system.pattern, exact, system.groups)
    ones = np.ones(system.size // 2, dtype=complex)
    solver.prepare(system.nonzeros(system.mesh.vertices), ones)
    return solver


@pytest.mark.parametrize("like", ["", "a name"])
@pytest.mark.parametrize("tolerance", [1e-3, TOLERANCE])
def test_solutions_at_later_poses_are_as_near_as_asked_for(system, like, tolerance):
    solver = prepared(system)
    for seed, angle in enumerate([0.05, 0.1, 0.2, 0.4, 0.8]):
        positions, frame = bent(system.mesh, angle)
        solver.prepare(system.nonzeros(positions), frame)
        right = right_side(system, seed)
        off = solver.solve(right, tolerance, like) - solved(system, positions, right)
        assert np.abs(off).max() < tolerance
    assert solver.iterations > 5


def test_a_turned_drawing_costs_no_more_iterations_than_one_at_rest(system):
    counts = []
    for turn in (1.0, np.exp(1.3j)):
        solver = prepared(system)
        positions = to_points(turn * to_complex(system.mesh.vertices))
        solver.prepare(system.nonzeros(positions), np.full(system.size // 2, turn, dtype=complex))
        solver.solve(turn * right_side(system, 1), TOLERANCE)
        assert solver.factorizations == 1
        counts.append(solver.iterations)
    assert counts[1] == counts[0] <= 5  # in half precision, an iteration gains three digits


def test_solutions_like_earlier_ones_cost_fewer_iterations(system, monkeypatch):
    """A force that rotates with the drawing and changes its size; only the first pose is factorized."""
    monkeypatch.setattr(preconditioned_cholesky, "MAX_WASTED_ITERATIONS_OF_SMALL", 1000)
    counts = []
    for key in ("", "force"):
        solver = prepared(system)
        for angle in np.linspace(0.1, 0.3, 11):
            positions, frame = bent(system.mesh, angle)
            solver.prepare(system.nonzeros(positions), frame)
            right = (1 + angle) * frame * right_side(system, 3)
            found = solver.solve(right, TOLERANCE, key)
            assert np.abs(found - solved(system, positions, right)).max() < TOLERANCE
        counts.append(solver.iterations)
    assert counts[1] < 0.7 * counts[0]


def test_a_pose_too_far_away_is_factorized(system):
    solver = prepared(system)
    positions = system.mesh.vertices * [1.0, 0.01]
    solver.prepare(system.nonzeros(positions), np.ones(system.size // 2, dtype=complex))
    right = right_side(system, 2)
    found = solver.solve(right, TOLERANCE)
    assert solver.factorizations == 2
    assert np.abs(found - solved(system, positions, right)).max() < 1e-8


def test_many_iterations_call_for_a_factorization(system):
    """Once for several poses; with the new factors, few iterations are needed."""
    solver = prepared(system)
    positions, frame = system.mesh.vertices * [1.3, 0.8], np.ones(system.size // 2, dtype=complex)
    counts, factorizations = [], []
    for seed in range(40):
        before = solver.iterations
        solver.prepare(system.nonzeros(positions), frame)
        right = right_side(system, seed)
        assert np.abs(solver.solve(right, TOLERANCE) - solved(system, positions, right)).max() < TOLERANCE
        counts.append(solver.iterations - before)
        factorizations.append(solver.factorizations)
    assert factorizations[1] == 1
    assert factorizations[-1] == 2
    assert counts[0] > 5
    assert max(counts[-10:]) <= 3


def test_what_is_forgotten_is_factorized_again(system):
    solver = prepared(system)
    solver.invalidate()
    solver.prepare(system.nonzeros(system.mesh.vertices), np.ones(system.size // 2, dtype=complex))
    assert solver.factorizations == 2


def test_exact_factorizes_every_matrix(system):
    solver = prepared(system, exact=True)
    for angle in (0.1, 0.2, 0.3):
        positions, frame = bent(system.mesh, angle)
        solver.prepare(system.nonzeros(positions), frame)
        right = right_side(system, 4)
        found, expected = solver.solve(right, 0.0), solved(system, positions, right)
        assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()
    assert solver.factorizations == 4


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_a_bend_is_the_same_with_few_factorizations_as_with_many(memory):
    """Each step within a hundredth of a pixel of the exact one on a drawing of a million square pixels."""
    mesh = shapes.SHAPES["bar"]
    points = shapes.random_pins(mesh, 4, 3)
    start = mesh.evaluate(points, mesh.vertices)
    exact, reusing = (AkapDeformer(mesh, memory=memory, exact=on) for on in (True, False))
    exact.set_pins(points)
    reusing.set_pins(points)
    visible = 0.01 * mesh.length / 1000
    goal = start.copy()
    pose = other = mesh.vertices
    for share in np.linspace(0, 1, 31)[1:]:
        goal[-1] = start[-1] + share * np.array([-0.2, 0.3]) * np.ptp(mesh.vertices, axis=0).max()
        found = reusing.step(pose, goal).positions
        assert np.abs(found - exact.step(pose, goal).positions).max() < visible
        pose, other = found, exact.step(other, goal).positions
    for _ in range(40):
        pose, other = reusing.step(pose, goal).positions, exact.step(other, goal).positions
    ours, theirs = distortion(mesh, pose), distortion(mesh, other)
    assert ours.area == pytest.approx(theirs.area, abs=5e-5)
    assert ours.angle == pytest.approx(theirs.angle, abs=5e-5)


@pytest.fixture
def factors_beside(monkeypatch):
    """New factors are made in a thread, also for a small mesh."""
    monkeypatch.setattr(preconditioned_cholesky, "MIN_THREAD_VERTICES", 0)


def drag_of_bar(memory=1.0, stiffness=None, exact=False):
    """The poses of a drag that is long enough for several factorizations."""
    mesh = shapes.SHAPES["bar"]
    deformer = AkapDeformer(mesh, memory=memory, stiffness=stiffness, exact=exact)
    points = shapes.random_pins(mesh, 4, 3)
    deformer.set_pins(points)
    goal, pose, poses = mesh.evaluate(points, mesh.vertices), mesh.vertices, []
    for _ in range(40):
        goal[-1] += [-1.0, 1.5]
        pose = deformer.step(pose, goal).positions
        poses.append(pose)
    return poses


@pytest.mark.usefixtures("factors_beside")
def test_solutions_are_as_near_as_asked_for_while_factors_are_made_beside(system):
    solver = prepared(system)
    for seed, angle in enumerate([0.05, 0.1, 0.2, 0.4, 0.8]):
        positions, frame = bent(system.mesh, angle)
        solver.prepare(system.nonzeros(positions), frame)
        right = right_side(system, seed)
        found = solver.solve(right, 1e-9, "a name")
        assert np.abs(found - solved(system, positions, right)).max() < 1e-9


@pytest.mark.usefixtures("factors_beside")
def test_with_memory_iterations_end_within_the_tolerance_at_once(system):
    solver = PreconditionedCholesky(system.pattern, False, system.groups, confirm=False)
    positions, frame = bent(system.mesh, 0.4)
    solver.prepare(system.nonzeros(positions), frame)
    right = right_side(system, 7)
    found = solver.solve(right, TOLERANCE)
    assert np.abs(found - solved(system, positions, right)).max() < TOLERANCE
    assert solver.iterations < 5


def test_factors_of_the_very_matrix_give_double_precision(system):
    right = right_side(system, 7)
    found, expected = prepared(system).solve(right, 1e-3), solved(system, system.mesh.vertices, right)
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("largest", [1.0, 1e12])  # the second is too much for half precision
def test_another_matrix_is_solved_to_double_precision(system, largest):
    solver, right = prepared(system), right_side(system, 7)
    positions, _ = bent(system.mesh, 0.8)
    nonzeros = system.nonzeros(positions) * largest
    before = solver.solve(right, TOLERANCE)
    found = solver.solve_once(nonzeros, right, is_definite=True)
    expected = solved(system, positions, right) / largest
    assert np.abs(found - expected).max() < 1e-12 * np.abs(expected).max()
    after = solver.solve(right, TOLERANCE, "a name")
    if largest == 1.0:
        assert (after == before).all(), "the prepared matrix stays"
    assert np.abs(after - before).max() < TOLERANCE * np.abs(before).max()


@pytest.mark.parametrize("is_definite", [False, True])
def test_a_matrix_that_is_not_positive_definite_is_refused(system, is_definite):
    solver = prepared(system)
    with pytest.raises(SolverError):
        solver.solve_once(-system.nonzeros(system.mesh.vertices), right_side(system, 1), is_definite)


@pytest.mark.usefixtures("factors_beside")
@pytest.mark.parametrize("slow_calls", [range(0), range(2, 100), range(2, 100, 3)])
@pytest.mark.parametrize("long_delay", [False, True])
def test_poses_do_not_depend_on_how_fast_factors_are_made_beside(monkeypatch, slow_calls, long_delay):
    if long_delay:
        monkeypatch.setattr(preconditioned_cholesky, "MIN_LARGE_VERTICES", 0)
    expected = drag_of_bar()
    factorize, calls = CholeskyFactors.factorize, []

    def slow(factors, nonzeros):
        calls.append(1)
        if len(calls) in slow_calls:
            time.sleep(0.02)
        factorize(factors, nonzeros)

    monkeypatch.setattr(CholeskyFactors, "factorize", slow)
    assert all((a == b).all() for a, b in zip(drag_of_bar(), expected, strict=True))
    assert len(calls) > 4


@pytest.mark.usefixtures("factors_beside")
@pytest.mark.parametrize(
    "announced", ["the pose", "another pose", "other pins", "none that can be factorized"]
)
def test_factors_made_ahead_change_no_bit(monkeypatch, announced):
    """A step with the factors of the pose announced does not factorize; each other one does, as ever."""
    mesh = shapes.SHAPES["bar"]
    points, others = shapes.random_pins(mesh, 4, 3), shapes.random_pins(mesh, 5, 3)
    goal = mesh.evaluate(points, mesh.vertices)
    goal[-1] += [-1.0, 1.5]
    later_goal = goal + np.array([1.0, 0.5])
    usual, prepared = AkapDeformer(mesh, memory=1.0), AkapDeformer(mesh, memory=1.0)
    usual.set_pins(points)
    expected = [usual.step(mesh.vertices, goal).positions]
    expected.append(usual.step(expected[0], later_goal).positions)

    prepared.set_pins(others if announced == "other pins" else points)
    if announced == "none that can be factorized":
        prepared.prepare(np.zeros_like(mesh.vertices))
    else:
        prepared.prepare(mesh.vertices * (1.1 if announced == "another pose" else 1.0))
    for thread in threading.enumerate():
        if thread.name == "factorization":
            thread.join()
    prepared.set_pins(points)
    callers, factorize = [], CholeskyFactors.factorize
    monkeypatch.setattr(
        CholeskyFactors,
        "factorize",
        lambda *arguments: (callers.append(threading.current_thread()), factorize(*arguments))[1],
    )
    assert (prepared.step(mesh.vertices, goal).positions == expected[0]).all()
    assert (threading.main_thread() in callers) == (announced != "the pose")
    assert (prepared.step(expected[0], later_goal).positions == expected[1]).all()


@pytest.mark.usefixtures("factors_beside")
@pytest.mark.parametrize(("min_vertices", "delay"), [(10**6, 1), (0, 2)])
def test_factors_are_taken_over_later_in_a_large_mesh(monkeypatch, system, min_vertices, delay):
    monkeypatch.setattr(preconditioned_cholesky, "MIN_LARGE_VERTICES", min_vertices)
    solver, start, begun, taken_over = prepared(system), threading.Thread.start, [], []
    monkeypatch.setattr(threading.Thread, "start", lambda thread: (begun.append(pose), start(thread)))
    ones = np.ones(system.size // 2, dtype=complex)
    for pose in range(20):
        before = solver.factorizations
        solver.prepare(system.nonzeros(system.mesh.vertices * [1.0 + 0.05 * pose, 1.0]), ones)
        taken_over += [pose] * (solver.factorizations - before)
        solver.solve(right_side(system, pose), TOLERANCE)
    assert len(taken_over) > 1
    assert (np.subtract(taken_over, begun[: len(taken_over)]) == delay).all()


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_stiffness_beyond_half_precision_is_solved_in_double(memory):
    """A stiff half and a soft rest, a factor of 10⁹ apart."""
    mesh = shapes.SHAPES["bar"]
    is_left = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] < mesh.vertices[:, 0].mean()
    stiffness = np.where(is_left, 1e6, 1e-3)
    ours, exact = (drag_of_bar(memory, stiffness, on)[:5] for on in (False, True))
    visible = 0.01 * mesh.length / 1000
    assert np.abs(ours[0] - exact[0]).max() < visible
    assert all(np.isfinite(pose).all() for pose in ours)


@pytest.mark.usefixtures("factors_beside")
def test_pins_that_change_during_a_factorization_beside_do_no_harm(system):
    """`invalidate` discards factors that are being made for the matrix with the old pins."""
    solver = prepared(system)
    stretched, frame = system.mesh.vertices * [1.3, 0.8], np.ones(system.size // 2, dtype=complex)
    for seed in range(30):
        solver.prepare(system.nonzeros(stretched), frame)
        right = right_side(system, seed)
        found = solver.solve(right, TOLERANCE)
        assert np.abs(found - solved(system, stretched, right)).max() < TOLERANCE
        if seed % 3 == 2:
            solver.invalidate()
