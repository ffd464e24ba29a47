"""Layers that can move on their own, and that they look as the file does."""

import numpy as np
import pytest

from akap_editor.layers.composite import composite
from akap_editor.layers.layered_picture import Layer, LayeredPicture, LayerGroup
from akap_editor.layers.merging import movable_layers
from tests.support.layered_files import filled

RED, BLUE, GREEN = filled(8, 8, 255, 0, 0), filled(8, 8, 0, 0, 255), filled(8, 8, 0, 255, 0, 120)
GROUP, MULTIPLIED = LayerGroup("head", opacity=0.5), LayerGroup("shade", 0.5, "multiply")
HIDDEN, CLIPPING = LayerGroup("old", visible=False), LayerGroup("light", clipping=True)

CASES = {
    "plain": ([Layer("a", RED), Layer("b", BLUE, (4, 2))], ["a", "b"]),
    "clipped": ([Layer("a", RED), Layer("b", BLUE, (4, 2), clipping=True), Layer("c", GREEN)], ["a", "c"]),
    "clipped, blended": (
        [Layer("a", RED, opacity=0.6), Layer("b", GREEN, (4, 2), blend="multiply", clipping=True)],
        ["a"],
    ),
    "group": ([Layer("a", RED), Layer("b", BLUE, (4, 2), (GROUP,))], ["a", "b"]),
    "blended group": (
        [Layer("a", RED), Layer("b", BLUE, (4, 2), (MULTIPLIED,)), Layer("c", GREEN, (0, 0), (MULTIPLIED,))],
        ["a", "shade"],
    ),
    "clipping group": (
        [Layer("a", RED), Layer("b", BLUE, (2, 2), (CLIPPING,)), Layer("c", GREEN, (5, 0), (CLIPPING,))],
        ["a"],
    ),
    "clipped to a group": (
        [
            Layer("a", RED, (0, 0), (GROUP,)),
            Layer("b", BLUE, (4, 2), (GROUP,)),
            Layer("c", GREEN, clipping=True),
        ],
        ["head"],
    ),
    "blended": ([Layer("a", RED), Layer("b", GREEN, (3, 3), blend="screen")], ["a", "b"]),
}


@pytest.mark.parametrize(("layers", "names"), CASES.values(), ids=CASES)
def test_what_belongs_together_is_merged_and_looks_the_same(layers, names):
    before = LayeredPicture((16, 12), tuple(layers))
    movable = movable_layers(before)
    assert [layer.name for layer in movable] == names
    after = LayeredPicture(
        (16, 12),
        tuple(
            Layer(layer.name, layer.picture, layer.offset, (), layer.opacity, layer.blend, layer.visible)
            for layer in movable
        ),
    )
    expected, result = composite(before).astype(int), composite(after)
    assert np.abs(expected - result).max() <= 2


def test_hidden_layers_stay_hidden_and_empty_ones_are_dropped():
    nothing = RED * np.array([1, 1, 1, 0], np.uint8)
    layers = (
        Layer("a", RED),
        Layer("b", BLUE, (0, 0), (HIDDEN,)),
        Layer("c", nothing),
        Layer("d", GREEN, clipping=True),
    )
    movable = movable_layers(LayeredPicture((16, 12), layers))
    assert [(layer.name, layer.visible) for layer in movable] == [("a", True), ("b", False)]
    assert movable[1].path == ("old", "b")
