"""What the options bar offers for the selected pins."""

from imgui_bundle import imgui  # isort: skip
import math

import numpy as np
import pytest

from akap_editor.editor import pin_arrangement
from akap_editor.editor.session.edits import PaintStiffness


def type_into(ui, item, text):
    def type_(hand):
        hand.item_double_click(f"//Options/{item}")
        hand.key_chars_replace_enter(text)

    ui.do(type_)


def offered(ui, *items):
    found = []
    ui.do(lambda hand: found.extend(hand.item_exists(f"//Options/{item}") for item in items))
    return found


ONE, SEVERAL, NONE = "##angle", "###align", "###Suggest Pins"


@pytest.mark.parametrize(
    ("selection", "expected"),
    [((), [False, False, True]), ((2,), [True, False, False]), ((1, 3), [False, True, False])],
)
def test_the_selection_decides(pinned, selection, expected):
    pinned.editor.select(selection)
    pinned.settle()
    canvas = pinned.editor.canvas
    assert offered(pinned, ONE, SEVERAL, NONE) == expected
    assert pinned.editor.canvas == canvas


def test_a_typed_angle_rotates_around_the_pin(pinned):
    pinned.editor.select({3})
    pinned.settle()
    type_into(pinned, ONE, "30")
    assert pinned.session.state.pin(3).angle == pytest.approx(math.radians(30))
    assert pinned.session.history.labels == ["Rotate Pin"]


def test_looking_at_a_value_changes_nothing(pinned):
    pinned.bend()
    labels = pinned.session.history.labels
    pinned.editor.select({3})
    pinned.settle()

    def look(hand):
        for item in ("##angle", "##depth", "##stiffness"):
            hand.item_double_click(f"//Options/{item}")
            hand.key_press(imgui.Key.escape)

    pinned.do(look)
    assert pinned.session.history.labels == labels


def test_the_depth_of_several_pins_is_set_at_once(pinned):
    pinned.editor.select({1, 3})
    pinned.settle()
    type_into(pinned, "##depth", "4")
    assert [pin.depth for pin in pinned.pins] == [4, 0, 4]
    assert pinned.session.history.labels == ["Set Depth"]


def test_stiffness_around_pins_replaces_what_is_there_and_goes_without_a_trace(pinned):
    session = pinned.session
    pinned.editor.select({1})
    pinned.settle()
    type_into(pinned, "##stiffness", "50")
    assert pin_arrangement.stiffness_at(session, session.state.pin(1)) == pytest.approx(50)
    assert pin_arrangement.stiffness_at(session, session.state.pin(3)) == 1.0
    type_into(pinned, "##stiffness", "8")
    assert session.state.stiffness.max() == pytest.approx(8)
    type_into(pinned, "##stiffness", "1")
    assert session.state.stiffness is None
    assert session.history.labels == ["Set Stiffness"] * 3


def test_two_neighbors_keep_their_stiffness(pinned):
    pinned.editor.apply("Paint Stiffness", PaintStiffness([(130.0, 80.0)], 3.0, 5.0))
    pin_arrangement.stiffen_pins(pinned.editor, (1, 2, 3), 20.0)
    session = pinned.session
    stiffness = [pin_arrangement.stiffness_at(session, pin) for pin in session.state.pins]
    np.testing.assert_allclose(stiffness, 20.0)


def test_a_button_removes_them(pinned):
    pinned.editor.select({1, 2})
    pinned.settle()
    pinned.do(lambda hand: hand.item_click("//Options/###Remove Selected Pins"))
    assert [pin.id for pin in pinned.pins] == [3]
