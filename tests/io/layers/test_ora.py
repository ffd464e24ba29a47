"""OpenRaster files: what stacks become, and damage."""

from io import BytesIO

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.layers.ora import decode_ora
from tests.support.layered_files import filled, ora_bytes

RED = filled(3, 2, 255, 0, 0)
LAYER = "<layer name='a' src='data/a.png'/>"


def read(stack, pictures=None, **options):
    return decode_ora(
        BytesIO(ora_bytes(stack, {"data/a.png": RED} if pictures is None else pictures, **options))
    )


def test_layers_come_from_the_bottom_to_the_top_and_offsets_add_up():
    picture = np.random.default_rng(1).integers(1, 256, (2, 3, 4), dtype=np.uint8)
    layered = read(
        "<stack name='head' x='2' y='1' opacity='0.5'><layer name='eye' src='data/a.png' x='-3' opacity='0.2'"
        " visibility='hidden'/></stack><layer name='body' src='data/b.png' y='2'/>",
        {"data/a.png": RED, "data/b.png": picture},
    )
    assert layered.size == (6, 4)
    body, eye = layered.layers
    assert (body.name, body.offset, body.picture.tolist()) == ("body", (0, 2), picture.tolist())
    assert (eye.path, eye.offset, eye.opacity, eye.visible) == (("head", "eye"), (-1, 1), 0.2, False)
    assert eye.groups[0].opacity == 0.5


@pytest.mark.parametrize(
    ("operation", "blend"),
    [("src-over", "normal"), ("multiply", "multiply"), ("screen", "screen"), ("plus", "add")],
)
def test_blend_modes(operation, blend):
    (layer,) = read(f"<layer src='data/a.png' composite-op='svg:{operation}'/>").layers
    assert layer.blend == blend


@pytest.mark.parametrize(
    ("attributes", "blend"),
    [
        ("", "pass through"),
        ("isolation='auto'", "pass through"),
        ("isolation='isolate'", "normal"),
        ("opacity='0.5'", "normal"),
        ("composite-op='svg:screen'", "screen"),
    ],
)
def test_isolation_of_groups(attributes, blend):
    (layer,) = read(f"<stack {attributes}>{LAYER}</stack>").layers
    assert layer.groups[0].blend == blend


def test_what_is_not_drawn_is_named():
    layered = read(
        "<layer name='shade' src='data/a.png' composite-op='svg:overlay'/><text name='Hello'/>"
        "<layer name='vector' src='data/a.svg'/>"
    )
    assert layered.left_out == (
        "the layer “vector”, which is no PNG picture",
        "“Hello”, which is no picture but of the kind “text”",
        "the blend mode “svg:overlay” of “shade”",
    )
    assert [layer.name for layer in layered.layers] == ["shade"]


DEEP = "<stack>" * 60 + LAYER + "</stack>" * 60
ENTITY = (
    "<!DOCTYPE image [<!ENTITY e 'x'>]><image w='6' h='4'><stack>"
    "<layer name='&e;' src='data/a.png'/></stack></image>"
)
BAD = {
    "no zip": (b"hello", "damaged or not an OpenRaster file"),
    "empty": (b"", "damaged or not an OpenRaster file"),
    "cut off": (ora_bytes(LAYER, {"data/a.png": RED})[:200], "damaged or not an OpenRaster file"),
    "another type": (ora_bytes(LAYER, mimetype="application/epub"), "expected the type image/openraster"),
    "no picture": (ora_bytes(LAYER), "layer “a”: expected the entry data/a.png, which is missing"),
    "outside": (ora_bytes("<layer src='../../a.png'/>"), "expected the entry ../../a.png, which is missing"),
    "no source": (ora_bytes("<layer name='a'/>"), "layer “a”: expected the name of its picture"),
    "no layers": (ora_bytes(""), "no layer with visible pixels"),
    "no stack": (ora_bytes("<image w='6' h='4'/>"), "stack.xml: expected an image with a stack"),
    "no size": (ora_bytes(LAYER, size=""), "stack.xml: w: expected a number, got 'nothing'"),
    "canvas": (ora_bytes(LAYER, size="w='60000' h='60000'"), "canvas: expected at most 100 megapixels"),
    "no canvas": (ora_bytes(LAYER, size="w='0' h='4'"), "canvas: expected at least 1 x 1 pixels"),
    "opacity": (
        ora_bytes("<layer name='a' src='a.png' opacity='7'/>"),
        "layer “a”: opacity: expected a number from 0",
    ),
    "nan": (ora_bytes("<layer name='a' src='a.png' x='nan'/>"), "layer “a”: x: expected a number, got 'nan'"),
    "far": (
        ora_bytes("<layer name='a' src='a.png' y='1e9'/>"),
        "layer “a”: y: expected at most 1000000 pixels",
    ),
    "entities": (ora_bytes(ENTITY, {"data/a.png": RED}), "stack.xml: expected no document type"),
    "entities, UTF-16": (ora_bytes(ENTITY.encode("utf-16").decode("latin-1")), "stack.xml"),
    "deep": (ora_bytes(DEEP, {"data/a.png": RED}), "stack.xml: expected groups in groups at most 50 deep"),
    "no XML": (ora_bytes("<image"), "stack.xml: the list of layers is damaged"),
}


@pytest.mark.parametrize("kind", BAD)
def test_damage_gives_one_sentence(kind):
    data, message = BAD[kind]
    with pytest.raises(InputError) as caught:
        decode_ora(BytesIO(data))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_damaged_list_of_layers_is_named_once():
    data = bytearray(ora_bytes(LAYER, {"data/a.png": RED}))
    start = data.index(b"stack.xml")
    data[start + 20] ^= 255
    with pytest.raises(InputError, match=r"^stack\.xml: the entry is damaged$"):
        decode_ora(BytesIO(data))


def test_a_damaged_picture_names_its_layer():
    data = ora_bytes(LAYER, {"data/a.png": RED}).replace(b"IHDR", b"IHDX")
    with pytest.raises(InputError, match=r"^layer “a”: "):
        decode_ora(BytesIO(data))
