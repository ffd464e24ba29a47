"""The symmetric Dirichlet energy, its derivatives, and the line search."""

import numpy as np
import pytest
from scipy.sparse import coo_array

from akap_editor.deform.akap.rest_energy import MAX_LOCAL_CHANGE, SymmetricDirichlet, line_search
from akap_editor.geometry.killing_matrix import KillingMatrix, VertexBlocks
from akap_editor.geometry.mesh import signed_areas
from akap_editor.geometry.operators import to_complex, to_points
from tests.support.shapes import SHAPES


class Energy:
    """The energy by positions of the vertices instead of columns of J."""

    def __init__(self, mesh):
        self.of = SymmetricDirichlet(mesh)

    def value(self, pose):
        return self.of.evaluate(pose)[0]

    def gradient(self, pose):
        return self.of.evaluate(pose)[1]

    def columns(self, pose):
        return self.of.evaluate(pose)[2]


def noisy(mesh, seed, size=0.03):
    """A pose near the rest pose, without flips: vertices moved by a share of the shortest edge."""
    i, j = mesh.edges.T
    shortest = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1).min()
    noise = np.random.default_rng(seed).uniform(-1, 1, mesh.vertices.shape)
    return to_complex(mesh.vertices + size * shortest * noise)


@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_value_is_four_areas_at_rest_and_under_rigid_motion(mesh, turn):
    energy = Energy(mesh)
    pose = np.exp(1j * turn) * to_complex(mesh.vertices) + 30 - 5j
    assert energy.value(pose) == pytest.approx(4 * mesh.rest_areas.sum(), rel=1e-12)


@pytest.mark.parametrize(("a", "b"), [(2.0, 2.0), (0.5, 3.0)])
def test_value_of_stretches(mesh, a, b):
    pose = to_complex(mesh.vertices * [a, b])
    density = a**2 + b**2 + a**-2 + b**-2
    assert Energy(mesh).value(pose) == pytest.approx(density * mesh.rest_areas.sum(), rel=1e-12)


def test_rest_is_the_minimum(mesh):
    energy = Energy(mesh)
    assert np.abs(energy.gradient(to_complex(mesh.vertices))).max() < 1e-9
    for seed in range(5):
        assert energy.value(noisy(mesh, seed)) > 4 * mesh.rest_areas.sum()


def test_flipped_or_collapsed_faces_are_infinitely_bad(mesh):
    energy = Energy(mesh)
    assert energy.value(to_complex(mesh.vertices * [-1, 1])) == np.inf
    assert energy.value(to_complex(mesh.vertices * [0, 1])) == np.inf


def test_gradient_is_that_of_finite_differences(mesh):
    energy = Energy(mesh)
    pose = noisy(mesh, 1) * (1.2 - 0.4j)
    gradient = energy.gradient(pose)
    rng = np.random.default_rng(2)
    for _ in range(3):
        direction = to_complex(rng.normal(size=mesh.vertices.shape))
        step = 1e-5
        slope = (energy.value(pose + step * direction) - energy.value(pose - step * direction)) / (2 * step)
        assert slope == pytest.approx((gradient.conj() * direction).real.sum(), rel=1e-5, abs=1e-4)


def hessian(mesh, pose, convex=False):
    """Twice what `half_hessian` gives, as a matrix (2n, 2n)."""
    energy, blocks, size = Energy(mesh), VertexBlocks(mesh), 2 * len(mesh.vertices)
    nonzeros = 2 * energy.of.half_hessian(energy.columns(pose), convex, blocks)
    lower = coo_array((nonzeros, (blocks.rows, blocks.columns)), shape=(size, size)).toarray()
    return lower + np.tril(lower, -1).T


# In faces that are larger than at rest the energy is convex anyway.
@pytest.mark.parametrize(("size", "convex"), [(1.4, True), (1.4, False), (0.7, False)])
def test_hessian_is_that_of_finite_differences(mesh, size, convex):
    energy, pose = Energy(mesh), size * np.exp(0.5j) * noisy(mesh, 1)
    matrix = hessian(mesh, pose, convex)
    rng = np.random.default_rng(3)
    for _ in range(3):
        change = to_complex(rng.normal(size=mesh.vertices.shape))
        step = 1e-5
        ahead, behind = (energy.gradient(pose + s * change) for s in (step, -step))
        product = to_complex((matrix @ to_points(change).ravel()).reshape(-1, 2))
        assert np.abs(product - (ahead - behind) / (2 * step)).max() < 1e-5 * np.abs(product).max()


