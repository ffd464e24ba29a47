"""The timeline and the poses, by mouse."""

from dataclasses import replace

import numpy as np
import pytest
from imgui_bundle import imgui
from PIL import Image

from akap_editor.app.commands.command import CTRL
from akap_editor.app.dialogs.export.animation import AnimationExportOptions, export_animation
from akap_editor.app.dialogs.take import TakeDialog
from akap_editor.editor.session.replay import replay


@pytest.fixture
def bent(pinned):
    """The timeline is shown, and a drag was made."""
    pinned.state.timeline.is_shown = True
    pinned.settle()
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0] - 20, start[1] - 100))
    return pinned


def on_track(ui, share, down=0.5):
    """A place on the track of the time line, so far down from its top."""
    places = {}

    def find(hand):
        info = hand.item_info("//Timeline/##track")
        places["rect"] = info.rect_full

    ui.do(find)
    rect = places["rect"]
    return round(rect.min.x + share * (rect.max.x - rect.min.x)), round(
        rect.min.y + down * (rect.max.y - rect.min.y)
    )


def test_the_other_mode_leaves_the_canvas_where_it_is(bent):
    camera, canvas = bent.editor.camera, bent.editor.canvas
    for mode in ("keyframes", "session"):
        bent.state.timeline.set_mode(mode)
        bent.settle()
        assert bent.editor.canvas == canvas
        assert bent.editor.camera == camera


def test_a_pin_dragged_at_an_earlier_moment_says_that_what_came_after_is_cut_off(bent):
    bent.drag(on_track(bent, 0.99), on_track(bent, 0.02))
    start = bent.to_screen(bent.pin_position(3))
    bent.drag(start, (start[0] + 30, start[1] + 40))
    assert bent.state.notice.startswith("Continued from an earlier moment")
    bent.key(CTRL | imgui.Key.z)
    assert not bent.state.notice, "it is undone"


def test_a_drag_on_the_track_goes_back_and_forth(bent):
    now = bent.session.state
    rest = bent.session.drawing.mesh.vertices
    bent.drag(on_track(bent, 0.99), on_track(bent, 0.02))
    np.testing.assert_array_equal(bent.session.state.positions, rest)
    assert bent.session.is_previewing
    bent.drag(on_track(bent, 0.5), on_track(bent, 1.0))
    assert bent.session.state is now


def test_the_head_is_taken_at_the_end_and_the_mark_below_it(bent):
    playback = bent.state.timeline.session_playback
    bent.drag(on_track(bent, 0.99), on_track(bent, 0.5))
    assert playback.time == pytest.approx(0.5 * playback.duration, abs=0.05)
    assert playback.marked_range is None
    bent.drag(on_track(bent, 0.995, 0.85), on_track(bent, 0.7, 0.85))
    assert playback.played_range == pytest.approx((0.0, 0.7 * playback.duration), abs=0.05)


def test_the_wheel_shows_a_part_of_the_time_where_the_head_goes_slower(bent):
    playback = bent.state.timeline.session_playback
    playback.snapshots = [replace(shot, time=float(number)) for number, shot in enumerate(playback.snapshots)]
    bent.wheel(on_track(bent, 0.5), 5)
    start, seconds = playback.visible_range.start, playback.visible_range.seconds
    assert 0 < start < start + seconds < playback.duration
    bent.drag(on_track(bent, 0.5), on_track(bent, 0.4))
    assert start < playback.time < start + seconds
    assert playback.time == pytest.approx(start + 0.4 * seconds, abs=0.02 * seconds)
    playback.scrub(0.0)
    assert playback.visible_range.start == 0.0
    bent.wheel(on_track(bent, 0.5), -40)
    assert not playback.visible_range.is_zoomed


def test_control_and_drag_from_an_earlier_moment_takes_the_gesture_from_there(bent):
    playback = bent.state.timeline.session_playback
    playback.scrub(0.5 * playback.duration)
    bent.settle()
    here = playback.snapshot_at(playback.time).time
    start = bent.to_screen(bent.pin_position(3))
    bent.drag(start, (start[0] + 30, start[1] + 30), held=imgui.Key.mod_ctrl)
    assert bent.session.history.labels[-2:] == ["Go Back in Time", "Drag Pin"]
    assert playback.marked_range is not None
    assert playback.marked_range[0] == pytest.approx(here)
    assert playback.marked_range[0] < playback.marked_range[1] <= playback.duration


def test_a_drag_on_the_canvas_goes_on_from_there(bent):
    bent.state.timeline.session_playback.scrub(0.0)
    bent.settle()
    start = bent.to_screen(bent.pin_position(3))
    bent.drag(start, (start[0] - 20, start[1] + 60))
    assert not bent.session.is_previewing
    *_, last = replay(bent.session.recording, bent.session.drawing)
    np.testing.assert_array_equal(last.state.positions, bent.session.state.positions)
    assert bent.session.history.labels[-2:] == ["Go Back in Time", "Drag Pin"]


def test_control_and_drag_records_that_gesture_only(bent):
    before = bent.state.timeline.session_playback.duration
    start = bent.to_screen(bent.pin_position(3))
    bent.drag(start, (start[0] + 30, start[1] + 30), held=imgui.Key.mod_ctrl)
    assert bent.state.timeline.session_playback.marked_range is not None
    start, end = bent.state.timeline.session_playback.marked_range
    assert before <= start < end <= bent.state.timeline.session_playback.duration
    assert bent.state.timeline.session_playback.take_start is None


def test_the_range_is_exported(bent, tmp_path):
    playback = bent.state.timeline.session_playback
    playback.mark_range(0.0, min(0.5, playback.duration))
    export_animation(bent.state, AnimationExportOptions(), tmp_path / "wave.webp")
    bent.settle()
    assert bent.state.error == ""
    with Image.open(tmp_path / "wave.webp") as opened:
        assert opened.n_frames >= 1
    export_animation(bent.state, AnimationExportOptions(), tmp_path / "wave.avi")
    bent.settle()
    assert ".avi" in bent.state.error


def test_a_take_becomes_keyframes(bent):
    playback, dialog = bent.state.timeline.session_playback, bent.state.part(TakeDialog)
    dialog.open(bent.state)
    bent.settle()
    assert dialog.count >= 2
    bent.do(lambda hand: hand.item_click("//$FOCUSED/###add"))
    assert not dialog.is_open
    keyframes = bent.session.present.animation.keyframes
    assert (keyframes[0].time, keyframes[-1].time) == (0.0, pytest.approx(playback.duration, abs=1e-3))
    np.testing.assert_array_equal(keyframes[-1].positions, playback.snapshots[-1].state.positions)
    assert bent.state.timeline.mode == "keyframes"
    assert bent.state.timeline.keyframe_playback.selected == {each.time for each in keyframes}
    bent.editor.undo()
    assert not bent.session.present.animation.keyframes
