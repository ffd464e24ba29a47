"""Composition of layers, against Pillow and against the formulas for single pixels."""

import itertools

import numpy as np
import pytest
from PIL import Image

from akap_editor.layers import composite as module
from akap_editor.layers.composite import composite, hidden_layers
from akap_editor.layers.layered_picture import BLEND_MODES, Layer, LayeredPicture, LayerGroup
from tests.support.layered_files import filled

BLEND = {
    "normal": lambda b, s: s,
    "multiply": lambda b, s: b * s,
    "screen": lambda b, s: b + s - b * s,
    "add": lambda b, s: np.minimum(1, b + s),
}


def over(backdrop, source, mode="normal", opacity=1.0):
    """W3C's formula for straight colors (4,) from 0 to 1."""
    source_alpha, alpha = source[3] * opacity, backdrop[3]
    mixed = (1 - alpha) * source[:3] + alpha * BLEND[mode](backdrop[:3], source[:3])
    total = source_alpha + alpha * (1 - source_alpha)
    color = source_alpha * mixed + (1 - source_alpha) * alpha * backdrop[:3]
    return np.array([*(color / total if total else color), total])


def pixel(*layers, size=(1, 1)):
    return composite(LayeredPicture(size, layers))[0, 0]


def assert_close(came, expected):
    assert np.abs(came - 255 * np.asarray(expected)).max() <= 0.51


COLORS = [(200, 30, 90, 255), (10, 250, 100, 128), (90, 90, 255, 3)]


@pytest.mark.parametrize("mode", BLEND_MODES)
@pytest.mark.parametrize("opacity", [1.0, 0.4])
def test_blend_modes_follow_the_formula(mode, opacity):
    for below, above in itertools.product(COLORS, COLORS):
        layers = (
            Layer("a", filled(1, 1, *below)),
            Layer("b", filled(1, 1, *above), opacity=opacity, blend=mode),
        )
        expected = over(np.array(below) / 255, np.array(above) / 255, mode, opacity)
        assert_close(pixel(*layers) * (expected[3] > 0), expected)


def test_one_layer_comes_back_bit_for_bit():
    picture = np.random.default_rng(1).integers(0, 256, (40, 30, 4), dtype=np.uint8)
    picture[picture[..., 3] == 0] = 0
    assert (composite(LayeredPicture((30, 40), (Layer("a", picture),))) == picture).all()


@pytest.mark.parametrize("strip_pixels", [1, 100, 10**6])
def test_many_layers_agree_with_pillow(monkeypatch, strip_pixels):
    monkeypatch.setattr(module, "STRIP_PIXELS", strip_pixels)
    rng = np.random.default_rng(2)
    expected, layers = Image.new("RGBA", (50, 40)), []
    for k in range(6):
        picture = rng.integers(0, 256, (20, 25, 4), dtype=np.uint8)
        x, y = int(rng.integers(-10, 40)), int(rng.integers(-10, 30))
        layers.append(Layer(str(k), picture, (x, y)))
        placed = Image.new("RGBA", (50, 40))
        placed.paste(Image.fromarray(picture), (x, y))
        expected.alpha_composite(placed)
    came, expected = composite(LayeredPicture((50, 40), layers)).astype(float), np.asarray(expected, float)
    assert np.abs(came[..., 3] - expected[..., 3]).max() <= 3
    premultiplied = [each[..., :3] * each[..., 3:] / 255.0 for each in (came, expected)]
    assert np.abs(premultiplied[0] - premultiplied[1]).max() <= 4  # Pillow rounds after each layer


RED, GREEN, BLUE = filled(1, 1, 255, 0, 0), filled(1, 1, 0, 255, 0), filled(1, 1, 0, 0, 255)


def test_the_opacity_of_a_group_counts_once_for_all_its_layers():
    for blend in ("pass through", "normal"):
        group = LayerGroup("g", opacity=0.5, blend=blend)
        came = pixel(Layer("a", RED), Layer("b", GREEN, groups=(group,)), Layer("c", BLUE, groups=(group,)))
        assert_close(came, [0.5, 0, 0.5, 1])


