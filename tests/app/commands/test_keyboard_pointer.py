"""Commands that replace the mouse on the canvas: the crosshair, pins by keys, panning."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.commands.command import ALT, CTRL, SHIFT, Key
from akap_editor.editor.tools.keyboard_pointer import BIG_STEP, STEP


@pytest.fixture(autouse=True)
def nothing_watched(module_window):
    yield
    module_window.window.after_draw.clear()


def test_a_pin_is_set_nudged_and_removed_by_keys_alone(ui):
    keys = Key.c, Key.enter, Key.escape, Key.up_arrow, SHIFT | Key.left_arrow
    seen = ui.keys(*keys, look=lambda: (ui.editor.pointer, [tuple(pin.target) for pin in ui.pins]))
    x, y = ui.to_drawing(seen[0][0])
    assert seen[1][1] == [pytest.approx((x, y), abs=0.01)]
    (pin,) = ui.pins
    assert ui.editor.selection == {pin.id}
    assert ui.pins[0].target == pytest.approx((x - 10, y - 1), abs=0.01)
    ui.keys(Key.delete)
    assert not ui.pins


def test_arrows_move_the_crosshair_on_the_screen(ui):
    seen = ui.keys(Key.c, Key.left_arrow, SHIFT | Key.down_arrow, look=lambda: ui.editor.pointer)
    (x, y), *others = seen
    assert others == [(x - STEP, y), (x - STEP, y + BIG_STEP)]


@pytest.mark.parametrize("key", [Key.enter, Key.keypad_enter, Key.space])
def test_these_keys_click_once(ui, key):
    tools = ui.keys(Key.c, key, key, look=lambda: ui.tool)
    assert tools == ["KeyboardPointer"] * 3
    assert len(ui.pins) == 1
    assert ui.editor.request is None, "Enter opens no values meanwhile"


def test_shift_and_alt_mean_what_they_do_with_a_click(pinned):
    seen = pinned.keys(
        *(Key.c, Key.j, Key.j, SHIFT | Key.enter, Key.j, SHIFT | Key.j, ALT | Key.enter),
        look=lambda: (pinned.editor.selection, len(pinned.pins)),
    )
    assert [selection for selection, _ in seen[:4]] == [set(), {1}, {2}, set()]
    assert seen[-1] == (set(), 2)
    assert [pin.id for pin in pinned.pins] == [1, 2]


def test_escape_and_the_key_again_leave_it(ui):
    tools = ui.keys(Key.c, Key.escape, Key.c, Key.c, look=lambda: ui.tool)
    assert tools == ["KeyboardPointer", "PinsIdle"] * 2


def test_it_stays_through_menus_and_palette(ui):
    tools = ui.keys(Key.c, Key.f10, Key.escape, Key.f3, Key.escape, Key.z, look=lambda: ui.tool)
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
    ((x, y),) = ui.keys(Key.c, look=lambda: tuple(map(round, ui.editor.pointer)))
    arm = slice(y - 1, y + 2), slice(x + 15, x + 28)
    drawn = [(shot[arm] != snapshots[0][arm]).any(axis=2).mean() for shot in snapshots]
    assert max(drawn) > 0.9


def test_the_brush_dabs_where_the_crosshair_is(ui):
    ui.keys(Key.b, Key.c, Key.right_bracket, Key.enter)
    assert ui.session.history.undo_label == "Paint Stiffness"
    assert ui.session.state.stiffness.max() > 50


def test_the_values_of_a_pin_are_changed_by_keys(pinned):
    def act(hand):
        hand.key_press(Key.j)
        hand.key_press(Key.f2)
        hand.yield_(3)
        hand.key_chars_replace("61.5")
        hand.key_press(Key.tab)
        hand.key_chars_replace("77")
        hand.key_press(Key.enter)
        hand.yield_(2)

    pinned.do(act)
    assert pinned.pins[0].target == pytest.approx((61.5, 77.0))


def test_the_menu_of_a_pin_is_walked_by_keys(pinned):
    pinned.keys(Key.j, SHIFT | Key.f10, *[Key.down_arrow] * 3, Key.enter)
    assert [pin.depth for pin in pinned.pins] == [1, 0, 0]


def test_ctrl_and_arrows_look_around_and_nudge_nothing(pinned):
    pinned.editor.select({2})
    x = pinned.editor.camera.offset[0]
    pinned.keys(CTRL | Key.right_arrow)
    assert pinned.editor.camera.offset[0] < x
    assert pinned.session.history.depth == 0
