from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.settings import Settings
from akap_editor.errors import InputError


def test_a_drawing_covers_its_picture(image, drawing):
    assert drawing.size == (120, 80)
    assert drawing.mesh.vertices.min() >= 0
    assert (drawing.mesh.vertices <= drawing.size).all()
    assert len(drawing.mesh.vertices) == pytest.approx(150, rel=0.1)
    visible = np.argwhere(image[..., 3] > 127)[:, ::-1] + 0.5
    assert all(drawing.mesh.find(pixel) is not None for pixel in visible[::37])


def test_uv_are_vertices_as_shares_of_the_picture(drawing):
    assert drawing.uv.dtype == np.float32
    np.testing.assert_allclose(drawing.uv * drawing.size, drawing.mesh.vertices, atol=1e-4)


@pytest.mark.parametrize(
    "bad",
    [
        np.zeros((4, 4), np.uint8),
        np.zeros((4, 4, 3), np.uint8),
        np.zeros((4, 4, 4), np.float32),
        np.zeros((0, 4, 4), np.uint8),
    ],
)
def test_a_picture_is_rgba_bytes(drawing, bad):
    with pytest.raises(InputError, match="image"):
        Drawing(bad, drawing.mesh, drawing.uv)
    with pytest.raises(InputError):
        make_drawing(bad)


def test_a_transparent_picture_is_no_drawing():
    with pytest.raises(InputError, match="transparent"):
        make_drawing(np.zeros((20, 20, 4), np.uint8))


def test_uv_must_be_one_finite_pair_a_vertex(drawing):
    broken = drawing.uv.copy()
    broken[3] = np.nan
    for uv in (drawing.uv[:-1], drawing.uv[:, :1], broken):
        with pytest.raises(InputError, match="uv"):
            Drawing(drawing.image, drawing.mesh, uv)


def test_a_drawing_leaves_its_arguments_alone(image):
    mine = image.copy()
    drawing = make_drawing(mine, vertices=60)
    mine[:] = 7
    np.testing.assert_array_equal(drawing.image, image)


def test_arrays_are_read_only(drawing):
    document = new_document(drawing)
    pin = Pin(1, 0, [1, 0, 0], [3, 4])
    for array in (drawing.image, drawing.uv, document.state.positions, pin.weights, pin.target):
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


def test_a_pin_keeps_a_copy_of_its_target():
    mine = np.array([3.0, 4.0])
    pin = Pin(1, 0, np.array([1.0, 0.0, 0.0]), mine)
    mine[:] = 0
    assert pin.target.tolist() == [3.0, 4.0]


def test_a_new_document_is_at_rest(drawing):
    document = new_document(drawing)
    assert document.state.positions is drawing.mesh.vertices
    assert (document.state.pins, document.revision, document.path) == ((), 0, None)
    assert document.state.settings == Settings()
    assert document.state.points.weights.shape == (0, 3)
    assert document.state.targets.shape == (0, 2)


def test_with_state_is_one_revision_on_and_changes_no_original(drawing):
    document = new_document(drawing)
    state = EditState((), drawing.mesh.vertices + 1)
    following = document.with_state(state)
    assert following.state is state
    assert (following.revision, document.revision) == (1, 0)
    assert document.state.positions is drawing.mesh.vertices


def test_pins_in_order_and_by_id(drawing):
    pins = (Pin(5, 0, [1, 0, 0], [1, 2]), Pin(3, 7, [0, 0.5, 0.5], [3, 4]))
    state = EditState(pins, drawing.mesh.vertices)
    assert state.points.faces.tolist() == [0, 7]
    assert state.points.weights.tolist() == [[1, 0, 0], [0, 0.5, 0.5]]
    assert state.targets.tolist() == [[1, 2], [3, 4]]
    assert state.pin(3) is pins[1]
    with pytest.raises(KeyError):
        state.pin(4)


def test_settings_with_a_parameter_changed_or_added():
    settings = Settings()
    changed = settings.with_parameter("memory", 0.25)
    assert changed.get("memory") == 0.25
    assert settings.get("memory") == 1.0
    assert changed.with_parameter("memory", 1.0) == settings
    assert settings.get("dirichlet", "left to the method") == "left to the method"


def test_settings_are_equal_whatever_the_order_of_changes():
    one = Settings().with_parameter("pin_weight", 10.0).with_parameter("dirichlet", False)
    other = Settings().with_parameter("dirichlet", False).with_parameter("pin_weight", 10.0)
    assert one == other
