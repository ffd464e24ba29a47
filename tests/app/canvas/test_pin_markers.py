"""Pins in the window: keys, Alt, the right button, double clicks, and what opens at a pin."""

from imgui_bundle import imgui  # isort: skip
import numpy as np
import pytest

from akap_editor.app.commands import registry as commands
from akap_editor.editor.events import PinRequest

Key = imgui.Key


def test_arrows_nudge_also_after_a_click_on_a_panel(pinned):
    pinned.reset(pinned.document, clock=lambda: 0.0)  # one series, however slow the machine is
    pinned.editor.select({3})
    before = pinned.session.state.pin(3).target

    def nudge(hand):
        hand.item_click(f"//Tools/{commands.SHOW_MESH.icon}##{commands.SHOW_MESH.label}")
        for chord in (Key.up_arrow, Key.up_arrow, Key.mod_shift | Key.left_arrow):
            hand.key_press(int(chord))

    pinned.do(nudge)
    np.testing.assert_allclose(pinned.session.state.pin(3).target, np.add(before, (-10, -2)), atol=1e-9)
    assert pinned.session.history.labels == ["Nudge Pin"]
    assert pinned.state.show_mesh


def test_backspace_removes_the_last_pin(pinned):
    pinned.key(Key.backspace)
    assert [pin.id for pin in pinned.pins] == [1, 2]


def test_alt_click_cuts_a_pin_off_and_the_keyboard_stays_with_the_canvas(pinned):
    at = pinned.screen(pinned.pin_place(2))

    def cut(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*at))
        hand.key_down(Key.mod_alt)
        hand.mouse_click(0)
        hand.key_up(Key.mod_alt)
        hand.yield_(2)

    pinned.do(cut)
    assert [pin.id for pin in pinned.pins] == [1, 3]
    assert not pinned.editor.held
    pinned.key(Key.m)
    assert pinned.state.show_mesh


def test_h_hides_the_pins_while_it_is_held(pinned):
    shown = pinned.screenshot()
    snapshots = []

    def hold(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*pinned.empty_place))
        hand.key_down(Key.h)
        hand.yield_(2)
        pinned.on_main_thread(hand, lambda: pinned.window.after_draw.append(shoot))
        hand.yield_(2)
        hand.key_up(Key.h)

    def shoot():
        snapshots.append(pinned.window.screenshot())
        pinned.window.after_draw.clear()

    pinned.do(hold)
    pinned.state.show_pins = False
    hidden = pinned.screenshot()
    canvas = slice(0, round(pinned.editor.canvas[2]))
    assert (snapshots[0][:, canvas] == hidden[:, canvas]).all()
    pinned.state.show_pins = True
    assert (pinned.screenshot() == shown).all()


def at_pin(ui, pin, button, clicks, *actions):
    """Click a pin and go on while what opened is there: at the end of its run Test Engine closes popups."""

    def act(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*ui.screen(ui.pin_place(pin))))
        (hand.mouse_click if clicks == 1 else hand.mouse_double_click)(button)
        hand.yield_(3)
        for action in actions:
            action(hand)
            hand.yield_(2)

    ui.do(act)


def test_a_double_click_opens_the_values_which_move_the_pin(pinned):
    revision, seen = pinned.document.revision, []

    def type_half(hand):
        seen.append(pinned.editor.request)
        hand.key_chars_replace("19")  # X has the keyboard
        hand.yield_(2)
        seen.append(pinned.document.revision)

    def type_all(hand):
        hand.key_chars("5")
        hand.key_press(Key.enter)
        hand.yield_(2)
        seen.append(pinned.editor.request)
        hand.key_press(Key.escape)

    at_pin(pinned, 3, 0, 2, type_half, type_all)
    assert seen == [PinRequest("values", 3), revision, PinRequest("values", 3)], "half a number moves nothing"
    assert pinned.editor.request is None
    np.testing.assert_allclose(pinned.session.state.pin(3).target, (195, 80))
    np.testing.assert_allclose(pinned.pin_place(3), (195, 80), atol=0.25)
    assert pinned.session.history.labels == ["Move Pin"]


def test_escape_closes_the_values_at_once(pinned):
    before = pinned.session.state
    at_pin(pinned, 3, 0, 2, lambda hand: (hand.key_chars_replace("19"), hand.key_press(Key.escape)))
    assert pinned.editor.request is None
    assert pinned.session.state is before


def test_a_double_click_on_the_drawing_adds_one_pin(ui):
    def act(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*ui.screen((100.0, 80.0))))
        hand.mouse_double_click(0)
        hand.yield_(3)
        assert ui.editor.request is None

    ui.do(act)
    assert len(ui.pins) == 1


@pytest.mark.parametrize(
    ("label", "request_after", "pins", "selected"),
    [
        ("Remove Selected Pins", None, 2, 0),
        ("Select All Pins", None, 3, 3),
        ("Values...", PinRequest("values", 2), 3, 1),
    ],
)
def test_a_right_click_opens_the_menu_of_a_pin(pinned, label, request_after, pins, selected):
    seen = []

    def choose(hand):
        seen.append((pinned.editor.request, pinned.editor.selection))
        hand.item_click(f"//$FOCUSED/{label}")
        hand.yield_(2)
        seen.append(pinned.editor.request)

    at_pin(pinned, 2, 1, 1, choose)
    assert seen == [(PinRequest("menu", 2), {2}), request_after]
    assert (len(pinned.pins), len(pinned.editor.selection)) == (pins, selected)


def test_a_click_beside_an_open_menu_closes_it_and_adds_no_pin(pinned):
    counts = []

    def click_beside(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*pinned.screen((80.0, 60.0))))
        hand.mouse_click(0)
        hand.yield_(2)
        counts.append((pinned.editor.request, len(pinned.pins)))

    at_pin(pinned, 2, 1, 1, click_beside, click_beside)
    assert counts == [(None, 3), (None, 4)]
