"""The current pose as the rest pose: no vertex moves, and it is undone, saved and replayed."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.rest_pose import bake
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion
from akap_editor.io.akap.project import load, save
from tests.support.editor_driver import bits


@pytest.fixture
def bent(pinned):
    """The driver after a drag of its pin 3 upwards."""
    pinned.drag((105.0, 40.0), (95.0, 18.0))
    pinned.editor.session.settle()
    return pinned


def test_no_vertex_and_no_pin_moves(bent):
    session = bent.editor.session
    before, pins, pin_positions = session.state, session.state.pins, session.pin_positions()
    gestures.set_rest_pose(bent.editor)
    assert not session.is_posed
    np.testing.assert_array_equal(session.state.positions, before.positions)
    np.testing.assert_array_equal(session.drawing.mesh.vertices, before.positions)
    np.testing.assert_array_equal(session.pin_positions(), pin_positions)
    assert [(pin.id, pin.face, pin.weights.tolist()) for pin in session.state.pins] == [
        (pin.id, pin.face, pin.weights.tolist()) for pin in pins
    ]
    assert session.pin_error() == 0
    assert not session.is_moving
    assert session.is_modified


def test_the_picture_stays_on_the_mesh(bent):
    before = bent.editor.session.drawing
    gestures.set_rest_pose(bent.editor)
    after = bent.editor.session.drawing
    assert after.image is before.image
    np.testing.assert_array_equal(after.uv, before.uv)
    np.testing.assert_array_equal(after.mesh.faces, before.mesh.faces)
    assert after.mesh.tied == before.mesh.tied
    assert distortion(after.mesh, bent.state.positions).angle == pytest.approx(2)


def test_the_drawing_springs_back_to_the_new_rest_pose(bent):
    gestures.set_rest_pose(bent.editor)
    session = bent.editor.session
    rest_pose = session.state.positions
    session.begin("There and back")
    for target in ((60.0, 70.0), tuple(session.state.pin(3).target)):
        session.apply(SetTargets({3: target}))
        session.settle()
    session.commit()
    assert np.abs(session.state.positions - rest_pose).max() < 1.0
    gestures.reset_pose(bent.editor)
    np.testing.assert_array_equal(session.state.positions, rest_pose)


def test_undo_and_redo_restore_every_bit(bent):
    session = bent.editor.session
    before, drawing = bits(session.state), session.drawing
    gestures.set_rest_pose(bent.editor)
    after, baked = bits(session.state), session.drawing
    assert session.history.undo_label == "Set Rest Pose from Current"
    bent.editor.undo()
    assert bits(session.state) == before
    assert session.drawing is drawing
    assert session.is_posed
    bent.editor.redo()
    assert bits(session.state) == after
    assert session.drawing is baked


def test_after_undo_the_drawing_deforms_from_the_old_rest_pose(new_driver):
    """A drag ends alike with and without a new rest pose that was undone before."""
    ends = []
    for sets_rest_pose in (False, True):
        driver = new_driver()
        for at in ((20.0, 40.0), (105.0, 40.0)):
            driver.click(at)
        driver.drag((105.0, 40.0), (95.0, 18.0))
        driver.editor.session.settle()
        if sets_rest_pose:
            gestures.set_rest_pose(driver.editor)
            driver.editor.undo()
        session = driver.editor.session
        session.begin("Drag")
        session.apply(SetTargets({2: (60.0, 70.0)}))
        session.settle()
        ends.append(session.state.positions)
    np.testing.assert_allclose(ends[0], ends[1], atol=0.01)  # within what a cached factorization may change


def test_at_rest_there_is_nothing_to_undo(pinned):
    depth = pinned.editor.session.history.depth
    gestures.set_rest_pose(pinned.editor)
    assert pinned.editor.session.history.depth == depth


def test_a_pose_with_flipped_faces_is_refused_and_changes_nothing(pinned):
    session = pinned.editor.session
    pose = session.state.positions * [-1.0, 1.0]
    gestures.apply_pose(pinned.editor, session.state.pins, pose)
    before, depth = session.state, session.history.depth
    count = len(session.drawing.mesh.faces)
    with pytest.raises(InputError, match=rf"the right way up, but {count} of {count} are flipped or flat"):
        gestures.set_rest_pose(pinned.editor)
    assert session.state is before
    assert session.history.depth == depth
    assert not session.history.is_open


def test_it_is_saved_and_opened_as_any_drawing(bent, tmp_path):
    gestures.set_rest_pose(bent.editor)
    document = bent.editor.session.document
    opened = load(save(document, tmp_path / "a.akap").path)
    np.testing.assert_array_equal(opened.drawing.mesh.vertices, document.state.positions)
    assert not Session(opened).is_posed


def test_a_recording_is_replayed(bent, drawing):
    gestures.set_rest_pose(bent.editor)
    bent.drag((95.0, 18.0), (90.0, 50.0))
    session = bent.editor.session
    session.settle()
    *_, last = replay(session.recording, drawing)
    np.testing.assert_array_equal(last.state.positions, session.state.positions)
    np.testing.assert_array_equal(last.state.drawing.mesh.vertices, session.drawing.mesh.vertices)


def test_in_the_library(drawing):
    pose = drawing.mesh.vertices @ [[1.2, 0.1], [-0.2, 0.9]]
    document = new_document(drawing)
    document = document.with_state(EditState((), pose, document.state.settings))
    baked = bake(document)
    np.testing.assert_array_equal(baked.drawing.mesh.vertices, pose)
    np.testing.assert_array_equal(baked.state.positions, pose)
    assert baked.revision == document.revision + 1
    np.testing.assert_array_equal(document.drawing.mesh.vertices, drawing.mesh.vertices)
