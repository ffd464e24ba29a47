"""The Poses section of the side panel."""

import numpy as np
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from akap_editor.app.panels.poses import PosesSection
from akap_editor.editor import gestures


def test_poses_are_kept_and_applied_with_a_click(pinned):
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0] - 20, start[1] - 100))
    gestures.add_pose(pinned.editor, "Up")
    gestures.reset_pose(pinned.editor)
    pinned.panel("**/pose Up")
    np.testing.assert_array_equal(pinned.session.state.positions, pinned.session.state.poses[0].positions)
    assert pinned.session.history.labels[-1] == "Apply Up"


def test_a_pose_is_renamed_with_f2(pinned):
    gestures.add_pose(pinned.editor, "Up")
    pinned.settle()

    def rename(hand):
        hand.mouse_move("//Panel/**/pose Up")
        hand.key_press(imgui.Key.f2)
        hand.key_chars_replace_enter("Wave")

    pinned.do(rename)
    assert [pose.name for pose in pinned.session.present.poses] == ["Wave"]
    assert pinned.session.history.labels[-1] == "Rename Up"


def test_a_pose_is_renamed_with_a_double_click(pinned):
    gestures.add_pose(pinned.editor, "Up")
    pinned.settle()

    def rename(hand):
        hand.mouse_move("//Panel/**/pose Up")
        picture = hand.item_info("//Panel/**/pose Up").rect_full
        hand.mouse_move_to_pos(imgui.ImVec2(picture.min.x + 8, picture.max.y + 12))
        hand.mouse_double_click(0)
        hand.yield_(5)
        hand.key_chars_replace_enter("Wave")

    pinned.do(rename)
    assert [pose.name for pose in pinned.session.present.poses] == ["Wave"]
    assert pinned.state.part(PosesSection).name_field.key is None


def test_the_whole_tab_is_seen_in_a_window_of_ordinary_height(bent):
    def scroll(hand):
        panel = hand.window_info("//Panel").window
        found.append((panel.size.y / bent.window.scale, panel.scroll_max.y))

    found = []
    bent.do(scroll)
    assert found[0][0] < 700, "the window is that of a new user"
    assert found[0][1] == 0


def test_nothing_moves_when_a_pose_is_added(bent):
    def places(hand):
        labels = (f"{icons.ICON_FA_PLUS}  Add to Poses", "##mix", "###section Bending")
        found.append([hand.item_info(f"//Panel/**/{label}").rect_full.min.y for label in labels])

    found = []
    bent.do(places)
    for _ in range(8):
        gestures.add_pose(bent.editor)
    bent.do(places)
    assert found[0] == found[1]
