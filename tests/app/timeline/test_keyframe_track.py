"""Keyframes on the timeline, by mouse and keys."""

import numpy as np
import pytest
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from akap_editor.app import files
from akap_editor.app.commands.command import SHIFT
from akap_editor.app.timeline.keyframe_track import time_label
from akap_editor.editor import gestures
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.replay import replay
from akap_editor.io.akap.project import load, save


@pytest.fixture
def keyed(pinned):
    """Keyframes of the rest pose at 0, of a bent one at 1 second; one looks at the first."""
    pinned.add_keyframes(1.0, (-20.0, -100.0))
    pinned.state.timeline.keyframe_playback.scrub(0.0)
    pinned.settle()
    return pinned


def times(ui):
    return ui.session.present.animation.times


def on_track(ui, time, y=28):
    """A place on the track of keyframes, y points below its top."""
    found = {}
    ui.do(lambda hand: found.setdefault("rect", hand.item_info("//Timeline/##keys").rect_full))
    rect, playback = found["rect"], ui.state.timeline.keyframe_playback
    left, width = rect.min.x + 8, rect.max.x - rect.min.x - 16
    view = playback.visible_range
    return round(left + width * (time - view.start) / view.seconds), round(rect.min.y + y)


def at_time(ui, time, share):
    """What is seen is the pose at a time, the share of the way from rest to the bent pose."""
    first, last = (ui.session.present.animation.keyframes[number].positions for number in (0, -1))
    seen = ui.session.state.positions
    assert ui.state.timeline.keyframe_playback.time == pytest.approx(time)
    far = np.abs(last - first).max()
    return np.abs(seen - first).max() == pytest.approx(share * far, abs=0.06 * far)


def test_the_time_has_no_duration_beside_it_once_all_keyframes_are_undone(keyed):
    playback = keyed.state.timeline.keyframe_playback
    keyed.drag(on_track(keyed, 0.1, y=8), on_track(keyed, 0.5, y=8))
    assert time_label(playback) == "0.50 / 1.00 s"
    while times(keyed):
        keyed.session.undo()
    keyed.settle()
    assert time_label(playback) == f"{playback.time:.2f} s"


def test_a_drag_on_the_ruler_moves_along_and_edits_nothing(keyed):
    depth, events = keyed.session.history.depth, len(keyed.session.recording.events)
    keyed.drag(on_track(keyed, 0.1, y=8), on_track(keyed, 0.5, y=8))
    assert at_time(keyed, 0.5, 0.5)
    assert keyed.session.is_previewing
    keyed.drag(on_track(keyed, 0.5, y=8), on_track(keyed, 1.7, y=8))
    assert at_time(keyed, 1.7, 1.0)
    assert (keyed.session.history.depth, len(keyed.session.recording.events)) == (depth, events)


def test_a_drag_on_the_canvas_takes_what_is_seen_and_k_keeps_it(keyed):
    keyed.state.timeline.keyframe_playback.scrub(0.5)
    keyed.settle()
    seen, depth = keyed.session.state.positions, keyed.session.history.depth
    before = keyed.session.present
    start = keyed.to_screen(keyed.pin_position(3))
    keyed.click(start)
    assert keyed.session.present is before, "a click takes nothing"
    keyed.drag(start, (start[0] + 20, start[1] + 30))
    assert not keyed.session.is_previewing
    assert keyed.session.history.depth == depth + 1
    assert np.abs(keyed.session.state.positions - seen).max() < 60, "it went on from there"
    keyed.key(imgui.Key.k)
    assert times(keyed) == (0.0, 0.5, 1.0)
    assert keyed.session.present.animation.keyframes[1].positions is keyed.session.state.positions
    keyed.editor.undo()
    keyed.editor.undo()
    assert keyed.session.present is before
    *_, last = replay(keyed.session.recording, keyed.session.drawing)
    np.testing.assert_array_equal(last.state.positions, keyed.session.present.positions)


def test_keyframes_are_dragged_copied_and_stretched(keyed):
    keyed.drag(on_track(keyed, 1.0), on_track(keyed, 1.3))
    assert times(keyed) == pytest.approx((0.0, 1.3))
    keyed.drag(on_track(keyed, 1.3), on_track(keyed, 0.6), held=imgui.Key.mod_ctrl)
    assert times(keyed) == pytest.approx((0.0, 0.6, 1.3))
    keyed.drag(on_track(keyed, 1.3), on_track(keyed, 1.95), held=imgui.Key.mod_alt)
    assert times(keyed) == pytest.approx((0.0, 0.9, 1.95))
    assert keyed.session.history.labels[-3:] == [
        "Move Keyframe",
        "Duplicate Keyframe",
        "Move 3 Keyframes",
    ]
    for expected in ((0.0, 0.6, 1.3), (0.0, 1.3), (0.0, 1.0)):
        keyed.editor.undo()
        assert times(keyed) == pytest.approx(expected)


