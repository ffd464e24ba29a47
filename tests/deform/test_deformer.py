"""The contract that every deformation method keeps (see `Deformer`), method by method."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.deform.methods import make_deformer, method_names, presets_of
from akap_editor.errors import AkapError, InputError, SolverError
from akap_editor.geometry.mesh import NO_POINTS, MeshPoints, TriMesh
from tests.support import shapes

# Every method is tested with the parameters of each of its presets, and with these.
FURTHER_PARAMETERS = {
    "akap": [
        {"memory": 1.0},
        {"memory": 1.0, "dirichlet": False, "trajectory": "linear"},
        {"exact": True},
        {"memory": 1.0, "exact": True},
    ],
    "arap": [{"iterations": 1}],
    "igarashi": [{"pin_weight": 10.0}],
    "cauchy-green": [{"cage": 40, "smoothness": 0.1}],
    "mls": [{"transform": "similarity"}, {"transform": "affine"}, {"alpha": 3.0}],
}
CASES = {
    " ".join([method, *(f"{name}={value}" for name, value in parameters.items())]): (method, parameters)
    for method in method_names()
    for parameters in [
        *(preset.parameters for preset in presets_of(method)),
        *FURTHER_PARAMETERS.get(method, []),
    ]
}
SHAPE_NAMES = ["triangle", "bar", "star", "ring", "islands", "strip", "disc 1", "tied islands"]


@pytest.fixture(params=CASES)
def case(request):
    """Each method with each of its sets of parameters."""
    return CASES[request.param]


@pytest.fixture(params=SHAPE_NAMES)
def shape_name(request):
    return request.param


@pytest.fixture
def mesh(shape_name):
    """Each shape in turn; of the tied islands, one moves with the body, and one with the other island."""
    if shape_name != "tied islands":
        return shapes.SHAPES[shape_name]
    return replace(shapes.blocks("##.#.# ##.#.. ##...#", 50, 3, 0.2), tied=True)


def deformer_of(case, mesh, points):
    method, parameters = case
    deformer = make_deformer(method, mesh, **parameters)
    deformer.set_pins(points)
    return deformer


def stepped(case, mesh, points, positions, targets, steps=1):
    """Positions after steps of a new deformer."""
    deformer = deformer_of(case, mesh, points)
    for _ in range(steps):
        positions = deformer.step(positions, targets).positions
    return positions


def scene(mesh, seed=1):
    """Pins, a pose that is no rigid motion of the rest pose, and targets a few pixels from the pins.

    Where parts are tied, one of them has all the pins.
    """
    points = shapes.random_pins(mesh, seed)
    if mesh.tied:
        part = mesh.component[mesh.faces[points.faces, 0]]
        points = MeshPoints(points.faces[part == 0], points.weights[part == 0])
    x, y = mesh.vertices.T
    pose = np.stack([x + 3 * np.sin(y / 40), 1.03 * y - 2 * np.cos(x / 50)], axis=1)
    targets = mesh.evaluate(points, pose) + np.random.default_rng(seed).normal(
        scale=1.5, size=(len(points), 2)
    )
    return points, pose, targets


def test_arguments_are_not_modified(case, mesh):
    arguments = points, pose, targets = scene(mesh)
    copies = [points.faces.copy(), points.weights.copy(), pose.copy(), targets.copy()]
    result = deformer_of(case, mesh, points).step(pose, targets)
    result.positions[:] += 1.0  # the caller's own from here on
    for now, before in zip((points.faces, points.weights, *arguments[1:]), copies, strict=True):
        assert now.tolist() == before.tolist()


def test_result_is_well_formed(case, mesh):
    points, pose, targets = scene(mesh)
    result = deformer_of(case, mesh, points).step(pose, targets)
    assert result.positions.shape == pose.shape
    assert result.positions.dtype == np.float64
    assert np.isfinite(result.positions).all()
    if result.field is not None:
        assert result.field.shape == pose.shape
        assert np.isfinite(result.field).all()
    off = np.hypot(*(mesh.evaluate(points, result.positions) - targets).T)
    assert result.report.pin_error == pytest.approx(off.max(), rel=1e-9, abs=1e-12)


def test_result_depends_on_nothing_but_the_arguments(case, mesh):
    """Not on earlier steps, earlier pins, or another deformer: restoring the pose restores everything."""
    points, pose, targets = scene(mesh)
    expected = stepped(case, mesh, points, pose, targets)
    others = shapes.random_pins(mesh, 7, 2)
    used = deformer_of(case, mesh, others)
    used.step(mesh.vertices, mesh.evaluate(others, mesh.vertices) + 4.0)
    used.set_pins(points)
    used.step(pose, targets + 2.0)
    # a cache may change a result within the solver's stated tolerance
    bound = 1e-5 * mesh.length if case[0] == "akap" and not case[1].get("exact") else 1e-9
    assert np.abs(used.step(pose, targets).positions - expected).max() < bound
    assert stepped(case, mesh, points, pose, targets).tolist() == expected.tolist()
    prepared = deformer_of(case, mesh, points)
    prepared.prepare(mesh.vertices)
    assert prepared.step(pose, targets).positions.tolist() == expected.tolist()


@pytest.mark.parametrize(("factor", "shift"), [(np.exp(0.7j), 0), (1, 400 - 90j), (12.5, 0), (0.04j, 3 + 1j)])
def test_moving_turning_and_scaling_commute_with_a_step(case, mesh, factor, shift):
    def moved(points):
        z = factor * (points[:, 0] + 1j * points[:, 1]) + shift
        return np.stack([z.real, z.imag], axis=1)

    points, pose, targets = scene(mesh)
    expected = moved(stepped(case, mesh, points, pose, targets))
    other = TriMesh(moved(mesh.vertices), mesh.faces, mesh.tied)
    found = stepped(case, other, points, moved(pose), moved(targets))
    assert np.abs(found - expected).max() < 1e-9 * 300 * abs(factor)


def test_renumbering_commutes_with_a_step(case, mesh):
    points, pose, targets = scene(mesh)
    expected = stepped(case, mesh, points, pose, targets)
    other, order, new_faces = shapes.renumbered(mesh, 3)
    swap = np.random.default_rng(3).permutation(len(points))
    faces = new_faces[points.faces]
    old_corner = order[other.faces[faces]]
    same = old_corner[:, :, None] == mesh.faces[points.faces][:, None, :]
    weights = (same * points.weights[:, None, :]).sum(axis=2)
    found = stepped(case, other, MeshPoints(faces[swap], weights[swap]), pose[order], targets[swap])
    assert np.abs(found - expected[order]).max() < 1e-9 * 300


def test_choosing_pins_moves_nothing_at_rest(case, mesh):
    """The targets of the pins are their positions."""
    rest = mesh.vertices
    for points in (shapes.random_pins(mesh, 1), shapes.random_pins(mesh, 2, 1)):
        assert np.abs(stepped(case, mesh, points, rest, mesh.evaluate(points, rest)) - rest).max() < 1e-9


def test_without_pins_nothing_moves(case, mesh):
    _, pose, _ = scene(mesh)
    assert stepped(case, mesh, NO_POINTS, pose, np.zeros((0, 2))).tolist() == pose.tolist()


def test_part_without_a_pin_holds_still(case):
    mesh = shapes.SHAPES["islands"]
    _, pose, _ = scene(mesh)
    own = mesh.component == mesh.component[mesh.faces[0, 0]]
    free = np.flatnonzero(own[mesh.faces[:, 0]])[[0, 7, -1]]
    points = MeshPoints(free, np.full((3, 3), 1 / 3))
    targets = mesh.evaluate(points, pose) + np.array([[5.0, 1.0], [-3.0, 8.0], [9.0, 9.0]])
    result = stepped(case, mesh, points, pose, targets, 3)
    assert np.abs(result - pose)[own].max() > 3.0
    assert result[~own].tolist() == pose[~own].tolist()


def test_one_pin_moves_its_part_rigidly(case, mesh):
    points = MeshPoints([len(mesh.faces) // 2], [[0.2, 0.3, 0.5]])
    own = mesh.tied | (mesh.component == mesh.component[mesh.faces[points.faces[0], 0]])
    target = mesh.evaluate(points, mesh.vertices) + np.array([17.0, -9.0])
    result = stepped(case, mesh, points, mesh.vertices, target, 3)
    i, j = mesh.edges[own[mesh.edges[:, 0]]].T
    rest, now = (np.linalg.norm(p[i] - p[j], axis=1) for p in (mesh.vertices, result))
    assert np.abs(now - rest).max() < 1e-9 * 300
    assert np.abs(mesh.evaluate(points, result) - target).max() < 1e-6
    assert result[~own].tolist() == mesh.vertices[~own].tolist()


def test_pins_at_their_targets_translate_the_drawing(case, mesh):
    points, _, _ = scene(mesh)
    targets = mesh.evaluate(points, mesh.vertices) + np.array([6.0, -11.0])
    result = stepped(case, mesh, points, mesh.vertices, targets, 3)
    assert np.abs(result - mesh.vertices - [6.0, -11.0]).max() < 1e-6


@pytest.mark.parametrize("shape_name", ["triangle", "strip", "islands"])
def test_no_argument_leads_to_numbers_that_are_not_finite(case, mesh):
    """Targets that contradict one another, are very far away, or are all at one place."""
    points, pose, targets = scene(mesh)
    opposite = 2 * targets.mean(axis=0) - targets
    for wanted in (opposite, np.repeat(targets[:1], len(targets), axis=0)):
        assert np.isfinite(stepped(case, mesh, points, pose, wanted)).all()
    collapsed = np.zeros_like(pose)
    try:
        with np.errstate(all="ignore"):
            assert np.isfinite(stepped(case, mesh, points, collapsed, targets)).all()
    except AkapError:
        pass  # says so instead; the caller keeps the last good pose


@pytest.mark.parametrize("shape_name", ["star", "tied islands"])
@pytest.mark.parametrize("distance", [30.0, 1e8])
def test_a_step_ends_however_far_the_targets_are(case, mesh, distance):
    """All pins move in one direction, one moves alone, all move to one place, or all rotate together."""
    points, pose, targets = scene(mesh)
    far = distance * mesh.length
    alone = targets.copy()
    alone[0, 0] += far
    turned = (targets - targets[0]) @ [[0.0, 1.0], [-1.0, 0.0]] + [far, -far]
    for goals in (targets + far, alone, np.tile(targets[:1] + far, (len(targets), 1)), turned):
        with np.errstate(all="ignore"):
            try:
                result = deformer_of(case, mesh, points).step(pose, goals)
            except SolverError:
                continue  # the caller keeps the last good pose
        assert np.isfinite(result.positions).all()
        assert result.report.substeps < 2000


def test_targets_beyond_all_digits_are_refused(case):
    mesh = shapes.SHAPES["bar"]
    points, pose, targets = scene(mesh)
    for value in (1e155, -1e300):
        with pytest.raises(InputError, match=r"targets: expected points within .* pixels of the drawing"):
            deformer_of(case, mesh, points).step(pose, np.full_like(targets, value))


@pytest.mark.parametrize(
    ("positions", "targets", "sentence"),
    [
        (np.zeros((4, 2)), np.zeros((1, 2)), r"positions: expected shape \(3, 2\), got \(4, 2\)"),
        (np.full((3, 2), np.nan), np.zeros((1, 2)), "positions: expected finite numbers"),
        (None, np.zeros((1, 2)), "positions: expected "),
        (np.eye(3)[:, :2], np.zeros((2, 2)), r"targets: expected shape \(1, 2\), got \(2, 2\)"),
        (np.eye(3)[:, :2], [[0.0, np.inf]], "targets: expected finite numbers"),
        (np.eye(3)[:, :2], [["a", "b"]], "targets: expected real numbers"),
    ],
)
def test_bad_arguments_are_refused(case, positions, targets, sentence):
    deformer = deformer_of(case, shapes.SHAPES["triangle"], MeshPoints([0], [[1.0, 0.0, 0.0]]))
    with pytest.raises(InputError, match=sentence):
        deformer.step(positions, targets)


def test_pins_of_another_mesh_are_refused_and_the_old_ones_stay(case):
    mesh = shapes.SHAPES["triangle"]
    points = MeshPoints([0], [[1.0, 0.0, 0.0]])
    deformer = deformer_of(case, mesh, points)
    with pytest.raises(InputError, match="expected indices from 0 to 0, got 1"):
        deformer.set_pins(MeshPoints([1], [[1.0, 0.0, 0.0]]))
    target = mesh.vertices[mesh.faces[0, :1]] + 1.0
    result = deformer.step(mesh.vertices, target).positions
    assert np.abs(result - mesh.vertices - 1.0).max() < 1e-6
