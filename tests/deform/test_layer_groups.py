"""Layers are deformed on their own, and what has no pins rides on the layer it lies on."""

import numpy as np
import pytest

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.deform.layer_groups import LayerGroupDeformer, solved_groups
from akap_editor.deform.methods import make_deformer, method_names
from akap_editor.errors import InputError
from akap_editor.geometry.joints import MeshJoints
from akap_editor.geometry.mesh import MeshPoints, TriMesh, signed_areas
from tests.support.puppets import ARM, BODY, EYES, HAT, SKULL, joints, puppet

MESH = puppet().mesh


def alone(mesh, layer):
    """The mesh of one layer."""
    own = mesh.layers == layer
    number = np.cumsum(own) - 1
    return TriMesh(mesh.vertices[own], number[mesh.faces[mesh.face_layers == layer]])


def is_moved_rigidly(mesh, layer, pose):
    """Whether a layer has moved like a rigid body, to a hundredth of a pixel."""
    own = mesh.layers == layer
    rest, moved = (p[own] - p[own].mean(axis=0) for p in (mesh.vertices, pose))
    u, _, v = np.linalg.svd(rest.T @ moved)
    return np.abs(rest @ (u @ v) - moved).max() < 0.01


@pytest.mark.parametrize("method", method_names())
def test_a_layer_is_deformed_as_if_it_were_alone_bit_for_bit(method):
    part = alone(MESH, ARM)
    places = [(90.0, 120.0), (150.0, 118.0)]
    targets = np.array([(92.0, 118.0), (140.0, 100.0)])
    layered, single = LayerGroupDeformer(MESH, _constructor(method)), make_deformer(method, part)
    layered.set_pins(MESH.locate(places, layers=[ARM, ARM]))
    single.set_pins(part.locate(places))
    pose, expected = MESH.vertices, part.vertices
    for _ in range(3):
        result, other = layered.step(pose, targets), single.step(expected, targets)
        pose, expected = result.positions, other.positions
    own = MESH.layers == ARM
    np.testing.assert_array_equal(pose[own], expected)
    np.testing.assert_array_equal(pose[~own], MESH.vertices[~own])
    assert result.report.pin_error == other.report.pin_error
    if other.flow is not None:
        np.testing.assert_array_equal(result.at(0.5)[own], other.at(0.5))
        np.testing.assert_array_equal(result.field[own], other.field)


def _constructor(method):
    return lambda mesh, **parameters: make_deformer(method, mesh, **parameters)


def test_layers_without_pins_ride_on_those_that_they_lie_on():
    deformer = make_deformer("akap", MESH)
    deformer.set_pins(MESH.locate([(80.0, 160.0), (80.0, 50.0)], layers=[BODY, SKULL]))
    pose = MESH.vertices
    for number in range(12):
        pose = deformer.step(pose, [(80.0, 160.0), (80.0 + 2 * number, 50.0 - number)]).positions
    shift = {layer: (pose - MESH.vertices)[MESH.layers == layer].mean(axis=0) for layer in range(5)}
    np.testing.assert_allclose(shift[EYES], [22, -11], atol=1.0)
    np.testing.assert_allclose(shift[HAT], [22, -11], atol=1.0)
    np.testing.assert_allclose(shift[ARM], [0, 0], atol=0.5)
    assert all(is_moved_rigidly(MESH, layer, pose) for layer in (ARM, EYES, HAT))


def test_stiffness_reaches_each_layer_and_lengths_are_those_of_the_layer():
    stiffness = np.ones(len(MESH.faces))
    stiffness[MESH.face_layers == ARM] = np.linspace(1, 100, (MESH.face_layers == ARM).sum())
    part = alone(MESH, ARM)
    layered = make_deformer("akap", MESH, stiffness=stiffness, max_step=0.05)
    single = make_deformer("akap", part, stiffness=stiffness[MESH.face_layers == ARM], max_step=0.05)
    places, targets = [(90.0, 120.0), (150.0, 118.0)], [(90.0, 120.0), (145.0, 105.0)]
    layered.set_pins(MESH.locate(places, layers=[ARM, ARM]))
    single.set_pins(part.locate(places))
    result, other = layered.step(MESH.vertices, targets), single.step(part.vertices, targets)
    np.testing.assert_array_equal(result.positions[MESH.layers == ARM], other.positions)
    assert result.report.substeps == other.report.substeps > 1