def test_several_are_chosen_with_shift_and_moved_together(keyed):
    keyed.state.timeline.keyframe_playback.set_keyframe(0.5)
    keyed.click(on_track(keyed, 0.5))
    keyed.click(on_track(keyed, 1.0), shift=True)
    keyed.drag(on_track(keyed, 0.5), on_track(keyed, 0.7))
    assert times(keyed) == pytest.approx((0.0, 0.7, 1.2))
    keyed.key(SHIFT | imgui.Key.k)
    assert times(keyed) == (0.0,)


def test_escape_takes_a_drag_of_keyframes_back(keyed):
    before, start, end = keyed.session.present, on_track(keyed, 1.0), on_track(keyed, 1.5)

    def drag(hand):
        keyed.begin_drag(hand, start)
        hand.mouse_move_to_pos(imgui.ImVec2(*end))
        assert keyed.state.timeline.keyframe_playback.is_dragging
        hand.key_press(imgui.Key.escape)
        hand.mouse_move_to_pos(imgui.ImVec2(*start))
        hand.mouse_up(0)

    keyed.do(drag)
    assert keyed.session.present is before


def test_a_double_click_adds_and_delete_is_for_keyframes_where_no_pin_is_selected(keyed):
    def click_twice(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*place))
        hand.mouse_double_click(0)

    place = on_track(keyed, 0.5)
    keyed.do(click_twice)
    assert times(keyed) == (0.0, 0.5, 1.0)
    assert not keyed.editor.selection
    keyed.key(imgui.Key.delete)
    assert times(keyed) == (0.0, 1.0)
    assert len(keyed.pins) == 3


def test_the_range_is_cut_by_its_marks(keyed):
    keyed.drag(on_track(keyed, 1.0, y=44), on_track(keyed, 0.8, y=44))
    assert keyed.state.timeline.keyframe_playback.played_range == pytest.approx((0.0, 0.8))


def test_the_menu_of_a_keyframe_changes_its_easing(keyed):
    def choose(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*place))
        hand.mouse_click(1)
        hand.item_click("//$FOCUSED/Hold")

    place = on_track(keyed, 0.0)
    keyed.do(choose)
    assert keyed.session.present.animation.keyframes[0].ease == "hold"
    keyed.state.timeline.keyframe_playback.scrub(0.9)
    keyed.settle()
    np.testing.assert_array_equal(
        keyed.session.state.positions, keyed.session.present.animation.keyframes[0].positions
    )


def test_a_pose_is_dragged_to_the_timeline_and_to_another_place(keyed):
    for name in ("Up", "Down"):
        gestures.add_pose(keyed.editor, name)

    keyed.state.timeline.keyframe_playback.move_keyframe(1.0, 0.5)
    keyed.settle()
    keyed.do(lambda hand: hand.item_drag_and_drop("//Panel/**/pose Up", "//Timeline/##keys"))
    assert times(keyed) == (0.0, 0.5, 1.0)
    kept = keyed.session.present.poses[0].positions
    np.testing.assert_array_equal(keyed.session.present.animation.keyframes[-1].positions, kept)
    keyed.do(lambda hand: hand.item_drag_and_drop("//Panel/**/pose Down", "//Panel/**/pose Up"))
    assert [pose.name for pose in keyed.session.present.poses] == ["Down", "Up"]


def test_a_pose_that_is_dragged_to_the_timeline_keeps_what_passes_in_front(keyed):
    playback, session = keyed.state.timeline.keyframe_playback, keyed.session
    playback.show_present()
    keyed.editor.apply("Drag Pin", SetTargets({3: (22.0, 46.0)}))
    keyed.settle()
    keyed.editor.select({3})
    gestures.order_limb(keyed.editor, False)
    gestures.add_pose(keyed.editor, "Folded")
    gestures.reset_pose(keyed.editor)
    keyed.settle()
    keyed.do(lambda hand: hand.item_drag_and_drop("//Panel/**/pose Folded", "//Timeline/##keys"))
    folded = session.present.poses[0]
    assert len(folded.crossings) > 0
    keyframe = session.present.animation.keyframes[-1]
    np.testing.assert_array_equal(keyframe.positions, folded.positions)
    np.testing.assert_array_equal(keyframe.crossings, folded.crossings)


def test_onion_skin_is_seen_in_two_tints_and_only_while_nothing_plays(keyed):
    playback = keyed.state.timeline.keyframe_playback
    playback.scrub(0.5)
    plain = keyed.screenshot().astype(int)
    playback.onion_skin.is_shown = True
    skinned = keyed.screenshot().astype(int)
    left, top, right, bottom = (round(each) for each in keyed.editor.canvas)
    differs = (skinned - plain)[top:bottom, left:right]
    redder = differs[..., 0] - differs[..., 2]
    assert (redder > 20).sum() > 200, "orange, after"
    assert (redder < -20).sum() > 200, "blue, before"
    playback.scrub(0.0)
    assert [len(each) for each in playback.onion_poses()] == [0, 1]
    playback.onion_skin.kind, playback.onion_skin.count = "times", 3
    assert [len(each) for each in playback.onion_poses()] == [0, 3]
    playback.toggle_playing()
    assert playback.onion_poses() == ([], [])


