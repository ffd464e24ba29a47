"""As-rigid-as-possible deformation: its energy, and a dense implementation to compare with."""

from itertools import pairwise

import numpy as np
import pytest

from akap_editor.deform.rivals.arap import ArapDeformer
from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import MeshPoints
from tests.support import dense, shapes


def deformer_with(mesh, points, **settings):
    deformer = ArapDeformer(mesh, **settings)
    deformer.set_pins(points)
    return deformer


def scene(mesh, seed=1):
    """Pins, a pose that is no rigid motion of the rest pose, and targets."""
    points = shapes.random_pins(mesh, seed)
    x, y = mesh.vertices.T
    pose = np.stack([x + 8 * np.sin(y / 40), 1.1 * y - 6 * np.cos(x / 50)], axis=1)
    targets = mesh.evaluate(points, pose) + np.random.default_rng(seed).normal(
        scale=8.0, size=(len(points), 2)
    )
    return points, pose, targets


# -- the paper's formula, edge by edge -----------------------------------------------------------------------


def cotangent_edges(mesh):
    """Face, start, end and half the cotangent of the angle opposite, for each edge of each face."""
    for number, face in enumerate(mesh.faces.tolist()):
        for corner in range(3):
            start, end, opposite = face[corner - 2], face[corner - 1], face[corner]
            a, b = mesh.vertices[[start, end]] - mesh.vertices[opposite]
            yield number, start, end, 0.5 * (a @ b) / (a[0] * b[1] - a[1] * b[0])


def rotations(mesh, pose):
    """The best rotation of each face by the singular value decomposition of Σ cot (p_i − p_j)(v_i − v_j)ᵀ."""
    sums = np.zeros((len(mesh.faces), 2, 2))
    for face, i, j, weight in cotangent_edges(mesh):
        sums[face] += weight * np.outer(pose[i] - pose[j], mesh.vertices[i] - mesh.vertices[j])
    left, _, right = np.linalg.svd(sums)
    signs = np.linalg.det(left @ right)
    left[:, :, 1] *= signs[:, None]
    return left @ right


def dense_energy(mesh, pose):
    turns = rotations(mesh, pose)
    return sum(
        weight * np.sum((pose[i] - pose[j] - turns[face] @ (mesh.vertices[i] - mesh.vertices[j])) ** 2)
        for face, i, j, weight in cotangent_edges(mesh)
    )


def dense_iteration(mesh, points, pose, targets):
    """One local step, and one global step with the pins as Lagrange's constraints."""
    n = len(mesh.vertices)
    turns = rotations(mesh, pose)
    system, right = np.zeros((n, n)), np.zeros((n, 2))
    for face, i, j, weight in cotangent_edges(mesh):
        difference = np.zeros(n)
        difference[[i, j]] = 1.0, -1.0
        system += weight * np.outer(difference, difference)
        right += weight * np.outer(difference, turns[face] @ (mesh.vertices[i] - mesh.vertices[j]))
    pins = dense.pin_rows(mesh, points)[::2, ::2]
    k = len(pins)
    bordered = np.block([[system, pins.T], [pins, np.zeros((k, k))]])
    return np.linalg.lstsq(bordered, np.vstack([right, targets]), rcond=1e-13)[0][:n]


def test_energy_is_that_of_the_paper(mesh):
    _, pose, _ = scene(mesh)
    noise = np.random.default_rng(2).normal(scale=20.0, size=pose.shape)  # with flipped faces
    for positions in (pose, pose + noise):
        assert ArapDeformer(mesh).energy(positions) == pytest.approx(dense_energy(mesh, positions), rel=1e-9)


@pytest.mark.parametrize("shape_name", ["square", "L", "star", "ring", "islands", "strip", "disc 1"])
@pytest.mark.parametrize("iterations", [1, 3])
def test_agrees_with_the_dense_implementation(mesh, iterations):
    points, pose, targets = scene(mesh)
    found = deformer_with(mesh, points, iterations=iterations, tolerance=0).step(pose, targets).positions
    for _ in range(iterations):
        pose = dense_iteration(mesh, points, pose, targets)
    assert np.abs(found - pose).max() < 1e-8


