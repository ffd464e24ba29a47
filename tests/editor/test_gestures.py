"""Gestures without a tool: nudging, removing and moving pins."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.events import KeyEvent
from akap_editor.editor.session.replay import replay
from akap_editor.errors import InputError
from tests.support.editor_driver import bits

HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def pause(driver, seconds):
    driver.clock.now += seconds


# -- nudging -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("key", "shift", "direction"),
    [
        ("left", False, (-1, 0)),
        ("right", False, (1, 0)),
        ("up", False, (0, -1)),
        ("down", False, (0, 1)),
        ("left", True, (-10, 0)),
    ],
)
def test_arrows_nudge_the_selected_pins(pinned, key, shift, direction):
    before = pinned.state.targets
    pinned.editor.select({1, 3})
    pinned.handle(KeyEvent(key, shift=shift))
    np.testing.assert_array_equal(pinned.state.targets, before + np.outer([1, 0, 1], direction))
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
