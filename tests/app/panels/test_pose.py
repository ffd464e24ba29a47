"""A pose goes into a file and comes back, through the menus."""

from akap_editor.editor import gestures
from akap_editor.io.akap.pose import load_pose


def test_a_pose_is_carried_through_a_file(pinned, tmp_path):
    pinned.state.folder = tmp_path
    start = pinned.screen(pinned.pin_place(3))
    pinned.drag(start, (start[0], start[1] - 80))
    posed = pinned.session.state
    pinned.menu("File", "Export Pose File...")
    pinned.type_name("Save pose", "wave")
    assert pinned.state.notice == "Saved wave.pose.json"
    assert load_pose(tmp_path / "wave.pose.json", pinned.session.drawing).positions.tobytes() == (
        posed.positions.tobytes()
    )
    pinned.menu("Edit", "Reset Pose")
    gestures.remove_pins(pinned.editor, {1})
    pinned.menu("File", "Apply Pose File...")
    pinned.type_name("Apply pose", "wave.pose.json")
    assert pinned.state.notice == "Applied wave.pose.json"
    assert pinned.session.state.positions.tobytes() == posed.positions.tobytes()
    assert [pin.id for pin in pinned.pins] == [1, 2, 3]
    before = pinned.session.state
    (tmp_path / "bad.pose.json").write_text("{}")
    pinned.menu("File", "Apply Pose File...")
    pinned.type_name("Apply pose", "bad.pose.json")
    assert "bad.pose.json”. Expected format to be a text" in pinned.state.error
    assert pinned.session.state is before
    pinned.dialog("Error", "OK")
