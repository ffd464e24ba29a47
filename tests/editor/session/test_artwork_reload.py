"""Artwork that was painted anew: pins, joints, poses and stiffness stay, layer by layer."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.editor.session.artwork_reload import reload_layers, with_artwork
from akap_editor.editor.session.edits import (
    AddPose,
    ReloadArtwork,
    SetJoints,
    SetKeyframe,
    SetRestPose,
    SetStiffness,
    SetTargets,
)
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import signed_areas
from akap_editor.layers.layered_picture import Layer, LayeredPicture
from tests.support.editor_driver import Ticks, bits
from tests.support.layered_files import filled
from tests.support.pictures import figure_picture
from tests.support.puppets import ARM, BODY, EYES, HAT, SKULL, disc, puppet, puppet_layers


def artwork(*, without=(), more=(), **changes):
    """The layers of the puppet with some changed, by name, some left out, and more on top."""
    layers = [
        replace(layer, **changes.get(layer.name, {}))
        for layer in puppet_layers().layers
        if layer.name not in without
    ]
    return LayeredPicture(puppet_layers().size, (*layers, *more))


@pytest.fixture
def session():
    """The puppet with joints, four pins, a named pose, two keyframes and stiffness, in a pose."""
    drawing = puppet()
    session = Session(new_document(drawing), Ticks())
    session.begin("Rig")
    session.apply(SetJoints(suggest_joints(drawing)))
    session.apply(SetStiffness(1.0 + drawing.mesh.face_layers))
    session.apply(SetKeyframe(0.0))
    for place in ((80.0, 155.0), (66.0, 160.0), (150.0, 118.0), (80.0, 40.0)):
        add_pin(session, place)
    session.apply(SetTargets({3: (140.0, 95.0), 4: (92.0, 36.0)}))
    session.settle()
    session.apply(AddPose("wave"))
    session.apply(SetKeyframe(1.0))
    session.commit()
    return session


def reloaded(session, picture):
    session.begin("Reload Artwork")
    session.apply(ReloadArtwork(picture))
    session.commit()
    return session


def part(drawing, pose, name):
    """The pose of a layer's vertices."""
    number = [layer.name for layer in drawing.layers].index(name)
    return pose[drawing.mesh.layers == number]


def test_the_same_artwork_changes_no_bit(session):
    before = session.state
    mesh = session.drawing.mesh
    reloaded(session, artwork())
    np.testing.assert_array_equal(session.drawing.mesh.vertices, mesh.vertices)
    np.testing.assert_array_equal(session.drawing.mesh.faces, mesh.faces)
    np.testing.assert_array_equal(session.state.positions, before.positions)
    np.testing.assert_array_equal(session.state.stiffness, before.stiffness)
    assert [joint.faces for joint in session.state.joints] == [joint.faces for joint in before.joints]


def test_a_layer_painted_anew_gets_another_mesh_and_the_others_keep_theirs(session):
    before, old = session.state, session.drawing
    wider = filled(78, 24, 10, 80, 200)
    reloaded(session, artwork(arm={"picture": wider, "offset": (82, 107)}))
    state, drawing = session.state, session.drawing
    for name in ("body", "skull", "eyes", "hat"):
        np.testing.assert_array_equal(part(drawing, state.positions, name), part(old, before.positions, name))
    assert len(part(drawing, state.positions, "arm")) == pytest.approx(
        len(part(old, before.positions, "arm")), rel=0.4
    )
    assert signed_areas(state.positions, drawing.mesh.faces).min() > 0
    assert [pin.id for pin in state.pins] == [1, 2, 3, 4]
    assert state.pin_error(drawing.mesh) < 0.5
    assert [pose.name for pose in state.poses] == ["wave"]
    assert state.animation.times == (0.0, 1.0) or list(state.animation.times) == [0.0, 1.0]
    np.testing.assert_array_equal(state.stiffness, 1.0 + drawing.mesh.face_layers)
    for joint in state.joints:
        places = joint.places(drawing.mesh, state.positions)
        assert np.abs(places[0] - places[1]).max() < 0.5
    assert len(state.joints) == 2
    session.settle()
    assert session.state.pin_error(drawing.mesh) < 0.25


