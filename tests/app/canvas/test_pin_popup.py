"""The popup of a pin: its menu on a right click, its values on a double click."""

from imgui_bundle import imgui  # isort: skip
import math

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.events import PinRequest

Key = imgui.Key


def open_menu(ui, pin, *actions):
    """Click a pin with the right button, then act on its menu."""
    _open(ui, pin, lambda hand: hand.mouse_click(1), actions)


def open_values(ui, pin, *actions):
    """Double-click a pin, then act on its values."""
    _open(ui, pin, lambda hand: hand.mouse_double_click(0), actions)


def _open(ui, pin, click, actions):
    """All in one run, because the Test Engine closes popups at the end of a run."""

    def act(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*ui.to_screen(ui.pin_position(pin))))
        click(hand)
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

    open_values(pinned, 3, type_half, type_all)
    assert seen == [PinRequest("values", 3), revision, PinRequest("values", 3)], "half a number moves nothing"
    assert pinned.editor.request is None
    np.testing.assert_allclose(pinned.session.state.pin(3).target, (195, 80))
    np.testing.assert_allclose(pinned.pin_position(3), (195, 80), atol=0.25)
    assert pinned.session.history.labels == ["Move Pin"]


def test_escape_closes_the_values_at_once(pinned):
    before = pinned.session.state
    open_values(pinned, 3, lambda hand: (hand.key_chars_replace("19"), hand.key_press(Key.escape)))
    assert pinned.editor.request is None
    assert pinned.session.state is before


@pytest.mark.parametrize("end", [Key.escape, Key.enter, Key.tab])
def test_looking_at_the_values_changes_nothing_however_many_digits_they_have(pinned, end):
    gestures.move_pin(pinned.editor, 3, (209.123456789, 80.987654321))
    pinned.settle()
    gestures.set_pin_angle(pinned.editor, 3, 0.123456789)
    pinned.settle()
    before, labels = pinned.session.state, pinned.session.history.labels
    open_values(pinned, 3, *([lambda hand: hand.key_press(end)] * 4), lambda hand: hand.key_press(Key.escape))
    assert pinned.session.history.labels == labels
    assert pinned.session.state is before


def test_a_double_click_on_the_drawing_adds_one_pin(ui):
    def act(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*ui.to_screen((100.0, 80.0))))
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

    open_menu(pinned, 2, choose)
    assert seen == [(PinRequest("menu", 2), {2}), request_after]
    assert (len(pinned.pins), len(pinned.editor.selection)) == (pins, selected)


def test_a_click_beside_an_open_menu_closes_it_and_adds_no_pin(pinned):
    counts = []

    def click_beside(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*pinned.to_screen((80.0, 60.0))))
        hand.mouse_click(0)
        hand.yield_(2)
        counts.append((pinned.editor.request, len(pinned.pins)))

    open_menu(pinned, 2, click_beside, click_beside)
    assert counts == [(None, 3), (None, 4)]


def test_the_menu_of_a_pin_holds_its_angle_and_lets_it_go(pinned):
    choose = [lambda hand: hand.item_click("//$FOCUSED/Hold Angle")]
    open_menu(pinned, 2, *choose)
    assert pinned.session.state.pin(2).angle == pytest.approx(0.0, abs=1e-9)
    open_menu(pinned, 2, *choose)
    assert pinned.session.state.pin(2).angle is None
    assert pinned.session.history.labels == ["Hold Angle", "Release Angle"]


def test_the_values_of_a_pin_have_its_angle_in_degrees(pinned):
    def type_angle(hand):
        hand.item_input("//$FOCUSED/##Angle")
        hand.key_chars_replace_enter("30")
        hand.yield_(2)

    open_values(pinned, 2, type_angle)
    assert pinned.session.state.pin(2).angle == pytest.approx(math.radians(30))
    assert pinned.session.pin_angle(2) == pytest.approx(math.radians(30), abs=0.02)
    open_values(pinned, 2, lambda hand: hand.item_click("//$FOCUSED/Hold angle"))
    assert pinned.session.state.pin(2).angle is None
