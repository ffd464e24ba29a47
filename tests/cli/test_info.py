"""`akap-editor info`: what a file is, and whether it is sound."""

import json
import struct
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.io.akap.pose import save_pose
from akap_editor.io.akap.project import load, save
from akap_editor.io.export import EXPORT_FORMATS
from akap_editor.io.images import write_png
from akap_editor.resources import bundled_drawings, resource
from tests.support.command_line import assert_one_line
from tests.support.layered_files import add_layer, filled, ora_bytes, psd_bytes
from tests.support.names import assert_readable
from tests.support.puppets import puppet

RECORDING = resource("assets", "recordings", "elephant.akaprec")
MESHES = [each.suffix for each in EXPORT_FORMATS if not each.uses_framing]


@pytest.fixture
def facts(run):
    """Exit code and what `info --json` says."""

    def call(path):
        code, said, errors = run("info", path, "--json")
        assert errors == ""
        record = json.loads(said)
        assert record["sound"] == (code == 0) == (record["problems"] == [])
        assert code in (0, 1)
        return record

    return call


@pytest.mark.parametrize("path", bundled_drawings(), ids=lambda path: path.stem)
def test_bundled_drawings_are_sound_pictures(facts, path):
    record = facts(path)
    assert (record["kind"], record["sound"]) == ("picture", True)
    with Image.open(path) as image:
        assert (record["facts"]["width"], record["facts"]["height"]) == image.size
    assert record["facts"]["transparent"]
    assert record["facts"]["parts"] >= 1


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WebP", "BMP", "GIF"])
def test_kinds_of_pictures_are_told_by_their_content(facts, tmp_path, kind):
    Image.new("RGB", (40, 30), (200, 30, 30)).save(tmp_path / "picture", kind)
    record = facts(tmp_path / "picture")
    assert (record["kind"], record["facts"]["format"]) == ("picture", kind)
    assert not record["facts"]["transparent"]


def test_a_drawing(facts, posed):
    record = facts(posed)
    assert (record["kind"], record["sound"]) == ("drawing", True)
    assert (record["facts"]["width"], record["facts"]["height"]) == (90, 60)
    assert record["facts"]["angle distortion"] > 2.1


def test_a_drawing_in_layers(facts, tmp_path):
    document = new_document(puppet())
    joints = suggest_joints(document.drawing)
    save(replace(document, state=replace(document.state, joints=joints)), tmp_path / "puppet.akap")
    values = facts(tmp_path / "puppet.akap")["facts"]
    assert (values["layers"], values["joints"]) == (len(document.drawing.layers), len(joints))
    assert len(joints) > 0


def test_a_recording(facts):
    record = facts(RECORDING)
    assert (record["kind"], record["sound"]) == ("recording", True)
    assert record["facts"]["drawing"] == "elephant"
    assert record["facts"]["events"] > 100


def test_a_clip(facts, tmp_path):
    record = facts(resource("assets", "clips", "nod.clip.json"))
    assert record["kind"] == "clip"
    assert record["sound"]
    assert record["facts"] == {"name": "Nod", "pins": "Body, Chest, Head", "keys": 5, "seconds": 1.1}


def test_a_pose(facts, posed, tmp_path):
    save_pose(load(posed), tmp_path / "a.pose.json")
    record = facts("a.pose.json")
    assert (record["kind"], record["sound"]) == ("pose", True)
    assert record["facts"]["vertices"] == facts(posed)["facts"]["vertices"]
    text = (tmp_path / "a.pose.json").read_text("utf-8")
    (tmp_path / "a.pose.json").write_text(text.replace('"positions":[', '"positions":[[0,0],', 1))
    assert "vertices, got" in facts("a.pose.json")["problems"][0]


@pytest.mark.parametrize("suffix", MESHES)
def test_what_is_exported_is_a_sound_mesh(run, facts, posed, suffix):
    run("export", posed, "-o", f"cat{suffix}")
    record, drawing = facts(f"cat{suffix}"), facts(posed)
    assert (record["kind"], record["sound"]) == ("mesh", True)
    assert record["facts"]["faces"] == drawing["facts"]["faces"]
    assert record["facts"]["vertices"] == drawing["facts"]["vertices"]
    assert record["facts"]["parts"] == 1


def test_in_words(run, posed):
    code, said, errors = run("info", posed)
    assert (code, errors) == (0, "")
    lines = said.splitlines()
    assert lines[0] == f"{posed}: drawing, sound"
    assert any(line.split() == ["width", "90"] for line in lines)
    assert {line.index(line.split("  ")[-1].strip()) for line in lines[1:]} == {len("  angle distortion  ")}


SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.mark.parametrize(
    ("obj", "problem"),
    [
        (SQUARE + "f 1 2 3\nf 1 2 4\n", "1 edge with two faces on one side"),
        (SQUARE + "f 1 2 3\n", "1 vertex in no face"),
        (SQUARE + "f 1 2 3 4\nf 1 2 2\n", "1 face without area"),
        (SQUARE, "it has no faces"),
        (SQUARE + "f 1 2 9\n", "9"),
        (SQUARE + "f 1 2 x\n", "x"),
        ("v 0 nan 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "nan"),
        ("", "OBJ"),
    ],
)
def test_meshes_that_are_not_sound(facts, tmp_path, obj, problem):
    (tmp_path / "a.obj").write_text(obj)
    record = facts("a.obj")
    assert record["kind"] == "mesh"
    assert any(problem in each for each in record["problems"])


def test_polygons_are_no_problem(facts, tmp_path):
    (tmp_path / "a.obj").write_text(SQUARE + "f 1 2 3 4\n")
    assert facts("a.obj")["facts"]["faces"] == 2


def damaged(data):
    """Cut off, and with each of some bytes changed."""
    yield from (data[:size] for size in (0, 1, 3, 7, len(data) // 2, len(data) - 1))
    rng = np.random.default_rng(5)
    for place in rng.integers(0, min(len(data), 1500), 20):
        yield data[:place] + bytes([data[place] ^ rng.integers(1, 256)]) + data[place + 1 :]


@pytest.mark.parametrize("suffix", [*MESHES, ".png", ".akap", ".akaprec"])
def test_damage_of_any_kind_is_a_finding_and_not_a_crash(run, facts, posed, picture, tmp_path, suffix):
    path = {".png": picture, ".akap": posed, ".akaprec": RECORDING}.get(suffix)
    if path is None:
        run("export", posed, "-o", f"cat{suffix}")
        path = tmp_path / f"cat{suffix}"
    found = []
    for number, data in enumerate(damaged(path.read_bytes())):
        (tmp_path / f"{number}{suffix}").write_bytes(data)
        found.append(facts(f"{number}{suffix}")["sound"])
    assert not any(found[:4])


def test_glb_with_indices_out_of_range(run, facts, posed, tmp_path):
    run("export", posed, "-o", "a.glb")
    data = bytearray((tmp_path / "a.glb").read_bytes())
    size = struct.unpack_from("<I", data, 12)[0]
    record = json.loads(data[20 : 20 + size])
    view = record["bufferViews"][record["accessors"][2]["bufferView"]]
    struct.pack_into("<I", data, 28 + size + view["byteOffset"], 10**6)
    (tmp_path / "a.glb").write_bytes(data)
    assert "1000000" in facts("a.glb")["problems"][0]


def test_nothing_to_cut_out(facts, tmp_path):
    write_png(tmp_path / "a.png", np.zeros((20, 20, 4), dtype=np.uint8))
    assert "fully transparent" in facts("a.png")["problems"][0]


def test_something_else(run, tmp_path):
    (tmp_path / "notes.txt").write_text("Hello.")
    code, said, errors = run("info", "notes.txt")
    assert (code, errors) == (1, "")
    assert said.startswith("notes.txt: unknown, not sound\n")
    assert "b'Hello.'" in said


@pytest.mark.parametrize("name", ["nothing.png", "."])
def test_what_cannot_be_read_is_an_error(run, name):
    assert_one_line(run("info", name), name)


@pytest.mark.parametrize(
    "error",
    [
        ZeroDivisionError("division by zero"),
        RecursionError("a" * 5000),
        MemoryError(),
        KeyError("x\n\x1b[31m"),
    ],
    ids=lambda error: type(error).__name__,
)
@pytest.mark.parametrize("reader", ["decode_mesh", "mesh_defects", "count_parts"])
def test_a_defect_that_no_reader_names_is_no_traceback(run, monkeypatch, tmp_path, reader, error):
    def fails(*_):
        raise error

    (tmp_path / "mesh.json").write_text('{"vertices": [[0, 0], [1, 0], [0, 1]], "faces": [[0, 1, 2]]}')
    assert run("info", tmp_path / "mesh.json")[0] == 0
    monkeypatch.setattr(f"akap_editor.io.inspection.{reader}", fails)
    code, said, errors = run("info", tmp_path / "mesh.json")
    assert (code, errors) == (1, "")
    first, second = said.splitlines()
    assert first.endswith("mesh.json: mesh, not sound")
    assert second.startswith(f"  the file is damaged ({type(error).__name__}: ")
    assert len(second) < 200
    assert_readable(said)


def test_pictures_in_layers(facts, tmp_path):
    bar = filled(60, 30, 200, 30, 30)
    (tmp_path / "a.psd").write_bytes(psd_bytes(lambda psd: add_layer(psd, "bar", bar, 10, 10), (90, 60)))
    (tmp_path / "a.ora").write_bytes(
        ora_bytes("<text name='Hi'/><layer src='a.png'/>", {"a.png": bar}, "w='90' h='60'")
    )
    (tmp_path / "folder").mkdir()
    write_png(tmp_path / "folder" / "a.png", bar)
    for path, kind in (("a.psd", "Photoshop"), ("a.ora", "OpenRaster"), ("folder", "folder")):
        record = facts(path)
        assert (record["kind"], record["sound"], record["facts"]["format"]) == ("layers", True, kind)
        assert (record["facts"]["layers"], record["facts"]["parts"]) == (1, 1)
    assert facts("a.ora")["facts"]["not drawn"] == "“Hi”, which is no picture but of the kind “text”"
    with zipfile.ZipFile(tmp_path / "a.ora") as packed, zipfile.ZipFile(tmp_path / "b.ora", "w") as other:
        for name in sorted(packed.namelist(), reverse=True):  # opens, too, although its type is not in front
            other.writestr(name, packed.read(name), zipfile.ZIP_DEFLATED)
    assert facts("b.ora")["facts"] == facts("a.ora")["facts"]
    (tmp_path / "a.psd").write_bytes(b"8BPS and nothing else")
    assert not facts("a.psd")["sound"]
    for name, kind in (("a.psd", "a Photoshop"), ("a.PSB", "a Photoshop"), ("a.ora", "an OpenRaster")):
        (tmp_path / name).write_bytes(b"nothing")
        assert facts(name)["problems"] == [f"the file is damaged or not {kind} file"]
