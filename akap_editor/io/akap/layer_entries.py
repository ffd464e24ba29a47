"""The layers of a drawing as entries of an .akap file: descriptions in document.json and a picture each."""

import reprlib
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ...editor.document.drawing import Drawing
from ...editor.document.rig.joint import MAX_JOINTS, Joint
from ...errors import InputError, error_context
from ...geometry.validation import MAX_COORDINATE, Ints, freeze
from ...layers.drawing_layer import Artwork, DrawingLayer
from ...layers.layer_view import LayerView
from ...layers.layered_picture import MAX_GROUPS
from ...words import tr
from ..images import decode_image, encode_png
from .archive import Archive, ArchiveEntry
from .json_records import Json, numbers, optional, require

MAX_LAYERS = 1000
MAX_TEXTURE_PIXELS = 2**28
MAX_PICTURE_BYTES = 2**29

# The pictures of layers never change, and encoding them takes longer than the rest of a save.
_encoded: WeakKeyDictionary[Artwork, bytes] = WeakKeyDictionary()


def describe_layers(drawing: Drawing) -> Json:
    """The keys of document.json for a drawing in layers; {} for another one. Raises InputError."""
    if not drawing.layers:
        return {}
    assert drawing.mesh.layers is not None
    if (np.diff(drawing.mesh.layers) < 0).any():
        raise InputError(tr("layers: expected vertices that are sorted by layer"))
    if len(drawing.layers) > MAX_LAYERS:
        raise InputError(
            tr("expected at most {most} layers, got {count}", most=MAX_LAYERS, count=len(drawing.layers))
        )
    counts = np.bincount(drawing.mesh.layers, minlength=len(drawing.layers)).tolist()
    height, width = drawing.image.shape[:2]
    return {
        "layers": [_describe(layer, count) for layer, count in zip(drawing.layers, counts, strict=True)],
        "layerOrder": list(drawing.layer_order),
        "texture": {"width": width, "height": height},
    }


def _describe(layer: DrawingLayer, vertices: int) -> Json:
    artwork = layer.artwork
    return {
        "name": layer.name,
        "groups": list(layer.groups),
        "offset": list(artwork.offset),
        "size": [artwork.picture.shape[1], artwork.picture.shape[0]],
        "corner": list(artwork.corner),
        "vertices": vertices,
        "opacity": layer.opacity,
        "blend": layer.blend,
        "visible": layer.visible,
        "solo": layer.solo,
        "locked": layer.locked,
        **({"slot": layer.slot} if layer.slot else {}),
        **({"closedGroups": list(layer.closed_groups)} if layer.closed_groups else {}),
    }


def layer_picture_entries(drawing: Drawing) -> list[ArchiveEntry]:
    """The entries layers/0.png, layers/1.png, ... with the picture of each layer."""
    entries: list[ArchiveEntry] = []
    for number, layer in enumerate(drawing.layers):
        if layer.artwork not in _encoded:
            _encoded[layer.artwork] = encode_png(layer.artwork.picture)
        entries.append((_entry_name(number), _encoded[layer.artwork], False))
    return entries


def _entry_name(number: int) -> str:
    return f"layers/{number}.png"


def read_layers(
    archive: Archive, record: Json, vertices: int
) -> tuple[NDArray[np.uint8], tuple[DrawingLayer, ...], tuple[int, ...], Ints]:
    """Texture (h, w, 4) uint8, layers, their order, and the layer of each of ``vertices`` (n,).

    Raises InputError.
    """
    with error_context("document.json"):
        records, order = require(record, "layers", list), require(record, "layerOrder", list)
        size = require(record, "texture", dict)
        width, height = require(size, "width", int), require(size, "height", int)
        if not 1 <= len(records) <= MAX_LAYERS:
            raise InputError(
                tr("expected 1 to {most} layers, got {count}", most=MAX_LAYERS, count=len(records))
            )
        if not (width >= 1 and height >= 1 and width * height <= MAX_TEXTURE_PIXELS):
            raise InputError(
                tr(
                    "texture: expected 1 to {most} pixels, got {width} x {height}",
                    most=MAX_TEXTURE_PIXELS,
                    width=width,
                    height=height,
                )
            )
        if any(type(number) is not int for number in order) or sorted(order) != list(range(len(records))):
            raise InputError(
                tr("layerOrder: expected each layer once, got {value}", value=reprlib.repr(order))
            )
        counts = [require(_as_record(each), "vertices", int) for each in records]
        if min(counts) < 1 or sum(counts) != vertices:
            raise InputError(
                tr(
                    "layers: expected {vertices} vertices in all, got {count}",
                    vertices=vertices,
                    count=sum(counts),
                )
            )
    archive.count_expanded(4 * width * height)
    texture = np.zeros((height, width, 4), np.uint8)
    boxes = []
    for number, each in enumerate(records):
        with error_context(f"layer {number}"):
            boxes.append(_read_box(each, width, height))
        (_, (x, y), (w, h)), name = boxes[-1], _entry_name(number)
        content = archive.read(name, MAX_PICTURE_BYTES)
        with error_context(name):
            picture = decode_image(content, ("PNG",), (w, h))
            if picture.shape[:2] != (h, w):
                raise InputError(tr("expected an upright picture, got one rotated by its EXIF data"))
        texture[y : y + h, x : x + w] = picture
    freeze(texture)
    layers = []
    for number, (each, (offset, (x, y), (w, h))) in enumerate(zip(records, boxes, strict=True)):
        with error_context(f"layer {number}"):
            layers.append(_read_layer(each, Artwork(texture[y : y + h, x : x + w], offset, (x, y))))
    return texture, tuple(layers), tuple(order), np.repeat(np.arange(len(counts)), counts).astype(np.int32)


