"""Trajectories of fields whose flows are known."""

import numpy as np
import pytest

from akap_editor.deform.akap.log_spiral import LogSpirals, linear_flow, spiral_factor
from akap_editor.geometry.operators import to_complex, to_points
from tests.support import dense

CENTER = 70.0 + 40.0j


def reference_factor(s):
    """(eˢ − 1) / s in extended precision, by its series, halved until small: e²ˢ − 1 = (eˢ − 1)(eˢ + 1)."""
    s = np.clongdouble(s)
    halvings = 0
    while abs(s) > 0.25:
        s, halvings = s / 2, halvings + 1
    term = total = np.clongdouble(1)
    for k in range(2, 30):
        term = term * s / k
        total += term
    for _ in range(halvings):
        total, s = total * (total * s + 2) / 2, 2 * s
    return complex(total)


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e-12, 9.99e-7, 1.01e-6, 1e-4, 0.03, 0.5, 1.0, 3.0])
def test_spiral_factor(size):
    s = size * np.exp(1j * np.linspace(0, 2 * np.pi, 17))
    expected = np.array([reference_factor(value) for value in s])
    assert np.abs(spiral_factor(s) - expected).max() <= 2e-15 * np.abs(expected).max()


def test_spiral_factor_is_one_at_zero():
    assert spiral_factor(np.zeros(3, dtype=complex)).tolist() == [1, 1, 1]


@pytest.mark.parametrize("t", [0.0, 0.25, 1.0])
@pytest.mark.parametrize("angle", [1e-9, 0.1, -1.0, 3.0])
def test_rotation_fields_become_rotations(mesh, angle, t):
    p = to_complex(mesh.vertices)
    moved = LogSpirals(mesh).flow(p, 1j * angle * (p - CENTER), t)
    assert np.abs(moved - (CENTER + np.exp(1j * angle * t) * (p - CENTER))).max() < 1e-12 * 500


@pytest.mark.parametrize("t", [0.0, 0.3, 1.0])
def test_translation_fields_become_translations(mesh, t):
    p = to_complex(mesh.vertices)
    moved = LogSpirals(mesh).flow(p, np.full_like(p, 30 - 7j), t)
    assert np.abs(moved - (p + t * (30 - 7j))).max() < 1e-12 * 500


@pytest.mark.parametrize("s", [0.3, -0.2 + 0.4j])
def test_linear_holomorphic_fields_become_similarities(mesh, s):
    p = to_complex(mesh.vertices)
    moved = LogSpirals(mesh).flow(p, s * (p - CENTER))
    assert np.abs(moved - (CENTER + np.exp(s) * (p - CENTER))).max() < 1e-12 * 500


@pytest.mark.parametrize("t", [0.5, 1.0])
def test_flow_is_the_mean_of_the_spirals_with_centers(mesh, t):
    rng = np.random.default_rng(1)
    field = rng.normal(scale=3.0, size=mesh.vertices.shape)
    moved = to_points(LogSpirals(mesh).flow(to_complex(mesh.vertices), to_complex(field), t))
    assert np.abs(moved - dense.spiral_flow(mesh, mesh.vertices, field, t)).max() < 1e-10


def test_flow_starts_with_the_field(mesh):
    rng = np.random.default_rng(2)
    p, u = to_complex(mesh.vertices), to_complex(rng.normal(size=mesh.vertices.shape))
    moved = LogSpirals(mesh).flow(p, u, 1e-6)
    assert np.abs((moved - p) / 1e-6 - u).max() < 1e-5


@pytest.mark.parametrize("angle", [0.01, 0.3, 2.0])
def test_linear_steps_make_a_turning_shape_grow(mesh, angle):
    p = to_complex(mesh.vertices)
    moved = linear_flow(p, 1j * angle * (p - CENTER))
    i, j = mesh.edges.T
    growth = np.abs(moved[i] - moved[j]) / np.abs(p[i] - p[j])
    assert np.abs(growth - np.sqrt(1 + angle**2)).max() < 1e-12
