"""Layers are deformed on their own, and what has no pins rides on the layer it lies on."""

import numpy as np
import pytest

from akap_editor.deform.layer_groups import LayerGroupDeformer
from akap_editor.deform.methods import make_deformer, method_names
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import TriMesh
from tests.support.puppets import ARM, BODY, EYES, HAT, SKULL, puppet

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
