"""The options of the stiffness brush in the bar over the canvas."""

import numpy as np
import pytest

from akap_editor.app.commands import registry as commands
from akap_editor.editor.session.edits import PaintLoose, PaintStiffness
from akap_editor.words import use_language


def test_the_options_of_the_brush(pinned):
    pinned.tool_button(commands.BRUSH_TOOL)
    pinned.do(lambda hand: hand.item_click("//Options/Erase"))
    assert pinned.editor.brush_tool.brush.erasing
    pinned.editor.apply("Paint Stiffness", PaintStiffness([(50.0, 80.0)], 30.0, 100.0))
    pinned.do(lambda hand: hand.item_click(f"//Options/{commands.CLEAR_STIFFNESS.label}"))
    assert pinned.session.state.stiffness is None

    def slide(hand):
        hand.item_input("//Options/##Strength")
        hand.key_chars_replace_enter("1000")

    pinned.do(slide)
    assert pinned.editor.brush_tool.brush.factor == pytest.approx(1000.0)
    assert np.isfinite(pinned.editor.brush_tool.brush.radius)


def test_the_bar_leaves_the_canvas_where_it_is_and_is_never_out_of_sight(pinned):
    canvas, camera = pinned.editor.canvas, pinned.editor.camera
    pinned.tool_button(commands.BRUSH_TOOL)
    assert (pinned.editor.canvas, pinned.editor.camera) == (canvas, camera)
    boxes = []

    def look(hand):
        for item in ("##Strength", "##Size", "Erase", commands.CLEAR_STIFFNESS.label):
            boxes.append(hand.item_info(f"//Options/{item}").rect_full)

    pinned.do(look)
    _, top, right, _ = canvas
    for box in boxes:
        assert 0 <= box.min.x < box.max.x <= 1280
        assert 0 <= box.min.y < box.max.y <= top
    assert right < 1280, "the bar is as wide as the window"
    pinned.tool_button(commands.PIN_TOOL)
    assert not pinned.editor.brush_tool.brush.erasing


def test_the_options_of_loose_parts(pinned):
    pinned.tool_button(commands.BRUSH_TOOL)
    pinned.do(lambda hand: hand.item_click("//Options/Loose"))
    assert pinned.editor.brush_tool.brush.paints == "loose"

    def type_into(label, text):
        def slide(hand):
            hand.item_input(f"//Options/##{label}")
            hand.key_chars_replace_enter(text)

        pinned.do(slide)

    use_language("de")
    try:
        type_into("Speed", "2,5")  # ImGui itself knows only the point
    finally:
        use_language("en")
    assert pinned.editor.brush_tool.brush.speed == 2.5
    type_into("Speed", "2")
    assert pinned.editor.brush_tool.brush.speed == 2.0
    assert pinned.session.state.loose is None
    pinned.editor.apply("Paint Loose Parts", PaintLoose([(50.0, 80.0)], 30.0))
    type_into("Bounce", "20")
    assert pinned.session.state.loose.bounce == 0.2
    assert pinned.session.history.undo_label == "Change Swing"
    pinned.do(lambda hand: hand.item_click(f"//Options/{commands.CLEAR_LOOSE.label}"))
    assert pinned.session.state.loose is None
    pinned.do(lambda hand: hand.item_click("//Options/Stiff"))
    assert pinned.editor.brush_tool.brush.paints == "stiff"
