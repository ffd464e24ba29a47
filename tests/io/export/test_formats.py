"""Names, options and files of every format; what is in the files is tested one format at a time."""

import json
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.export import EXPORT_FORMATS, ExportOptions, export, format_of
from akap_editor.io.images import read_image, write_png
from akap_editor.io.open_document import open_document
from tests.support.names import assert_readable, strange_names

OUTSIDE = {".obj": ["cat-texture.png", "cat.mtl"], ".spine.json": ["cat-texture.png", "cat.atlas"]}


@pytest.mark.parametrize("each", EXPORT_FORMATS, ids=lambda each: each.suffix)
def test_the_name_decides_on_the_files(bent, painter, tmp_path, each):
    written = export(bent, tmp_path / f"cat{each.suffix}", ExportOptions(), painter)
    assert [path.name for path in written] == [*OUTSIDE.get(each.suffix, []), f"cat{each.suffix}"]
    assert sorted(tmp_path.iterdir()) == sorted(written)
    assert all(path.stat().st_size for path in written)
    assert bool(painter.asked) == (each.suffix == ".png")


@pytest.mark.parametrize("each", EXPORT_FORMATS, ids=lambda each: each.suffix)
def test_the_same_drawing_gives_the_same_bytes(bent, painter, tmp_path, each):
    first = [
        path.read_bytes() for path in export(bent, tmp_path / f"a{each.suffix}", ExportOptions(), painter)
    ]
    again = [
        path.read_bytes() for path in export(bent, tmp_path / f"a{each.suffix}", ExportOptions(), painter)
    ]
    assert first == again


@pytest.mark.parametrize("each", EXPORT_FORMATS, ids=lambda each: each.suffix)
def test_the_rest_pose_on_demand(drawn, bent, painter, tmp_path, each):
    """Nothing of the pose is left; pins, which are in the JSON of both, apart."""
    bent = bent.with_state(drawn.state.__class__((), bent.state.positions, drawn.state.settings))
    (tmp_path / "rest").mkdir()
    (tmp_path / "bent").mkdir()
    options = ExportOptions(crop="frame")
    plain = export(drawn, tmp_path / "rest" / f"a{each.suffix}", options, painter)
    rest = export(
        bent, tmp_path / "bent" / f"a{each.suffix}", ExportOptions(crop="frame", rest=True), painter
    )
    assert [path.read_bytes() for path in plain] == [path.read_bytes() for path in rest]
    if painter.asked:
        assert painter.asked[0][0] is painter.asked[1][0]


@pytest.mark.parametrize(
    ("name", "suffix"),
    [
        ("a.png", ".png"),
        ("A.PNG", ".png"),
        ("a.spine.json", ".spine.json"),
        ("a.json", ".json"),
        ("a.b.glb", ".glb"),
    ],
)
def test_the_format_of_a_name(name, suffix):
    assert format_of(name).suffix == suffix


@pytest.mark.parametrize("name", ["a", "a.jpg", "png", "a.json.txt", "spine"])
def test_a_name_that_says_no_format(name, bent, painter, tmp_path):
    with pytest.raises(InputError, match=r"Expected a name that ends in \.png, \.svg, .* or \.json, got "):
        export(bent, tmp_path / name, ExportOptions(), painter)
    assert list(tmp_path.iterdir()) == []


def test_capitals_in_a_name_are_kept(bent, painter, tmp_path):
    assert export(bent, tmp_path / "CAT.PNG", ExportOptions(), painter) == [tmp_path / "CAT.PNG"]
    assert [path.name for path in tmp_path.iterdir()] == ["CAT.PNG"]


@pytest.mark.parametrize("suffix", [".obj", ".spine.json"])
def test_the_picture_of_the_same_name_is_not_replaced(bent, painter, tmp_path, suffix):
    write_png(tmp_path / "cat.png", bent.drawing.image)
    before = (tmp_path / "cat.png").read_bytes()
    export(bent, tmp_path / f"cat{suffix}", ExportOptions(), painter)
    assert (tmp_path / "cat.png").read_bytes() == before


def test_options_reach_the_painter(bent, painter, tmp_path):
    options = ExportOptions(scale=2.0, background=(0.1, 0.2, 0.3), crop="frame")
    export(bent, tmp_path / "a.png", options, painter)
    assert painter.asked == [(bent.state.positions, (0, 0, 140, 90), 2.0, (0.1, 0.2, 0.3), None)]
    assert read_image(tmp_path / "a.png").shape == (180, 280, 4)