def test_only_a_group_that_passes_through_blends_with_what_lies_below():
    def came(blend):
        group = LayerGroup("g", blend=blend)
        return pixel(
            Layer("a", filled(1, 1, 255, 255, 0)),
            Layer("b", filled(1, 1, 0, 255, 255), groups=(group,), blend="multiply"),
        ).tolist()

    assert came("pass through") == [0, 255, 0, 255]
    assert came("normal") == [0, 255, 255, 255]
    assert came("multiply") == [0, 255, 0, 255]


def test_what_clips_is_seen_on_its_base_only_and_leaves_its_opacity():
    base = np.concatenate([filled(1, 1, 255, 0, 0, 128), filled(1, 1, 9, 9, 9, 0)], axis=1)
    top = Layer("b", filled(2, 1, 0, 0, 255), opacity=0.5, clipping=True)
    came = composite(LayeredPicture((2, 1), (Layer("a", base), top)))[0]
    assert np.abs(came[0] - [127.5, 0, 127.5, 128]).max() <= 0.5
    assert came[1].tolist() == [0, 0, 0, 0]
    two = composite(
        LayeredPicture((2, 1), (Layer("a", base), top, Layer("c", filled(2, 1, 0, 255, 0), clipping=True)))
    )
    assert two[0, 0].tolist() == [0, 255, 0, 128]


def test_the_base_of_clipped_layers_is_blended_with_them():
    layers = (
        Layer("below", filled(1, 1, 255, 255, 0)),
        Layer("base", RED, blend="multiply", opacity=0.5),
        Layer("clipped", filled(1, 1, 0, 255, 255), clipping=True),
    )
    assert_close(pixel(*layers), [0.5, 1, 0, 1])


def test_layers_clip_to_a_group_and_groups_clip():
    group = LayerGroup("g")
    left = Layer("a", RED, (0, 0), (group,))
    came = composite(LayeredPicture((2, 1), (left, Layer("b", filled(2, 1, 0, 0, 255), clipping=True))))
    assert came[0].tolist() == [[0, 0, 255, 255], [0, 0, 0, 0]]
    clipped = LayerGroup("h", clipping=True)
    came = composite(
        LayeredPicture((2, 1), (Layer("a", RED), Layer("b", filled(2, 1, 0, 255, 0), groups=(clipped,))))
    )
    assert came[0].tolist() == [[0, 255, 0, 255], [0, 0, 0, 0]]


@pytest.mark.parametrize(
    "hidden",
    [
        Layer("b", GREEN, visible=False),
        Layer("b", GREEN, groups=(LayerGroup("g", visible=False),)),
        Layer("b", GREEN, opacity=0),
        Layer("b", GREEN, (1, 0)),
        Layer("b", GREEN, (0, -1)),
    ],
)
def test_what_is_hidden_or_outside_is_not_drawn_nor_what_clips_to_it(hidden):
    assert pixel(Layer("a", RED), hidden).tolist() == [255, 0, 0, 255]
    assert pixel(Layer("a", RED), hidden, Layer("c", BLUE, clipping=True, groups=hidden.groups)).tolist() == [
        255,
        0,
        0,
        255,
    ]


def test_hidden_layers_are_those_that_are_not_drawn():
    old = LayerGroup("old", visible=False)
    layers = (
        Layer("body", RED),
        Layer("spots", GREEN, clipping=True),
        Layer("sketch", RED, visible=False),
        Layer("shade", BLUE, clipping=True),
        Layer("arm", RED, groups=(old,)),
        Layer("sleeve", RED, clipping=True),
        Layer("head", RED),
    )
    assert [layer.name for layer in hidden_layers(LayeredPicture((1, 1), layers))] == [
        "sketch",
        "shade",
        "arm",
        "sleeve",
    ]


def test_groups_of_equal_names_are_different():
    groups = LayerGroup("g", opacity=0.5), LayerGroup("g")
    came = pixel(
        Layer("a", RED), Layer("b", BLUE, groups=groups[:1]), Layer("c", BLUE, groups=groups[1:], opacity=0)
    )
    assert_close(came, [0.5, 0, 0.5, 1])
