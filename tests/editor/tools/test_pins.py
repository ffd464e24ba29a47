"""Clicks, presses and boxes of the pins tool."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.camera import Camera
from akap_editor.editor.editor import PICK_RADIUS
from akap_editor.editor.tools.base import DRAG_DISTANCE
from akap_editor.errors import InputError
from tests.support.editor_driver import OUTSIDE, bits

HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def drag_end(driver, at):
    """A point at a distance that makes a movement a drag."""
    return at[0], at[1] + 2 * DRAG_DISTANCE / driver.editor.camera.zoom


def click_end(driver, at):
    """A point at a distance that a click may have."""
    return at[0], at[1] + 0.5 * DRAG_DISTANCE / driver.editor.camera.zoom


# -- pointing ----------------------------------------------------------------------------------------------


def test_a_click_on_the_drawing_adds_a_pin_and_selects_it(driver):
    driver.click(NECK)
    assert driver.ids == [1]
    assert driver.editor.selection == {1}
    assert driver.depth == 1
    assert driver.session.history.undo_label == "Add Pin"


def test_a_pin_sits_exactly_where_it_was_clicked(pinned):
    pinned.drag(END, (85.0, 65.0))
    pinned.settle()
    for pin, at in enumerate([(30.3, 21.7), (45.123, 44.456)], start=4):
        pinned.click(at)
        np.testing.assert_allclose(pinned.where(pin), at, rtol=0, atol=1e-9)
        np.testing.assert_allclose(pinned.state.pin(pin).target, at, rtol=0, atol=1e-9)


def test_adding_and_removing_pins_moves_no_vertex_even_while_it_settles(pinned):
    pinned.drag(END, (85.0, 65.0), steps=2)
    assert pinned.editor.is_moving
    pose = pinned.state.positions.tobytes()
    pinned.click((40.0, 25.0))
    pinned.settle()
    assert pinned.state.positions.tobytes() == pose
    pinned.drag(HEAD, (25.0, 45.0), steps=2)
    assert pinned.editor.is_moving
    pose = pinned.state.positions.tobytes()
    gestures.remove_pins(pinned.editor, [1, 2])
    pinned.settle()
    assert pinned.state.positions.tobytes() == pose


def test_a_click_on_a_pin_selects_it_alone(pinned):
    pinned.editor.select_all()
    pinned.click(NECK)
    assert pinned.editor.selection == {2}


def test_shift_click_adds_to_the_selection_and_takes_from_it(pinned):
    pinned.click(HEAD)
    pinned.click(END, shift=True)
    assert pinned.editor.selection == {1, 3}
    pinned.click(HEAD, shift=True)
    assert pinned.editor.selection == {3}


def test_a_trembling_click_on_a_pin_does_not_drag_it(pinned):
    before, depth = bits(pinned.state), pinned.depth
    pinned.press(NECK)
    pinned.move(click_end(pinned, NECK))
    assert pinned.tool == "PointingPin"
    pinned.release(click_end(pinned, NECK))
    assert (bits(pinned.state), pinned.depth) == (before, depth)
    pinned.press(NECK)
    pinned.move(drag_end(pinned, NECK))
    assert pinned.tool == "DraggingPin"


@pytest.mark.parametrize(("zoom", "ui_scale"), [(0.5, 1.0), (1.0, 1.0), (3.0, 1.0), (1.0, 2.0)])
def test_pins_are_picked_within_a_radius_on_the_screen(driver, zoom, ui_scale):
    driver.click(NECK)
    driver.editor.camera, driver.editor.ui_scale = Camera(zoom, (100.0, 50.0)), ui_scale
    radius = PICK_RADIUS * ui_scale
    x, y = driver.editor.camera.to_screen(NECK)
    assert driver.editor.pin_at((x + radius - 0.1, y)) == 1
    assert driver.editor.pin_at((x, y - radius - 0.1)) is None
    driver.click((NECK[0] + (radius - 0.1) / zoom, NECK[1]))
    assert driver.ids == [1]
    driver.click((NECK[0] + (radius + 0.1) / zoom, NECK[1]))
    assert driver.ids == [1, 2]


def test_the_nearest_of_several_pins_is_picked(driver):
    gestures.add_pin(driver.editor, NECK)
    gestures.add_pin(driver.editor, (64.0, 40.0))
    driver.editor.camera = Camera()
    assert driver.editor.pin_at((62.5, 40.0)) == 1
    assert driver.editor.pin_at((63.5, 40.0)) == 2


def test_an_unusable_position_leaves_no_gesture_open(pinned):
    before = pinned.everything
    with pytest.raises(InputError):
        pinned.press((np.nan, 1.0))
    assert pinned.tool == "PinsIdle"
    assert pinned.everything == before
    pinned.press(END)
    pinned.move((90.0, 60.0))
    assert pinned.tool == "DraggingPin"
    with pytest.raises(InputError):
        pinned.move((np.inf, 1.0))
    assert pinned.tool == "PinsIdle"
    pinned.editor.select(())
    assert pinned.everything == before


# -- the canvas --------------------------------------------------------------------------------------------


def test_a_click_beside_the_drawing_clears_the_selection_and_shift_keeps_it(pinned):
    pinned.editor.select({1, 2})
    pinned.click(OUTSIDE, shift=True)
    assert pinned.editor.selection == {1, 2}
    pinned.click(OUTSIDE)
    assert pinned.editor.selection == frozenset()


def test_a_click_beside_the_drawing_does_not_stop_it_settling(pinned):
    pinned.drag(END, (88.0, 66.0), steps=2)
    pinned.click(OUTSIDE)
    assert pinned.editor.is_moving
    pinned.settle()
    assert np.hypot(*np.subtract(pinned.where(3), (88.0, 66.0))) < 0.25


@pytest.mark.parametrize(("shift", "selected"), [(False, {1, 2}), (True, {1, 2, 3})])
def test_a_rubber_band_selects_the_pins_inside(pinned, shift, selected):
    pinned.editor.select({3})
    pinned.press(OUTSIDE, shift=shift)
    pinned.move((118.0, 78.0))
    assert pinned.editor.selection == {1, 2, 3}
    pinned.move((70.0, 60.0))
    assert pinned.editor.selection == selected
    pinned.release((70.0, 60.0))
    assert pinned.editor.selection == selected


def test_a_rubber_band_may_be_drawn_backwards(pinned):
    pinned.drag((118.0, 78.0), (55.0, 5.0))
    assert pinned.editor.selection == {2, 3}
