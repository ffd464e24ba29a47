"""Clicks of the pins tool with Alt and Shift, with the right button, and double clicks."""

import pytest

from akap_editor.editor.events import PinRequest, PointerEvent
from akap_editor.editor.tools.base import DRAG_DISTANCE
from tests.support.editor_driver import OUTSIDE, bits

NECK = (62.0, 40.0)


def press(driver, at, button="left", **how):
    driver.handle(PointerEvent("press", driver.editor.camera.to_screen(at), button, **how))


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


@pytest.mark.parametrize("start", [NECK, (45.0, 55.0), OUTSIDE])
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


def test_hints_say_what_alt_and_shift_do(pinned):
    pinned.move(NECK)
    plain = pinned.editor.hint
    pinned.key("alt")
    assert "remove" in pinned.editor.hint
    pinned.key("alt", pressed=False)
    pinned.key("shift")
    assert "select" in pinned.editor.hint
    assert pinned.editor.hint != plain
