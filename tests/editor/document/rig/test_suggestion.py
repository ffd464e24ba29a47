"""Proposed joints: the parents that a person would choose, also on puppets that nothing was tuned on."""

import numpy as np
import pytest

from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.io.layers.open_layers import open_layers
from akap_editor.layers.layered_picture import Layer, LayeredPicture, LayerGroup
from akap_editor.resources import resource
from tests.support.pictures import figure_picture
from tests.support.puppets import ARM, BODY, EYES, HAT, SKULL, puppet

SIZE = 300, 400
RIDES = None  # the layer rides on what it lies on, without a joint


def ellipse(x, y, rx, ry):
    """A layer's picture and offset: an ellipse around (x, y), pixels."""
    v, u = np.mgrid[: 2 * ry, : 2 * rx]
    inside = ((u + 0.5 - rx) / rx) ** 2 + ((v + 0.5 - ry) / ry) ** 2 <= 1
    picture = np.zeros((2 * ry, 2 * rx, 4), np.uint8)
    picture[inside] = 90, 160, 120, 255
    return picture, (x - rx, y - ry)


# Layers from the bottom to the top as (name, ellipse), and the parent of each; "-" for the root.
PUPPETS = {
    "robot with forearms": {
        "thigh left": ((115, 280, 20, 45), "torso"),
        "shin left": ((112, 345, 14, 40), "thigh left"),
        "thigh right": ((185, 280, 20, 45), "torso"),
        "shin right": ((188, 345, 14, 40), "thigh right"),
        "torso": ((150, 190, 55, 70), "-"),
        "upper arm left": ((85, 165, 35, 15), "torso"),
        "forearm left": ((40, 170, 32, 12), "upper arm left"),
        "upper arm right": ((215, 165, 35, 15), "torso"),
        "forearm right": ((260, 170, 32, 12), "upper arm right"),
        "head": ((150, 95, 40, 42), "torso"),
        "visor": ((150, 90, 25, 10), RIDES),
    },
    "dog from the side": {
        "far hind leg": ((95, 300, 16, 55), "body"),
        "far front leg": ((195, 300, 16, 55), "body"),
        "tail": ((45, 200, 35, 12), "body"),
        "body": ((145, 230, 80, 50), "-"),
        "near hind leg": ((80, 295, 18, 60), "body"),
        "near front leg": ((210, 295, 18, 60), "body"),
        "head": ((230, 160, 42, 38), "body"),
        "ear": ((205, 150, 14, 30), "head"),
        "eye": ((240, 150, 6, 6), RIDES),
        "nose": ((262, 165, 8, 7), RIDES),
    },
    "bird without names": {
        "Layer 1": ((150, 330, 8, 40), "Layer 3"),
        "Layer 2": ((180, 330, 8, 40), "Layer 3"),
        "Layer 3": ((160, 230, 60, 75), "-"),
        "Layer 4": ((210, 235, 50, 25), "Layer 3"),
        "Layer 5": ((150, 135, 40, 38), "Layer 3"),
        "Layer 6": ((140, 128, 7, 7), RIDES),
    },
    "snowman with hat and scarf": {
        "belly": ((150, 300, 75, 70), "-"),
        "arm left": ((70, 265, 45, 10), "belly"),
        "arm right": ((230, 265, 45, 10), "belly"),
        "head": ((150, 200, 48, 45), "belly"),
        "hat": ((150, 150, 40, 25), "head"),
        "eye left": ((135, 195, 6, 6), RIDES),
        "eye right": ((165, 195, 6, 6), RIDES),
        "carrot nose": ((160, 210, 18, 6), RIDES),
    },
    "doll in a dress": {
        "leg left": ((125, 330, 15, 60), "body"),
        "leg right": ((175, 330, 15, 60), "body"),
        "arm left": ((85, 200, 40, 13), "body"),
        "arm right": ((215, 200, 40, 13), "body"),
        "body": ((150, 225, 45, 75), "-"),
        "dress": ((150, 240, 60, 60), "body"),
        "head": ((150, 120, 45, 48), "body"),
        "hair": ((150, 90, 55, 45), "head"),
        "mouth": ((150, 145, 12, 5), RIDES),
    },
    "pony in three quarters": {
        "Leg back L": ((90, 300, 15, 55), "Body"),
        "Leg front L": ((180, 300, 15, 55), "Body"),
        "Tail": ((45, 235, 28, 14), "Body"),
        "Body": ((135, 240, 80, 45), "-"),
        "Leg back R": ((75, 305, 16, 55), "Body"),
        "Leg front R": ((195, 305, 16, 55), "Body"),
        "Neck": ((205, 185, 24, 45), "Body"),
        "Head": ((230, 135, 42, 24), "Neck"),
        "Ear": ((210, 108, 8, 18), "Head"),
        "Eye": ((228, 130, 6, 6), RIDES),
    },
    "crab": {
        "leg left 1": ((75, 260, 40, 9), "shell"),
        "leg left 2": ((80, 285, 40, 9), "shell"),
        "leg right 1": ((225, 260, 40, 9), "shell"),
        "leg right 2": ((220, 285, 40, 9), "shell"),
        "arm left": ((80, 200, 35, 12), "shell"),
        "arm right": ((220, 200, 35, 12), "shell"),
        "claw left": ((45, 165, 24, 32), "arm left"),
        "claw right": ((255, 165, 24, 32), "arm right"),
        "shell": ((150, 240, 65, 55), "-"),
        "spot": ((150, 250, 18, 12), RIDES),
    },
}


