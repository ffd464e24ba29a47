"""Layers of drawings: which are shown, the order of their faces, and what they show together."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.layers.composite import composite
from akap_editor.layers.drawing_layer import Artwork, DrawingLayer, flat_picture, shown_layers, stacked_faces
from tests.support.layered_files import filled
from tests.support.puppets import puppet, puppet_layers

ART = Artwork(filled(4, 4, 1, 2, 3), (0, 0), (8, 8))
A, B, C = (DrawingLayer(ART, name) for name in "abc")
FACE_LAYERS = np.array([0, 0, 1, 1, 2])


@pytest.mark.parametrize(
    ("layers", "shown"),
    [
        ((A, B, C), [True, True, True]),
        ((A, replace(B, visible=False), C), [True, False, True]),
        ((A, replace(B, solo=True), C), [False, True, False]),
        ((replace(A, solo=True), replace(B, solo=True, visible=False), C), [True, False, False]),
    ],
)
def test_eyes_and_solo_decide_what_is_shown(layers, shown):
    assert shown_layers(layers).tolist() == shown


@pytest.mark.parametrize(
    ("order", "hidden", "layer_order", "faces"),
    [
        (None, None, (0, 1, 2), None),
        (None, None, (2, 0, 1), [4, 0, 1, 2, 3]),
        (None, 1, (0, 1, 2), [0, 1, 4]),
        ([4, 3, 2, 1, 0], None, (0, 1, 2), [1, 0, 3, 2, 4]),
        ([4, 3, 2, 1, 0], 0, (1, 2, 0), [3, 2, 4]),
    ],
)
def test_faces_are_stacked_layer_by_layer(order, hidden, layer_order, faces):
    layers = [replace(layer, visible=number != hidden) for number, layer in enumerate((A, B, C))]
    order = None if order is None else np.array(order)
    found = stacked_faces(order, FACE_LAYERS, layers, layer_order)
    assert (None if found is None else found.tolist()) == faces


@pytest.mark.parametrize("values", [{"opacity": 1.5}, {"blend": "burn"}, {"visible": 3}, {"solo": "no"}])
def test_other_values_are_refused(values):
    with pytest.raises(InputError):
        replace(A, **values)


def test_the_flat_picture_is_that_of_the_file():
    drawing = puppet()
    flat = flat_picture(drawing.layers, drawing.layer_order, drawing.size)
    assert (flat == composite(puppet_layers())).all()
