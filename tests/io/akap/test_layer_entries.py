"""Drawings in layers in .akap files: round trips, version 1 for flat drawings, damage."""

import json
import zipfile
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.document.rig.joint import make_joint
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.errors import InputError
from akap_editor.io.akap.archive import pack
from akap_editor.io.akap.project import decode_document, encode_document
from akap_editor.io.images import encode_png
from akap_editor.layers.composite import composite
from akap_editor.layers.layer_view import LayerView
from tests.support.layered_files import filled
from tests.support.puppets import BODY, HAT, SKULL, puppet, puppet_layers
from tests.support.recorded_drag import plank_drawing


@pytest.fixture(scope="module")
def document():
    drawing = puppet()
    layers = list(drawing.layers)
    layers[SKULL] = replace(layers[SKULL], opacity=0.5, blend="multiply", locked=True, name="head “1”")
    layers[HAT] = replace(layers[HAT], visible=True, solo=True, slot="hats", closed_groups=(0,))
    document = new_document(replace(drawing, layers=tuple(layers), layer_order=(1, 0, 2, 4, 3)))
    weld = make_joint(drawing.mesh, 4, SKULL, BODY, np.array([80.0, 85.0]), kind="weld")
    joints = (*suggest_joints(drawing), weld)
    pose = document.state.positions
    view = LayerView((True, False, True, True, False), (4, 3, 2, 1, 0))
    animation = Animation((Keyframe(0.0, pose), Keyframe(0.5, pose, layers=view)))
    return replace(document, state=replace(document.state, joints=joints, animation=animation))


@pytest.fixture(scope="module")
def entries(document):
    with zipfile.ZipFile(BytesIO(encode_document(document))) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def reopened(entries):
    return decode_document(pack((name, content, False) for name, content in entries.items()))


def test_a_drawing_in_layers_comes_back_bit_for_bit(document):
    data = encode_document(document)
    drawing, other = document.drawing, decode_document(data).drawing
    assert encode_document(decode_document(data)) == data
    for name in ("image", "uv"):
        np.testing.assert_array_equal(getattr(other, name), getattr(drawing, name))
    np.testing.assert_array_equal(other.mesh.layers, drawing.mesh.layers)
    assert (other.size, other.layer_order, other.meshing) == (
        drawing.size,
        drawing.layer_order,
        drawing.meshing,
    )
    for a, b in zip(drawing.layers, other.layers, strict=True):
        values = [(each.path, each.opacity, each.blend) for each in (a, b)]
        assert values[0] == values[1]
        assert (a.visible, a.solo, a.locked) == (b.visible, b.solo, b.locked)
        assert (a.slot, a.closed_groups) == (b.slot, b.closed_groups)
        np.testing.assert_array_equal(a.artwork.picture, b.artwork.picture)
        assert a.artwork.offset == b.artwork.offset


def test_what_keyframes_show_of_the_layers_comes_back(document):
    keyframes = decode_document(encode_document(document)).state.animation.keyframes
    assert [key.layers for key in keyframes] == [key.layers for key in document.state.animation.keyframes]


@pytest.mark.parametrize(
    ("layers", "message"),
    [
        ({"visible": [0], "order": [0, 1]}, "keyframes: expected 5 layers in each, got 2"),
        ({"visible": [7], "order": [0, 1, 2, 3, 4]}, "expected each layer once in the order"),
        ({"visible": [], "order": [0, 0, 2, 3, 4]}, "expected each layer once in the order"),
        ({"visible": [0.5], "order": [0, 1, 2, 3, 4]}, "expected numbers of at most 1000 layers"),
        ({"visible": []}, "order"),
        ([1], "expected layers to be an object"),
    ],
)
def test_damaged_layers_of_a_keyframe_are_refused(entries, layers, message):
    index = json.loads(entries["animation.json"])
    index["keyframes"][1]["layers"] = layers
    with pytest.raises(InputError, match=message):
        reopened({**entries, "animation.json": json.dumps(index).encode()})


def test_version_2_is_written_for_layers_only(entries):
    assert json.loads(entries["document.json"])["version"] == 2
    assert "picture.png" not in entries
    with zipfile.ZipFile(BytesIO(encode_document(new_document(plank_drawing())))) as archive:
        flat = json.loads(archive.read("document.json"))
        assert flat["version"] == 1
        assert not {"layers", "texture", "layerOrder"} & flat.keys()
        assert "picture.png" in archive.namelist()


def test_the_thumbnail_shows_the_visible_layers():
    data = encode_document(new_document(puppet()))
    with zipfile.ZipFile(BytesIO(data)) as archive:
        thumbnail = np.asarray(Image.open(BytesIO(archive.read("thumbnail.png"))))
    assert (thumbnail == composite(puppet_layers())).all()


def test_joints_come_back_bit_for_bit(document):
    joints, other = document.state.joints, decode_document(encode_document(document)).state.joints
    assert len(joints) == len(other) == 3
    for a, b in zip(joints, other, strict=True):
        assert (a.id, a.faces, a.kind, a.is_proposed) == (b.id, b.faces, b.kind, b.is_proposed)
        np.testing.assert_array_equal(a.weights, b.weights)


