"""Panning: by the hand, by Space and by the middle button."""

import pytest

from akap_editor.editor.events import PinRequest, PointerEvent
from tests.support.editor_driver import bits

NECK = (62.0, 40.0)


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


def test_the_hand_opens_the_menu_of_a_pin_and_drags_none(pinned):
    pinned.editor.chosen_tool = pinned.editor.hand_tool
    pinned.move(NECK)
    assert pinned.hovered_pin == 2
    assert not pinned.would_add_pin
    assert pinned.editor.tool.cursor == "pan"
    pinned.press(NECK, "right")
    pinned.release(NECK, "right")
    assert pinned.editor.request == PinRequest("menu", 2)
    depth = pinned.depth
    pinned.drag(NECK, (72.0, 45.0))
    assert pinned.depth == depth


def test_space_in_a_gesture_waits_for_its_end(pinned):
    pinned.press(NECK)
    pinned.key("space")
    assert pinned.tool == "PointingPin"
    pinned.release(NECK)
    assert pinned.tool == "HandIdle"
