"""Mouse on the canvas: pins, bending, selection, moving about, and what ends a gesture."""

from imgui_bundle import imgui  # isort: skip
from functools import partial

import glfw
import numpy as np
import pytest

from akap_editor.app.commands.command import CTRL
from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.editor.camera import Camera
from akap_editor.editor.session.stepper import PIN_TOLERANCE
from akap_editor.errors import SolverError

Key = imgui.Key
PANEL, STATUS = (1020.0, 500.0), (600.0, 790.0)  # where nothing is to be moved


def move(hand, at):
    hand.mouse_move_to_pos(imgui.ImVec2(*at))


def pose(ui):
    return ui.session.state.positions


# -- pins ---------------------------------------------------------------------------------------------------


def test_a_click_adds_a_pin_exactly_there(ui):
    at = ui.to_screen((100.0, 80.0))
    ui.click(at)
    (pin,) = ui.pins
    assert tuple(pin.target) == ui.to_drawing(at)
    np.testing.assert_allclose(ui.pin_position(pin.id), ui.to_drawing(at), atol=1e-9)
    assert ui.editor.selection == {pin.id}
    assert ui.session.history.undo_label == "Add Pin"
    assert not ui.session.is_posed


def test_a_click_beside_the_drawing_adds_none_and_deselects(pinned):
    pinned.editor.select({1})
    pinned.click(pinned.empty_point)
    assert len(pinned.pins) == 3
    assert not pinned.editor.selection
    assert pinned.session.history.depth == 0


def test_a_drag_bends_and_the_pin_arrives_while_others_hold(pinned):
    held = {pin: pinned.pin_position(pin) for pin in (1, 2)}
    start = pinned.to_screen(pinned.pin_position(3))
    end = start[0] - 60, start[1] - 200
    wanted = pinned.pin_position(3) + np.subtract(end, start) / pinned.editor.camera.zoom
    pinned.drag(start, end)
    np.testing.assert_allclose(pinned.session.state.pin(3).target, wanted, atol=1e-9)
    assert np.linalg.norm(pinned.pin_position(3) - wanted) < PIN_TOLERANCE == 0.25
    for pin, place in held.items():
        assert np.linalg.norm(pinned.pin_position(pin) - place) < PIN_TOLERANCE
    assert pinned.session.history.undo_label == "Drag Pin"
    assert pinned.session.history.depth == 1


def test_press_and_drag_on_the_drawing_adds_a_pin_and_bends_in_one_gesture(ui):
    ui.click(ui.to_screen((50.0, 80.0)))
    before = pose(ui)
    start = ui.to_screen((200.0, 80.0))
    end = start[0], start[1] + 150
    ui.drag(start, end)
    assert np.linalg.norm(ui.pin_position(2) - ui.to_drawing(end)) < PIN_TOLERANCE
    assert ui.session.history.undo_label == "Add and Drag Pin"
    ui.key(CTRL | Key.z)
    assert [pin.id for pin in ui.pins] == [1]
    assert pose(ui).tobytes() == before.tobytes()


def test_shift_click_selects_and_unselects_pins(pinned):
    pinned.click(pinned.to_screen(pinned.pin_position(1)))
    pinned.click(pinned.to_screen(pinned.pin_position(2)), shift=True)
    assert pinned.editor.selection == {1, 2}
    pinned.click(pinned.to_screen(pinned.pin_position(1)), shift=True)
    assert pinned.editor.selection == {2}
    assert pinned.session.history.depth == 0


def test_selected_pins_are_dragged_together(pinned):
    pinned.editor.select({2, 3})
    before = {pin: pinned.pin_position(pin) for pin in (2, 3)}
    start = pinned.to_screen(before[3])
    pinned.drag(start, (start[0], start[1] + 100))
    for pin, place in before.items():
        wanted = place + np.array([0, 100 / pinned.editor.camera.zoom])
        assert np.linalg.norm(pinned.pin_position(pin) - wanted) < PIN_TOLERANCE


def test_a_rubber_band_selects_what_is_in_it(pinned):
    x, y = pinned.to_screen(pinned.pin_position(3))
    corner = pinned.to_screen((232.0, 2.0))
    pinned.drag(corner, (x - 20, y + 20))
    assert pinned.editor.selection == {3}
    assert len(pinned.pins) == 3