# -- laws ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rotations", ["faces", "spokes-and-rims"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_energy_never_rises(mesh, seed, rotations):
    points, pose, targets = scene(mesh, seed)
    deformer = deformer_with(mesh, points, iterations=1, tolerance=0, rotations=rotations)
    energies = []
    for _ in range(40):
        pose = deformer.step(pose, targets).positions
        energies.append(deformer.energy(pose))
    rounding = 1e-12 * energies[0]
    assert all(after <= before + rounding for before, after in pairwise(energies))


def test_rigid_motions_cost_nothing(mesh):
    turned = mesh.vertices @ [[0.6, 0.8], [-0.8, 0.6]] + [30.0, -80.0]
    assert ArapDeformer(mesh).energy(turned) < 1e-20 * mesh.rest_areas.sum()
    assert ArapDeformer(mesh).energy(2 * mesh.vertices) == pytest.approx(2 * mesh.rest_areas.sum())


def test_pins_are_exactly_at_their_targets(mesh):
    points, pose, targets = scene(mesh)
    result = deformer_with(mesh, points).step(pose, targets)
    assert np.abs(mesh.evaluate(points, result.positions) - targets).max() < 1e-10 * 300


def test_pins_that_contradict_one_another_meet_in_the_middle(mesh):
    face = len(mesh.faces) // 2
    points = MeshPoints([face] * 2, [[0.2, 0.3, 0.5]] * 2)
    here = mesh.evaluate(points, mesh.vertices)
    result = deformer_with(mesh, points).step(mesh.vertices, here + np.array([[12.0, 0.0], [0.0, -4.0]]))
    assert np.abs(mesh.evaluate(points, result.positions) - here - [6.0, -2.0]).max() < 1e-9 * 300


def test_turned_pins_turn_the_drawing(mesh):
    points = shapes.random_pins(mesh, 4)
    turned = mesh.vertices @ [[0.6, 0.8], [-0.8, 0.6]] + [30.0, -80.0]
    deformer = deformer_with(mesh, points, iterations=5000, tolerance=1e-12)
    result = deformer.step(mesh.vertices, mesh.evaluate(points, turned)).positions
    assert np.abs(result - turned).max() < 1e-4


def test_iterations_go_on_from_the_pose(mesh):
    points, pose, targets = scene(mesh)
    at_once = deformer_with(mesh, points, iterations=6, tolerance=0).step(pose, targets).positions
    deformer = deformer_with(mesh, points, iterations=2, tolerance=0)
    for _ in range(3):
        pose = deformer.step(pose, targets).positions
    assert np.abs(at_once - pose).max() < 1e-9 * 300


def test_step_ends_once_nothing_moves_farther_than_the_tolerance():
    mesh = shapes.SHAPES["square"]
    points, pose, targets = scene(mesh)
    ended = deformer_with(mesh, points, iterations=100_000, tolerance=1e-6).step(pose, targets).positions
    once_more = deformer_with(mesh, points, iterations=1).step(ended, targets).positions
    assert np.abs(once_more - ended).max() < 1e-6 * mesh.length


def test_converging_goes_on_until_nothing_moves():
    mesh = shapes.SHAPES["bar"]
    points, pose, targets = scene(mesh)
    few = deformer_with(mesh, points).step(pose, targets).positions
    deformer = deformer_with(mesh, points, converge=True)
    ended = deformer.step(pose, targets).positions
    assert deformer.energy(ended) < 0.99 * deformer.energy(few)
    bound = 1e-7 * mesh.length
    assert np.abs(deformer.step(ended, targets).positions - ended).max() < bound
    many = deformer_with(mesh, points, iterations=100_000).step(pose, targets).positions
    assert many.tolist() == ended.tolist()


# -- spokes and rims -----------------------------------------------------------------------------------------


