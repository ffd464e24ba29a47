"""The ring, held angles and the stiffness brush in the window."""

from imgui_bundle import imgui  # isort: skip
import math

import numpy as np
import pytest

from akap_editor.app.commands import registry as commands
from akap_editor.editor.session.edits import PaintStiffness
from akap_editor.editor.tools.rotate import RING_RADIUS
from akap_editor.render.overlays import FaceColors
from tests.app.canvas.test_pin_markers import at_pin

Key = imgui.Key


def ring_places(ui, pin, *degrees):
    x, y = ui.screen(ui.pin_place(pin))
    turns = [math.radians(each) for each in degrees]
    return [(x + RING_RADIUS * math.cos(turn), y + RING_RADIUS * math.sin(turn)) for turn in turns]


def test_an_alt_drag_of_the_ring_turns_and_holds(pinned):
    plain = pinned.screenshot()
    pinned.drag(*ring_places(pinned, 2, 0, 20, 40), held=Key.mod_alt)
    assert math.degrees(pinned.session.state.pin(2).angle) == pytest.approx(40, abs=3)
    assert pinned.session.pin_angle(2) == pytest.approx(pinned.session.state.pin(2).angle, abs=0.02)
    assert pinned.session.history.labels == ["Rotate Pin"]
    assert (pinned.screenshot() != plain).any()
    pinned.key(commands.UNDO.chords[0])
    assert pinned.session.state.pin(2).angle is None
    assert not pinned.session.is_posed


def test_the_ring_is_seen_while_alt_is_held(pinned):
    snapshots, places = [], ring_places(pinned, 2, 0)

    def look(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*places[0]))
        for held in (False, True):
            if held:
                hand.key_down(Key.mod_alt)
            hand.yield_(2)
            pinned.on_main_thread(hand, lambda: pinned.window.after_draw.append(shoot))
            hand.yield_(2)
        hand.key_up(Key.mod_alt)

    def shoot():
        ring = pinned.editor.tool.markers.ring
        snapshots.append((ring.pin if ring is not None else None, pinned.window.screenshot()))
        pinned.window.after_draw.clear()

    pinned.do(look)
    (no_pin, before), (pin, after) = snapshots
    assert (no_pin, pin) == (None, 2)
    assert all((after != before)[round(y), round(x)].any() for x, y in ring_places(pinned, 2, 90, 180, 270))


def test_the_menu_of_a_pin_holds_its_angle_and_lets_it_go(pinned):
    choose = [lambda hand: hand.item_click("//$FOCUSED/Hold Angle")]
    at_pin(pinned, 2, 1, 1, *choose)
    assert pinned.session.state.pin(2).angle == pytest.approx(0.0, abs=1e-9)
    at_pin(pinned, 2, 1, 1, *choose)
    assert pinned.session.state.pin(2).angle is None
    assert pinned.session.history.labels == ["Hold Angle", "Release Angle"]


def test_the_values_of_a_pin_have_its_angle_in_degrees(pinned):
    def type_angle(hand):
        hand.item_input("//$FOCUSED/##Angle")
        hand.key_chars_replace_enter("30")
        hand.yield_(2)

    at_pin(pinned, 2, 0, 2, type_angle)
    assert pinned.session.state.pin(2).angle == pytest.approx(math.radians(30))
    assert pinned.session.pin_angle(2) == pytest.approx(math.radians(30), abs=0.02)
    at_pin(pinned, 2, 0, 2, lambda hand: hand.item_click("//$FOCUSED/Hold this angle"))
    assert pinned.session.state.pin(2).angle is None


def test_a_stroke_of_the_brush_is_tinted_only_while_the_brush_is_at_hand(pinned):
    plain = pinned.screenshot()
    pinned.key(Key.s)
    start, end = pinned.screen((120.0, 80.0)), pinned.screen((160.0, 80.0))
    pinned.drag(start, end)
    stiffness = pinned.session.state.stiffness
    assert stiffness.max() == 100.0
    assert len(pinned.pins) == 3
    assert isinstance(pinned.state.overlays(1.0).face_colors, FaceColors)
    tinted = pinned.screenshot()
    x, y = map(round, pinned.screen((140.0, 70.0)))
    assert (tinted[y, x] != plain[y, x]).any()
    pinned.key(Key.p)
    assert pinned.state.overlays(1.0).face_colors is None
    assert (pinned.screenshot()[y, x] == plain[y, x]).all()
    pinned.key(Key.s)
    pinned.drag(start, end, button=1)
    assert pinned.session.state.stiffness is None or pinned.session.state.stiffness.max() < 100.0
    assert pinned.session.history.labels == ["Paint Stiffness", "Erase Stiffness"]


def test_the_options_of_the_brush(pinned):
    pinned.tool_button(commands.BRUSH_TOOL)
    pinned.panel("Erase")
    assert pinned.editor.brush_tool.brush.erasing
    pinned.editor.apply("Paint Stiffness", PaintStiffness([(50.0, 80.0)], 30.0, 100.0))
    pinned.panel(commands.SOFTEN_ALL.label.capitalize())
    assert pinned.session.state.stiffness is None

    def slide(hand):
        hand.item_input("//Panel/##Strength")
        hand.key_chars_replace_enter("1000")

    pinned.do(slide)
    assert pinned.editor.brush_tool.brush.factor == pytest.approx(1000.0)
    assert np.isfinite(pinned.editor.brush_tool.brush.radius)