def test_a_rubber_band_that_is_escaped_selects_nothing(pinned):
    pinned.editor.select({1})
    x, y = pinned.to_screen(pinned.pin_position(3))
    seen = []

    def actions(hand):
        pinned.begin_drag(hand, pinned.to_screen((232.0, 2.0)))
        move(hand, (x - 20, y + 20))
        seen.append((pinned.tool, pinned.editor.selection))
        hand.key_press(Key.escape)
        seen.append((pinned.tool, pinned.editor.selection))
        hand.mouse_up(0)

    pinned.do(actions)
    assert seen == [("RubberBand", {3}), ("PinsIdle", {1})]


# -- moving about -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("notches", [3.0, -2.0])
def test_the_wheel_zooms_at_the_pointer(ui, notches):
    at = (300.0, 500.0)
    place, zoom = ui.to_drawing(at), ui.editor.camera.zoom
    ui.wheel(at, notches)
    assert ui.editor.camera.zoom == pytest.approx(zoom * 1.15**notches)
    np.testing.assert_allclose(ui.to_drawing(at), place, atol=1e-9)


@pytest.mark.parametrize("how", ["middle button", "space", "hand tool"])
def test_panning_takes_the_canvas_along_and_edits_nothing(pinned, how):
    start = pinned.to_screen(pinned.pin_position(2))
    end = start[0] + 70, start[1] - 40
    place = pinned.to_drawing(start)
    if how == "hand tool":
        pinned.editor.chosen_tool = pinned.editor.hand_tool
    pinned.drag(
        start, end, button=2 if how == "middle button" else 0, held=Key.space if how == "space" else None
    )
    np.testing.assert_allclose(pinned.to_drawing(end), place, atol=1e-9)
    assert not pinned.editor.is_modified
    assert pinned.tool == ("HandIdle" if how == "hand tool" else "PinsIdle")


def test_escape_in_a_pan_goes_back(ui):
    camera = ui.editor.camera

    def actions(hand):
        ui.begin_drag(hand, (400.0, 300.0), button=2)
        move(hand, (450.0, 350.0))
        assert ui.editor.camera != camera
        hand.key_press(Key.escape)
        hand.mouse_up(2)

    ui.do(actions)
    assert ui.editor.camera == camera


def test_space_released_where_the_canvas_does_not_hear_it_leaves_no_hand(ui):
    def actions(hand):
        move(hand, ui.empty_point)
        hand.key_down(Key.space)
        hand.yield_(2)
        assert ui.tool == "HandIdle"
        ui.state.error = "A message takes the keyboard."
        hand.yield_(3)
        hand.key_up(Key.space)
        hand.yield_(2)
        hand.item_click("//Error###dialog Error/OK")

    ui.do(actions)
    assert ui.tool == "PinsIdle"


# -- canvas and panels --------------------------------------------------------------------------------------


@pytest.mark.parametrize("at", [PANEL, STATUS, (20.0, 500.0), (900.0, 8.0)])
def test_a_click_on_a_panel_never_reaches_the_canvas(ui, at):
    ui.editor.camera = Camera(6.0, (at[0] - 6 * 70, at[1] - 6 * 80))  # the head lies under the panel
    assert ui.session.drawing.mesh.find(ui.to_drawing(at), pose(ui)) is not None
    over = []

    def click(hand):
        move(hand, at)
        hand.mouse_click(0)
        over.append((ui.editor.pointer, ui.tool))

    ui.do(click)
    assert over == [(None, "PinsIdle")]
    assert not ui.pins


@pytest.mark.parametrize("how", ["Shift", "horizontal"])
def test_the_wheel_pans_sideways(ui, how):
    camera, at = ui.editor.camera, ui.to_screen((100.0, 80.0))

    def turn(hand):
        move(hand, at)
        if how == "Shift":
            hand.key_down(Key.mod_shift)
            hand.mouse_wheel_y(2.0)
            hand.key_up(Key.mod_shift)
        else:
            hand.mouse_wheel_x(2.0)

    ui.do(turn)
    assert ui.editor.camera.zoom == camera.zoom
    assert ui.editor.camera.offset[1] == camera.offset[1]
    assert ui.editor.camera.offset[0] - camera.offset[0] == pytest.approx(120.0)


