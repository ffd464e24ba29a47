"""Pins by keys, by clicks with Alt, by the right button and by their values."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.events import KeyEvent, PinRequest, PointerEvent
from akap_editor.editor.session.replay import replay
from akap_editor.editor.tools.base import DRAG_DISTANCE
from akap_editor.errors import InputError
from tests.support.editor_driver import BESIDE, bits

HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def press(driver, at, button="left", **how):
    driver.handle(PointerEvent("press", driver.editor.camera.to_screen(at), button, **how))


def pause(driver, seconds):
    driver.editor._clock.now += seconds


# -- nudging -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("key", "shift", "way"),
    [
        ("left", False, (-1, 0)),
        ("right", False, (1, 0)),
        ("up", False, (0, -1)),
        ("down", False, (0, 1)),
        ("left", True, (-10, 0)),
    ],
)
def test_arrows_nudge_the_selected_pins(pinned, key, shift, way):
    before = pinned.state.targets
    pinned.editor.select({1, 3})
    pinned.handle(KeyEvent(key, shift=shift))
    np.testing.assert_array_equal(pinned.state.targets, before + np.outer([1, 0, 1], way))
    pinned.settle()
    assert pinned.session.pin_error() < 0.25
    assert pinned.session.history.undo_label == "Nudge 2 Pins"


def test_presses_in_a_row_are_one_entry_that_undo_takes_back_exactly(pinned):
    pinned.editor.select({3})
    before, depth = bits(pinned.state), pinned.depth
    for key in ("up", "up", "left"):
        pinned.handle(KeyEvent(key))
        pinned.advance()
    assert pinned.depth == depth + 1
    assert tuple(pinned.state.pin(3).target) == pytest.approx((END[0] - 1, END[1] - 2))
    pinned.settle()
    after = bits(pinned.state)
    pinned.undo()
    assert bits(pinned.state) == before
    pinned.redo()
    assert bits(pinned.state) == after


@pytest.mark.parametrize("between", ["pause", "selection", "other edit", "undo and redo"])
def test_a_series_ends_with_whatever_else_is_done(pinned, between):
    pinned.editor.select({3})
    pinned.handle(KeyEvent("up"))
    depth = pinned.depth
    if between == "pause":
        pause(pinned, 1.5)
    elif between == "selection":
        pinned.editor.select({2})
    elif between == "other edit":
        gestures.add_pin(pinned.editor, (45.0, 55.0))
        pinned.editor.select({3})
        depth += 1
    else:
        pinned.undo()
        pinned.redo()
    pinned.handle(KeyEvent("up"))
    assert pinned.depth == depth + 1


def test_nudging_without_a_selection_or_in_a_drag_does_nothing(pinned):
    before = pinned.everything
    pinned.handle(KeyEvent("up"))
    assert pinned.everything == before
    pinned.press(END)
    pinned.move((90.0, 60.0))
    target = pinned.state.pin(3).target
    pinned.handle(KeyEvent("up"))
    assert pinned.state.pin(3).target is target


def test_a_series_is_replayed_as_one_entry(pinned, drawing):
    pinned.editor.select({3})
    for _ in range(3):
        pinned.handle(KeyEvent("up", shift=True))
        pinned.advance()
    pinned.settle()
    pinned.undo()
    *_, last = replay(pinned.session.recording, drawing)
    assert bits(last.state) == bits(pinned.state)


# -- removing ----------------------------------------------------------------------------------------------


def test_backspace_removes_the_last_added(pinned):
    gestures.remove_pins(pinned.editor, {2})
    pinned.click((45.0, 55.0))
    for left in ([1, 3], [1], []):
        gestures.remove_last_pin(pinned.editor)
        assert pinned.ids == left
    gestures.remove_last_pin(pinned.editor)
    pinned.undo()
    assert pinned.ids == [1]


def test_alt_click_cuts_one_off_and_undo_brings_it_back(pinned):
    pinned.editor.select({1, 3})
    before = bits(pinned.state)
    press(pinned, NECK, alt=True)
    assert (pinned.tool, pinned.ids) == ("RemovingPin", [1, 2, 3])
    pinned.release(NECK)
    assert pinned.ids == [1, 3]
    assert pinned.editor.selection == {1, 3}
    pinned.undo()
    assert bits(pinned.state) == before


@pytest.mark.parametrize("how", ["drag", "escape"])
def test_an_alt_press_that_is_no_click_cuts_nothing(pinned, how):
    before = pinned.everything
    press(pinned, NECK, alt=True)
    if how == "drag":
        pinned.move((NECK[0], NECK[1] + 2 * DRAG_DISTANCE / pinned.editor.camera.zoom))
    else:
        pinned.key("escape")
    pinned.release(NECK)
    assert pinned.everything == before


@pytest.mark.parametrize("modifier", ["shift", "alt"])
def test_a_click_for_pins_that_misses_them_adds_none(pinned, modifier):
    pinned.editor.select({1})
    pinned.key(modifier)
    pinned.move((45.0, 55.0))
    assert not pinned.would_add_pin
    press(pinned, (45.0, 55.0), **{modifier: True})
    pinned.release((45.0, 55.0))
    assert pinned.ids == [1, 2, 3]
    assert pinned.editor.selection == ({1} if modifier == "shift" else set())
    pinned.key(modifier, pressed=False)
    assert pinned.would_add_pin


def test_shift_drags_a_rubber_band_on_the_drawing(pinned):
    pinned.editor.select({1})
    press(pinned, (50.0, 30.0), shift=True)
    pinned.move((75.0, 50.0))
    assert pinned.tool == "RubberBand"
    pinned.release((75.0, 50.0))
    assert pinned.editor.selection == {1, 2}


# -- menu and values ---------------------------------------------------------------------------------------


def test_a_right_click_on_a_pin_asks_for_its_menu(pinned):
    pinned.editor.select({1})
    before = pinned.state
    pinned.press(NECK, "right")
    assert pinned.editor.request is None
    pinned.release(NECK, "right")
    assert pinned.editor.request == PinRequest("menu", 2)
    assert pinned.editor.selection == {2}
    assert pinned.state is before


def test_the_menu_of_a_selected_pin_keeps_the_selection(pinned):
    pinned.editor.select({1, 2})
    pinned.press(NECK, "right")
    pinned.release(NECK, "right")
    assert pinned.editor.selection == {1, 2}


@pytest.mark.parametrize("start", [NECK, (45.0, 55.0), BESIDE])
def test_a_right_drag_does_nothing(pinned, start):
    before = pinned.everything
    pinned.drag(start, (90.0, 60.0), button="right")
    assert pinned.tool == "PinsIdle"
    assert pinned.everything == before
    assert pinned.editor.request is None


def test_a_double_click_on_a_pin_asks_for_its_values(pinned):
    pinned.click(NECK)
    press(pinned, NECK, clicks=2)
    pinned.release(NECK)
    assert pinned.editor.request == PinRequest("values", 2)
    assert pinned.editor.selection == {2}
    assert not pinned.editor.is_busy


def test_a_double_click_on_the_drawing_adds_one_pin_and_opens_nothing(driver):
    driver.click(NECK)
    press(driver, NECK, clicks=2)
    driver.release(NECK)
    assert driver.ids == [1]
    assert driver.editor.request is None
    driver.click(NECK)
    press(driver, NECK, clicks=2)
    assert driver.editor.request == PinRequest("values", 1)


def test_a_request_goes_with_its_pin(pinned):
    pinned.editor.request_pin_popup("values", 2)
    pinned.undo()
    pinned.undo()
    assert pinned.ids == [1]
    assert pinned.editor.request is None


def test_a_pin_goes_to_the_values_given_in_one_gesture(pinned):
    depth = pinned.depth
    gestures.move_pin(pinned.editor, 3, (95.0, 55.0))
    pinned.settle()
    np.testing.assert_allclose(pinned.where(3), (95.0, 55.0), atol=0.25)
    assert (pinned.depth, pinned.session.history.undo_label) == (depth + 1, "Move Pin")
    pinned.undo()
    before = pinned.everything
    with pytest.raises(InputError):
        gestures.move_pin(pinned.editor, 3, (np.nan, 0.0))
    with pytest.raises(InputError):
        gestures.move_pin(pinned.editor, 9, (1.0, 1.0))
    assert pinned.everything == before


def test_held_keys(pinned, drawing):
    for name in ("h", "alt"):
        pinned.key(name)
    assert pinned.editor.held == {"h", "alt"}
    pinned.key("alt", pressed=False)
    assert pinned.editor.held == {"h"}
    pinned.editor.open(new_document(drawing))
    assert pinned.editor.held == {"h"}


def test_hints_say_what_alt_and_shift_do(pinned):
    pinned.move(NECK)
    plain = pinned.editor.hint
    pinned.key("alt")
    assert "remove" in pinned.editor.hint
    pinned.key("alt", pressed=False)
    pinned.key("shift")
    assert "select" in pinned.editor.hint
    assert pinned.editor.hint != plain
