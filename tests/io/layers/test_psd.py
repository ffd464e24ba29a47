"""Photoshop files: what layers become, and damage. The files are written by psd-tools."""

import re
import warnings
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from psd_tools import PSDImage
from psd_tools.constants import BlendMode, Clipping, Tag
from psd_tools.psd.descriptor import Bool, Descriptor, DescriptorBlock, DescriptorBlock2, Double, Integer

from akap_editor.errors import InputError
from akap_editor.io.layers import limits
from akap_editor.io.layers.psd import decode_psd
from akap_editor.layers.composite import composite
from tests.support.layered_files import add_layer, add_mask, filled, psd_bytes

RED = filled(3, 2, 255, 0, 0)


def read(build, **options):
    return decode_psd(BytesIO(psd_bytes(build, **options)))


def test_layers_come_from_the_bottom_to_the_top_with_name_place_and_pixels():
    picture = np.random.default_rng(1).integers(1, 256, (2, 3, 4), dtype=np.uint8)

    def build(psd):
        add_layer(psd, "Körper", picture, 1, 2)
        head = psd.create_group(name="head")
        add_layer(head, "eye", RED, -1, 0, opacity=51, visible=False)

    layered = read(build, size=(6, 4))
    assert layered.size == (6, 4)
    body, eye = layered.layers
    assert (body.name, body.offset, body.groups) == ("Körper", (1, 2), ())
    assert body.picture.tolist() == picture.tolist()
    assert (eye.path, eye.offset, eye.opacity, eye.visible) == (("head", "eye"), (-1, 0), 0.2, False)
    assert layered.left_out == ()


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        (BlendMode.NORMAL, "normal"),
        (BlendMode.MULTIPLY, "multiply"),
        (BlendMode.SCREEN, "screen"),
        (BlendMode.LINEAR_DODGE, "add"),
    ],
)
def test_blend_modes(mode, expected):
    (layer,) = read(lambda psd: add_layer(psd, "a", RED, blend_mode=mode)).layers
    assert layer.blend == expected


def test_other_blend_modes_become_normal_and_are_named():
    layered = read(lambda psd: add_layer(psd, "shade", RED, blend_mode=BlendMode.COLOR_BURN))
    assert layered.layers[0].blend == "normal"
    assert layered.left_out == ("the blend mode “color burn” of “shade”",)


@pytest.mark.parametrize("is_on", [True, False])
def test_effects_of_older_files_are_named(is_on):
    def build(psd):
        shadow = Descriptor(classID=b"DrSh", items={b"enab": Bool(True)})
        block = DescriptorBlock2(
            classID=b"null", items={b"masterFXSwitch": Bool(is_on), b"DrSh": shadow}, version=0
        )
        add_layer(psd, "hat", RED).tagged_blocks.set_data(Tag.OBJECT_BASED_EFFECTS_LAYER_INFO, block)

    assert read(build).left_out == (("the effects of “hat”",) if is_on else ())


@pytest.mark.parametrize("kind", [1, 2])
def test_the_background_of_an_artboard_is_named(kind):
    def build(psd):
        board = psd.create_group(name="page")
        sides = {key: Double(0.0) for key in (b"Top ", b"Left", b"Btom", b"Rght")}
        rectangle = Descriptor(classID=b"classFloatRect", items=sides)
        items = {b"artboardRect": rectangle, b"artboardBackgroundType": Integer(kind)}
        block = DescriptorBlock(classID=b"artboard", items=items, version=16)
        board.tagged_blocks.set_data(Tag.ARTBOARD_DATA1, block)
        add_layer(board, "a", RED)

    assert read(build).left_out == (("the background of the artboard “page”",) if kind == 2 else ())


