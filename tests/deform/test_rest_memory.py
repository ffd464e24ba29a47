"""The energy that remembers the rest shape, and the descent on it."""

import numpy as np
import pytest

from akap_editor.deform.rest_memory import SymmetricDirichlet, descend, newton_direction
from akap_editor.geometry.operators import to_complex, to_points


def noisy(mesh, seed, size=0.03):
    """A pose near the rest pose, without flips: vertices moved by a share of the shortest edge."""
    i, j = mesh.edges.T
    shortest = np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1).min()
    noise = np.random.default_rng(seed).uniform(-1, 1, mesh.vertices.shape)
    return to_complex(mesh.vertices + size * shortest * noise)


@pytest.mark.parametrize("turn", [0.0, 2.0])
def test_value_is_four_areas_at_rest_and_under_rigid_motion(mesh, turn):
    energy = SymmetricDirichlet(mesh)
    pose = np.exp(1j * turn) * to_complex(mesh.vertices) + 30 - 5j
    assert energy.value(pose) == pytest.approx(4 * mesh.rest_areas.sum(), rel=1e-12)


@pytest.mark.parametrize(("a", "b"), [(2.0, 2.0), (0.5, 3.0)])
def test_value_of_stretches(mesh, a, b):
    pose = to_complex(mesh.vertices * [a, b])
    density = a**2 + b**2 + a**-2 + b**-2
    assert SymmetricDirichlet(mesh).value(pose) == pytest.approx(density * mesh.rest_areas.sum(), rel=1e-12)


def test_rest_is_the_minimum(mesh):
    energy = SymmetricDirichlet(mesh)
    assert np.abs(energy.gradient(to_complex(mesh.vertices))).max() < 1e-9
    for seed in range(5):
        assert energy.value(noisy(mesh, seed)) > 4 * mesh.rest_areas.sum()


def test_flipped_or_collapsed_faces_are_infinitely_bad(mesh):
    energy = SymmetricDirichlet(mesh)
    assert energy.value(to_complex(mesh.vertices * [-1, 1])) == np.inf
    assert energy.value(to_complex(mesh.vertices * [0, 1])) == np.inf


def test_gradient_is_that_of_finite_differences(mesh):
    energy = SymmetricDirichlet(mesh)
    pose = noisy(mesh, 1) * (1.2 - 0.4j)
    gradient = energy.gradient(pose)
    rng = np.random.default_rng(2)
    for _ in range(3):
        direction = to_complex(rng.normal(size=mesh.vertices.shape))
        step = 1e-5
        slope = (energy.value(pose + step * direction) - energy.value(pose - step * direction)) / (2 * step)
        assert slope == pytest.approx((gradient.conj() * direction).real.sum(), rel=1e-5, abs=1e-4)


def test_curvature_is_that_of_finite_differences(mesh):
    energy = SymmetricDirichlet(mesh)
    pose = noisy(mesh, 1) * (1.2 - 0.4j)
    curvature = energy.curvature(pose)
    rng = np.random.default_rng(3)
    for _ in range(3):
        change = to_complex(rng.normal(size=mesh.vertices.shape))
        step = 1e-5
        difference = energy.gradient(pose + step * change) - energy.gradient(pose - step * change)
        product = curvature(change)
        assert np.abs(product - difference / (2 * step)).max() < 1e-5 * np.abs(product).max()


def real_product(matrix):
    """The product with a real symmetric matrix, of complex numbers with interleaved x and y."""
    return lambda values: to_complex((matrix @ to_points(values).ravel()).reshape(-1, 2))


def test_newton_direction_solves_where_the_energy_is_convex():
    rng = np.random.default_rng(4)
    root = rng.normal(size=(12, 12))
    matrix, gradient = root @ root.T + np.eye(12), rng.normal(size=6) + 1j * rng.normal(size=6)
    expected = -real_product(np.linalg.inv(matrix))(gradient)
    off = newton_direction(gradient, real_product(matrix), real_product(np.eye(12))) - expected
    assert np.abs(off).max() < 1e-2 * np.abs(expected).max()
    exactly = newton_direction(gradient, real_product(matrix), real_product(np.linalg.inv(matrix)))
    assert np.abs(exactly - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("lowest", [-3.0, 0.0])
def test_newton_direction_descends_where_the_energy_is_not_convex(lowest):
    rng = np.random.default_rng(5)
    axes, _ = np.linalg.qr(rng.normal(size=(12, 12)))
    matrix = axes @ np.diag([lowest, lowest, *range(1, 11)]) @ axes.T
    for gradient in to_complex(rng.normal(size=(60, 2))).reshape(10, 6):
        direction = newton_direction(gradient, real_product(matrix), real_product(np.eye(12)))
        assert np.vdot(gradient, direction).real < 0


def test_newton_direction_at_a_minimum_is_none():
    assert not newton_direction(np.zeros(3, dtype=complex), lambda x: x, lambda x: x).any()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("length", [1.0, 0.3])
def test_descent_never_raises_the_energy(mesh, seed, length):
    energy = SymmetricDirichlet(mesh)
    pose = noisy(mesh, seed, 0.1)
    before, gradient = energy.value(pose), energy.gradient(pose)
    rng = np.random.default_rng(seed)
    random = to_complex(rng.normal(size=mesh.vertices.shape))
    for direction in (-gradient, -1e-9 * gradient, -1e9 * gradient, random, gradient, 0 * gradient):
        after = energy.value(descend(pose, energy.value, gradient, direction, length))
        assert after <= before
    assert energy.value(descend(pose, energy.value, gradient, -1e-3 * gradient, length)) < before


def test_descent_goes_to_the_minimum_of_a_parabola():
    start, least = np.array([3.0 + 1.0j]), 1.0 - 2.0j

    def value(p):
        return float(np.abs(p[0] - least) ** 2)

    gradient = 2 * (start - least)
    for far in (0.5, 0.7, 3.0):  # shares of the gradient; 0.5 is Newton's step
        reached = descend(start, value, gradient, -far * gradient, 1.0)
        assert reached[0] == pytest.approx(least, abs=1e-12)


def test_direction_upwards_moves_nothing():
    start = np.array([3.0 + 1.0j])
    assert descend(start, lambda p: float(np.abs(p[0]) ** 2), 2 * start, start, 1.0) is start


def test_result_has_one_point_for_each_vertex(mesh):
    energy = SymmetricDirichlet(mesh)
    assert to_points(energy.gradient(to_complex(mesh.vertices))).shape == mesh.vertices.shape
