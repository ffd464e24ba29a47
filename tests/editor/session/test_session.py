"""Sessions: steps, edits, gestures, undo, and what counts as modified."""

from unittest.mock import ANY

import numpy as np
import pytest

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.deform.methods import method_names
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import ResetPose, SetPose, SetSettings, SetTargets
from akap_editor.editor.session.pin_edits import add_pin, remove_pins
from akap_editor.editor.session.session import Session
from akap_editor.editor.session.stepper import PIN_TOLERANCE
from akap_editor.errors import InputError, SolverError
from tests.support.editor_driver import Ticks, bits


@pytest.fixture
def session(drawing):
    """A session with pins 1 and 2, added in one gesture."""
    session = Session(new_document(drawing), Ticks())
    session.begin("Pins")
    assert add_pin(session, (20.0, 40.0)) == 1
    assert add_pin(session, (105.0, 40.0)) == 2
    session.commit()
    return session


def test_only_step_moves_the_drawing(session, drawing):
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (90.0, 65.0)}))
    assert session.state.positions is drawing.mesh.vertices
    assert session.is_moving
    session.step()
    assert not np.array_equal(session.state.positions, drawing.mesh.vertices)


def test_each_step_brings_pins_nearer_until_they_arrive(session):
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (90.0, 65.0)}))
    errors = [session.pin_error()]
    while session.is_moving:
        session.step()
        errors.append(session.pin_error())
    traveling = [error for error in errors if error > 1.0]
    assert traveling == sorted(traveling, reverse=True)
    assert errors[-1] < PIN_TOLERANCE


def test_targets_that_are_reached_already_move_nothing_noticeable(session, drawing):
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (105.0, 40.0)}))
    session.settle()
    np.testing.assert_allclose(session.state.positions, drawing.mesh.vertices, atol=0.01)


def test_steps_without_pins_move_nothing(drawing):
    session = Session(new_document(drawing), Ticks())
    session.step()
    np.testing.assert_array_equal(session.state.positions, drawing.mesh.vertices)
    assert not session.is_moving


def test_a_gesture_that_changed_nothing_makes_no_entry(session):
    session.begin("Nothing")
    session.commit()
    assert session.history.depth == 1
    assert session.history.undo_label == "Pins"


@pytest.mark.parametrize(
    ("targets", "message"),
    [
        ({7: (1.0, 2.0)}, r"expected ids of pins \[1, 2\], got 7"),
        ({1: (np.nan, 2.0)}, "finite"),
        ({1: (1.0, 2.0, 3.0)}, "shape"),
        ({1: 5.0}, "shape"),
    ],
)
def test_bad_targets_change_nothing(session, targets, message):
    session.begin("Drag Pin")
    state, events = session.state, len(session.recording.events)
    with pytest.raises(InputError, match=message):
        session.apply(SetTargets(targets))
    assert session.state is state
    assert not session.is_moving
    assert len(session.recording.events) == events


def test_targets_of_any_kind_of_number_can_be_written(session):
    session.begin("Drag Pin")
    session.apply(SetTargets({1: np.array([20, 41]), 2: np.array([100.5, 42.0], dtype=np.float32)}))
    assert '"targets":{"1":[20.0,41.0],"2":[100.5,42.0]}' in session.recording.to_text()


def test_a_new_pose_takes_the_pins_along(session, drawing):
    pose = drawing.mesh.vertices * 0.5 + [30.0, 10.0]
    session.begin("Pose")
    session.apply(SetPose(pose))
    np.testing.assert_array_equal(session.state.positions, pose)
    np.testing.assert_allclose(session.state.targets, [(40.0, 30.0), (82.5, 30.0)])
    assert session.is_posed
    session.apply(ResetPose())
    assert not session.is_posed
    np.testing.assert_allclose(session.state.targets, [(20.0, 40.0), (105.0, 40.0)])


@pytest.mark.parametrize("bad", [np.zeros((3, 2)), "pose", None])
def test_a_bad_pose_changes_nothing(session, bad):
    state = session.state
    session.begin("Pose")
    with pytest.raises(InputError, match="positions"):
        session.apply(SetPose(bad))
    assert session.state is state


@pytest.mark.parametrize(
    "settings",
    [
        Settings("no such method"),
        Settings("akap", (("no such parameter", 1),)),
        Settings("akap", (("memory", 2.0),)),
        Settings("akap", (("trajectory", "zigzag"),)),
    ],
)
def test_bad_settings_change_nothing(session, settings):
    state, events = session.state, len(session.recording.events)
    session.begin("Settings")
    with pytest.raises(InputError):
        session.apply(SetSettings(settings))
    assert session.state is state
    assert len(session.recording.events) == events + 1
    session.apply(SetTargets({2: (90.0, 65.0)}))
    session.settle()
    assert session.pin_error() < PIN_TOLERANCE