@pytest.mark.parametrize(("right", "is_cropping"), [(3.0, False), (2.0, False), (1.0, True)])
def test_what_an_artboard_hides_is_drawn_and_named(right, is_cropping):
    def build(psd):
        board = psd.create_group(name="page")
        sides = {b"Top ": Double(0.0), b"Left": Double(0.0), b"Btom": Double(2.0), b"Rght": Double(right)}
        rectangle = Descriptor(classID=b"classFloatRect", items=sides)
        block = DescriptorBlock(classID=b"artboard", items={b"artboardRect": rectangle}, version=16)
        board.tagged_blocks.set_data(Tag.ARTBOARD_DATA1, block)
        add_layer(board, "a", RED)

    layered = read(build)
    assert layered.layers[0].box == (0, 0, 3, 2)
    assert layered.left_out == (("the crop of the artboard “page”",) if is_cropping else ())


def test_a_knockout_and_old_adjustment_layers_are_named():
    def build(psd):
        add_layer(psd, "base", RED)
        add_layer(psd, "hole", RED).tagged_blocks.set_data(Tag.KNOCKOUT_SETTING, 1)
        light = add_layer(psd, "light", filled(1, 1, 0, 0, 0))
        light.tagged_blocks.set_data(Tag.BRIGHTNESS_AND_CONTRAST, 20, 0, 127)
        record = light._record
        record.top = record.left = record.bottom = record.right = 0

    layered = read(build)
    assert [layer.name for layer in layered.layers] == ["base", "hole"]
    assert layered.left_out == ("the knockout of “hole”", "the adjustment layer “light”")


def test_groups_keep_opacity_visibility_and_blending():
    def build(psd):
        outer = psd.create_group(name="outer")
        outer.blend_mode, outer.opacity = BlendMode.PASS_THROUGH, 102
        inner = outer.create_group(name="inner")
        inner.blend_mode, inner.visible = BlendMode.MULTIPLY, False
        add_layer(inner, "a", RED)
        add_layer(outer, "b", RED)

    a, b = read(build).layers
    assert [(group.blend, group.opacity, group.visible) for group in a.groups] == [
        ("pass through", 0.4, True),
        ("multiply", 1.0, False),
    ]
    assert b.groups == a.groups[:1]


def test_opacity_and_fill_opacity_are_multiplied():
    (layer,) = read(lambda psd: add_layer(psd, "a", RED, opacity=102, fill_opacity=51)).layers
    assert layer.opacity == pytest.approx(0.4 * 0.2)


def masked(build_mask, in_group=False):
    """The opacities (2, 3) of a layer at (1, 1) with a mask."""

    def build(psd):
        group = psd.create_group(name="g") if in_group else psd
        layer = add_layer(group, "a", RED, 1, 1)
        build_mask(group if in_group else layer)

    alpha = np.zeros((4, 6), int)
    for layer in read(build).layers:
        left, top, right, bottom = layer.box
        alpha[top:bottom, left:right] = layer.picture[..., 3]
    return alpha[1:3, 1:4].tolist()


@pytest.mark.parametrize("in_group", [False, True])
def test_masks_are_multiplied_into_the_opacity(in_group):
    gray = np.array([[255, 100]], np.uint8)
    assert masked(lambda of: add_mask(of, gray, 2, 1), in_group) == [[0, 255, 100], [0, 0, 0]]

    def outside_is_visible(of):
        add_mask(of, gray, 2, 1).data.background_color = 255

    assert masked(outside_is_visible, in_group) == [[255, 255, 100], [255, 255, 255]]

    def disabled(of):
        add_mask(of, gray, 2, 1).disabled = True

    assert masked(disabled, in_group) == [[255] * 3] * 2


def test_clipping():
    def build(psd):
        add_layer(psd, "base", RED, 1, 1)
        add_layer(psd, "spots", filled(6, 4, 0, 0, 255), clipping=True)

    layered = read(build)
    assert [layer.clipping for layer in layered.layers] == [False, True]
    came = composite(layered)
    assert (came[1:3, 1:4] == [0, 0, 255, 255]).all()
    assert came[..., 3].sum() == 6 * 255


def test_a_group_is_clipped_as_painting_programs_write_it():
    def build(psd):
        add_layer(psd, "base", RED, 1, 1)
        group = psd.create_group(name="pattern")
        add_layer(group, "spots", filled(6, 4, 0, 0, 255))
        group._record.clipping = Clipping.NON_BASE  # psd-tools' setter refuses it

    layered = read(build)
    assert layered.layers[1].groups[0].clipping
    came = composite(layered)
    assert (came[1:3, 1:4] == [0, 0, 255, 255]).all()
    assert came[..., 3].sum() == 6 * 255


