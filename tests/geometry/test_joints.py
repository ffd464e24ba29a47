"""Joints: their rows at rest, under rigid motions, and the groups that they form."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.geometry.joints import NO_JOINTS, STRONG, JointRows, MeshJoints, joined_groups
from tests.support.puppets import ARM, BODY, EYES, SKULL, joints, puppet

MESH = puppet().mesh


SHOULDER, NECK = (ARM, BODY, (92.0, 118.0), False), (SKULL, BODY, (80.0, 85.0), True)


def test_rows_are_zero_in_all_rigid_motions():
    rows = JointRows(MESH, joints(SHOULDER, NECK))
    rest = MESH.vertices @ np.array([1, 1j])
    for pose in (rest, 2j + np.exp(0.7j) * rest, 1.5 * rest):
        assert np.abs(rows.gaps(pose)).max() < 1e-9


def test_a_hinge_has_one_strong_row_and_a_weld_more():
    rows = JointRows(MESH, joints(SHOULDER, NECK))
    assert rows.is_strong.reshape(2, 4).tolist() == [[True, False, False, False], [True] * 4]


def test_entries_and_pull_are_those_of_the_energy():
    rows = JointRows(MESH, joints(SHOULDER, NECK))
    rng = np.random.default_rng(3)
    pose = rng.normal(size=len(MESH.vertices)) + 1j * rng.normal(size=len(MESH.vertices))
    gaps = rows.gaps(pose)
    n = 2 * len(MESH.vertices)
    values, row, column = rows.entries()
    matrix = np.zeros((n, n))
    np.add.at(matrix, (row, column), values)
    matrix += np.tril(matrix, -1).T
    x = pose.view(np.float64)
    assert rows.energy(gaps) == pytest.approx(x @ matrix @ x)
    np.testing.assert_allclose(rows.pull(gaps).view(np.float64), matrix @ x, atol=1e-6 * STRONG)
    coupled = {tuple(pair) for pair in rows.links.tolist()}
    cross = [(min(i, j) // 2, max(i, j) // 2) for i, j in zip(row, column, strict=True)]
    layers = MESH.layers
    assert {pair for pair in cross if layers[pair[0]] != layers[pair[1]]} == coupled


def test_rows_of_a_renumbered_mesh_are_those_of_the_same_places():
    """Also where a joint lies on a vertex, and which of the faces around it is taken depends on rounding."""
    rng = np.random.default_rng(8)
    vertex_order, face_order = (rng.permutation(len(part)) for part in (MESH.vertices, MESH.faces))
    mesh = MESH.renumber(vertex_order, face_order)
    x, y = MESH.vertices.T
    of_arm = MESH.vertices[(MESH.layers == ARM) & (x > 87) & (x < 97) & (abs(y - 119) < 6)]
    rows = JointRows(MESH, joints(*((ARM, BODY, place, False) for place in of_arm), NECK))
    assert len(of_arm)
    found = rows.renumber(mesh, np.argsort(face_order))
    assert (vertex_order[found.corners] == rows.corners).all()
    assert np.abs(found.weights - rows.weights).max() < 1e-9
    assert (found.places == rows.places).all()
    assert {frozenset(pair) for pair in vertex_order[found.links].tolist()} == {
        frozenset(pair) for pair in rows.links.tolist()
    }


def test_joined_components_form_groups():
    groups = joined_groups(MESH, joints(SHOULDER, NECK).components(MESH))
    of_layer = [set(groups[MESH.layers == layer]) for layer in range(5)]
    assert of_layer[BODY] == of_layer[ARM] == of_layer[SKULL]
    assert of_layer[EYES].isdisjoint(of_layer[BODY])
    assert len(of_layer[EYES]) == 2
    assert (joined_groups(MESH, NO_JOINTS.components(MESH)) == MESH.component).all()


@pytest.mark.parametrize(
    ("faces", "weights", "is_weld"),
    [
        ([[0, 1]], [[[1, 0, 0]]], [False]),
        ([[0, 1]], np.zeros((1, 2, 3)), []),
        ([[0]], np.zeros((1, 2, 3)), [False]),
        ([[-1, 0]], np.zeros((1, 2, 3)), [False]),
    ],
)
def test_other_shapes_are_refused(faces, weights, is_weld):
    with pytest.raises(InputError, match="joints"):
        MeshJoints(np.array(faces), np.array(weights), np.array(is_weld))


def test_a_joint_within_one_component_is_refused():
    with pytest.raises(InputError, match="two components"):
        JointRows(MESH, joints((BODY, BODY, (80.0, 150.0), False)))
