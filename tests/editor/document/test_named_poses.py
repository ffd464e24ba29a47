"""Named poses: added, applied and deleted, each undoable, and the same in a replay."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.named_poses import MAX_POSE_NAME, NamedPose, unused_pose_name
from akap_editor.errors import InputError
from tests.support.editor_driver import replayed_state

END = (105.0, 40.0)


def names(driver):
    return [pose.name for pose in driver.state.poses]


@pytest.fixture
def posed(pinned):
    """The driver with two named poses: the rest pose, and one with the neck bent."""
    gestures.add_pose(pinned.editor)
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    gestures.add_pose(pinned.editor, "Bent")
    return pinned


def test_a_named_pose_is_applied_bit_for_bit_and_undone(posed):
    rest, bent = posed.state.poses
    assert names(posed) == ["Pose 1", "Bent"]
    before = posed.state
    gestures.set_pose(posed.editor, rest.positions)
    np.testing.assert_array_equal(posed.state.positions, posed.session.drawing.mesh.vertices)
    assert posed.session.pin_error() < 1e-9, "the pins move with the drawing"
    posed.undo()
    assert posed.state is before
    np.testing.assert_array_equal(posed.state.positions, bent.positions)


def test_adding_and_deleting_poses_is_undone_and_modifies_the_document(posed):
    posed.session.mark_saved(None)
    gestures.delete_pose(posed.editor, "Pose 1")
    assert names(posed) == ["Bent"]
    assert posed.editor.is_modified
    posed.undo()
    assert names(posed) == ["Pose 1", "Bent"]
    assert not posed.editor.is_modified
    posed.undo()
    assert names(posed) == ["Pose 1"]


def test_a_pose_replaces_the_one_of_the_same_name(posed):
    gestures.add_pose(posed.editor, "Pose 1")
    assert names(posed) == ["Pose 1", "Bent"]
    np.testing.assert_array_equal(posed.state.poses[0].positions, posed.state.positions)


def test_a_replay_gives_the_same_poses(posed, drawing):
    gestures.delete_pose(posed.editor, "no such pose")
    gestures.set_pose(posed.editor, posed.state.poses[0].positions)
    posed.undo()
    posed.undo()
    posed.undo()
    state = replayed_state(posed.session.recording, drawing)
    np.testing.assert_array_equal(state.positions, posed.state.positions)
    assert [pose.name for pose in state.poses] == names(posed) == ["Pose 1"]


def test_unused_names_are_numbered(posed):
    assert unused_pose_name(()) == "Pose 1"
    assert unused_pose_name(posed.state.poses) == "Pose 2"


@pytest.mark.parametrize("name", ["", "  ", "x" * (MAX_POSE_NAME + 1)])
def test_bad_names_are_refused_and_change_nothing(pinned, name):
    with pytest.raises(InputError, match=f"expected a name of 1 to {MAX_POSE_NAME} characters"):
        gestures.add_pose(pinned.editor, name)
    assert names(pinned) == []
    assert pinned.session.history.depth == 3


def test_a_pose_has_finite_positions():
    with pytest.raises(InputError, match="pose: expected"):
        NamedPose("a", np.full((3, 2), np.nan))
