"""Documents: immutable values with read-only arrays and growing revisions."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.settings import Settings


def test_arrays_are_read_only(drawing):
    document = new_document(drawing)
    pin = Pin(1, 0, [1, 0, 0], [3, 4])
    stiffness = EditState((), drawing.mesh.vertices, stiffness=np.ones(len(drawing.mesh.faces))).stiffness
    for array in (drawing.image, drawing.uv, document.state.positions, stiffness, pin.weights, pin.target):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


@pytest.mark.parametrize(
    ("value", "name"),
    [("drawing", "name"), ("document", "path"), ("state", "pins"), ("pin", "target"), ("settings", "method")],
)
def test_values_are_frozen(drawing, value, name):
    document = new_document(drawing)
    values = {
        "drawing": drawing,
        "document": document,
        "state": document.state,
        "pin": Pin(1, 0, [1, 0, 0], [3, 4]),
        "settings": document.state.settings,
    }
    with pytest.raises(FrozenInstanceError):
        setattr(values[value], name, None)


def test_a_new_document_is_at_rest(drawing):
    document = new_document(drawing)
    assert document.state.positions is drawing.mesh.vertices
    assert (document.state.pins, document.revision, document.path) == ((), 0, None)
    assert document.state.settings == Settings()
    assert document.state.points.weights.shape == (0, 3)
    assert document.state.targets.shape == (0, 2)


def test_another_state_is_the_next_revision_and_changes_no_original(drawing):
    document = new_document(drawing)
    state = EditState((), drawing.mesh.vertices + 1)
    changed = document.with_state(state)
    assert changed.state is state
    assert (changed.revision, document.revision) == (1, 0)
    assert document.state.positions is drawing.mesh.vertices


def test_pins_in_order_and_by_id(drawing):
    pins = (Pin(5, 0, [1, 0, 0], [1, 2]), Pin(3, 7, [0, 0.5, 0.5], [3, 4], angle=0.5))
    state = EditState(pins, drawing.mesh.vertices)
    assert state.points.faces.tolist() == [0, 7]
    assert state.points.weights.tolist() == [[1, 0, 0], [0, 0.5, 0.5]]
    assert state.targets.tolist() == [[1, 2], [3, 4]]
    np.testing.assert_array_equal(state.angles, [np.nan, 0.5])
    assert state.pin(3) is pins[1]
    with pytest.raises(KeyError):
        state.pin(4)