def vertex_energy(mesh, pose):
    """⅓ Σ_v min_R Σ cot |(p_i − p_j) − R (v_i − v_j)|² over the edges of the faces around each vertex v."""
    edges = list(cotangent_edges(mesh))
    total = 0.0
    for vertex in range(len(mesh.vertices)):
        near = [edge for edge in edges if vertex in mesh.faces[edge[0]]]
        moment = sum(
            w * np.outer(mesh.vertices[i] - mesh.vertices[j], pose[i] - pose[j]) for _, i, j, w in near
        )
        left, _, right = np.linalg.svd(moment)
        turn = left @ np.diag([1.0, np.linalg.det(left @ right)]) @ right
        for _, i, j, weight in near:
            off = pose[i] - pose[j] - (mesh.vertices[i] - mesh.vertices[j]) @ turn
            total += weight * (off @ off) / 3
    return total


@pytest.mark.parametrize("shape_name", ["triangle", "L", "ring", "strip", "disc 1"])
def test_energy_of_spokes_and_rims_is_that_of_its_definition(mesh):
    _, pose, _ = scene(mesh)
    noise = np.random.default_rng(2).normal(scale=20.0, size=pose.shape)
    deformer = ArapDeformer(mesh, rotations="spokes-and-rims")
    for positions in (pose, pose + noise):
        assert deformer.energy(positions) == pytest.approx(vertex_energy(mesh, positions), rel=1e-9)


# -- others' implementations, real drawings, bad settings ----------------------------------------------------


@pytest.mark.parametrize(
    ("rotations", "kind"), [("faces", "ELEMENTS"), ("spokes-and-rims", "SPOKES_AND_RIMS")]
)
@pytest.mark.parametrize("shape_name", ["square", "bar", "star", "ring", "disc 2"])
def test_least_energy_is_that_of_libigl(mesh, rotations, kind):
    igl = pytest.importorskip("igl", reason="libigl is not installed")
    vertices = np.random.default_rng(6).choice(len(mesh.vertices), 4, replace=False)
    points = shapes.vertex_pins(mesh, vertices)
    targets = mesh.vertices[vertices] + np.random.default_rng(7).normal(scale=10.0, size=(4, 2))
    deformer = deformer_with(mesh, points, tolerance=1e-11, converge=True, rotations=rotations)
    found = deformer.step(mesh.vertices, targets).positions

    data = igl.ARAPData()
    data.max_iter = 20_000
    data.energy = getattr(igl, f"ARAP_ENERGY_TYPE_{kind}")
    igl.arap_precomputation(
        mesh.vertices.copy(), mesh.faces.astype(np.int64), 2, vertices.astype(np.int32), data
    )
    theirs = igl.arap_solve(targets, data, mesh.vertices.copy())
    assert np.abs(theirs[vertices] - targets).max() < 1e-9
    assert deformer.energy(found) == pytest.approx(deformer.energy(theirs), rel=1e-6)


@pytest.mark.parametrize("name", ["elephant", "cat", "noto/dancer"])
def test_bent_cartoon_keeps_its_shape(cartoon_mesh, name):
    mesh = cartoon_mesh(name)
    points = shapes.random_pins(mesh, 1, 4)
    size = mesh.length
    targets = mesh.evaluate(points, mesh.vertices)
    targets += np.random.default_rng(1).normal(scale=0.05 * size, size=targets.shape)
    result = deformer_with(mesh, points, iterations=200).step(mesh.vertices, targets)
    assert result.report.pin_error < 1e-9 * size
    after = distortion(mesh, result.positions)
    assert after.area < 2.1
    assert after.angle < 2.1


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"iterations": 0}, "iterations: expected a number from 1 to 100000, got 0"),
        ({"iterations": "many"}, "iterations: expected a number"),
        ({"tolerance": -1.0}, "tolerance: expected a number from 0 to 1, got -1.0"),
        ({"tolerance": float("nan")}, "tolerance: expected a number"),
        ({"rotations": "edges"}, "rotations: expected 'faces' or 'spokes-and-rims', got 'edges'"),
    ],
)
def test_bad_settings_are_refused(settings, message):
    with pytest.raises(InputError, match=message):
        ArapDeformer(shapes.SHAPES["triangle"], **settings)
