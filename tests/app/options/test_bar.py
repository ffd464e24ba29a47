"""The options bar: items that have no room are in a popup."""

import pytest

from akap_editor.app.glfw_window import MIN_SIZE


@pytest.fixture(scope="module")
def module_window(new_window):
    return new_window(size=MIN_SIZE, scale=1.5)


def test_what_has_no_room_is_in_a_popup(pinned):
    pinned.editor.select({2})
    pinned.settle()
    inside, found = [], {}

    def look(hand):
        found["more"] = hand.item_info("//Options/###more").rect_full
        found["remove"] = hand.item_exists("//Options/###Remove Selected Pins")
        hand.item_click("//Options/###more")
        hand.yield_(3)
        hand.item_click("//$FOCUSED/###Remove Selected Pins")
        inside.append(len(pinned.pins))

    pinned.do(look)
    assert found["more"].max.x <= MIN_SIZE[0]
    assert not found["remove"]
    assert [pin.id for pin in pinned.pins] == [1, 3]


def test_all_that_fits_is_shown(pinned):
    pinned.editor.chosen_tool = pinned.editor.hand_tool
    pinned.settle()
    found = []
    pinned.do(lambda hand: found.append(hand.item_exists("//Options/###more")))
    assert found == [False]