def joint(**values):
    """A joint's record with some values changed."""
    return [{"id": 1, "faces": [0, 500], "weights": [[1, 0, 0], [0, 1, 0]], **values}]


def changed(key, value, layer=None):
    """A function that changes document.json: a key of it, or of one of its layers."""

    def change(record):
        (record if layer is None else record["layers"][layer])[key] = value

    return change


DAMAGE = {
    "no order": (changed("layerOrder", [0, 1]), "layerOrder: expected each layer once, got"),
    "an order of truths": (changed("layerOrder", [True, 0, 2, 3, 4]), "layerOrder: expected each layer once"),
    "no layers": (changed("layers", []), "expected 1 to 1000 layers, got 0"),
    "a layer that is a number": (changed("layers", [1] * 5), "expected layers to be objects, got 1"),
    "layers as a text": (changed("layers", "abc"), "expected layers to be a list"),
    "too many vertices": (changed("vertices", 9999, 1), "layers: expected 4[0-9][0-9] vertices in all"),
    "no vertices": (changed("vertices", 0, 1), "layers: expected"),
    "a huge texture": (changed("texture", {"width": 10**6, "height": 10**6}), "texture: expected 1 to"),
    "no texture": (changed("texture", {"width": 0, "height": 5}), "texture: expected 1 to"),
    "outside the texture": (changed("corner", [5000, 5], 0), "layer 0: expected a picture inside"),
    "left of the texture": (changed("corner", [-1, 5], 0), "layer 0: expected a picture inside"),
    "another size": (changed("size", [7, 7], 1), r"layers/1\.png: expected 7 x 7 pixels, got 70 x 18"),
    "a size of one number": (changed("size", [7], 1), "layer 1: size: expected two whole numbers"),
    "an offset of fractions": (changed("offset", [0.5, 1], 1), "layer 1: offset: expected two whole"),
    "an offset at the moon": (changed("offset", [10**15, 1], 1), "layer 1: offset: expected two whole"),
    "bright": (changed("opacity", 2.0, 3), "layer 3: opacity: expected a number from 0 to 1"),
    "unknown blending": (changed("blend", "burn", 3), "layer 3: blend: expected 'normal'"),
    "groups of numbers": (changed("groups", [1], 3), "layer 3: expected at most 50 names of groups"),
    "a name that is a number": (changed("name", 3, 3), "layer 3: expected name to be a text, got 3"),
    "a slot that is a number": (changed("slot", 3, 3), "layer 3: expected slot to be a text, got 3"),
    "a closed group that is none": (changed("closedGroups", [4], 3), "layer 3: closed_groups: expected"),
    "closed groups of texts": (changed("closedGroups", ["a"], 3), "layer 3: closed_groups: expected"),
    "joints of numbers": (changed("joints", [1]), "expected joints to be objects, got 1"),
    "joints as a text": (changed("joints", "x"), "expected joints to be a list"),
    "a joint of one face": (changed("joints", joint(faces=[1])), "expected two faces of a joint"),
    "a joint far away": (changed("joints", joint(faces=[0, 10**8])), "joint 1: expected faces from 0"),
    "a joint in one layer": (
        changed("joints", joint(faces=[0, 1])),
        "joint 1: expected points on two layers",
    ),
    "heavy weights": (
        changed("joints", joint(weights=[[2, 0, 0], [0, 1, 0]])),
        "joint 1: expected two times",
    ),
    "few weights": (changed("joints", joint(weights=[[1, 0], [0, 1]])), "expected two times 3 weights"),
    "a spring": (changed("joints", joint(kind="spring")), "kind: expected 'hinge' or 'weld'"),
    "one joint twice": (changed("joints", joint() * 2), "expected each joint once"),
    "visible": (changed("visible", 1, 3), "layer 3: expected visible to be true or false, got 1"),
}


@pytest.mark.parametrize(("change", "message"), DAMAGE.values(), ids=DAMAGE)
def test_damage_is_named(entries, change, message):
    record = json.loads(entries["document.json"])
    change(record)
    with pytest.raises(InputError, match=message):
        reopened(entries | {"document.json": json.dumps(record).encode()})


def test_a_missing_or_damaged_picture_is_named(entries):
    with pytest.raises(InputError, match=r"expected the entry layers/2\.png, which is missing"):
        reopened({name: content for name, content in entries.items() if name != "layers/2.png"})
    with pytest.raises(InputError, match=r"layers/2\.png: the file is damaged or not a PNG picture"):
        reopened(entries | {"layers/2.png": b"hello"})
    wrong = encode_png(filled(3, 3, 1, 2, 3))
    with pytest.raises(InputError, match=r"layers/2\.png: expected 72 x 72 pixels, got 3 x 3"):
        reopened(entries | {"layers/2.png": wrong})


def test_a_reader_of_version_1_ignores_nothing_silently(entries):
    """Keys of layers in a file of version 1 mean nothing, as unknown keys do."""
    record = json.loads(entries["document.json"]) | {"version": 1}
    picture = encode_png(np.zeros((200, 160, 4), np.uint8))
    flat = reopened(entries | {"document.json": json.dumps(record).encode(), "picture.png": picture})
    assert not flat.drawing.layers