def test_settings_move_nothing_and_decide_how_it_bends(session):
    poses = []
    for memory in (1.0, 0.0):
        session.begin("Drag Pin")
        state = session.state
        session.apply(SetSettings(session.state.settings.with_parameter("memory", memory)))
        assert session.state.positions is state.positions
        session.apply(SetTargets({2: (60.0, 75.0)}))
        session.settle()
        poses.append(session.state.positions)
        session.abort()
    assert np.abs(poses[0] - poses[1]).max() > 0.5


@pytest.mark.parametrize("method", method_names())
def test_switching_the_method_in_mid_pose_moves_nothing_and_goes_on_bending(session, method):
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (90.0, 65.0)}))
    session.settle()
    session.commit()
    before = session.state
    session.begin("Method")
    session.apply(SetSettings(Settings(method, ())))
    session.commit()
    assert session.state.positions is before.positions
    session.undo()
    assert bits(session.state) == bits(before)
    session.redo()
    assert session.state.settings.method == method
    session.begin("Bend on")
    session.apply(SetTargets({2: (80.0, 70.0)}))
    session.settle()
    session.commit()
    assert not session.is_moving
    # moving least squares interpolate at the pins, but a pin's position is that of the vertices around it
    assert session.pin_error() < (1.0 if method == "mls" else PIN_TOLERANCE)
    positions = session.state.positions
    session.begin("Method")
    session.apply(SetSettings(Settings()))
    session.commit()
    assert session.state.positions is positions
    session.begin("Bend back")
    session.apply(SetTargets({2: (90.0, 65.0)}))
    session.settle()
    assert session.pin_error() < PIN_TOLERANCE


def test_after_undo_of_settings_the_old_method_bends(session):
    def bend():
        session.begin("Drag Pin")
        session.apply(SetTargets({2: (80.0, 70.0)}))
        session.step()
        result = session.state.positions.tobytes()
        session.abort()
        return result

    with_memory = bend()
    session.begin("Settings")
    session.apply(SetSettings(Settings("akap", (("memory", 0.0),))))
    session.commit()
    without = bend()
    session.undo()
    assert session.state.settings == Settings()
    assert bend() == with_memory != without
    session.redo()
    assert bend() == without


def test_abort_restores_bit_for_bit(session):
    before = bits(session.state)
    session.begin("Everything")
    session.apply(SetTargets({1: (25.0, 50.0)}))
    session.settle()
    add_pin(session, (62.0, 40.0))
    remove_pins(session, [1])
    session.apply(SetSettings(Settings("akap", (("memory", 0.5),))))
    session.apply(ResetPose())
    session.abort()
    assert bits(session.state) == before
    assert session.history.depth == 1
    assert not session.is_moving


def test_undo_and_redo_at_the_ends_do_nothing(session):
    session.redo()
    session.undo()
    state, events = session.state, len(session.recording.events)
    session.undo()
    assert session.state is state
    assert len(session.recording.events) == events


def test_modified_is_about_the_saved_state_not_about_the_number_of_edits(session, tmp_path):
    assert session.is_modified
    session.mark_saved(tmp_path / "figure.akap")
    assert not session.is_modified
    assert session.document.path == tmp_path / "figure.akap"
    session.begin("Move")
    session.apply(SetPose(session.state.positions + 1.0))
    session.commit()
    assert session.is_modified
    session.undo()
    assert not session.is_modified
    session.undo()
    assert session.is_modified
    session.redo()
    assert not session.is_modified


def test_an_opened_document_is_not_modified(drawing):
    assert not Session(new_document(drawing), Ticks()).is_modified


def test_revision_grows_with_every_change(session):
    revisions = [session.document.revision]
    session.begin("Drag Pin")
    for change in (
        lambda: session.apply(SetTargets({2: (90.0, 65.0)})),
        session.step,
        session.abort,
        session.undo,
    ):
        change()
        revisions.append(session.document.revision)
    assert revisions == sorted(set(revisions))


def test_a_failed_step_keeps_the_last_good_pose_and_stops(session, monkeypatch):
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (90.0, 65.0)}))
    session.step()
    state, events = session.state, len(session.recording.events)
    monkeypatch.setattr(AkapDeformer, "step", _fail)
    with pytest.raises(SolverError, match="on purpose"):
        session.step()
    assert session.state is state
    assert not session.is_moving
    assert session.recording.events[events:] == [{"t": ANY, "do": "targets", "targets": {}}], "moves nothing"


def _fail(self, positions, targets):
    raise SolverError("on purpose")
