"""Without a mouse: the crosshair on the canvas, pins, keyframes, and every panel around the canvas."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.canvas.view_options import DISTORTION_RANGES
from akap_editor.app.commands.command import ALT, CTRL, SHIFT, Key
from akap_editor.app.dialogs.first_steps import FirstSteps
from akap_editor.editor import gestures
from akap_editor.editor.tools.keyboard_pointer import BIG_STEP, STEP


@pytest.fixture(autouse=True)
def nothing_watched(module_window):
    yield
    module_window.window.after_draw.clear()


def keys(ui, *chords, look=None):
    """Press keys in one go; what ``look`` finds after each of them.

    In one go, since Test Engine takes its mouse away at the end of its tests, which ends the crosshair.
    """
    seen = []

    def press(hand):
        hand.yield_(2)
        ui.editor.last_pointer = None  # so that the crosshair begins in the middle
        for chord in chords:
            hand.key_press(int(chord))
            hand.yield_(3)
            if look is not None:
                ui.on_main_thread(hand, lambda: seen.append(look()))

    ui.do(press)
    return seen


# -- crosshair ----------------------------------------------------------------------------------------------


def test_a_pin_is_set_nudged_and_removed_by_keys_alone(ui):
    at = keys(ui, Key.c, Key.enter, look=lambda: ui.editor.pointer)[0]
    (pin,) = ui.pins
    assert ui.pin_position(pin.id) == pytest.approx(ui.to_drawing(at), abs=0.01)
    assert ui.editor.selection == {pin.id}
    keys(ui, Key.escape, Key.up_arrow, SHIFT | Key.left_arrow)
    x, y = ui.to_drawing(at)
    assert ui.pins[0].target == pytest.approx((x - 10, y - 1), abs=0.01)
    keys(ui, Key.delete)
    assert not ui.pins


def test_arrows_move_the_crosshair_on_the_screen(ui):
    seen = keys(ui, Key.c, Key.left_arrow, SHIFT | Key.down_arrow, look=lambda: ui.editor.pointer)
    (x, y), *others = seen
    assert others == [(x - STEP, y), (x - STEP, y + BIG_STEP)]


@pytest.mark.parametrize("key", [Key.enter, Key.keypad_enter, Key.space])
def test_these_keys_click_once(ui, key):
    tools = keys(ui, Key.c, key, key, look=lambda: ui.tool)
    assert tools == ["KeyboardPointer"] * 3
    assert len(ui.pins) == 1
    assert ui.editor.request is None, "Enter opens no values meanwhile"


def test_shift_and_alt_mean_what_they_do_with_a_click(pinned):
    seen = keys(
        pinned,
        *(Key.c, Key.j, Key.j, SHIFT | Key.enter, Key.j, SHIFT | Key.j, ALT | Key.enter),
        look=lambda: (pinned.editor.selection, len(pinned.pins)),
    )
    assert [selection for selection, _ in seen[:4]] == [set(), {1}, {2}, set()]
    assert seen[-1] == (set(), 2)
    assert [pin.id for pin in pinned.pins] == [1, 2]


def test_escape_and_the_key_again_leave_it(ui):
    tools = keys(ui, Key.c, Key.escape, Key.c, Key.c, look=lambda: ui.tool)
    assert tools == ["KeyboardPointer", "PinsIdle"] * 2


def test_it_stays_through_menus_and_palette(ui):
    tools = keys(ui, Key.c, Key.f10, Key.escape, Key.f3, Key.escape, Key.z, look=lambda: ui.tool)
    assert tools == ["KeyboardPointer"] * 6


def test_the_mouse_takes_over_where_it_really_moves(ui):
    tools = []

    def act(hand):
        x, y = ui.empty_point
        hand.mouse_move_to_pos(imgui.ImVec2(x, y))
        hand.key_press(Key.c)
        for way in (2, 60):
            hand.mouse_move_to_pos(imgui.ImVec2(x + way, y))
            hand.yield_(2)
            tools.append(ui.tool)

    ui.do(act)
    assert tools == ["KeyboardPointer", "PinsIdle"]


def test_it_is_seen(ui):
    snapshots = []
    ui.window.after_draw.append(lambda: snapshots.append(ui.window.screenshot()))
    ((x, y),) = keys(ui, Key.c, look=lambda: tuple(map(round, ui.editor.pointer)))
    arm = slice(y - 1, y + 2), slice(x + 15, x + 28)
    drawn = [(shot[arm] != snapshots[0][arm]).any(axis=2).mean() for shot in snapshots]
    assert max(drawn) > 0.9


def test_the_brush_dabs_where_the_crosshair_is(ui):
    keys(ui, Key.s, Key.c, Key.right_bracket, Key.enter)
    assert ui.session.history.undo_label == "Paint Stiffness"
    assert ui.session.state.stiffness.max() > 50


# -- pins ---------------------------------------------------------------------------------------------------


def test_the_values_of_a_pin_are_changed_by_keys(pinned):
    def act(hand):
        hand.key_press(Key.j)
        hand.key_press(Key.enter)
        hand.yield_(3)
        hand.key_chars_replace("61.5")
        hand.key_press(Key.tab)
        hand.key_chars_replace("77")
        hand.key_press(Key.enter)
        hand.yield_(2)

    pinned.do(act)
    assert pinned.pins[0].target == pytest.approx((61.5, 77.0))


def test_the_menu_of_a_pin_is_walked_by_keys(pinned):
    keys(pinned, Key.j, SHIFT | Key.f10, *[Key.down_arrow] * 3, Key.enter)
    assert [pin.depth for pin in pinned.pins] == [1, 0, 0]


# -- the timeline -------------------------------------------------------------------------------------------


@pytest.fixture
def keyed(pinned):
    """Keyframes at 0 and at 1 second."""
    playback = pinned.state.timeline.keyframe_playback
    pinned.state.timeline.is_shown, pinned.state.timeline.mode = True, "keyframes"
    pinned.settle()
    playback.set_keyframe(0.0)
    gestures.move_pin(pinned.editor, 3, (210.0, 50.0))
    pinned.settle()
    playback.set_keyframe(1.0)
    playback.scrub(0.0)
    pinned.editor.select(())
    pinned.settle()
    return pinned


def test_keyframes_are_chosen_and_retimed_by_keys(keyed):
    keys(keyed, Key.home, Key.period, SHIFT | Key.period, SHIFT | Key.period)
    assert keyed.session.present.animation.times == (0.0, 1.1)


def test_the_menu_of_a_keyframe_changes_its_easing(keyed):
    keys(keyed, Key.period, SHIFT | Key.f10, *[Key.down_arrow] * 2, Key.enter)
    eases = [key.ease for key in keyed.session.present.animation.keyframes]
    assert eases[0] is None
    assert eases[1] is not None


def test_stepping_stops_what_plays(keyed):
    keyed.state.timeline.playback.toggle_playing()
    keys(keyed, Key.page_down)
    assert not keyed.state.timeline.playback.is_playing


def test_the_session_is_looked_back_at_by_keys(pinned):
    pinned.state.timeline.is_shown = True
    gestures.move_pin(pinned.editor, 3, (210.0, 50.0))
    pinned.settle()
    playback = pinned.state.timeline.session_playback
    keys(pinned, Key.home)
    assert playback.time == 0.0
    assert pinned.session.is_previewing
    keys(pinned, Key.end)
    assert playback.time is None


def test_keys_that_walk_a_panel_move_no_time(keyed):
    keyed.state.timeline.keyframe_playback.scrub(0.5)
    keys(keyed, Key.tab, Key.page_down, Key.end, Key.home)
    assert keyed.state.timeline.keyframe_playback.time == 0.5


# -- around the canvas --------------------------------------------------------------------------------------


def pane():
    window = imgui.get_current_context().nav_window
    return window.name if window is not None and imgui.get_io().nav_visible else ""


def test_f6_goes_to_every_pane_and_back_to_the_canvas(keyed):
    keyed.state.view.is_split, keyed.state.part(FirstSteps).is_open = True, True
    keyed.state.view.distortion_measure = "area"
    keyed.settle()
    panes = ["Panel", "Tools", "Timeline", "Comparison", "##legend", "First steps", ""]
    assert keys(keyed, *[Key.f6] * 7, look=pane) == panes
    assert keys(keyed, *[SHIFT | Key.f6] * 7, look=pane) == [*panes[-2::-1], ""]


def test_f6_stops_nowhere_else(ui):
    assert keys(ui, *[Key.f6] * 3, look=pane) == ["Panel", "Tools", ""]


def test_the_second_method_is_chosen_by_keys(pinned):
    pinned.state.view.is_split = True
    pinned.settle()
    before = pinned.state.comparison.spec
    keys(pinned, *[Key.f6] * 3, Key.space, Key.down_arrow, Key.space)
    assert pinned.state.comparison.spec != before


def test_the_range_of_the_scale_is_chosen_by_keys(ui):
    ui.state.view.distortion_measure = "area"
    ui.settle()
    keys(ui, Key.r)
    assert DISTORTION_RANGES[ui.state.view.distortion_range] == 2.0
    keys(ui, *[Key.f6] * 3, Key.space)
    assert DISTORTION_RANGES[ui.state.view.distortion_range] == 4.0
    walk_to(ui, "##range", Key.space, Key.up_arrow, Key.space)
    assert DISTORTION_RANGES[ui.state.view.distortion_range] == 2.0


def test_first_steps_are_put_away_by_keys(ui):
    ui.state.part(FirstSteps).is_open = True
    ui.settle()
    keys(ui, *[Key.f6] * 3, Key.space)
    assert not ui.state.part(FirstSteps).is_open


def test_lists_of_the_panel_are_walked_into(pinned):
    """From the title of the pins down to the second of them."""
    walk_to(pinned, "###section Pins", Key.down_arrow, Key.down_arrow, Key.space)
    assert pinned.editor.selection == {2}
    walk_to(pinned, "###section Pins", *[Key.down_arrow] * 3, SHIFT | Key.space)
    assert pinned.editor.selection == {2, 3}


def test_a_pose_is_ordered_and_forgotten_from_its_menu(ui):
    for _ in range(3):
        gestures.add_pose(ui.editor)
    ui.settle()
    names = [pose.name for pose in ui.session.state.poses]
    walk_to(ui, f"pose {names[2]}", SHIFT | Key.f10, *[Key.down_arrow] * 3, Key.enter)
    assert [pose.name for pose in ui.session.state.poses] == [names[0], names[2], names[1]]
    walk_to(ui, f"pose {names[2]}", Key.menu, *[Key.down_arrow] * 5, Key.enter)
    assert [pose.name for pose in ui.session.state.poses] == [names[0], names[1]]


def walk_to(ui, label, *chords):
    """Walk through the side panel with Tab to an item, and press keys there."""

    def act(hand):
        wanted = hand.item_info(f"//Panel/{label}").id_
        hand.key_press(Key.tab)
        for _ in range(80):
            hand.yield_(2)
            if imgui.get_current_context().nav_id == wanted:
                break
            hand.key_press(Key.tab)
        else:
            raise AssertionError(f"Tab never comes to {label}")
        for chord in chords:
            hand.key_press(int(chord))
            hand.yield_(3)
        hand.key_press(Key.escape)

    ui.do(act)


def test_keys_return_to_the_canvas(pinned):
    pinned.editor.select({2})
    y = pinned.pins[1].target[1]
    keys(pinned, Key.f6, Key.escape, Key.up_arrow)
    assert pinned.pins[1].target[1] == pytest.approx(y - 1)


def test_ctrl_and_arrows_look_around_and_nudge_nothing(pinned):
    pinned.editor.select({2})
    x = pinned.editor.camera.offset[0]
    keys(pinned, CTRL | Key.right_arrow)
    assert pinned.editor.camera.offset[0] < x
    assert pinned.session.history.depth == 0
