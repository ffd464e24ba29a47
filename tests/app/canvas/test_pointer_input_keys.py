"""Keys on the canvas, alone and with the mouse."""

from imgui_bundle import imgui  # isort: skip
import math

import numpy as np
import pytest

from akap_editor.app.commands import registry as commands
from akap_editor.app.commands.command import SHIFT

Key = imgui.Key


def test_arrows_nudge_also_after_a_click_on_a_panel(pinned):
    pinned.reset(pinned.document, clock=lambda: 0.0)  # one series, however slow the machine is
    pinned.editor.select({3})
    before = pinned.session.state.pin(3).target

    def nudge(hand):
        hand.item_click(f"//Tools/{commands.SHOW_MESH.icon}##{commands.SHOW_MESH.label}")
        for chord in (Key.up_arrow, Key.up_arrow, SHIFT | Key.left_arrow):
            hand.key_press(int(chord))

    pinned.do(nudge)
    np.testing.assert_allclose(pinned.session.state.pin(3).target, np.add(before, (-10, -2)), atol=1e-9)
    assert pinned.session.history.labels == ["Nudge Pin"]
    assert pinned.state.view.show_mesh


def test_backspace_removes_the_last_pin(pinned):
    pinned.key(Key.backspace)
    assert [pin.id for pin in pinned.pins] == [1, 2]


def test_alt_click_cuts_a_pin_off_and_the_keyboard_stays_with_the_canvas(pinned):
    at = pinned.to_screen(pinned.pin_position(2))

    def cut(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*at))
        hand.key_down(Key.mod_alt)
        hand.mouse_click(0)
        hand.key_up(Key.mod_alt)
        hand.yield_(2)

    pinned.do(cut)
    assert [pin.id for pin in pinned.pins] == [1, 3]
    assert not pinned.editor.held
    pinned.key(Key.b)
    assert pinned.editor.chosen_tool is pinned.editor.brush_tool


def test_an_alt_drag_of_the_ring_rotates_and_holds(pinned):
    plain = pinned.screenshot()
    pinned.drag(*pinned.ring_points(2, 0, 20, 40), held=Key.mod_alt)
    assert math.degrees(pinned.session.state.pin(2).angle) == pytest.approx(40, abs=3)
    assert pinned.session.pin_angle(2) == pytest.approx(pinned.session.state.pin(2).angle, abs=0.02)
    assert pinned.session.history.labels == ["Rotate Pin"]
    assert (pinned.screenshot() != plain).any()
    pinned.key(commands.UNDO.chords[0])
    assert pinned.session.state.pin(2).angle is None
    assert not pinned.session.is_posed
