"""Where pins went in the last gesture; the fields of the last move."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings

HEAD, END = (20.0, 40.0), (105.0, 40.0)


def test_a_trail_leads_from_where_the_drag_began_to_where_the_pin_is(pinned):
    assert len(pinned.editor.trails.segments()) == 0
    pinned.drag(END, (85.0, 65.0))
    pinned.settle()
    segments = pinned.editor.trails.segments()
    np.testing.assert_allclose(segments[0, 0], END)
    assert np.linalg.norm(segments[-1, 1] - pinned.where(3)) <= 1.0
    np.testing.assert_array_equal(segments[1:, 0], segments[:-1, 1])


@pytest.mark.parametrize("how", ["drag", "escape", "undo", "open"])
def test_a_new_gesture_or_a_jump_begins_new_trails(pinned, drawing, how):
    pinned.drag(END, (85.0, 65.0))
    pinned.settle()
    if how == "drag":
        pinned.press(HEAD)
        pinned.move((25.0, 45.0))
    elif how == "escape":
        pinned.press(HEAD)
        pinned.move((25.0, 45.0))
        pinned.advance()
        pinned.key("escape")
    elif how == "undo":
        pinned.undo()
    else:
        pinned.editor.open(new_document(drawing))
    assert len(pinned.editor.trails.segments()) == 0


def test_fields_are_those_of_the_last_move_of_the_pins(pinned):
    assert pinned.session.vector_fields() is None
    pinned.press(END)
    pinned.move((95.0, 50.0))
    pinned.advance()
    optimal, smooth = pinned.session.vector_fields()
    assert optimal.shape == smooth.shape == pinned.state.positions.shape
    at_pins = pinned.session.drawing.mesh.evaluate(pinned.state.points, smooth)
    np.testing.assert_allclose(at_pins, pinned.session.last_motion[1], atol=0.1)
    pinned.key("escape")
    assert pinned.session.vector_fields() is None


def test_methods_without_fields_have_none(pinned):
    gestures.set_settings(pinned.editor, Settings("mls", ()))
    pinned.drag(END, (95.0, 50.0))
    assert pinned.session.vector_fields() is None
