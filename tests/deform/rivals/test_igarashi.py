"""As-rigid-as-possible deformation in two solves, compared with the paper's formulas in dense matrices."""

import numpy as np
import pytest

from akap_editor.deform.rivals.arap import ArapDeformer
from akap_editor.deform.rivals.igarashi import IgarashiDeformer
from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import MeshPoints
from tests.support import shapes


def moved(mesh, points, targets, **settings):
    deformer = IgarashiDeformer(mesh, **settings)
    deformer.set_pins(points)
    return deformer.step(mesh.vertices, targets).positions


def some_targets(mesh, points, scale=8.0, seed=1):
    rng = np.random.default_rng(seed)
    return mesh.evaluate(points, mesh.vertices) + rng.normal(scale=scale, size=(len(points), 2))


def quarter_turn(v):
    return np.array([-v[1], v[0]])


def frame_rows(mesh, corners, n):
    """(2, 2n): what v_k − v_i − x (v_j − v_i) − y R90 (v_j − v_i) is, with x and y those of the rest pose."""
    i, j, k = corners
    arm, span = mesh.vertices[k] - mesh.vertices[i], mesh.vertices[j] - mesh.vertices[i]
    x, y = arm @ span / (span @ span), arm @ quarter_turn(span) / (span @ span)
    turn = np.array([[x, -y], [y, x]])
    rows = np.zeros((2, n, 2))
    rows[:, k] += np.eye(2)
    rows[:, i] -= np.eye(2) - turn
    rows[:, j] -= turn
    return rows.reshape(2, -1)


def pin_rows(mesh, points):
    rows = np.zeros((len(points), len(mesh.vertices)))
    for row, face, weights in zip(rows, points.faces, points.weights, strict=True):
        row[mesh.faces[face]] = weights
    return rows


def dense_pose(mesh, points, targets, pull):
    """The paper's two steps, face by face, as plain least squares."""
    n, pins = len(mesh.vertices), pin_rows(mesh, points)
    rows = [frame_rows(mesh, np.roll(face, turn), n) for face in mesh.faces for turn in range(3)]
    system = np.vstack([*rows, pull * np.kron(pins, np.eye(2))])
    right = np.concatenate([np.zeros(len(system) - targets.size), pull * targets.ravel()])
    similar = np.linalg.lstsq(system, right, rcond=None)[0].reshape(n, 2)
    rows, right = [], []
    for face in mesh.faces:
        rest, now = (p[face] - p[face].mean(axis=0) for p in (mesh.vertices, similar))
        left, _, other = np.linalg.svd(rest.T @ now)  # congruent and of the same orientation (Kabsch)
        turn = left @ np.diag([1, np.linalg.det(left @ other)]) @ other
        for i, j in zip(face, np.roll(face, -1), strict=True):
            row = np.zeros(n)
            row[[i, j]] = -1.0, 1.0
            rows.append(row)
            right.append((mesh.vertices[j] - mesh.vertices[i]) @ turn)
    return np.linalg.lstsq(np.vstack([*rows, pull * pins]), np.vstack([*right, pull * targets]), rcond=None)[
        0
    ]


@pytest.mark.parametrize("shape_name", ["triangle", "square", "L", "ring", "strip", "disc 1"])
def test_agrees_with_the_paper_in_dense_matrices(mesh):
    points = shapes.random_pins(mesh, 1)
    targets = some_targets(mesh, points)
    found = moved(mesh, points, targets, pin_weight=30.0)
    assert np.abs(found - dense_pose(mesh, points, targets, 30.0)).max() < 1e-7


@pytest.mark.parametrize("factor", [1.0, 0.6 + 0.8j, -1.0])
def test_rigid_motions_are_reproduced(mesh, factor):
    points = shapes.random_pins(mesh, 2)
    z = factor * (mesh.vertices[:, 0] + 1j * mesh.vertices[:, 1]) + (30 - 80j)
    expected = np.stack([z.real, z.imag], axis=1)
    found = moved(mesh, points, mesh.evaluate(points, expected))
    assert np.abs(found - expected).max() < 1e-6


def test_scaled_pins_do_not_scale_the_drawing():
    """Which is what the second step is for."""
    mesh = shapes.SHAPES["disc 2"]
    points = shapes.random_pins(mesh, 2, 2)
    found = moved(mesh, points, 1.3 * mesh.evaluate(points, mesh.vertices))
    assert distortion(mesh, found).area < 2.05
    assert distortion(mesh, 1.3 * mesh.vertices).area > 2.25


def test_larger_weight_brings_pins_nearer(mesh):
    points = shapes.random_pins(mesh, 3)
    targets = some_targets(mesh, points)
    off = [
        np.hypot(*(mesh.evaluate(points, moved(mesh, points, targets, pin_weight=weight)) - targets).T).max()
        for weight in (1.0, 30.0, 1000.0)
    ]
    assert off[0] > off[1] > off[2]
    assert off[2] < 0.01


def test_pins_at_one_place_translate_by_their_mean(mesh):
    points = MeshPoints([0, 0], [[0.2, 0.3, 0.5]] * 2)
    here = mesh.evaluate(points, mesh.vertices)
    found = moved(mesh, points, here + np.array([[12.0, 0.0], [0.0, -4.0]]))
    own = mesh.component == mesh.component[mesh.faces[0, 0]]
    assert np.abs(found - mesh.vertices - [6.0, -2.0])[own].max() < 1e-10


def test_the_pose_so_far_does_not_matter(mesh):
    points = shapes.random_pins(mesh, 1)
    targets = some_targets(mesh, points)
    deformer = IgarashiDeformer(mesh)
    deformer.set_pins(points)
    from_rest = deformer.step(mesh.vertices, targets).positions
    assert deformer.step(mesh.vertices[::-1] * 3, targets).positions.tolist() == from_rest.tolist()


@pytest.mark.parametrize("name", ["elephant", "cat", "noto/dancer"])
def test_cartoon_is_bent_nearly_as_by_iterations(cartoon_mesh, name):
    """Somewhat worse than iterative methods, as the paper of 2011 says."""
    mesh = cartoon_mesh(name)
    points = shapes.random_pins(mesh, 1, 4)
    size = mesh.length
    targets = some_targets(mesh, points, 0.05 * size)
    found = moved(mesh, points, targets)
    arap = ArapDeformer(mesh, converge=True, tolerance=1e-6)
    arap.set_pins(points)
    best = arap.step(mesh.vertices, targets).positions
    assert np.hypot(*(mesh.evaluate(points, found) - targets).T).max() < 1e-4 * size
    assert arap.energy(best) < arap.energy(found) < 3 * arap.energy(best)


@pytest.mark.parametrize("weight", [0.5, 1e6, "strong", float("nan")])
def test_bad_settings_are_refused(weight):
    with pytest.raises(InputError, match="pin_weight: expected a number"):
        IgarashiDeformer(shapes.SHAPES["triangle"], pin_weight=weight)
