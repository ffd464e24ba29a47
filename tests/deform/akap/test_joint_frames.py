"""Rotations that agree at the joints, so that earlier factors serve while limbs rotate."""

import numpy as np
import pytest

from akap_editor.deform.akap.joint_frames import JointFrames
from akap_editor.deform.akap.preconditioned_cholesky import PreconditionedCholesky
from akap_editor.deform.methods import make_deformer
from akap_editor.geometry.joints import JointRows, MeshJoints
from akap_editor.geometry.mesh import TriMesh
from tests.support.puppets import ARM, BODY, SKULL, joints, puppet

MESH = puppet().mesh
PLACE = 92 + 118j
PAIRS = [((0, 1), (80.0, 120.0)), ((1, 2), (81.0, 121.0))]
SHOULDER, NECK = (ARM, BODY, (92.0, 118.0), False), (SKULL, BODY, (80.0, 85.0), False)


def layer_rotations(**angles):
    """Unit numbers of the vertices, by the angles of layers in radians."""
    frames = np.ones(len(MESH.vertices), dtype=np.complex128)
    for layer, angle in angles.items():
        frames[MESH.layers == {"arm": ARM, "body": BODY, "skull": SKULL}[layer]] = np.exp(1j * angle)
    return frames


def ends(rows, row):
    """The corners of both ends of a row that have a weight."""
    return rows.corners[row][rows.weights[row] != 0]


def test_both_ends_of_a_joint_rotate_halfway_and_what_is_far_away_as_before():
    rows = JointRows(MESH, joints(SHOULDER, NECK))
    frames = layer_rotations(arm=0.8)
    blended = JointFrames(MESH, rows).blend(frames)
    np.testing.assert_allclose(np.angle(blended[ends(rows, 0)]), 0.4, atol=1e-12)
    np.testing.assert_allclose(np.angle(blended[ends(rows, 4)]), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.abs(blended), 1.0, atol=1e-12)
    far = np.abs(MESH.vertices @ np.array([1, 1j]) - PLACE) > 45
    np.testing.assert_array_equal(blended[far], frames[far])
    angles = np.angle(blended)
    assert angles.min() >= 0
    assert angles.max() <= 0.8 + 1e-12
    assert len(np.unique(angles[MESH.layers == ARM].round(2))) > 5  # goes over gradually


def test_where_everything_rotates_alike_nothing_is_blended():
    frames = np.exp(0.7j) * np.ones(len(MESH.vertices))
    blended = JointFrames(MESH, JointRows(MESH, joints(SHOULDER, NECK))).blend(frames)
    np.testing.assert_allclose(blended, frames, atol=1e-14)


def test_joints_at_one_place_have_one_rotation():
    """A sleeve hangs on the arm where the arm hangs on the body: all three copies of one layer."""
    sheet = MESH.vertices[MESH.layers == BODY]
    faces = (np.cumsum(MESH.layers == BODY) - 1)[MESH.faces[MESH.face_layers == BODY]]
    n, copies = len(sheet), range(3)
    stack = TriMesh(
        np.tile(sheet, (3, 1)),
        np.concatenate([faces + n * k for k in copies]),
        layers=np.repeat(copies, n),
    )
    pairs = [stack.locate([place] * 2, layers=pair) for pair, place in PAIRS]
    rig = MeshJoints([at.faces for at in pairs], [at.weights for at in pairs], [False, False])
    rows = JointRows(stack, rig)
    blended = JointFrames(stack, rows).blend(np.repeat(np.exp([0.0, 0.6j, -0.9j]), n))
    at_ends = blended[np.concatenate([ends(rows, 0), ends(rows, 4)])]
    assert np.abs(at_ends - at_ends[0]).max() < 1e-12


@pytest.mark.parametrize("angle", [np.pi, np.pi - 1e-12, -np.pi / 2])
def test_opposite_rotations_give_unit_numbers(angle):
    blended = JointFrames(MESH, JointRows(MESH, joints(SHOULDER))).blend(layer_rotations(arm=angle))
    np.testing.assert_allclose(np.abs(blended), 1.0, atol=1e-12)


def test_earlier_factors_and_solutions_serve_on_while_a_limb_rotates_about_its_joint(monkeypatch):
    """With a rotation of its own for each layer, 824 iterations and 29 factorizations were needed."""
    systems = set()
    prepare = PreconditionedCholesky.prepare
    monkeypatch.setattr(
        PreconditionedCholesky, "prepare", lambda self, *args: (systems.add(self), prepare(self, *args))
    )
    deformer = make_deformer("akap", MESH, joints(SHOULDER, NECK), memory=1.0)
    points = MESH.locate([(80, 155), (150, 118), (66, 165), (80, 40)], layers=[BODY, ARM, BODY, SKULL])
    deformer.set_pins(points)
    targets, pose = MESH.evaluate(points, MESH.vertices), MESH.vertices
    lever = complex(*targets[1]) - PLACE
    for number in range(40):
        hand = PLACE + np.exp(0.5j * np.sin(0.2 * number)) * lever
        targets[1] = hand.real, hand.imag
        pose = deformer.step(pose, targets).positions
    assert sum(system.iterations for system in systems) < 600
    assert sum(system.factorizations for system in systems) < 20