def test_a_right_click_beside_the_pins_opens_the_menu_of_the_canvas(pinned):
    at = pinned.to_screen((100.0, 60.0))

    def act(hand):
        move(hand, at)
        hand.mouse_click(1)
        hand.yield_(3)
        hand.item_click("//$FOCUSED/Select All Pins")

    pinned.do(act)
    assert pinned.editor.selection == {1, 2, 3}
    assert len(pinned.pins) == 3


def keyed(ui):
    playback = ui.state.timeline.keyframe_playback
    ui.state.timeline.show_keyframes()
    ui.settle()
    playback.set_keyframe(0.0)
    ui.bend()
    playback.set_keyframe(60.0)
    playback.scrub(0.0)
    ui.settle()
    return playback


def test_space_plays_when_it_is_tapped_and_pans_when_it_is_held(pinned):
    playback, seen = keyed(pinned), []
    camera, start = pinned.editor.camera, pinned.to_screen((100.0, 80.0))

    def act(hand):
        move(hand, start)
        hand.key_press(Key.space)
        hand.yield_(2)
        seen.append(playback.is_playing)
        hand.key_press(Key.space)
        hand.yield_(2)
        seen.append(playback.is_playing)
        hand.key_down(Key.space)
        hand.mouse_down(0)
        move(hand, (start[0] + 30, start[1]))
        hand.mouse_up(0)
        hand.key_up(Key.space)
        hand.yield_(2)
        seen.append(playback.is_playing)
        hand.key_down(Key.space)
        hand.sleep_no_skip(1.0, 1 / 20)
        hand.key_up(Key.space)
        hand.yield_(2)
        seen.append(playback.is_playing)

    pinned.do(act)
    assert seen == [True, False, False, False]
    assert pinned.editor.camera != camera


def test_a_tap_of_space_without_a_motion_says_why(ui):
    ui.key(Key.space)
    assert ui.state.notice.startswith("There is no motion yet")


def test_ctrl_space_zooms(ui):
    camera, at = ui.editor.camera, ui.to_screen((100.0, 80.0))

    def act(hand):
        move(hand, at)
        hand.key_down(Key.mod_ctrl)
        hand.key_down(Key.space)
        hand.mouse_click(0)
        hand.key_up(Key.space)
        hand.key_up(Key.mod_ctrl)

    ui.do(act)
    assert ui.editor.camera.zoom > camera.zoom
    assert not ui.pins


def test_the_wheel_over_a_panel_does_not_zoom(ui):
    camera = ui.editor.camera
    ui.wheel(PANEL, 2.0)
    assert ui.editor.camera == camera


def test_a_drag_goes_on_over_a_panel_and_ends_there(pinned):
    start = pinned.to_screen(pinned.pin_position(3))
    seen = []

    def actions(hand):
        pinned.begin_drag(hand, start)
        move(hand, (start[0] - 50, start[1] - 50))
        move(hand, PANEL)
        hand.yield_(2)
        seen.append((pinned.tool, pinned.session.state.pin(3).target))
        hand.mouse_up(0)

    pinned.do(actions)
    wanted = pinned.pin_position(3)
    (tool, target), shift = seen[0], np.subtract(PANEL, start) / pinned.editor.camera.zoom
    assert tool == "DraggingPin"
    np.testing.assert_allclose(target, np.add((210.0, 80.0), shift), atol=0.01)
    assert pinned.tool == "PinsIdle"
    assert np.linalg.norm(wanted - target) < PIN_TOLERANCE


def test_a_press_that_began_on_a_panel_drags_no_pin(pinned):
    pinned.drag(PANEL, pinned.to_screen(pinned.pin_position(3)), pinned.to_screen(pinned.pin_position(2)))
    assert not pinned.editor.is_modified
    assert not pinned.editor.selection


# -- what ends a gesture ------------------------------------------------------------------------------------


def escape(ui, hand):
    hand.key_press(Key.escape)