@pytest.mark.parametrize(
    ("parameters", "targets", "message"),
    [
        ({"memory": 3}, None, "memory"),
        ({"stiffness": [1.0, 2.0]}, None, "stiffness"),
        ({}, [(1.0, 2.0), (3.0, 4.0)], "targets"),
        ({}, [(np.nan, 0.0)], "targets"),
        ({}, [(1e15, 0.0)], "targets"),
    ],
)
def test_bad_arguments_are_refused(parameters, targets, message):
    def step():
        deformer = make_deformer("akap", MESH, **parameters)
        deformer.set_pins(MESH.locate([(80.0, 160.0)]))
        deformer.step(MESH.vertices, targets)

    with pytest.raises(InputError, match=message):
        step()


def test_without_pins_nothing_moves():
    result = make_deformer("akap", MESH).step(MESH.vertices, np.zeros((0, 2)))
    np.testing.assert_array_equal(result.positions, MESH.vertices)


# --- joints ---


SHOULDER, NECK = (ARM, BODY, (92.0, 118.0), False), (SKULL, BODY, (80.0, 85.0), False)
RIG = joints(SHOULDER, NECK)


def gap(pose, rig=RIG):
    places = rig.places(MESH, pose)
    return np.linalg.norm(places[:, 0] - places[:, 1], axis=1).max()


@pytest.mark.parametrize(
    ("joined", "pinned", "groups"),
    [
        ([], [0, 2], [(0,), (2,)]),
        ([(0, 1), (1, 2)], [0, 2], [(0, 1, 2)]),  # the way between pins
        ([(0, 1), (1, 2)], [0, 1], [(0, 1)]),  # 2 hangs on it without a pin
        ([(0, 1), (1, 2), (2, 3)], [0], [(0,)]),
        ([(0, 1), (2, 3)], [0, 1, 3], [(0, 1), (3,)]),
        ([(0, 1), (1, 2), (2, 0)], [0], [(0, 1, 2)]),  # a ring holds itself
        ([(0, 1), (0, 1)], [0, 1], [(0, 1)]),
    ],
)
def test_what_lies_between_pins_is_solved_together(joined, pinned, groups):
    assert solved_groups(np.array(joined, dtype=int).reshape(-1, 2), pinned) == groups


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_a_hinge_holds_while_the_limb_is_dragged_around(memory):
    deformer = make_deformer("akap", MESH, RIG, memory=memory)
    points = MESH.locate([(80.0, 155.0), (150.0, 118.0), (66.0, 165.0)], layers=[BODY, ARM, BODY])
    deformer.set_pins(points)
    rest = MESH.evaluate(points, MESH.vertices)
    pose, worst = MESH.vertices, 0.0
    for number in range(40):
        angle = 0.04 * number
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        targets = rest.copy()
        targets[1] = [92, 118] + turn @ (rest[1] - [92, 118])
        pose = deformer.step(pose, targets).positions
        worst = max(worst, gap(pose))
    for _ in range(10):
        pose = deformer.step(pose, targets).positions
    assert worst < 0.5
    assert gap(pose) < 0.05
    assert signed_areas(pose, MESH.faces).min() > 0


def test_a_rigid_motion_of_the_pins_moves_the_whole_puppet_rigidly():
    """Lemma 1: fields of joined layers reproduce rigid motions to the precision of the solver."""
    deformer = make_deformer("akap", MESH, RIG, exact=True)
    points = MESH.locate([(80.0, 155.0), (150.0, 118.0), (80.0, 40.0)], layers=[BODY, ARM, SKULL])
    deformer.set_pins(points)
    solved = np.isin(MESH.layers, [BODY, ARM, SKULL])
    z = MESH.vertices @ np.array([1, 1j])
    field = 2 - 3j + 0.3j * z
    pins = MESH.evaluate(points, np.stack([field.real, field.imag], axis=1))
    optimal, smooth = deformer.vector_fields(MESH.vertices, pins)
    for result in (optimal, smooth):
        error = np.abs((result @ np.array([1, 1j]) - field)[solved]).max()
        assert error < 1e-6 * np.abs(field).max()


def test_without_pins_of_its_own_a_limb_turns_with_the_patch_at_its_joint():
    deformer = make_deformer("akap", MESH, RIG, memory=1.0)
    points = MESH.locate([(66.0, 165.0), (80.0, 95.0)], layers=[BODY, BODY])
    deformer.set_pins(points)
    rest, pose = MESH.evaluate(points, MESH.vertices), MESH.vertices
    for number in range(20):
        targets = rest + np.array([(0, 0), (2.0 * number, 0)])
        pose = deformer.step(pose, targets).positions
    assert is_moved_rigidly(MESH, ARM, pose)
    assert gap(pose) < 1e-6
    assert np.abs(pose - MESH.vertices)[MESH.layers == ARM].max() > 5


