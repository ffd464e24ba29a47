"""Layers are drawn as the file shows them: order, opacity and blend modes."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.layers.composite import composite
from akap_editor.layers.drawing_layer import flat_picture
from akap_editor.layers.layered_picture import BLEND_MODES, Layer, LayeredPicture
from akap_editor.render.layer_runs import LayerRun, layer_runs
from tests.support.layered_files import filled
from tests.support.puppets import ARM, BODY, HAT, SKULL, puppet


def drawn(offscreen, drawing):
    document = new_document(drawing)
    return offscreen.render(drawing, drawing.mesh.vertices, (0, 0, *drawing.size), order=document.draw_order)


def assert_alike(result, expected, tolerance=2):
    """Equal colors over black, but for few pixels at the rims of meshes."""
    a, b = (picture[..., :3] * (picture[..., 3:] / 255.0) for picture in (result, expected))
    differences = np.abs(a - b).max(axis=2)
    assert (differences > tolerance).mean() < 0.002
    assert (np.abs(result[..., 3].astype(int) - expected[..., 3]) > 16).mean() < 0.002


@pytest.mark.parametrize("blend", BLEND_MODES)
@pytest.mark.parametrize("opacity", [1.0, 0.4])
def test_blend_modes_are_those_of_the_composition(offscreen, blend, opacity):
    layers = (
        Layer("back", filled(40, 50, 40, 160, 230), (0, 0)),
        Layer("middle", filled(40, 50, 220, 90, 30, 150), (15, 0), opacity=0.8),
        Layer("front", filled(60, 20, 30, 80, 15, 200), (10, 15), (), opacity, blend),
    )
    layered = LayeredPicture((80, 50), layers)
    result = drawn(offscreen, make_drawing(layers=layered, vertices=100))
    inside = slice(17, 33), slice(12, 68)
    assert_alike(result[inside], composite(layered)[inside])


@pytest.mark.parametrize(
    ("changes", "layer_order"),
    [
        ({}, (0, 1, 2, 3, 4)),
        ({SKULL: {"opacity": 0.5}}, (0, 1, 2, 3, 4)),
        ({SKULL: {"visible": False}, HAT: {"visible": True}}, (0, 1, 2, 3, 4)),
        ({}, (2, 3, 0, 1, 4)),
        ({ARM: {"solo": True}}, (0, 1, 2, 3, 4)),
        ({n: {"visible": False} for n in range(5)}, (0, 1, 2, 3, 4)),
    ],
)
def test_the_layer_list_decides_what_is_drawn(offscreen, changes, layer_order):
    drawing = puppet()
    layers = tuple(replace(layer, **changes.get(n, {})) for n, layer in enumerate(drawing.layers))
    drawing = replace(drawing, layers=layers, layer_order=layer_order)
    expected = flat_picture(layers, layer_order, drawing.size)
    assert_alike(drawn(offscreen, drawing), expected)


def test_changing_the_layer_list_uploads_nothing_and_is_seen(offscreen):
    drawing = puppet()
    first = drawn(offscreen, drawing)
    hidden = replace(drawing.layers[BODY], visible=False)
    second = drawn(offscreen, replace(drawing, layers=(hidden, *drawing.layers[1:])))
    assert first[150, 65].tolist() == [40, 160, 90, 255]
    assert second[150, 65, 3] == 0
    assert (drawn(offscreen, drawing) == first).all()


def test_runs_join_layers_that_are_drawn_alike():
    layers = puppet().layers
    assert layer_runs(np.array([0, 0, 1, 3, 3]), layers) == (LayerRun(0, 5, 1.0, "normal"),)
    faint = (layers[0], replace(layers[1], opacity=0.5), *layers[2:])
    assert layer_runs(np.array([0, 0, 1, 3, 3]), faint) == (
        LayerRun(0, 2, 1.0, "normal"),
        LayerRun(2, 1, 0.5, "normal"),
        LayerRun(3, 2, 1.0, "normal"),
    )
    assert layer_runs(np.zeros(4, int), ()) == (LayerRun(0, 4, 1.0, "normal"),)
    assert layer_runs(np.zeros(0, int), layers) == ()
