"""Poses with names: kept, applied, forgotten, each undoable, and the same in a replay."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.named_poses import MAX_POSE_NAME, NamedPose, unused_pose_name
from akap_editor.editor.session.recording import parse_recording
from akap_editor.editor.session.replay import replay
from akap_editor.errors import InputError

END = (105.0, 40.0)


def names(driver):
    return [pose.name for pose in driver.state.poses]


@pytest.fixture
def posed(pinned):
    """Two poses: at rest, and with the neck bent."""
    gestures.add_pose(pinned.editor)
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    gestures.add_pose(pinned.editor, "Bent")
    return pinned


def test_a_kept_pose_is_applied_bit_for_bit_and_undone(posed):
    rest, bent = posed.state.poses
    assert names(posed) == ["Pose 1", "Bent"]
    before = posed.state
    gestures.set_pose(posed.editor, rest.positions)
    np.testing.assert_array_equal(posed.state.positions, posed.session.drawing.mesh.vertices)
    assert posed.session.pin_error() < 1e-9, "the pins went along"
    posed.undo()
    assert posed.state is before
    np.testing.assert_array_equal(posed.state.positions, bent.positions)


def test_keeping_and_forgetting_are_undoable_and_unsaved(posed):
    posed.session.mark_saved(None)
    gestures.delete_pose(posed.editor, "Pose 1")
    assert names(posed) == ["Bent"]
    assert posed.editor.modified
    posed.undo()
    assert names(posed) == ["Pose 1", "Bent"]
    assert not posed.editor.modified
    posed.undo()
    assert names(posed) == ["Pose 1"]


def test_a_pose_of_the_same_name_takes_its_place(posed):
    gestures.add_pose(posed.editor, "Pose 1")
    assert names(posed) == ["Pose 1", "Bent"]
    np.testing.assert_array_equal(posed.state.poses[0].positions, posed.state.positions)


def test_a_replay_keeps_the_same_poses_and_undoes_the_same(posed, drawing):
    gestures.delete_pose(posed.editor, "no such pose")
    gestures.set_pose(posed.editor, posed.state.poses[0].positions)
    posed.undo()
    posed.undo()
    posed.undo()
    *_, last = replay(parse_recording(posed.session.recording.to_text()), drawing)
    np.testing.assert_array_equal(last.state.positions, posed.state.positions)
    assert [pose.name for pose in last.state.poses] == names(posed) == ["Pose 1"]


def test_names_that_are_free(posed):
    assert unused_pose_name(()) == "Pose 1"
    assert unused_pose_name(posed.state.poses) == "Pose 2"


@pytest.mark.parametrize("name", ["", "  ", "x" * (MAX_POSE_NAME + 1)])
def test_bad_names_are_refused_and_nothing_is_kept(pinned, name):
    with pytest.raises(InputError, match=f"expected a name of 1 to {MAX_POSE_NAME} characters"):
        gestures.add_pose(pinned.editor, name)
    assert names(pinned) == []
    assert pinned.session.history.depth == 3


def test_a_pose_has_finite_positions():
    with pytest.raises(InputError, match="pose: expected"):
        NamedPose("a", np.full((3, 2), np.nan))