def test_convex_hessian_is_nowhere_negative(mesh):
    squeezed = to_complex(to_points(noisy(mesh, 2)) * [0.3, 0.6])
    for pose in (squeezed, 1j * squeezed, to_complex(mesh.vertices)):
        spectrum = np.linalg.eigvalsh(hessian(mesh, pose, convex=True))
        assert spectrum[0] > -1e-9 * spectrum[-1]
    assert np.linalg.eigvalsh(hessian(mesh, squeezed))[0] < 0


def test_hessian_at_rest_is_twice_the_killing_matrix(mesh):
    for turn in (1.0, np.exp(2j)):
        pose = turn * to_complex(mesh.vertices)
        killing = KillingMatrix(mesh)
        lower = np.tril(hessian(mesh, pose))[killing.blocks.rows, killing.blocks.columns]
        nonzeros = killing.nonzeros(pose)
        assert np.abs(lower - 2 * nonzeros).max() < 1e-9 * np.abs(nonzeros).max()


@pytest.mark.parametrize("seed", range(3))
def test_step_to_first_flip_ends_where_a_face_flips(mesh, seed):
    energy, pose = Energy(mesh), noisy(mesh, seed, 0.1)
    change = to_complex(np.random.default_rng(seed).normal(size=mesh.vertices.shape))
    _, step = energy.of.direction(energy.columns(pose), change)
    if step == np.inf:  # a single face may grow forever
        assert signed_areas(to_points(pose + 1e6 * change), mesh.faces).min() > 0
        return
    areas = [signed_areas(to_points(pose + t * step * change), mesh.faces) for t in (0.2, 0.6, 0.999, 1.001)]
    assert [bool((area > 0).all()) for area in areas] == [True, True, True, False]


def test_change_that_flips_nothing_may_be_as_long_as_it_likes(mesh):
    energy, rest = Energy(mesh), to_complex(mesh.vertices)
    for change in (rest, 0 * rest, np.full_like(rest, 3 - 1j)):
        assert energy.of.direction(energy.columns(rest), change)[1] > 1e12


@pytest.mark.parametrize("seed", range(3))
def test_value_along_a_direction_is_that_of_the_pose_there(mesh, seed):
    energy, pose = Energy(mesh), noisy(mesh, seed)
    direction = to_complex(np.random.default_rng(seed).normal(size=mesh.vertices.shape))
    columns = energy.columns(pose)
    change, first_flip = energy.of.direction(columns, direction)
    for t in (0.0, 0.3 * min(first_flip, 1.0)):
        expected = energy.value(pose + t * direction)
        assert energy.of.value(columns, change, t) == pytest.approx(expected, rel=1e-9)
    if first_flip < np.inf:
        assert energy.of.value(columns, change, 1.001 * first_flip) == np.inf


def parabola(start, least):
    """A parabola of the step length, with its minimum at ``start`` minus ``least``, and its slope at 0."""
    return lambda step: (start - step - least) ** 2, -2 * (start - least)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("length", [1.0, 0.3])
def test_line_search_never_increases_the_energy(mesh, seed, length):
    energy = Energy(mesh)
    pose = noisy(mesh, seed, 0.1)
    before, gradient = energy.value(pose), energy.gradient(pose)
    rng = np.random.default_rng(seed)
    random = to_complex(rng.normal(size=mesh.vertices.shape))
    for direction in (-gradient, -1e-9 * gradient, -1e9 * gradient, random, gradient, 0 * gradient):
        slope = float(np.vdot(gradient, direction).real)
        step = line_search(lambda t, along=direction: energy.value(pose + t * along), before, slope, length)
        assert 0 <= step <= length
        assert energy.value(pose + step * direction) <= before
    direction = -1e-3 * gradient
    slope = float(np.vdot(gradient, direction).real)
    step = line_search(lambda t: energy.value(pose + t * direction), before, slope, length)
    assert step > 0
    assert energy.value(pose + step * direction) < before