def test_what_is_clipped_to_an_empty_layer_is_not_drawn():
    def build(psd):
        add_layer(psd, "below", RED)
        add_layer(psd, "empty", filled(3, 2, 0, 0, 0, 0))
        add_layer(psd, "spots", RED, clipping=True)

    layered = read(build)
    assert [layer.name for layer in layered.layers] == ["below"]
    assert layered.left_out == ("“spots”, which is clipped to a layer that is not drawn",)


@pytest.mark.parametrize(
    ("mode", "depth", "tolerance"),
    [("RGB", 8, 0), ("RGB", 16, 1), ("L", 8, 0), ("L", 16, 1), ("CMYK", 8, 1)],
)
def test_color_modes_and_depths_become_rgba_of_8_bits(mode, depth, tolerance):
    color = (120, 120, 120, 200) if mode == "L" else (200, 100, 50, 200)
    picture = filled(3, 2, *color)
    (layer,) = read(lambda psd: add_layer(psd, "a", picture), mode=mode, depth=depth).layers
    assert np.abs(layer.picture.astype(int) - picture).max() <= tolerance


@pytest.mark.parametrize(
    ("mode", "depth", "message"), [("LAB", 8, "got Lab; convert"), ("RGB", 32, "got 32; convert")]
)
def test_other_colors_are_refused(mode, depth, message):
    with pytest.raises(InputError, match=message):
        read(lambda psd: None, mode=mode, depth=depth)


def test_a_flat_file_is_one_layer():
    buffer = BytesIO()
    PSDImage.frompil(Image.fromarray(filled(5, 3, 1, 2, 3)).convert("RGB")).save(buffer)
    (layer,) = decode_psd(BytesIO(buffer.getvalue())).layers
    assert (layer.name, layer.picture.tolist()) == ("Background", filled(5, 3, 1, 2, 3).tolist())


GOOD = psd_bytes(
    lambda psd: add_layer(psd, "a", np.random.default_rng(1).integers(1, 256, (40, 30, 4), dtype=np.uint8))
)
BAD = {
    "empty": (b"", "the file is damaged or not a Photoshop file"),
    "text": (b"hello world", "the file is damaged or not a Photoshop file"),
    "header only": (GOOD[:26], "the file is damaged or not a Photoshop file"),
    "cut off": (GOOD[: len(GOOD) // 2], "damaged"),
    "no channels": (GOOD[:12] + b"\0\0" + GOOD[14:], "damaged"),
    "huge canvas": (
        GOOD[:14] + b"\0\0\x75\x30\0\0\x75\x30" + GOOD[22:],
        "canvas: expected at most 100 megapixels",
    ),
    "transparent": (psd_bytes(lambda psd: add_layer(psd, "a", RED * 0)), "no layer with visible pixels"),
}


@pytest.mark.parametrize("kind", BAD)
def test_damage_gives_one_sentence(kind):
    data, message = BAD[kind]
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        decode_psd(BytesIO(data))
    assert "\n" not in str(caught.value)


def test_too_many_layers_are_refused(monkeypatch):
    monkeypatch.setattr(limits, "MAX_LAYERS", 2)
    with pytest.raises(InputError, match="at most 2 layers and groups"):
        read(lambda psd: [add_layer(psd, "a", RED) for _ in range(3)])
    monkeypatch.setattr(limits, "MAX_LAYERS_PIXELS", 5)
    with pytest.raises(InputError, match="expected layers of at most 0 megapixels in all"):
        read(lambda psd: add_layer(psd, "a", RED))


def test_damaged_bytes_never_leak_other_errors():
    rng = np.random.default_rng(3)
    good = np.frombuffer(GOOD, np.uint8)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(150):
            data = good.copy()
            places = rng.integers(0, min(len(data), 600), rng.integers(1, 5))
            data[places] = rng.integers(0, 256, len(places))
            try:
                layered = decode_psd(BytesIO(data.tobytes()))
            except InputError:
                continue
            assert layered.layers
