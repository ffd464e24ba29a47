"""Drawings in layers: depths, crossings, clicks, other meshes and recordings stay within the layers."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.document.crossings import face_depths, face_order, overlaps_of
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing, Meshing, make_drawing, visible_point
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.remesh import remesh_drawing, transfer_state
from akap_editor.editor.session import pin_edits
from akap_editor.editor.session.edits import Remesh, SetTargets
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import signed_areas
from akap_editor.layers.layered_picture import LayeredPicture
from tests.support.layered_files import filled
from tests.support.meshers import needs_triangle
from tests.support.puppets import ARM, BODY, EYES, HAT, SKULL, puppet, puppet_layers

DRAWING = puppet()
MESH = DRAWING.mesh


def pin(pin_id, layer, place, depth=0):
    point = MESH.locate([place], layers=[layer])
    return Pin(pin_id, int(point.faces[0]), point.weights[0], np.array(place, dtype=float), depth)


def layer_at(place, drawing=DRAWING, unlocked=False):
    document = new_document(drawing)
    point = visible_point(drawing, place, drawing.mesh.vertices, document.face_order, unlocked)
    return None if point is None else int(drawing.face_layers[point.faces[0]])


def with_layer(layer, **changes):
    layers = list(DRAWING.layers)
    layers[layer] = replace(layers[layer], **changes)
    return replace(DRAWING, layers=tuple(layers))


def test_layers_do_not_cross_one_another():
    pins = (pin(1, BODY, (80, 160)),)
    overlaps = overlaps_of(MESH, pins, MESH.vertices, new_document(DRAWING).state.crossings)
    assert len(overlaps) == 0
    shown = with_layer(HAT, visible=True)
    assert face_order(shown, pins, MESH.vertices, new_document(shown).state.crossings) is None


def test_a_pin_lifts_its_own_layer_only_and_nothing_across_layers():
    pins = (pin(1, SKULL, (80, 60), depth=2), pin(2, BODY, (80, 160)))
    depths = face_depths(MESH, pins)
    means = [depths[MESH.face_layers == layer].mean() for layer in range(5)]
    assert means == [0, 0, 8, 0, 0]
    order = face_order(DRAWING, pins, MESH.vertices, new_document(DRAWING).state.crossings)
    assert (np.diff(MESH.face_layers[order]) >= 0).all()


def test_depths_order_the_faces_within_a_layer():
    pins = (pin(1, ARM, (90, 120), depth=3), pin(2, ARM, (150, 120)))
    order = face_order(DRAWING, pins, MESH.vertices, new_document(DRAWING).state.crossings)
    assert (np.diff(MESH.face_layers[order]) >= 0).all()
    own = order[MESH.face_layers[order] == ARM]
    x = MESH.vertices[MESH.faces[own]].mean(axis=1)[:, 0]
    assert x[: len(x) // 3].mean() > x[-len(x) // 3 :].mean() + 20  # the end with depth 3 is drawn last


@pytest.mark.parametrize(
    ("place", "drawing", "layer"),
    [
        ((66, 54), DRAWING, EYES),
        ((80, 54), DRAWING, SKULL),  # between the eyes, where their layer is transparent
        ((80, 40), DRAWING, SKULL),  # below the hidden hat
        ((80, 40), with_layer(HAT, visible=True), SKULL),
        ((80, 15), with_layer(HAT, visible=True), HAT),
        ((80, 160), DRAWING, BODY),
        ((90, 120), DRAWING, ARM),
        ((90, 120), replace(DRAWING, layer_order=(1, 0, 2, 3, 4)), BODY),
        ((90, 120), with_layer(ARM, visible=False), BODY),
        ((90, 120), with_layer(SKULL, solo=True), None),
        ((59, 160), DRAWING, BODY),  # on the margin around the visible pixels
        ((10, 10), DRAWING, None),
    ],
)
def test_a_click_takes_what_is_seen(place, drawing, layer):
    assert layer_at(place, drawing) == layer


def test_a_click_goes_through_locked_layers():
    locked = with_layer(ARM, locked=True)
    assert layer_at((90, 120), locked) == ARM
    assert layer_at((90, 120), locked, unlocked=True) == BODY
    assert layer_at((150, 120), locked, unlocked=True) is None


def posed_session(drawing=DRAWING):
    session = Session(new_document(drawing), clock=lambda: 0.0)
    session.begin("Pose")
    for place in ((80, 160), (80, 50), (150, 120)):
        pin_edits.add_pin(session, place)
    session.apply(SetTargets({2: (95.0, 40.0), 3: (140.0, 90.0)}))
    session.settle()
    session.commit()
    return session


@needs_triangle
def test_another_mesh_takes_over_pose_pins_and_stiffness_layer_by_layer():
    session = posed_session()
    state = session.state
    stiffness = 1.0 + MESH.face_layers
    drawing = remesh_drawing(DRAWING, replace(DRAWING.meshing, vertices=900, expand=3.0))
    moved = transfer_state(replace(state, stiffness=stiffness), MESH, drawing)
    mesh = drawing.mesh
    assert len(mesh.vertices) > 1.8 * len(MESH.vertices)
    assert [layer.name for layer in drawing.layers] == [layer.name for layer in DRAWING.layers]
    np.testing.assert_array_equal(moved.stiffness, 1.0 + mesh.face_layers)
    assert [mesh.face_layers[p.face] for p in moved.pins] == [MESH.face_layers[p.face] for p in state.pins]
    offsets = mesh.evaluate(moved.points, moved.positions) - MESH.evaluate(state.points, state.positions)
    assert np.abs(offsets).max() < 0.5
    assert signed_areas(moved.positions, mesh.faces).min() > 0
    for layer in range(5):
        centers = [
            pose[which == layer].mean(axis=0)
            for pose, which in ((moved.positions, mesh.layers), (state.positions, MESH.layers))
        ]
        assert np.abs(centers[0] - centers[1]).max() < 4


def test_recordings_replay_on_the_same_mesh_to_the_bit_and_on_another_one_on_the_same_layers():
    session = posed_session()
    *_, same = replay(session.recording, DRAWING)
    np.testing.assert_array_equal(same.state.positions, session.state.positions)
    other = make_drawing(layers=puppet_layers(), vertices=600, name="puppet")
    *_, last = replay(session.recording, other)
    layers = [other.mesh.face_layers[each.face] for each in last.state.pins]
    assert layers == [MESH.face_layers[each.face] for each in session.state.pins]


def test_remeshing_is_recorded_undone_and_keeps_the_list():
    session = posed_session(with_layer(HAT, visible=True))
    before = session.state
    session.begin("Change Mesh")
    session.apply(Remesh(Meshing(vertices=700)))
    session.commit()
    assert session.drawing.layers[HAT].visible
    session.undo()
    assert session.state is before


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"layers": DRAWING.layers[:3]}, "expected one for each layer of the mesh, 5, got 3"),
        ({"layer_order": (0, 1, 2, 3, 3)}, "expected each of 5 layers once"),
        ({"layers": (), "layer_order": (), "canvas": None}, "expected one for each layer of the mesh"),
        ({"canvas": None}, "canvas: expected a size"),
    ],
)
def test_layers_that_do_not_fit_the_mesh_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        replace(DRAWING, **values)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "expected either a picture or layers"),
        ({"image": filled(9, 9, 1, 2, 3), "layers": puppet_layers()}, "expected either a picture or layers"),
        ({"layers": puppet_layers(), "background": 0.1}, "background: expected None"),
        ({"layers": filled(9, 9, 1, 2, 3)}, "layers: expected a LayeredPicture"),
    ],
)
def test_drawings_are_made_of_a_picture_or_of_layers(arguments, message):
    with pytest.raises(InputError, match=message):
        make_drawing(**arguments)
    nothing = LayeredPicture((9, 9), tuple(replace(x, picture=x.picture * 0) for x in puppet_layers().layers))
    with pytest.raises(InputError, match="fully transparent"):
        make_drawing(layers=nothing)


def test_the_layers_a_drawing_was_made_of_share_the_pixels_of_its_texture():
    layers, originals = puppet_layers(), puppet_layers()
    drawing = make_drawing(layers=layers, vertices=600)
    for layer, original in zip(layers.layers, originals.layers, strict=True):
        assert np.shares_memory(layer.picture, drawing.image)
        np.testing.assert_array_equal(layer.picture, original.picture)
    again = make_drawing(layers=layers, vertices=600)
    np.testing.assert_array_equal(again.image, drawing.image)


def test_a_new_layer_list_shares_mesh_and_texture():
    drawing = with_layer(ARM, visible=False)
    assert isinstance(drawing, Drawing)
    assert drawing.image is DRAWING.image
    assert drawing.uv is DRAWING.uv
    assert drawing.mesh is MESH
