"""Exports of drawings in layers: from back to front, without hidden layers, each with its name."""

import json
import re
import struct
from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.io.export.formats import export
from akap_editor.layers.drawing_layer import flat_picture
from akap_editor.layers.layer_view import LayerView
from akap_editor.render.offscreen import OffscreenRenderer
from tests.support.puppets import puppet

ORDER = (0, 2, 3, 1, 4)  # the arm in front of the head; the hat is hidden
NAMES = ["body", "skull", "eyes", "arm"]


@pytest.fixture(scope="module")
def document():
    drawing = puppet()
    layers = list(drawing.layers)
    layers[1] = replace(layers[1], opacity=0.5)
    return new_document(replace(drawing, layers=tuple(layers), layer_order=ORDER))


def test_gltf_has_a_primitive_with_its_own_material_for_each_layer(document, tmp_path):
    export(document, tmp_path / "a.glb")
    data = (tmp_path / "a.glb").read_bytes()
    scene = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    primitives = scene["meshes"][0]["primitives"]
    assert [scene["materials"][each["material"]]["name"] for each in primitives] == NAMES
    counts = np.bincount(document.drawing.face_layers, minlength=5)
    sizes = [scene["accessors"][each["indices"]]["count"] // 3 for each in primitives]
    assert sizes == [counts[number] for number in ORDER[:4]]
    materials = [scene["materials"][each["material"]] for each in primitives]
    colors = [each["pbrMetallicRoughness"].get("baseColorFactor") for each in materials]
    assert colors == [None, None, None, [1, 1, 1, 0.5]]


def test_obj_has_a_group_for_each_layer(document, tmp_path):
    export(document, tmp_path / "a.obj")
    text = (tmp_path / "a.obj").read_text()
    assert re.findall(r"^g (.*)$", text, re.MULTILINE) == NAMES


def test_spine_has_a_slot_for_each_part_of_a_layer(document, tmp_path):
    export(document, tmp_path / "a.spine.json")
    record = json.loads((tmp_path / "a.spine.json").read_text())
    assert [slot["name"] for slot in record["slots"]] == ["body", "skull", "eyes", "eyes 2", "arm"]
    attachment = record["skins"][0]["attachments"]["arm"]["arm"]
    height, width = document.drawing.image.shape[:2]
    assert (attachment["width"], attachment["height"]) == (width, height)


def test_layers_of_one_name_differ_in_the_formats_that_tell_parts_apart_by_name(document, tmp_path):
    """As slots do in Spine files, whose parts of one layer have numbers, too."""
    names = ["left eye", "left eye", "eyes", "left_eye", "hat"]
    layers = tuple(
        replace(each, name=name) for each, name in zip(document.drawing.layers, names, strict=True)
    )
    twins = new_document(replace(document.drawing, layers=layers))
    for ending in ("obj", "glb", "spine.json"):
        export(twins, tmp_path / f"a.{ending}")
    groups = re.findall(r"^g (.*)$", (tmp_path / "a.obj").read_text(), re.MULTILINE)
    assert groups == ["left_eye", "eyes", "left_eye_3", "left_eye_2"]
    data = (tmp_path / "a.glb").read_bytes()
    scene = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    assert [each["name"] for each in scene["materials"]] == [
        "left eye",
        "left eye 2",
        "eyes",
        "left_eye",
        "hat",
    ]
    slots = [slot["name"] for slot in json.loads((tmp_path / "a.spine.json").read_text())["slots"]]
    assert slots == ["left eye", "eyes", "left_eye", "left_eye 2", "left eye 2"]


def test_json_names_layers_and_the_layer_of_each_face(document, tmp_path):
    export(document, tmp_path / "a.json")
    record = json.loads((tmp_path / "a.json").read_text())
    layers = record["layers"]
    shown = [
        layers["layers"][number]["name"] for number in layers["order"] if layers["layers"][number]["shown"]
    ]
    assert shown == NAMES
    drawn = [layers["layers"][layers["faceLayers"][face]]["name"] for face in record["order"]]
    assert list(dict.fromkeys(drawn)) == NAMES


def test_pictures_and_outlines_leave_out_hidden_layers(document, tmp_path):
    export(document, tmp_path / "a.svg")
    solo = tuple(replace(layer, solo=layer.name == "arm") for layer in document.drawing.layers)
    alone = replace(document, drawing=replace(document.drawing, layers=solo))
    export(alone, tmp_path / "b.svg")
    points = re.findall(r"[ML]([\d.]+) ([\d.]+)", (tmp_path / "b.svg").read_text())
    x, y = np.array(points, dtype=float).T
    assert (x.min() > 80, y.min() > 105, x.max() < 160, y.max() < 131) == (True,) * 4
    assert len((tmp_path / "a.svg").read_text()) > len((tmp_path / "b.svg").read_text())
    with OffscreenRenderer() as painter:
        drawing = document.drawing
        picture = painter.render(
            drawing, drawing.mesh.vertices, (0, 0, *drawing.size), order=document.draw_order
        )
    expected = flat_picture(drawing.layers, drawing.layer_order, drawing.size)
    assert np.abs(picture.astype(int) - expected).max(axis=2)[50:60, 60:100].max() <= 2


@pytest.fixture(scope="module")
def switched(document):
    """Keyframes at 0, 1 and 2: with the skull, with the hat in its place, and with the skull again."""
    pose = document.state.positions
    skull = LayerView((True, True, True, True, False), ORDER)
    hat = LayerView((True, True, False, True, True), ORDER)
    keyframes = tuple(Keyframe(float(k), pose, layers=view) for k, view in enumerate((skull, hat, skull)))
    animation = Animation(keyframes, "none")
    return replace(document, state=replace(document.state, animation=animation))


def test_spine_switches_the_slots_of_layers_and_shares_the_others(switched, tmp_path):
    export(switched, tmp_path / "a.spine.json")
    record = json.loads((tmp_path / "a.spine.json").read_text())
    assert [slot["name"] for slot in record["slots"]] == ["body", "skull", "eyes", "eyes 2", "arm", "hat"]
    switches = record["animations"]["keyframes"]["slots"]
    assert {name: keys["attachment"] for name, keys in switches.items()} == {
        "skull": [
            {"time": 0.0, "name": "skull"},
            {"time": 1.0, "name": None},
            {"time": 2.0, "name": "skull"},
        ],
        "hat": [{"name": None}, {"time": 1.0, "name": "hat"}, {"time": 2.0, "name": None}],
    }


def test_gltf_switches_layers_by_steps(switched, tmp_path):
    export(switched, tmp_path / "a.glb")
    data = (tmp_path / "a.glb").read_bytes()
    scene = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    names = [
        [scene["materials"][each["material"]]["name"] for each in mesh["primitives"]]
        for mesh in scene["meshes"]
    ]
    assert names == [["body", "skull", "eyes", "arm"], ["body", "eyes", "arm", "hat"]]
    steps = [each for each in scene["animations"][0]["samplers"] if each.get("interpolation") == "STEP"]
    assert len(steps) == 2