def test_a_layer_that_was_moved_moves_with_its_pins_and_its_mesh(session):
    old, before = session.drawing, session.state
    reloaded(session, artwork(eyes={"offset": (58, 54)}))
    drawing, state = session.drawing, session.state
    rest = part(drawing, drawing.mesh.vertices, "eyes") - part(old, old.mesh.vertices, "eyes")
    np.testing.assert_array_equal(rest, np.broadcast_to([0, 8], rest.shape))
    moved = part(drawing, state.positions, "eyes") - part(old, before.positions, "eyes")
    np.testing.assert_allclose(np.linalg.norm(moved, axis=1), 8, atol=1e-9)
    np.testing.assert_array_equal(part(drawing, state.positions, "arm"), part(old, before.positions, "arm"))
    assert state.pin_error(drawing.mesh) < 0.25


def test_removed_and_new_layers(session):
    beak = Layer("beak", disc(7, 250, 200, 0), (74, 66))
    reloaded(session, artwork(without=("arm",), more=(beak,)))
    drawing, state = session.drawing, session.state
    assert [layer.name for layer in drawing.layers] == ["body", "skull", "eyes", "hat", "beak"]
    assert drawing.layer_order == (0, 1, 2, 3, 4)
    assert [pin.id for pin in state.pins] == [1, 2, 4]
    assert [joint.layers(drawing.mesh) for joint in state.joints] == [(1, 0)]
    shift = part(drawing, state.positions, "beak") - part(drawing, drawing.mesh.vertices, "beak")
    assert np.linalg.norm(shift, axis=1).min() > 3  # it goes with the head
    assert signed_areas(state.positions, drawing.mesh.faces).min() > 0


def test_the_list_and_renamed_layers_stay():
    drawing = puppet()
    layers = list(drawing.layers)
    layers[HAT] = replace(layers[HAT], visible=True, opacity=0.5)
    drawing = replace(drawing, layers=tuple(layers), layer_order=(1, 0, 2, 3, 4))
    new, origins = reload_layers(drawing, artwork(arm={"name": "arm of the left side"}))
    assert new.layer_order == (1, 0, 2, 3, 4)
    assert origins.layers.tolist() == [BODY, ARM, SKULL, EYES, HAT]
    assert origins.is_same.all()
    assert (new.layers[HAT].visible, new.layers[HAT].opacity) == (True, 0.5)
    assert new.layers[ARM].name == "arm"


def test_two_layers_of_one_name_are_told_apart_by_their_order():
    two = artwork(more=(Layer("hat", disc(9, 1, 2, 3), (20, 20)),))
    drawing = make_drawing(layers=two, vertices=400)
    _, origins = reload_layers(drawing, two)
    assert origins.layers.tolist() == [0, 1, 2, 3, 4, 5]


def test_it_is_undone_recorded_and_replayed(session):
    before = session.state
    reloaded(session, artwork(arm={"picture": filled(78, 24, 10, 80, 200), "offset": (82, 107)}))
    after = session.state
    session.undo()
    assert session.state is before
    session.redo()
    assert session.state is after
    *_, last = replay(session.recording, puppet())
    assert bits(last.state) == bits(after)


def test_a_flat_picture_painted_anew():
    image = figure_picture()
    session = Session(new_document(make_drawing(image, vertices=200, name="figure")), Ticks())
    session.begin("Bend")
    add_pin(session, (20.0, 40.0))
    add_pin(session, (105.0, 40.0))
    session.apply(SetTargets({2: (100.0, 50.0)}))
    session.settle()
    painted = image.copy()
    painted[..., 0] = 255 - painted[..., 0]
    before = session.state.positions
    session.apply(
        ReloadArtwork(LayeredPicture((image.shape[1], image.shape[0]), (Layer("figure", painted),)))
    )
    assert np.abs(session.state.positions - before).max() < 1e-6
    assert (session.drawing.image[..., 0][painted[..., 3] > 0] == painted[..., 0][painted[..., 3] > 0]).all()
    assert len(session.state.pins) == 2


def test_what_cannot_be_reloaded_is_refused(session):
    nothing = LayeredPicture((9, 9), (Layer("a", filled(9, 9, 1, 2, 3) * 0),))
    with pytest.raises(InputError, match="fully transparent"):
        with_artwork(session.state, session.drawing, nothing)
    session.begin("Bake")
    session.apply(SetRestPose())
    session.commit()
    with pytest.raises(InputError, match="lies on its picture"):
        with_artwork(session.state, session.drawing, artwork())
