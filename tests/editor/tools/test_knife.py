"""The knife: strokes become slits, are undone, removed and kept; the pose is carried over."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.background_remesh import BackgroundRemesh
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.tools.knife import cut_at, cuts_of, cuts_on_screen, rest_place
from akap_editor.geometry.mesh import signed_areas
from akap_editor.io.akap.project import decode_document, encode_document
from akap_editor.overlap.face_pairs import overlapping_faces
from akap_editor.overlap.topology import mesh_topology
from tests.support.editor_driver import Driver, bits, replayed_state
from tests.support.puppets import puppet

SIDE = 120


def rotation(angle):
    """The matrix of a rotation by an angle in radians."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


@pytest.fixture(scope="module")
def square():
    """Two legs that touch along the middle."""
    image = np.zeros((SIDE, SIDE, 4), np.uint8)
    image[10:110, 10:110] = 200, 120, 60, 255
    return make_drawing(image, vertices=300, name="trousers")


@pytest.fixture
def knife(square):
    driver = Driver(new_document(square))
    driver.editor.chosen_tool = driver.editor.knife_tool
    driver.remesh = BackgroundRemesh(driver.editor)
    return driver


def cut(driver, *points):
    driver.press(points[0])
    for point in points[1:]:
        driver.move(point)
    driver.release(points[-1])
    driver.remesh.advance()
    driver.remesh.finish()


def test_a_stroke_is_one_entry_of_the_history_and_is_replayed(knife, square):
    before = bits(knife.state)
    cut(knife, (60, 118), (60, 80), (60, 40))
    assert knife.session.history.labels == ["Cut"]
    assert cuts_of(knife.session.drawing) == (((60.0, 118.0), (60.0, 40.0)),)
    assert knife.session.drawing.mesh.is_cut
    state = replayed_state(knife.session.recording, square)
    assert bits(state) == bits(knife.session.state)
    knife.session.undo()
    assert bits(knife.state) == before
    knife.session.redo()
    data = encode_document(knife.session.document)
    again = decode_document(data)
    assert encode_document(again) == data
    assert cuts_of(again.drawing) == cuts_of(knife.session.drawing)
    assert again.drawing.mesh.is_cut


def test_legs_come_apart_and_the_pose_stays_when_the_density_changes(knife):
    cut(knife, (60, 118), (60, 40))
    left, right = (gestures.add_pin(knife.editor, point) for point in ((30.0, 105.0), (90.0, 105.0)))
    gestures.add_pin(knife.editor, (60.0, 15.0))
    gestures.move_pin(knife.editor, left, (20.0, 105.0))
    gestures.move_pin(knife.editor, right, (100.0, 105.0))
    knife.session.settle()
    mesh, pose = knife.session.drawing.mesh, knife.state.positions
    lips = np.flatnonzero(np.abs(mesh.vertices - [60, 112]).max(axis=1) < 1e-6)
    assert len(lips) == 2
    gap = abs(np.diff(pose[lips, 0])[0])
    assert gap > 15
    knife.remesh.request(replace(knife.remesh.meshing, vertices=600))
    knife.remesh.finish()
    mesh, pose = knife.session.drawing.mesh, knife.state.positions
    assert cuts_of(knife.session.drawing)
    assert len(mesh.vertices) > 500
    lips = np.flatnonzero(np.abs(mesh.vertices - [60, 112]).max(axis=1) < 1e-6)
    assert abs(np.diff(pose[lips, 0])[0]) == pytest.approx(gap, abs=0.5)
    assert signed_areas(pose, mesh.faces).min() > 0
    assert knife.session.pin_error() < 0.5


def test_lips_that_touch_do_not_overlap(knife):
    cut(knife, (60, 118), (60, 40), (75, 30))
    mesh = knife.session.drawing.mesh
    topology = mesh_topology(mesh)
    for angle in np.linspace(0, 6, 13):
        pose = mesh.vertices @ rotation(angle).T + [300 * angle, -200 * angle]
        assert len(overlapping_faces(topology, pose)) == 0
    centers = mesh.vertices[mesh.faces].mean(axis=1)
    left = np.unique(mesh.faces[(centers[:, 0] < 60) & (centers[:, 1] > 40)])
    crossed = mesh.vertices.copy()
    crossed[left, 0] += 0.2 * np.maximum(mesh.vertices[left, 1] - 40, 0)
    assert len(overlapping_faces(topology, crossed)) > 0


def test_a_stroke_is_seen_found_and_removed(knife):
    cut(knife, (60, 118), (60, 40))
    camera = knife.editor.camera
    assert len(cuts_on_screen(knife.editor)[0]) == 2  # both lips
    assert cut_at(knife.editor, camera.to_screen((60.0, 70.0))) == 0
    assert cut_at(knife.editor, camera.to_screen((30.0, 70.0))) is None
    knife.key("alt")
    knife.click((30, 70))
    knife.remesh.advance()
    assert len(cuts_of(knife.session.drawing)) == 1
    knife.click((60, 70))
    knife.remesh.advance()
    knife.remesh.finish()
    assert cuts_of(knife.session.drawing) == ()
    assert knife.session.history.labels == ["Cut", "Remove Cut"]


def test_a_stroke_in_a_pose_cuts_what_is_seen_there(knife):
    mesh = knife.session.drawing.mesh
    gestures.set_pose(knife.editor, mesh.vertices @ rotation(0.5).T + [40.0, -10.0])
    at = rotation(0.5) @ [60, 114] + [40, -10], rotation(0.5) @ [60, 40] + [40, -10]
    cut(knife, *(tuple(point.tolist()) for point in at))
    np.testing.assert_allclose(cuts_of(knife.session.drawing)[0], [[60, 114], [60, 40]], atol=0.5)


def test_beside_the_drawing_a_point_goes_with_the_nearest_vertex(square):
    pose = square.mesh.vertices @ rotation(0.7).T + [5.0, 9.0]
    for point in ([60.0, 60.0], [60.0, 118.0], [-5.0, 20.0]):
        x, y = rotation(0.7) @ point + [5.0, 9.0]
        np.testing.assert_allclose(rest_place(square.mesh, pose, (x, y)), point, atol=1e-6)


def test_escape_and_drawings_in_layers_leave_everything_as_it_is(knife):
    before = bits(knife.state)
    knife.press((60, 118))
    knife.move((60, 60))
    assert knife.editor.tool.markers.cut_stroke
    knife.editor.cancel()
    knife.remesh.advance()
    assert bits(knife.state) == before
    layered = Driver(new_document(puppet()))
    layered.editor.chosen_tool = layered.editor.knife_tool
    layered.press((80, 150))
    layered.move((80, 100))
    layered.release((80, 100))
    assert layered.editor.knife_tool.request is None
    assert "flat drawings" in layered.editor.knife_tool.press_hint
