"""Each state of the pointer completes, cancels without a trace, and can be undone bit for bit."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.camera import Camera
from akap_editor.editor.editor import PICK_RADIUS
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.tools.base import DRAG_DISTANCE
from akap_editor.errors import InputError
from tests.support.editor_driver import BESIDE, bits

HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def far(driver, at):
    """A place that is just a drag away on the screen."""
    return at[0], at[1] + 2 * DRAG_DISTANCE / driver.editor.camera.zoom


def near(driver, at):
    """A place that a trembling hand reaches within a click."""
    return at[0], at[1] + 0.5 * DRAG_DISTANCE / driver.editor.camera.zoom


# -- what each state is entered by, and how it looks --------------------------------------------------------


def enter_pointing_new_pin(d):
    d.press((50.0, 45.0))
    return "PointingPin"


def enter_pointing_pin(d):
    d.press(NECK)
    return "PointingPin"


def enter_dragging_pin(d):
    d.press(END)
    d.move((90.0, 60.0))
    d.advance()
    return "DraggingPin"


def enter_dragging_pins(d):
    d.press(END, shift=True)
    d.move((95.0, 55.0))
    d.advance()
    return "DraggingPin"


def enter_dragging_new_pin(d):
    d.press((50.0, 45.0))
    d.move((55.0, 55.0))
    d.advance()
    return "DraggingPin"


def enter_pointing_canvas(d):
    d.press(BESIDE)
    return "PointingCanvas"


def enter_rubber_band(d):
    d.press(BESIDE)
    d.move((70.0, 70.0))
    return "RubberBand"


def enter_panning(d):
    d.press(NECK, "middle")
    d.move((70.0, 70.0), "middle")
    return "Panning"


def enter_cutting_pin(d):
    d.handle(PointerEvent("press", d.editor.camera.to_screen(NECK), alt=True))
    return "RemovingPin"


def enter_asking_for_menu(d):
    d.press(NECK, "right")
    return "OpeningPinMenu"


ENTER = [
    enter_pointing_new_pin,
    enter_pointing_pin,
    enter_dragging_pin,
    enter_dragging_pins,
    enter_dragging_new_pin,
    enter_pointing_canvas,
    enter_rubber_band,
    enter_panning,
    enter_cutting_pin,
    enter_asking_for_menu,
]
BUTTON = {"Panning": "middle", "OpeningPinMenu": "right"}  # that ends a gesture; else the left one


@pytest.mark.parametrize("enter", ENTER)
@pytest.mark.parametrize("way_out", ["escape", "cancel", "undo"])
def test_a_cancelled_gesture_leaves_no_trace(pinned, enter, way_out):
    pinned.editor.select({2})
    before = pinned.everything
    assert enter(pinned) == pinned.tool
    {"escape": lambda: pinned.key("escape"), "cancel": pinned.editor.cancel, "undo": pinned.undo}[way_out]()
    assert pinned.tool == "PinsIdle"
    assert pinned.everything == before
    pinned.settle()
    assert pinned.everything == before


@pytest.mark.parametrize("enter", ENTER)
def test_after_a_cancelled_gesture_the_rest_of_it_does_nothing(pinned, enter):
    pinned.editor.select({2})
    before = pinned.everything
    enter(pinned)
    pinned.key("escape")
    for button in ("left", "middle", "right"):
        pinned.move((30.0, 30.0), button)
        pinned.release((30.0, 30.0), button)
    assert pinned.everything == before


@pytest.mark.parametrize("enter", ENTER)
def test_a_release_completes(pinned, enter):
    enter(pinned)
    pinned.release((70.0, 70.0), BUTTON.get(pinned.tool, "left"))
    assert pinned.tool == "PinsIdle"
    assert not pinned.editor.is_busy


@pytest.mark.parametrize("enter", ENTER)
def test_other_buttons_do_not_end_a_gesture(pinned, enter):
    name = enter(pinned)
    for button in {"left", "middle", "right"} - {BUTTON.get(name, "left")}:
        pinned.press((30.0, 30.0), button)
        pinned.release((30.0, 30.0), button)
    assert pinned.tool == name


@pytest.mark.parametrize("enter", ENTER)
def test_edits_wait_for_the_end_of_a_gesture(pinned, enter):
    name = enter(pinned)
    before = pinned.everything
    gestures.remove_pins(pinned.editor, [1, 2, 3])
    gestures.reset_pose(pinned.editor)
    pinned.redo()
    assert gestures.add_pin(pinned.editor, (50.0, 50.0)) is None
    gestures.set_settings(pinned.editor, pinned.state.settings.with_parameter("memory", 0.0))
    assert pinned.tool == name
    assert pinned.everything == before


@pytest.mark.parametrize(
    ("enter", "label"),
    [
        (enter_pointing_new_pin, "Add Pin"),
        (enter_dragging_pin, "Drag Pin"),
        (enter_dragging_pins, "Drag 2 Pins"),
        (enter_dragging_new_pin, "Add and Drag Pin"),
    ],
)
def test_a_gesture_is_one_entry_and_undo_and_redo_are_exact(pinned, enter, label):
    pinned.editor.select({2})
    before, depth = bits(pinned.state), pinned.depth
    enter(pinned)
    pinned.release((70.0, 70.0))
    pinned.settle()
    after = bits(pinned.state)
    assert after != before
    assert (pinned.depth, pinned.session.history.undo_label) == (depth + 1, label)
    pinned.undo()
    assert bits(pinned.state) == before
    assert (pinned.depth, pinned.session.history.redo_label) == (depth, label)
    pinned.redo()
    assert bits(pinned.state) == after
    assert pinned.depth == depth + 1
    assert not pinned.editor.is_moving


@pytest.mark.parametrize(
    "enter",
    [enter_pointing_pin, enter_pointing_canvas, enter_rubber_band, enter_panning, enter_asking_for_menu],
)
def test_what_is_no_edit_makes_no_entry(pinned, enter):
    before, depth = bits(pinned.state), pinned.depth
    enter(pinned)
    pinned.release((70.0, 70.0), BUTTON.get(pinned.tool, "left"))
    assert (bits(pinned.state), pinned.depth) == (before, depth)


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
    pinned.move(near(pinned, NECK))
    assert pinned.tool == "PointingPin"
    pinned.release(near(pinned, NECK))
    assert (bits(pinned.state), pinned.depth) == (before, depth)
    pinned.press(NECK)
    pinned.move(far(pinned, NECK))
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
    enter_dragging_pin(pinned)
    with pytest.raises(InputError):
        pinned.move((np.inf, 1.0))
    assert pinned.tool == "PinsIdle"
    pinned.editor.select(())
    assert pinned.everything == before


# -- the canvas --------------------------------------------------------------------------------------------


def test_a_click_beside_the_drawing_clears_the_selection_and_shift_keeps_it(pinned):
    pinned.editor.select({1, 2})
    pinned.click(BESIDE, shift=True)
    assert pinned.editor.selection == {1, 2}
    pinned.click(BESIDE)
    assert pinned.editor.selection == frozenset()


def test_a_click_beside_the_drawing_does_not_stop_it_settling(pinned):
    pinned.drag(END, (88.0, 66.0), steps=2)
    pinned.click(BESIDE)
    assert pinned.editor.is_moving
    pinned.settle()
    assert np.hypot(*np.subtract(pinned.where(3), (88.0, 66.0))) < 0.25


@pytest.mark.parametrize(("shift", "selected"), [(False, {1, 2}), (True, {1, 2, 3})])
def test_a_rubber_band_selects_the_pins_inside(pinned, shift, selected):
    pinned.editor.select({3})
    pinned.press(BESIDE, shift=shift)
    pinned.move((118.0, 78.0))
    assert pinned.editor.selection == {1, 2, 3}
    pinned.move((70.0, 60.0))
    assert pinned.editor.selection == selected
    pinned.release((70.0, 60.0))
    assert pinned.editor.selection == selected


def test_a_rubber_band_may_be_drawn_backwards(pinned):
    pinned.drag((118.0, 78.0), (55.0, 5.0))
    assert pinned.editor.selection == {2, 3}


def pan(d, how):
    button = "left"
    if how == "middle":
        button = "middle"
    elif how == "space":
        d.key("space")
    else:
        d.editor.chosen_tool = d.editor.hand_tool
    d.drag(NECK, (72.0, 45.0), button=button)
    d.key("space", pressed=False)


@pytest.mark.parametrize("how", ["middle", "space", "hand tool"])
def test_panning_moves_the_canvas_with_the_pointer_and_nothing_else(pinned, how):
    camera, before, depth = pinned.editor.camera, bits(pinned.state), pinned.depth
    x, y = camera.to_screen((72.0, 45.0))
    pan(pinned, how)
    assert pinned.editor.camera.to_screen(NECK) == pytest.approx((x, y))
    assert pinned.editor.camera.zoom == camera.zoom
    assert (bits(pinned.state), pinned.depth) == (before, depth)
    assert pinned.editor.selection == frozenset()


def test_space_let_go_gives_the_pointer_back(pinned):
    pinned.key("space")
    assert pinned.tool == "HandIdle"
    pinned.key("space", pressed=False)
    pinned.click(NECK)
    assert pinned.editor.selection == {2}


def test_the_wheel_zooms_while_panning(pinned):
    zoom = pinned.editor.camera.zoom
    pinned.press(NECK, "middle")
    pinned.scroll(NECK, 2)
    screen = pinned.editor.camera.to_screen(NECK)
    pinned.handle(PointerEvent("move", (screen[0] + 10, screen[1]), "middle"))
    assert pinned.editor.camera.zoom > zoom
    assert pinned.editor.camera.to_screen(NECK) == pytest.approx((screen[0] + 10, screen[1]))


@pytest.mark.parametrize("enter", ENTER)
def test_every_state_says_what_to_do(pinned, enter):
    idle = pinned.editor.hint
    enter(pinned)
    assert pinned.editor.hint
    assert pinned.editor.hint != idle