def _read_layer(record: Json, artwork: Artwork) -> DrawingLayer:
    groups = optional(record, "groups", list, [])
    if len(groups) > MAX_GROUPS or any(type(group) is not str for group in groups):
        raise InputError(
            tr(
                "expected at most {most} names of groups, got {value}",
                most=MAX_GROUPS,
                value=reprlib.repr(groups),
            )
        )
    return DrawingLayer(
        artwork,
        require(record, "name", str),
        tuple(groups),
        float(numbers([record.get("opacity", 1.0)], "opacity")[0]),
        optional(record, "blend", str, "normal"),
        optional(record, "visible", bool, True),
        optional(record, "solo", bool, False),
        optional(record, "locked", bool, False),
        optional(record, "slot", str, ""),
        tuple(optional(record, "closedGroups", list, [])),
    )


def _read_box(
    record: Json, width: int, height: int
) -> tuple[tuple[int, int], tuple[int, int], tuple[int, int]]:
    """Offset, corner in the texture, and size of a layer's picture; the texture has a width and a height."""
    offset, (x, y), (w, h) = (_pair(record, name) for name in ("offset", "corner", "size"))
    if not (x >= 0 and y >= 0 and w >= 1 and h >= 1 and x + w <= width and y + h <= height):
        raise InputError(
            tr("expected a picture inside the texture, got {w} x {h} pixels at {x}, {y}", w=w, h=h, x=x, y=y)
        )
    return offset, (x, y), (w, h)


def _pair(record: Json, name: str) -> tuple[int, int]:
    values = require(record, name, list)
    if len(values) != 2 or any(type(v) is not int or abs(v) > MAX_COORDINATE for v in values):
        raise InputError(
            tr(
                "{name}: expected two whole numbers of pixels, got {value}",
                name=name,
                value=reprlib.repr(values),
            )
        )
    return values[0], values[1]


def write_layer_view(view: LayerView | None) -> Json:
    """The entry of a keyframe for what is visible of the layers, and their order; empty if there is none."""
    if view is None:
        return {}
    visible = [number for number, on in enumerate(view.visible) if on]
    return {"layers": {"visible": visible, "order": list(view.order)}}


def read_layer_view(record: Json) -> LayerView | None:
    """What `write_layer_view` wrote, None if absent. Raises InputError on values of other kinds."""
    if "layers" not in record:
        return None
    value = require(record, "layers", dict)
    visible, order = require(value, "visible", list), require(value, "order", list)
    count = len(order)
    if count > MAX_LAYERS or any(type(number) is not int for number in [*visible, *order]):
        raise InputError(
            tr(
                "expected numbers of at most {most} layers, got {value}",
                most=MAX_LAYERS,
                value=reprlib.repr(value),
            )
        )
    if sorted(order) != list(range(count)) or any(not 0 <= number < count for number in visible):
        raise InputError(tr("expected each layer once in the order, got {value}", value=reprlib.repr(order)))
    shown = set(visible)
    return LayerView(tuple(number in shown for number in range(count)), tuple(order))


def read_joints(record: Json) -> tuple[Joint, ...]:
    """The joints of a record, none if absent. Raises InputError on values of other kinds."""
    records = optional(record, "joints", list, [])
    if len(records) > MAX_JOINTS:
        raise InputError(
            tr("expected at most {most} joints, got {count}", most=MAX_JOINTS, count=len(records))
        )
    return tuple(map(_read_joint, records))


def _read_joint(value: Any) -> Joint:
    if type(value) is not dict:
        raise InputError(tr("expected joints to be objects, got {value}", value=reprlib.repr(value)))
    faces, rows = require(value, "faces", list), require(value, "weights", list)
    if len(faces) != 2 or any(type(face) is not int for face in faces):
        raise InputError(tr("expected two faces of a joint, got {value}", value=reprlib.repr(faces)))
    weights = [numbers(row, "weights") for row in rows]
    if len(weights) != 2 or any(len(row) != 3 for row in weights):
        raise InputError(tr("expected two times 3 weights of a joint, got {value}", value=reprlib.repr(rows)))
    return Joint(
        require(value, "id", int),
        (faces[0], faces[1]),
        np.array(weights),
        optional(value, "kind", str, "hinge"),
        optional(value, "proposed", bool, False),
    )


def _as_record(value: Any) -> Json:
    if type(value) is not dict:
        raise InputError(tr("expected layers to be objects, got {value}", value=reprlib.repr(value)))
    return value
