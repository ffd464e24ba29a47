"""The Pins section of the side panel."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.pin import Pin


def row(pin, item):
    """The item of the list in the row of a pin."""
    return f"//Panel/**/###{item} {pin}"


def pin_in_list(ui, pin, shift=False):
    """Click a line of the pin list."""

    def click(hand):
        if shift:
            hand.key_down(imgui.Key.mod_shift)
        hand.item_click(row(pin, "name"))
        if shift:
            hand.key_up(imgui.Key.mod_shift)

    ui.do(click)


def test_the_pin_list_selects(pinned):
    pin_in_list(pinned, 2)
    assert pinned.editor.selection == {2}
    pin_in_list(pinned, 3, shift=True)
    assert pinned.editor.selection == {2, 3}
    pin_in_list(pinned, 2, shift=True)
    assert pinned.editor.selection == {3}
    pin_in_list(pinned, 1)
    assert pinned.editor.selection == {1}
    assert not pinned.editor.is_modified
    pinned.key(imgui.Key.delete)
    assert [pin.id for pin in pinned.pins] == [2, 3]


def do_in_row(ui, pin, item, act=lambda hand: None, double=False):
    def run(hand):
        (hand.item_double_click if double else hand.item_click)(row(pin, item))
        hand.yield_(3)
        act(hand)

    ui.do(run)


def pin(ui, number) -> Pin:
    return ui.session.state.pin(number)


def test_a_pin_is_hidden_and_shown_by_its_eye_and_still_holds(pinned):
    shown = pinned.screenshot()
    do_in_row(pinned, 2, "eye")
    assert pin(pinned, 2).is_hidden
    assert pinned.session.history.labels == ["Hide Pin"]
    assert (pinned.screenshot() != shown).any()
    at = pinned.to_screen(pinned.pin_position(2))
    assert pinned.editor.pin_at(at) is None
    pinned.bend()
    assert pinned.session.pin_error() < 0.25, "it still holds"
    do_in_row(pinned, 2, "eye")
    assert not pin(pinned, 2).is_hidden
    assert pinned.editor.pin_at(at) == 2


def test_a_locked_pin_is_selected_but_neither_moved_nor_removed(pinned):
    do_in_row(pinned, 3, "lock")
    assert pin(pinned, 3).is_locked
    target, labels = pin(pinned, 3).target, pinned.session.history.labels
    at = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(at, (at[0], at[1] - 60))
    assert pinned.editor.selection == {3}
    pinned.key(imgui.Key.delete, imgui.Key.right_arrow, imgui.Key.backspace)
    assert [each.id for each in pinned.pins] == [1, 3], "Backspace removes the last one that is free"
    assert (pin(pinned, 3).target == target).all()
    pinned.editor.select({1, 3})
    first = pin(pinned, 1).target
    pinned.key(imgui.Key.right_arrow)
    assert (pin(pinned, 3).target == target).all()
    assert (pin(pinned, 1).target != first).any()
    assert labels == ["Lock Pin"]
    do_in_row(pinned, 3, "lock")
    pinned.editor.select({3})
    pinned.key(imgui.Key.delete)
    assert [each.id for each in pinned.pins] == [1]


@pytest.mark.parametrize(
    ("end", "expected"),
    [(imgui.Key.enter, ["Pin 1", "Hand", "Pin 3"]), (imgui.Key.escape, ["Pin 1", "Pin 2", "Pin 3"])],
)
def test_a_double_click_on_a_name_renames_the_pin(pinned, end, expected):
    def type_name(hand):
        hand.key_chars_replace("Hand")
        hand.key_press(end)

    do_in_row(pinned, 2, "name", type_name, double=True)
    assert [each.label for each in pinned.pins] == expected


def test_a_name_that_is_too_long_is_an_error_and_changes_nothing(pinned):
    do_in_row(pinned, 2, "name", lambda hand: hand.key_chars_replace_enter("x" * 101), double=True)
    assert "up to 100 characters" in pinned.state.error
    assert pin(pinned, 2).name == ""


def test_the_depth_is_typed_in_the_list(pinned):
    def type_depth(hand):
        hand.item_double_click(row(2, "depth"))
        hand.key_chars_replace_enter("7")

    pinned.do(type_depth)
    assert [each.depth for each in pinned.pins] == [0, 7, 0]
    assert pinned.session.history.labels == ["Set Depth"]


def places(ui):
    """Where the sections below the pins are."""
    found = {}

    def find(hand):
        for title in ("Poses", "Bending"):
            found[title] = hand.item_info(f"//Panel/###section {title}").rect_full.min.y

    ui.do(find)
    return found


def test_nothing_below_the_list_moves_when_pins_are_added_and_removed(ui):
    before = places(ui)
    for number in range(8):
        gestures.add_pin(ui.editor, (45.0 + 5 * number, 80.0))
        ui.settle()
        assert places(ui) == before
    ui.editor.select_all()
    gestures.remove_selected_pins(ui.editor)
    ui.settle()
    assert places(ui) == before
