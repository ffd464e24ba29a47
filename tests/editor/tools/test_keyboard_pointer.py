"""The pointer moved by keys: it adds, takes and cuts pins, paints, and stays in sight."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.events import KeyEvent, PointerEvent
from akap_editor.editor.tools.keyboard_pointer import (
    BIG_STEP,
    MARGIN,
    STEP,
)
from akap_editor.errors import SolverError
from tests.support.editor_driver import OUTSIDE

NECK, END = (62.0, 40.0), (105.0, 40.0)


def at(driver, place):
    """Start the keyboard pointer at a point of the drawing, as if the mouse had left the canvas from it."""
    driver.move(place)
    driver.editor.pointer_left()
    driver.editor.toggle_keyboard_pointer()
    assert driver.tool == "KeyboardPointer"
    assert driver.editor.camera.to_drawing(driver.editor.pointer) == pytest.approx(place)


def enter(driver):
    driver.handle(KeyEvent("enter"))


def middle(editor):
    left, top, right, bottom = editor.canvas
    return (left + right) / 2, (top + bottom) / 2


def test_it_begins_where_the_mouse_was_last_or_in_the_middle(driver):
    driver.editor.toggle_keyboard_pointer()
    assert driver.editor.pointer == middle(driver.editor)
    driver.editor.toggle_keyboard_pointer()
    assert driver.tool == "PinsIdle"
    at(driver, NECK)
    driver.key("escape")
    assert driver.tool == "PinsIdle"
    driver.editor.canvas = (5000.0, 0.0, 6000.0, 500.0)
    driver.editor.toggle_keyboard_pointer()
    assert driver.editor.pointer == middle(driver.editor), "where the mouse was is no canvas any more"


def test_arrows_move_it_and_no_pin(pinned):
    pinned.editor.toggle_keyboard_pointer()
    pinned.editor.select(pinned.ids)
    before, (x, y) = pinned.everything, pinned.editor.pointer
    for name in ("left", "left", "up"):
        pinned.key(name)
    assert pinned.editor.pointer == (x - 2 * STEP, y - STEP)
    pinned.handle(KeyEvent("down", shift=True))
    pinned.editor.ui_scale = 2.0
    pinned.key("right")
    assert pinned.editor.pointer == (x, y - STEP + BIG_STEP)
    assert pinned.everything == before


def test_enter_adds_a_pin_exactly_there_in_one_gesture(driver):
    at(driver, NECK)
    assert driver.would_add_pin
    depth = driver.depth
    enter(driver)
    assert driver.tool == "KeyboardPointer"
    assert driver.where(driver.ids[-1]) == pytest.approx(NECK, abs=0.01)
    assert driver.editor.selection == {driver.ids[-1]}
    assert driver.depth == depth + 1
    enter(driver)
    assert len(driver.ids) == 1, "the second one selects the pin"
    driver.undo()
    assert not driver.ids


def test_enter_beside_the_drawing_adds_nothing(driver):
    at(driver, OUTSIDE)
    assert not driver.would_add_pin
    before = driver.everything
    enter(driver)
    assert driver.everything == before
    assert driver.tool == "KeyboardPointer"


def test_enter_selects_with_shift_several_and_alt_removes(pinned):
    first, second = pinned.ids[:2]
    at(pinned, pinned.where(first))
    assert pinned.hovered_pin == first
    enter(pinned)
    assert pinned.editor.selection == {first}
    pinned.editor.tool.reveal_pin(second)
    pinned.key("shift")
    enter(pinned)
    assert pinned.editor.selection == {first, second}
    enter(pinned)
    assert pinned.editor.selection == {first}
    pinned.key("shift", False)
    pinned.key("alt")
    enter(pinned)
    assert second not in pinned.ids


def test_once_it_is_left_arrows_nudge_the_pin_that_was_taken(pinned):
    pin = pinned.ids[-1]
    at(pinned, pinned.where(pin))
    enter(pinned)
    pinned.key("escape")
    x, y = pinned.state.pin(pin).target
    pinned.key("up")
    assert pinned.state.pin(pin).target == pytest.approx((x, y - 1))


def test_the_canvas_moves_to_keep_it_in_sight(driver):
    driver.editor.toggle_keyboard_pointer()
    left, top, right, bottom = driver.editor.canvas
    seen = []
    for _ in range(40):
        driver.handle(KeyEvent("right", shift=True))
        seen.append(driver.editor.camera.to_drawing(driver.editor.pointer)[0])
        assert driver.editor.pointer[0] <= right - MARGIN
    step = BIG_STEP / driver.editor.camera.zoom
    assert np.diff(seen) == pytest.approx(step), "it moves on over the drawing"
    driver.editor.canvas = (left, top, right - 300, bottom)
    assert driver.editor.pointer[0] == right - 300


def test_at_the_edge_it_comes_in_without_a_move_of_the_canvas(driver):
    left, top, _, _ = driver.editor.canvas
    driver.handle(PointerEvent("move", (left + 5, top + 5)))
    camera = driver.editor.camera
    driver.editor.toggle_keyboard_pointer()
    driver.key("right")
    driver.key("down")
    assert driver.editor.pointer == (left + 5 + STEP, top + 5 + STEP)
    assert driver.editor.camera == camera
    driver.key("left")
    assert driver.editor.pointer == (left + 5 + STEP, top + 5 + STEP)
    assert driver.editor.camera == camera.panned(STEP, 0.0)


def test_nothing_is_panned_where_it_is_in_sight(driver):
    camera = driver.editor.camera
    assert driver.editor.reveal(middle(driver.editor)) == middle(driver.editor)
    assert driver.editor.camera == camera
    driver.editor.canvas = (0.0, 0.0, 40.0, 30.0)
    assert driver.editor.reveal((500.0, -20.0)) == pytest.approx((20.0, 15.0)), "no room for a margin"


def test_the_mouse_takes_over_again(driver):
    driver.editor.toggle_keyboard_pointer()
    driver.editor.pointer_left()
    assert driver.editor.pointer is not None, "the crosshair is no mouse that could leave"
    driver.move(NECK)
    assert driver.tool == "PinsIdle"
    assert driver.editor.camera.to_drawing(driver.editor.pointer) == pytest.approx(NECK)


def test_it_hinders_no_edit_and_stays(pinned):
    pinned.editor.toggle_keyboard_pointer()
    pinned.editor.select({pinned.ids[0]})
    gestures.remove_selected_pins(pinned.editor)
    pinned.undo()
    pinned.editor.cancel()
    assert len(pinned.ids) == 3
    assert pinned.tool == "KeyboardPointer"


def test_it_ends_with_the_drawing(driver):
    driver.editor.toggle_keyboard_pointer()
    driver.editor.open(new_document(driver.session.drawing))
    assert driver.tool == "PinsIdle"
    driver.editor.toggle_keyboard_pointer()
    driver.editor.close()
    assert driver.tool == "PinsIdle"
    driver.editor.toggle_keyboard_pointer()
    assert driver.tool == "PinsIdle", "without a document it does not start"


def test_it_waits_for_the_end_of_a_gesture(pinned):
    pinned.press(pinned.where(pinned.ids[0]))
    pinned.editor.toggle_keyboard_pointer()
    assert pinned.tool == "PointingPin"


def test_zooming_holds_what_it_points_at(driver):
    at(driver, END)
    driver.editor.zoom(2.0)
    assert driver.editor.camera.to_drawing(driver.editor.pointer) == pytest.approx(END)


@pytest.mark.parametrize("erasing", [False, True])
def test_enter_dabs_with_the_brush(driver, erasing):
    editor = driver.editor
    editor.chosen_tool = editor.brush_tool
    at(driver, NECK)
    enter(driver)
    assert driver.session.history.undo_label == "Paint Stiffness"
    assert driver.state.stiffness.max() > 50
    if erasing:
        editor.brush_tool.brush = type(editor.brush_tool.brush)(erasing=True)
        assert "erases" in editor.hint
        enter(driver)
        assert driver.state.stiffness is None or driver.state.stiffness.max() < 50
    assert driver.tool == "KeyboardPointer"


def test_the_hand_is_laid_aside(driver):
    driver.editor.chosen_tool = driver.editor.hand_tool
    at(driver, NECK)
    enter(driver)
    assert len(driver.ids) == 1


def test_hints_say_what_enter_does(pinned):
    at(pinned, OUTSIDE)
    assert "Arrows" in pinned.editor.hint
    pinned.editor.tool.reveal_pin(pinned.ids[0])
    assert "selects this pin" in pinned.editor.hint
    pinned.key("alt")
    assert "removes" in pinned.editor.hint
    pinned.key("alt", False)
    pinned.key("escape")
    at(pinned, (50.0, 45.0))
    assert "adds a pin" in pinned.editor.hint


def test_what_goes_wrong_on_enter_is_taken_back(driver, monkeypatch):
    def fail(session, place):
        raise SolverError("no answer")

    at(driver, NECK)
    monkeypatch.setattr("akap_editor.editor.tools.pins.add_pin", fail)
    with pytest.raises(SolverError):
        driver.editor.handle_event(KeyEvent("enter"))
    monkeypatch.undo()
    driver.check()
    assert not driver.session.history.is_open
    assert not driver.ids


# -- pins one after the other -------------------------------------------------------------------------------


def test_pins_are_selected_one_after_the_other_and_around(pinned):
    first, second, third = pinned.ids
    pinned.editor.select(())
    seen = []
    for forward in (True, True, True, True, False, False):
        pinned.editor.select_next(forward)
        seen.append(*pinned.editor.selection)
    assert seen == [first, second, third, first, third, second]
    pinned.editor.select(())
    pinned.editor.select_next(False)
    assert pinned.editor.selection == {third}
    pinned.editor.select({first, second})
    pinned.editor.select_next()
    assert pinned.editor.selection == {third}


def test_a_pin_out_of_sight_is_brought_there(pinned):
    pinned.editor.camera = pinned.editor.camera.panned(-5000.0, 300.0)
    pinned.editor.select(())
    pinned.editor.select_next()
    x, y = pinned.editor.pins_on_screen()[pinned.ids[0]]
    left, top, right, bottom = pinned.editor.canvas
    assert left < x < right
    assert top < y < bottom


def test_the_crosshair_goes_along(pinned):
    pinned.editor.toggle_keyboard_pointer()
    pinned.editor.select_next()
    assert pinned.tool == "KeyboardPointer"
    assert pinned.hovered_pin == pinned.ids[0]


def test_without_pins_there_is_none_to_go_to(driver):
    driver.editor.select_next()
    assert not driver.editor.selection


def test_a_click_of_the_mouse_where_it_stands_ends_it(driver):
    driver.editor.toggle_keyboard_pointer()
    driver.handle(PointerEvent("press", driver.editor.camera.to_screen(NECK)))
    driver.handle(PointerEvent("release", driver.editor.camera.to_screen(NECK)))
    assert driver.tool == "PinsIdle"
    assert len(driver.ids) == 1
