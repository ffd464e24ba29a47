"""Crossings and depths of pins: order of faces, clicks on overlapping parts, undo, files and replays."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.crossings import depth_at, depth_order, overlaps_of
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.pin import MAX_DEPTH, Pin
from akap_editor.editor.editor import Editor
from akap_editor.editor.session.edits import Remesh, SetPose
from akap_editor.editor.session.recording import parse_recording
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import signed_areas
from akap_editor.io.akap.project import load, save
from akap_editor.io.images import read_image
from tests.support.bends import rope_with_seam
from tests.support.editor_driver import bits

HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def pins_at(mesh, *places):
    """Pins on a mesh at places (x, y, depth), with ids from 1."""
    points = mesh.locate([(x, y) for x, y, _ in places])
    return tuple(
        Pin(index, int(face), weights, (x, y), depth)
        for index, (face, weights, (x, y, depth)) in enumerate(
            zip(points.faces, points.weights, places, strict=True), start=1
        )
    )


def rank(order):
    """The position of each face in an order."""
    result = np.empty(len(order), dtype=int)
    result[order] = np.arange(len(order))
    return result


# -- order of faces ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("depths", [(), (0,), (0, 0), (3, 3)])
def test_without_differences_the_order_is_that_of_the_mesh(drawing, depths):
    places = [(*at, depth) for at, depth in zip((HEAD, END), depths, strict=False)]
    assert depth_order(drawing.mesh, pins_at(drawing.mesh, *places)) is None


@pytest.mark.parametrize("sign", [1, -1])
def test_faces_near_the_higher_pin_come_last(drawing, sign):
    mesh = drawing.mesh
    pins = pins_at(mesh, (*HEAD, 0), (*END, sign))
    order = depth_order(mesh, pins)
    assert sorted(order) == list(range(len(mesh.faces)))
    at_head, at_end = (rank(order)[pin.face] for pin in pins)
    assert (at_end > at_head) == (sign > 0)
    x = mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    low, high = rank(order)[x < 35], rank(order)[x > 95]
    assert high.min() > low.max() if sign > 0 else high.max() < low.min()


def test_faces_of_one_level_keep_the_order_of_the_mesh(drawing):
    mesh = drawing.mesh
    order = depth_order(mesh, pins_at(mesh, (*HEAD, 0), (*END, 1)))
    runs = np.split(order, np.flatnonzero(np.diff(order) < 0) + 1)
    assert len(runs) <= 5, "levels of a quarter from 0 to 1"


def test_the_order_depends_on_differences_only_and_not_on_targets(drawing):
    mesh = drawing.mesh
    first = pins_at(mesh, (*HEAD, 0), (*NECK, 2), (*END, -1))
    moved = tuple(Pin(pin.id, pin.face, pin.weights, pin.target + 9, pin.depth) for pin in first)
    shifted = tuple(Pin(pin.id, pin.face, pin.weights, pin.target, pin.depth + 5) for pin in first)
    assert depth_order(mesh, moved) is depth_order(mesh, first)
    np.testing.assert_array_equal(depth_order(mesh, shifted), depth_order(mesh, first))


def test_depth_is_exact_at_pins_and_blended_between_them(drawing):
    mesh = drawing.mesh
    pins = pins_at(mesh, (*HEAD, -4), (*END, 4))
    points = [mesh.locate([at]) for at in (HEAD, END, NECK)]
    assert depth_at(mesh, pins, points[0]) == -4
    assert depth_at(mesh, pins, points[1]) == 4
    assert abs(depth_at(mesh, pins, points[2])) < 2
    assert depth_at(mesh, (), points[0]) == 0


def test_parts_without_a_pin_have_the_depth_of_the_nearest_one(image):
    two_parts = np.zeros((80, 250, 4), dtype=np.uint8)
    two_parts[:, :120], two_parts[:, 130:] = image, image
    mesh = make_drawing(two_parts, vertices=200).mesh
    assert mesh.component.max() == 1
    pins = pins_at(mesh, (*HEAD, 0), (*END, 2))
    order = rank(depth_order(mesh, pins))
    second = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 130
    assert order[second].min() > order[pins[0].face]


# -- editing -----------------------------------------------------------------------------------------------


def test_forward_and_back_are_one_entry_each_and_move_nothing(pinned):
    pinned.editor.select({2, 3})
    before, depth = bits(pinned.state), pinned.depth
    pose = pinned.state.positions
    gestures.shift_depths(pinned.editor, 1)
    assert [pin.depth for pin in pinned.state.pins] == [0, 1, 1]
    gestures.set_depth(pinned.editor, 3, -5)
    assert [pin.depth for pin in pinned.state.pins] == [0, 1, -5]
    assert pinned.state.positions is pose
    assert pinned.session.history.labels[depth:] == ["Raise Depth", "Set Depth"]
    pinned.undo()
    pinned.undo()
    assert bits(pinned.state) == before


def test_a_depth_out_of_range_changes_nothing(pinned):
    before = pinned.everything
    with pytest.raises(InputError, match="depth of pin 2"):
        gestures.set_depth(pinned.editor, 2, MAX_DEPTH + 1)
    assert pinned.everything == before


def test_a_new_pin_takes_the_depth_of_the_place(pinned):
    gestures.set_depth(pinned.editor, 3, 4)
    added = gestures.add_pin(pinned.editor, (103.0, 45.0))
    assert pinned.state.pin(added).depth == 4
    added = gestures.add_pin(pinned.editor, (18.0, 45.0))
    assert pinned.state.pin(added).depth == 0


def fold(mesh):
    """A pose with the right half of the neck moved over the head; the faces between are flipped."""
    pose = mesh.vertices.copy()
    pose[:, 0] = np.where(pose[:, 0] > 62, pose[:, 0] - 62 + 5 + 0.2 * (pose[:, 0] - 62), pose[:, 0])
    return pose


def test_a_click_hits_the_part_in_front(drawing):
    mesh, pose = drawing.mesh, fold(drawing.mesh)
    faces = mesh.faces
    areas = signed_areas(pose, faces)
    at_end = mesh.locate([END])
    point = mesh.evaluate(at_end, pose)[0]
    for depth in (5, -5):
        order = depth_order(mesh, pins_at(mesh, (*HEAD, 0), (*END, depth)))
        hit = mesh.find(point, pose, order)
        x = mesh.vertices[faces[hit.faces[0]]].mean(axis=0)[0]
        assert (x > 62) == (depth > 0), (areas.min(), x)
        np.testing.assert_allclose(mesh.evaluate(hit, pose)[0], point, atol=1e-9)


# -- files -------------------------------------------------------------------------------------------------


def test_depths_are_saved_recorded_and_replayed(pinned, drawing, tmp_path):
    gestures.set_depth(pinned.editor, 2, 7)
    gestures.set_depth(pinned.editor, 3, -2)
    pinned.drag(END, (95.0, 55.0))
    pinned.settle()
    save(pinned.session.document, tmp_path / "deep.akap")
    again = load(tmp_path / "deep.akap")
    assert [pin.depth for pin in again.state.pins] == [0, 7, -2]
    np.testing.assert_array_equal(again.face_order, pinned.session.document.face_order)
    *_, last = replay(parse_recording(pinned.session.recording.to_text()), drawing)
    assert bits(last.state) == bits(pinned.state)


def test_a_cartoon_limb_changes_sides(shared_data):
    drawing = make_drawing(read_image(shared_data / "noto" / "dancer.png"), vertices=2000)
    editor = Editor()
    editor.open(new_document(drawing))
    vertices = drawing.mesh.vertices
    low, high = vertices[np.argmin(vertices[:, 0])], vertices[np.argmax(vertices[:, 0])]
    pins = [gestures.add_pin(editor, tuple(at)) for at in (low, high)]
    for depth in (1, -1):
        gestures.set_depth(editor, pins[1], depth)
        order = rank(editor.session.document.face_order)
        faces = [editor.session.state.pin(pin).face for pin in pins]
        assert (order[faces[1]] > order[faces[0]]) == (depth > 0)


# -- crossings -----------------------------------------------------------------------------------------------


@pytest.fixture
def folded(pinned):
    """The end of the figure is dragged over its head."""
    pinned.drag(END, (22.0, 46.0), steps=8)
    pinned.settle()
    assert len(pinned.state.crossings)
    return pinned


def in_front(driver, near):
    """Whether what is near to an end of the rest pose is above in all overlapping pairs it is part of."""
    mesh, state = driver.session.drawing.mesh, driver.state
    low, high = overlaps_of(mesh, state.pins, state.positions, state.crossings).low_and_high
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    is_above = np.abs(middles[high] - near).sum(axis=1) < np.abs(middles[low] - near).sum(axis=1)
    return bool(is_above.mean() > 0.9)


def test_what_is_dragged_passes_in_front_of_what_it_meets(folded):
    assert in_front(folded, END)
    order = rank(folded.session.document.face_order)
    mesh, state = folded.session.drawing.mesh, folded.state
    low, high = overlaps_of(mesh, state.pins, state.positions, state.crossings).low_and_high
    assert (order[low] < order[high]).all()


def test_a_limb_is_sent_to_the_back_stays_there_and_comes_back_by_undo(folded):
    crossings = folded.state.crossings
    folded.editor.select({3})
    gestures.order_limb(folded.editor, False)
    assert folded.session.history.undo_label == "Send Limb to Back"
    assert in_front(folded, HEAD)
    folded.drag(folded.where(3), (26.0, 44.0), steps=4)
    folded.settle()
    assert in_front(folded, HEAD), "what was asked for stays"
    folded.undo()
    folded.undo()
    assert folded.state.crossings is crossings
    depth = folded.depth
    gestures.order_limb(folded.editor, True)
    assert folded.depth == depth, "it is in front already"


def test_crossings_are_saved_recorded_and_replayed(folded, drawing, tmp_path):
    folded.editor.select({3})
    gestures.order_limb(folded.editor, False)
    gestures.add_pose(folded.editor, "folded")
    folded.drag(folded.where(3), (30.0, 47.0), steps=3)
    folded.settle()
    save(folded.session.document, tmp_path / "folded.akap")
    again = load(tmp_path / "folded.akap")
    assert bits(again.state) == bits(folded.state)
    np.testing.assert_array_equal(again.state.crossings, folded.state.crossings)
    *_, last = replay(parse_recording(folded.session.recording.to_text()), drawing)
    assert bits(last.state) == bits(folded.state)
    opened = Editor()
    opened.open(again)
    *_, last = replay(parse_recording(opened.session.recording.to_text()), again.drawing)
    np.testing.assert_array_equal(last.state.crossings, folded.state.crossings)


def test_a_seam_is_the_same_after_saving_undo_and_replay(tmp_path):
    document = rope_with_seam()
    drawing, state = document.drawing, document.state
    session = Session(new_document(drawing))
    session.begin("Tie")
    session.apply(SetPose(state.positions, state.crossings))
    session.commit()
    save(session.document, tmp_path / "rope.akap")
    *_, replayed = replay(parse_recording(session.recording.to_text()), drawing)
    session.undo()
    assert session.document.draw_order is None
    session.redo()
    expected = document.draw_order
    assert len(expected.edges) > 2
    for other in (load(tmp_path / "rope.akap"), document.with_state(replayed.state), session.document):
        found = other.draw_order
        np.testing.assert_array_equal(found.faces, expected.faces)
        np.testing.assert_array_equal(found.values(other.state.positions), expected.values(state.positions))


def test_another_mesh_keeps_what_is_in_front(folded):
    folded.editor.select({3})
    gestures.order_limb(folded.editor, False)
    gestures.add_pose(folded.editor, "folded")
    folded.editor.apply("Mesh", Remesh(replace(folded.session.drawing.meshing, vertices=200)))
    assert in_front(folded, HEAD)
    state, mesh = folded.state, folded.session.drawing.mesh
    assert state.poses[0].crossings.max() < len(mesh.faces)
    assert len(state.poses[0].crossings)


def test_the_wheel_brings_what_is_dragged_to_the_front_and_back(folded):
    x, y = folded.where(3)
    zoom = folded.editor.camera.zoom
    folded.press((x, y))
    folded.move((x + 8, y))
    assert "wheel" in folded.editor.tool.hint
    folded.scroll((x + 8, y), -1.0)
    assert in_front(folded, HEAD)
    assert folded.editor.camera.zoom == zoom
    folded.scroll((x + 8, y), 1.0)
    assert in_front(folded, END)
    folded.key("escape")