def test_what_cannot_be_written_leaves_nothing(bent, painter, tmp_path):
    with pytest.raises(InputError, match=r"Couldn't export “.*a\.svg”\. crop: expected one of"):
        export(bent, tmp_path / "a.svg", ExportOptions(crop="tight"), painter)
    with pytest.raises(InputError, match=r"Couldn't export “.*a\.svg”\. Picture size: expected at most 8192"):
        export(bent, tmp_path / "a.svg", ExportOptions(scale=1000), painter)
    with pytest.raises(InputError, match="No such file or directory"):
        export(bent, tmp_path / "none" / "a.obj", ExportOptions(), painter)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("each", EXPORT_FORMATS, ids=lambda each: each.suffix)
def test_a_pose_with_collapsed_and_flipped_faces_is_exported(drawn, painter, tmp_path, each):
    """All vertices on one line, and the drawing turned over: ugly, but no reason to fail."""
    for squeeze in ([[1.0, 0.0], [0.0, 0.0]], [[-1.0, 0.0], [0.0, 1.0]]):
        pose = drawn.drawing.mesh.vertices @ np.array(squeeze)
        document = drawn.with_state(drawn.state.__class__((), pose, drawn.state.settings))
        assert export(document, tmp_path / f"a{each.suffix}", ExportOptions(), painter)


def test_a_picture_needs_a_painter_and_the_rest_does_not(bent, tmp_path):
    with pytest.raises(InputError, match=r"Couldn't export “.*a\.png”\. Expected a painter for a picture"):
        export(bent, tmp_path / "a.png")
    assert export(bent, tmp_path / "a.glb") == [tmp_path / "a.glb"]


def test_faces_are_in_the_order_in_which_they_pass_one_another(bent, painter, tmp_path):
    """One pin is told to pass in front: pictures and meshes have its faces last, pins keep their own face."""
    first, second = bent.state.pins
    pins = replace(first, depth=3), replace(second, depth=-3)
    raised = bent.with_state(replace(bent.state, pins=pins))
    order = raised.face_order
    assert order is not None
    faces = raised.drawing.mesh.faces
    assert (order != np.arange(len(faces))).any()
    export(raised, tmp_path / "a.png", painter=painter)
    np.testing.assert_array_equal(painter.asked[0][-1], order)
    lines = export(raised, tmp_path / "a.obj")[-1].read_text().splitlines()
    written = [[int(word.split("/")[0]) - 1 for word in line.split()[1:]] for line in lines if line[0] == "f"]
    np.testing.assert_array_equal(np.array(written)[:, ::-1], faces[order])
    record = json.loads(export(raised, tmp_path / "a.json")[-1].read_text())
    np.testing.assert_array_equal(record["faces"], faces)
    np.testing.assert_array_equal(record["order"], order)
    assert [pin["depth"] for pin in record["pins"]] == [3, -3]


def every_text(record):
    """All texts in a JSON record, keys too."""
    if isinstance(record, dict):
        return [text for pair in record.items() for each in pair for text in every_text(each)]
    if isinstance(record, list):
        return [text for each in record for text in every_text(each)]
    return [record] if isinstance(record, str) else []


@pytest.mark.parametrize("stem", strange_names())
@pytest.mark.parametrize("each", EXPORT_FORMATS, ids=lambda each: each.suffix)
def test_files_of_strange_names_are_sound(bent, painter, tmp_path, each, stem):
    """The drawing is named like the file it came from, and is exported to a file of that name."""
    document = replace(bent, drawing=replace(bent.drawing, name=stem))
    *companions, main = export(document, tmp_path / f"{stem}{each.suffix}", ExportOptions(), painter)
    assert main == tmp_path / f"{stem}{each.suffix}"
    for path in companions:
        assert_readable(path.name)
    data = main.read_bytes()
    if each.suffix == ".glb":
        data = data[20 : 20 + int.from_bytes(data[12:16], "little")]
    if each.suffix == ".png":
        assert read_image(main).shape[2] == 4
        return
    text = data.decode()
    assert_readable(text)
    if each.suffix == ".svg":
        title = ElementTree.fromstring(text).find("{http://www.w3.org/2000/svg}title")
        assert title.text == document.drawing.name
    elif each.suffix == ".obj":
        material = next(path for path in companions if path.suffix == ".mtl")
        assert text.splitlines()[0] == f"mtllib {material.name}"
        opened = open_document(main)
        assert opened.drawing.name == document.drawing.name
        assert len(opened.drawing.mesh.vertices) == len(document.drawing.mesh.vertices)
        assert opened.drawing.size == document.drawing.size, "with its texture"
    else:
        for each_text in every_text(json.loads(text)):
            assert_readable(each_text)
