"""The options of the stiffness brush in the side panel."""

import numpy as np
import pytest

from akap_editor.app.commands import registry as commands
from akap_editor.editor.session.edits import PaintStiffness


def test_the_options_of_the_brush(pinned):
    pinned.tool_button(commands.BRUSH_TOOL)
    pinned.panel("Erase")
    assert pinned.editor.brush_tool.brush.erasing
    pinned.editor.apply("Paint Stiffness", PaintStiffness([(50.0, 80.0)], 30.0, 100.0))
    pinned.panel(commands.CLEAR_STIFFNESS.label)
    assert pinned.session.state.stiffness is None

    def slide(hand):
        hand.item_input("//Panel/##Strength")
        hand.key_chars_replace_enter("1000")

    pinned.do(slide)
    assert pinned.editor.brush_tool.brush.factor == pytest.approx(1000.0)
    assert np.isfinite(pinned.editor.brush_tool.brush.radius)
