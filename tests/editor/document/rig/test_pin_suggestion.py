"""Suggested places for pins: where a person would put them, also in a drawing of many layers."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.rig.pin_suggestion import suggest_places
from akap_editor.editor.editor import Editor
from akap_editor.editor.tools.suggested_pins import suggest_pins
from akap_editor.io.open_document import open_document
from akap_editor.resources import resource

LIMBS = ("arm lower left", "arm lower right", "leg left", "leg right", "head", "body")


@pytest.fixture(scope="module")
def robot():
    return open_document(resource("assets", "drawings", "robot.ora"))


def layer_names(drawing, layers):
    return [drawing.layers[layer].name for layer in layers]


def test_a_drawing_in_layers_gets_pins_as_a_whole(robot):
    names = layer_names(robot.drawing, suggest_places(robot.drawing, robot.state.joints).layers)
    assert {*names} >= {*LIMBS}
    for limb in ("arm lower left", "arm lower right", "leg left", "leg right"):
        assert names.count(limb) == 1, f"{limb}: a hand has one pin, not one on each finger"
    riding = {"eye left", "eye right", "badge", "mouth smile"}
    assert not riding.intersection(names)


def test_layers_that_are_hidden_or_locked_get_none(robot):
    def without(name, **changes):
        layers = tuple(
            replace(layer, **changes) if layer.name == name else layer for layer in robot.drawing.layers
        )
        drawing = replace(robot.drawing, layers=layers)
        return layer_names(drawing, suggest_places(drawing, robot.state.joints).layers)

    assert "leg left" not in without("leg left", visible=False)
    assert "leg left" not in without("leg left", locked=True)
    drawing = robot.drawing
    hidden = replace(drawing, layers=tuple(replace(layer, visible=False) for layer in drawing.layers))
    assert not len(suggest_places(hidden).rest)


def test_each_pin_is_on_its_layer_in_any_pose(robot):
    editor = Editor()
    editor.open(robot)
    mesh = robot.drawing.mesh
    places = suggest_places(robot.drawing, robot.state.joints)
    arm = places.layers == [layer.name for layer in robot.drawing.layers].index("arm lower left")
    on_arm = np.flatnonzero(mesh.layers == places.layers[arm][0])
    body = mesh.vertices[mesh.layers == places.layers[places.layers != places.layers[arm][0]][-1]]
    folded = mesh.vertices.copy()  # the hand lies on another layer
    folded[on_arm] += body.mean(axis=0) - folded[on_arm].mean(axis=0)
    gestures.set_pose(editor, folded, "Fold")
    suggest_pins(editor)
    editor.finish()
    pins = editor.session.state.pins
    found = mesh.face_layers[[pin.face for pin in pins]]
    np.testing.assert_array_equal(found, places.layers[: len(pins)])
    rest = mesh.evaluate(places.points(mesh), mesh.vertices)
    np.testing.assert_allclose(rest, places.rest, atol=1e-6)