@pytest.mark.parametrize("length", [2.5, 3.5, 15.0, 1e6])
def test_line_search_finds_the_minimum_of_a_parabola(length):
    value, slope = parabola(3.0, 0.5)
    assert line_search(value, value(0.0), slope, length) == pytest.approx(2.5, rel=1e-9)


def test_line_search_down_a_cliff_returns_the_best_try():
    """Next to a face that is nearly flipped, every parabola asks for half of the step."""
    step = line_search(lambda t: 1e7 / (1e-4 + t) ** 2 + t, 1e15, -2e19, 1.0)
    assert step > 0.2


def test_line_search_stays_within_its_limit():
    value, slope = parabola(3.0, 0.5)
    assert line_search(value, value(0.0), slope, 1.25) == 1.25


def test_ascent_direction_gives_no_step():
    assert line_search(lambda step: (3 + step) ** 2, 9.0, 6.0, 1.0) == 0.0
    assert line_search(lambda _: 9.0, 9.0, 0.0, 1.0) == 0.0


def test_result_has_one_point_for_each_vertex(mesh):
    assert to_points(Energy(mesh).gradient(to_complex(mesh.vertices))).shape == mesh.vertices.shape


# -- relaxation of single faces ------------------------------------------------------------------------------


SQUARE = SHAPES["square"]


@pytest.fixture
def leap():
    """A step in which one inner vertex of a square moves so far that faces beside it nearly collapse.

    Returns the energy, the pose after the step, the columns of the step, and the vertex.
    """
    n = len(SQUARE.vertices)
    vertex = int(np.setdiff1d(np.arange(n), SQUARE.boundary_vertices)[0])
    rest, direction = to_complex(SQUARE.vertices), np.zeros(n, dtype=np.complex128)
    neighbors = SQUARE.edges[(SQUARE.edges == vertex).any(axis=1)].ravel()
    away = rest[neighbors] - rest[vertex]
    direction[vertex] = 0.6 * away[np.argmax(away.real)]
    energy = SymmetricDirichlet(SQUARE)
    columns = energy.evaluate(rest)[2]
    change, first_flip = energy.direction(columns, direction)
    assert first_flip > 1
    return energy, rest + direction, change, vertex


def test_a_vertex_that_has_leapt_comes_to_the_least_energy_around_it(leap):
    energy, pose, change, vertex = leap
    relaxed, nothing = pose.copy(), np.zeros(len(pose), dtype=bool)
    energy.relax(relaxed, change, 1.0, nothing)
    before, after = energy.evaluate(pose), energy.evaluate(relaxed)
    assert after[0] < before[0]
    assert abs(after[1][vertex]) < 0.01 * abs(before[1][vertex])


def test_relaxation_spares_held_vertices_and_small_changes(leap):
    energy, pose, change, vertex = leap
    relaxed, nothing = pose.copy(), np.zeros(len(pose), dtype=bool)
    is_held = nothing.copy()
    is_held[vertex] = True
    energy.relax(relaxed, change, 1.0, is_held)
    assert relaxed[vertex] == pose[vertex]
    relaxed = pose.copy()
    energy.relax(relaxed, change, 1e-3, nothing)
    np.testing.assert_array_equal(relaxed, pose)


def test_relaxation_sets_in_gradually(leap):
    """Two steps that differ little lead to poses that differ little."""
    energy, pose, change, _ = leap
    limit = MAX_LOCAL_CHANGE / np.sqrt((np.abs(change) ** 2).sum(axis=1)).max()
    moves = []
    for factor in (0.99, 1.01, 1.5, 3.0):
        relaxed = pose.copy()
        energy.relax(relaxed, change, factor * limit, np.zeros(len(pose), dtype=bool))
        moves.append(np.abs(relaxed - pose).max())
    assert moves[0] == 0
    assert 0 < moves[1] < 0.02 * moves[3]
    assert moves[1] < moves[2] < moves[3]


def test_relaxation_turns_with_the_pose(leap):
    energy, pose, change, _ = leap
    motion, nothing = np.exp(0.7j), np.zeros(len(pose), dtype=bool)
    relaxed, turned = pose.copy(), motion * pose + (3 - 40j)
    energy.relax(relaxed, change, 1.0, nothing)
    energy.relax(turned, motion * change, 1.0, nothing)
    np.testing.assert_allclose(turned, motion * relaxed + (3 - 40j), atol=1e-9 * np.abs(pose).max())
