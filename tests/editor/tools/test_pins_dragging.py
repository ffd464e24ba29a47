"""Dragging pins: where they arrive, and that the others hold."""

import numpy as np
import pytest

from akap_editor.editor.editor import PICK_RADIUS

HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def test_the_dragged_pin_arrives_and_the_others_hold(pinned):
    pinned.drag(END, (88.0, 66.0))
    pinned.settle()
    assert not pinned.editor.is_moving
    for pin, at in ((1, HEAD), (2, NECK), (3, (88.0, 66.0))):
        assert np.hypot(*np.subtract(pinned.where(pin), at)) < 0.25


def test_all_selected_pins_move_by_the_same_offset(pinned):
    pinned.editor.select({2, 3})
    pinned.drag(END, (101.0, 52.0))
    pinned.settle()
    for pin, at in ((1, HEAD), (2, (58.0, 52.0)), (3, (101.0, 52.0))):
        assert np.hypot(*np.subtract(pinned.where(pin), at)) < 0.25


def test_dragging_a_pin_outside_the_selection_takes_it_alone(pinned):
    pinned.editor.select({1, 2})
    pinned.press(END)
    pinned.move((100.0, 50.0))
    assert pinned.editor.selection == {3}
    np.testing.assert_allclose(pinned.state.targets, [HEAD, NECK, (100.0, 50.0)], atol=1e-9)


def test_shift_drag_takes_what_was_selected_along(pinned):
    pinned.click(HEAD)
    pinned.press(END, shift=True)
    pinned.move((110.0, 43.0))
    np.testing.assert_allclose(pinned.state.targets, [(25.0, 43.0), NECK, (110.0, 43.0)], atol=1e-9)


def test_a_pin_keeps_its_distance_from_the_pointer(pinned):
    """A pin pressed off its center does not jump to the pointer, however often it is dragged."""
    offset = 0.7 * PICK_RADIUS / pinned.editor.camera.zoom
    for _ in range(4):
        x, y = pinned.where(3)
        pinned.drag((x + offset, y), (x + offset, y + 4.0))
        pinned.settle()
    assert np.hypot(*np.subtract(pinned.where(3), (END[0], END[1] + 16.0))) < 0.25


def test_a_pin_dragged_while_it_moves_starts_from_where_it_is(pinned):
    pinned.drag(END, (88.0, 66.0), steps=2)
    assert pinned.editor.is_moving
    x, y = pinned.where(3)
    pinned.press((x, y))
    pinned.move((x + 4.0, y + 1.0))
    np.testing.assert_allclose(pinned.state.pin(3).target, (x + 4.0, y + 1.0), rtol=0, atol=1e-9)


def test_a_drag_back_to_its_start_restores_the_target(pinned):
    pinned.press(END)
    pinned.move((80.0, 70.0))
    pinned.move(END)
    np.testing.assert_allclose(pinned.state.pin(3).target, END, rtol=0, atol=1e-9)


def test_a_zoom_during_a_drag_keeps_the_pin_under_the_pointer(pinned):
    pinned.press(END)
    pinned.move((100.0, 50.0))
    pinned.scroll((100.0, 50.0), 3)
    pinned.move((98.0, 52.0))
    np.testing.assert_allclose(pinned.state.pin(3).target, (98.0, 52.0), atol=1e-9)


def test_a_huge_jump_stays_finite_and_unflipped(pinned):
    pinned.press(END)
    for at in ((5105.0, 40.0), (-4000.0, -3000.0)):
        pinned.move(at)
        for _ in range(12):
            pinned.advance()  # the driver checks the pose
    pinned.key("escape")
    assert pinned.where(3) == pytest.approx(END)


def test_pins_stopped_before_their_targets_hold_while_another_is_dragged(pinned):
    first, second = pinned.ids[:2]
    x, y = pinned.where(first)
    pinned.drag((x, y), (x + 25, y - 20), steps=1)
    pinned.undo()
    pinned.redo()
    stopped_at = pinned.where(first)
    assert np.hypot(x + 25 - stopped_at[0], y - 20 - stopped_at[1]) > 1
    x, y = pinned.where(second)
    pinned.drag((x, y), (x + 4, y + 4))
    pinned.settle()
    assert np.allclose(pinned.where(first), stopped_at, atol=0.25)