def test_a_thousand_frames_of_a_drag_open_no_gap_flip_no_face_and_leave_no_drift():
    deformer = make_deformer("akap", MESH, RIG, memory=1.0)
    points = MESH.locate([(80.0, 155.0), (150.0, 118.0), (80.0, 40.0)], layers=[BODY, ARM, SKULL])
    deformer.set_pins(points)
    rest, pose = MESH.evaluate(points, MESH.vertices), MESH.vertices
    settled, worst, smallest = [], 0.0, np.inf
    for _ in range(4):
        for number in range(1, 251):
            angle = 2 * np.pi * number / 25
            targets = rest + np.array([(0, 0), (15 * np.cos(angle) - 15, 25 * np.sin(angle)), (0, 0)])
            pose = deformer.step(pose, targets).positions
            worst, smallest = max(worst, gap(pose)), min(smallest, signed_areas(pose, MESH.faces).min())
        for _ in range(12):
            pose = deformer.step(pose, rest).positions
        settled.append(pose)
    assert worst < 0.5
    assert smallest > 0
    assert gap(pose) < 0.05
    assert np.abs(settled[-1] - settled[0]).max() < 0.1


def test_with_reused_factors_each_step_is_the_exact_one():
    """To less than a hundredth of a pixel at 1000 x 1000 pixels, while the arm swings."""
    points = MESH.locate([(80.0, 155.0), (150.0, 118.0), (80.0, 40.0)], layers=[BODY, ARM, SKULL])
    drag, exact = (make_deformer("akap", MESH, RIG, memory=1.0, exact=is_exact) for is_exact in (False, True))
    for deformer in (drag, exact):
        deformer.set_pins(points)
    targets, pose = MESH.evaluate(points, MESH.vertices), MESH.vertices
    lever = targets[1] @ [1, 1j] - (92 + 118j)
    for number in range(30):
        hand = 92 + 118j + np.exp(0.6j * np.sin(0.3 * number)) * lever
        targets[1] = hand.real, hand.imag
        expected = exact.step(pose, targets).positions
        pose = drag.step(pose, targets).positions
        assert np.abs(pose - expected).max() < 0.01 * MESH.length / 1000


@pytest.mark.parametrize("method", [name for name in method_names() if name != "akap"])
def test_methods_without_joints_let_layers_ride_by_them(method):
    deformer = make_deformer(method, MESH, RIG)
    deformer.set_pins(MESH.locate([(80.0, 155.0)], layers=[BODY]))
    pose = deformer.step(MESH.vertices, [(95.0, 160.0)]).positions
    assert not deformer.takes_joints
    np.testing.assert_allclose((pose - MESH.vertices)[MESH.layers == ARM].mean(axis=0), [15, 5], atol=0.5)


def test_what_is_solved_for_is_prepared_when_it_is_needed_bit_for_bit():
    """Choosing pins one after another prepares the last chain only, as if they were chosen at once."""
    made = []

    def make(mesh, **parameters):
        made.append(mesh)
        return AkapDeformer(mesh, **parameters)

    deformer = LayerGroupDeformer(MESH, make, RIG, memory=1.0)
    at_once = LayerGroupDeformer(MESH, make, RIG, memory=1.0)
    made.clear()
    points = MESH.locate([(80.0, 155.0), (150.0, 118.0), (80.0, 40.0)], layers=[BODY, ARM, SKULL])
    scales = np.full(len(MESH.faces), 1.25)
    for count in (1, 2, 3):
        deformer.set_pins(MeshPoints(points.faces[:count], points.weights[:count]))
        deformer.set_scales(scales)
    assert not made
    at_once.set_scales(scales)
    at_once.set_pins(points)
    targets = MESH.evaluate(points, MESH.vertices) + np.array([(0, 0), (4, 9), (0, 0)])
    poses = [each.step(MESH.vertices, targets).positions for each in (deformer, at_once)]
    assert len(made) == 2
    assert (poses[0] == poses[1]).all()


def test_no_joints_are_as_none_at_all_bit_for_bit():
    points = MESH.locate([(80.0, 155.0), (66.0, 100.0)], layers=[BODY, BODY])
    poses = []
    for rig in (None, MeshJoints(np.zeros((0, 2), int), np.zeros((0, 2, 3)), np.zeros(0, bool))):
        deformer = make_deformer("akap", MESH, rig, memory=1.0)
        deformer.set_pins(points)
        poses.append(deformer.step(MESH.vertices, [(80.0, 155.0), (70.0, 96.0)]).positions)
    np.testing.assert_array_equal(*poses)