def test_playing_moves_on_with_the_clock_and_loops(keyed, monkeypatch):
    playback, now = keyed.state.timeline.keyframe_playback, [100.0]
    monkeypatch.setattr(playback, "_clock", lambda: now[0])
    playback.toggle_playing()
    for moment in (0.25, 0.5, 0.75):
        now[0] += 0.25
        keyed.frame()
        assert playback.time == pytest.approx(moment)
    now[0] += 0.5
    keyed.frame()
    assert playback.time == pytest.approx(0.25)
    playback.toggle_playing()
    assert not playback.is_playing


def test_keyframes_are_saved_and_opened(keyed, tmp_path):
    keyed.state.timeline.keyframe_playback.scrub(0.3)
    keyed.settle()
    files.write_document(keyed.state, tmp_path / "a.akap")
    assert not keyed.state.error
    again = load(tmp_path / "a.akap")
    assert [key.time for key in again.state.animation.keyframes] == [0.0, 1.0]
    assert save(again, tmp_path / "b.akap").path is not None
    assert (tmp_path / "a.akap").read_bytes() == (tmp_path / "b.akap").read_bytes()
    np.testing.assert_array_equal(again.state.positions, keyed.session.present.positions)
    keyed.state.timeline.set_mode("session")
    keyed.state.timeline.is_shown = False
    files.show_document(keyed.state, again)
    assert keyed.state.timeline.mode == "keyframes"
    assert keyed.state.timeline.is_shown


def test_the_wheel_zooms_in_on_a_time_and_keyframes_are_taken_there(keyed):
    playback = keyed.state.timeline.keyframe_playback
    place = on_track(keyed, 1.0)
    keyed.wheel(place, 4)
    assert (
        0
        < playback.visible_range.start
        < 1.0
        < playback.visible_range.start + playback.visible_range.seconds
        < 2.0
    )
    assert np.abs(np.subtract(on_track(keyed, 1.0), place)).max() <= 1
    keyed.drag(place, on_track(keyed, 0.85))
    assert times(keyed) == (0.0, 0.85)
    keyed.wheel(place, -20)
    assert (playback.visible_range.start, playback.visible_range.seconds) == (0.0, 2.0)


def test_looping_is_a_step_of_undo(keyed):
    keyed.do(lambda hand: hand.item_click(f"//Timeline/{icons.ICON_FA_REPEAT}##loop"))
    assert not keyed.session.present.animation.loop
    keyed.editor.undo()
    assert keyed.state.timeline.keyframe_playback.loop


def test_without_the_timeline_the_present_is_seen(keyed):
    keyed.state.timeline.keyframe_playback.scrub(0.5)
    keyed.settle()
    assert keyed.session.is_previewing
    keyed.key(SHIFT | imgui.Key.t)
    assert not keyed.session.is_previewing
    keyed.key(SHIFT | imgui.Key.t)
    assert not keyed.session.is_previewing


def test_an_edge_of_the_selection_makes_it_slower_in_one_edit(keyed):
    playback = keyed.state.timeline.keyframe_playback
    playback.set_keyframe(0.5)
    playback.selected, depth = frozenset({0.5, 1.0}), keyed.session.history.depth
    x, y = on_track(keyed, 1.0)
    scale = keyed.window.scale
    keyed.drag((x + round(12 * scale), y), (on_track(keyed, 1.5)[0] + round(12 * scale), y))
    assert times(keyed) == (0.0, 0.5, 1.5)
    x, y = on_track(keyed, 0.5)
    keyed.drag((x - round(12 * scale), y), (on_track(keyed, 0.9)[0] - round(12 * scale), y))
    assert times(keyed) == (0.0, 0.9, 1.5)
    assert playback.selected == {0.9, 1.5}
    assert keyed.session.history.depth == depth + 2


def test_a_drag_with_shift_selects_the_keyframes_in_a_box(keyed):
    playback = keyed.state.timeline.keyframe_playback
    for time in (0.5, 1.5):
        playback.set_keyframe(time)
    playback.selected, before = frozenset({0.0}), keyed.session.present
    keyed.drag(on_track(keyed, 0.3), on_track(keyed, 1.2), held=imgui.Key.mod_shift)
    assert playback.selected == {0.0, 0.5, 1.0}
    assert keyed.session.present is before


def test_copied_keyframes_are_pasted_at_the_playhead_also_backwards(keyed):
    playback = keyed.state.timeline.keyframe_playback
    poses = [each.positions for each in playback.animation.keyframes]
    assert not playback.can_paste()
    playback.selected = frozenset({0.0, 1.0})
    playback.copy_keyframes()
    playback.scrub(2.0)
    playback.paste_keyframes()
    assert times(keyed) == (0.0, 1.0, 2.0, 3.0)
    assert playback.selected == {2.0, 3.0}
    playback.scrub(4.0)
    playback.paste_keyframes(reverse=True)
    pasted = keyed.session.present.animation.keyframes[-2:]
    for each, pose in zip(pasted, poses[::-1], strict=True):
        np.testing.assert_array_equal(each.positions, pose)
    keyed.editor.undo()
    assert times(keyed) == (0.0, 1.0, 2.0, 3.0)