def parents(drawing):
    """The parent of each layer by name, None for those without a joint."""
    found = dict.fromkeys((layer.name for layer in drawing.layers), None)
    for joint in suggest_joints(drawing):
        limb, carrier = joint.layers(drawing.mesh)
        found[drawing.layers[limb].name] = drawing.layers[carrier].name
    return found


@pytest.mark.parametrize(("name", "joints", "riders"), [("alien", 7, 3), ("raptor", 4, 1)])
def test_the_real_puppets_get_the_right_parents_near_the_places_where_limbs_turn(
    shared_data, name, joints, riders
):
    drawing = make_drawing(layers=open_layers(shared_data / "puppets" / f"{name}-puppet.ora"), vertices=600)
    found = parents(drawing)
    expected = {"alien": {"antenna left": "skull", "antenna right": "skull"}, "raptor": {}}[name]
    rides = {"alien": {"eye left", "eye right", "mouth"}, "raptor": {"eye"}}[name]
    for layer, parent in found.items():
        root_or_rider = None if layer in rides or layer == "body" else "body"
        assert parent == expected.get(layer, root_or_rider)
    assert len(suggest_joints(drawing)) == joints
    assert len(rides) == riders
    for joint in suggest_joints(drawing):
        assert joint.is_proposed
        places = joint.places(drawing.mesh, drawing.mesh.vertices)
        assert np.abs(places[0] - places[1]).max() < 1e-6


@pytest.mark.parametrize("title", PUPPETS)
def test_nine_of_ten_parents_are_right_on_other_puppets(title):
    layers = PUPPETS[title]
    pictures = [Layer(name, *ellipse(*shape)) for name, (shape, _) in layers.items()]
    found = parents(make_drawing(layers=LayeredPicture(SIZE, tuple(pictures)), vertices=300))
    expected = {name: parent for name, (_, parent) in layers.items() if parent != "-"}
    wrong = {name: found[name] for name, parent in expected.items() if found[name] != parent}
    assert len(wrong) <= (1 if len(expected) > 5 else 0), wrong


def test_the_bundled_robot_is_rigged_right():
    drawing = make_drawing(layers=open_layers(resource("assets", "drawings", "robot.ora")), vertices=400)
    assert {name: parent for name, parent in parents(drawing).items() if parent is not None} == {
        "arm upper left": "body",
        "arm lower left": "arm upper left",
        "arm upper right": "body",
        "arm lower right": "arm upper right",
        "leg left": "body",
        "leg right": "body",
        "head": "body",
        "antenna": "head",
    }


def test_hidden_layers_and_flat_drawings_get_no_joints():
    drawing = puppet()
    layers = [set(joint.layers(drawing.mesh)) for joint in suggest_joints(drawing)]
    assert layers == [{ARM, BODY}, {SKULL, BODY}] or layers == [{SKULL, BODY}, {ARM, BODY}]
    assert not {HAT, EYES} & set().union(*layers)
    assert suggest_joints(make_drawing(figure_picture(), vertices=100)) == ()


def test_what_touches_nothing_gets_no_joint():
    apart = LayeredPicture(
        (300, 100),
        (Layer("a", *ellipse(50, 50, 30, 30)), Layer("b", *ellipse(240, 50, 30, 30), (LayerGroup("g"),))),
    )
    assert suggest_joints(make_drawing(layers=apart, vertices=100)) == ()