def lose_focus(ui, hand):
    for call in (glfw.hide_window, glfw.show_window, glfw.focus_window):
        ui.on_main_thread(hand, partial(call, ui.window.handle))


def undo(ui, hand):
    hand.key_press(CTRL | Key.z)


def open_dialog(ui, hand):
    hand.key_press(CTRL | Key.o)
    hand.yield_(2)
    assert ui.file_request is not None
    hand.mouse_up(0)
    hand.key_press(Key.escape)


@pytest.mark.parametrize("end", [escape, lose_focus, undo, open_dialog])
def test_a_drag_that_is_cut_short_restores_everything(pinned, end):
    before = pinned.session.state
    start = pinned.to_screen(pinned.pin_position(3))
    seen = []

    def actions(hand):
        pinned.begin_drag(hand, start)
        move(hand, (start[0], start[1] + 100))
        while pose(pinned) is before.positions:  # a slow machine takes some frames
            hand.yield_()
        seen.append((pinned.tool, pose(pinned) is before.positions))
        end(pinned, hand)
        hand.yield_(2)
        seen.append((pinned.tool, pinned.session.state is before))
        hand.mouse_up(0)
        move(hand, (start[0], start[1] + 150))

    pinned.do(actions)
    assert seen == [("DraggingPin", False), ("PinsIdle", True)]
    assert pinned.session.state is before
    assert pinned.session.history.depth == 0


def test_a_pointer_that_has_left_the_window_hovers_over_nothing(pinned):
    no_place = -float(np.finfo(np.float32).max)
    hovered = []

    def actions(hand):
        for at in (pinned.to_screen(pinned.pin_position(2)), (no_place, no_place)):
            hand.mouse_teleport_to_pos(imgui.ImVec2(*at))
            hand.yield_(2)
            hovered.append(pinned.editor.tool.markers.hovered_pin)

    pinned.do(actions)
    assert hovered == [2, None]


def test_an_unsolvable_drag_shows_a_message_and_restores_the_pose(pinned, monkeypatch):
    before = pinned.session.state
    start = pinned.to_screen(pinned.pin_position(3))
    seen = []

    def actions(hand):
        pinned.begin_drag(hand, start)
        move(hand, (start[0], start[1] + 100))
        hand.yield_(2)
        monkeypatch.setattr(AkapDeformer, "step", fail)
        move(hand, (start[0], start[1] + 200))
        hand.yield_(2)
        seen.append((pinned.state.error, pinned.tool))
        hand.mouse_up(0)
        hand.item_click("//Error###dialog Error/OK")

    def fail(deformer, positions, targets):
        raise SolverError("the pose became infinite")

    pinned.do(actions)
    assert seen == [("the pose became infinite", "PinsIdle")]
    assert pinned.session.state is before
    assert not pinned.state.error
    monkeypatch.undo()
    pinned.drag(start, (start[0], start[1] + 50))
    assert pinned.session.is_posed


# -- how it looks -------------------------------------------------------------------------------------------


def test_the_drawing_is_shown_where_the_camera_says(ui, image):
    background = ui.screenshot()[int(ui.empty_point[1]) + 2, int(ui.empty_point[0]) + 2]
    ui.state.view.show_checkerboard = False
    shot = ui.screenshot().astype(int)
    inside = ui.to_screen((70.0, 80.0))
    np.testing.assert_allclose(shot[round(inside[1]), round(inside[0])], [90, 140, 200], atol=1)
    left, top, right, bottom = (round(side) for side in ui.editor.canvas)
    part = shot[top:bottom, left:right]
    drawn = np.argwhere((abs(part - part[0, 0]) > 24).any(axis=2))[:, ::-1] + (left, top)
    opaque = np.argwhere(image[..., 3] > 40)[:, ::-1]
    low = ui.editor.camera.to_screen(opaque.min(axis=0))
    high = ui.editor.camera.to_screen(opaque.max(axis=0) + 1)
    zoom = ui.editor.camera.zoom
    np.testing.assert_allclose(drawn.min(axis=0), low, atol=zoom)
    np.testing.assert_allclose(drawn.max(axis=0) + 1, high, atol=zoom)
    assert background.max() < 200
