"""`akap-editor export`: what it writes, what it says, and what it refuses."""

import json
from dataclasses import replace

import numpy as np
import pygltflib
import pytest
import trimesh

from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.framing import CROPS, crop_box
from akap_editor.io.akap.project import load, save
from akap_editor.io.export import EXPORT_FORMATS
from akap_editor.io.images import read_image, write_png
from akap_editor.io.mesh_files.mesh_drawing import read_mesh
from akap_editor.io.open_document import open_document
from akap_editor.meshing.meshers import MESHERS
from akap_editor.render.offscreen import OffscreenRenderer
from tests.support.command_line import assert_one_line
from tests.support.meshers import needs_triangle

SUFFIXES = [each.suffix for each in EXPORT_FORMATS]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_each_format_is_written_into_a_new_folder(run, posed, tmp_path, suffix):
    output = tmp_path / "new" / f"cat{suffix}"
    code, said, errors = run("export", posed, "-o", output)
    assert (code, errors) == (0, "")
    assert said.startswith(f"{output}: ")
    assert said.count("\n") == 1
    assert output.stat().st_size
    for path in output.parent.iterdir():
        assert path.name in said


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_facts_as_json(run, posed, tmp_path, suffix):
    code, said, _ = run("export", posed, "-o", f"cat{suffix}", "--json")
    facts = json.loads(said)
    assert code == 0
    assert {tmp_path / name for name in facts["files"]} == {*tmp_path.iterdir()} - {
        posed,
        tmp_path / "bar.png",
    }
    assert facts["files"][-1] == f"cat{suffix}"
    assert ("width" in facts) == (suffix in (".png", ".svg"))


@pytest.mark.parametrize("crop", CROPS)
@pytest.mark.parametrize("rest", [False, True])
def test_png_is_what_the_renderer_draws(run, posed, tmp_path, crop, rest):
    options = ["--scale", "1.5", "--background", "#336699", "--crop", crop, *(["--rest"] if rest else [])]
    code, said, errors = run("export", posed, "-o", "a.png", *options)
    assert (code, errors) == (0, "")
    document = open_document(posed)
    pose = document.drawing.mesh.vertices if rest else document.state.positions
    with OffscreenRenderer() as renderer:
        box = crop_box(document.drawing, pose, crop)
        expected = renderer.render(document.drawing, pose, box, 1.5, (0x33 / 255, 0x66 / 255, 0x99 / 255))
    np.testing.assert_array_equal(read_image(tmp_path / "a.png"), expected)
    assert said == f"a.png: {expected.shape[1]} × {expected.shape[0]} pixels\n"


def test_an_svg_with_its_texture(run, posed, tmp_path):
    assert run("export", posed, "-o", "a.svg", "--textured")[0] == 0
    assert "<image " in (tmp_path / "a.svg").read_text("utf-8")
    assert_one_line(run("export", posed, "-o", "a.glb", "--textured"), "--textured", ".svg", ".glb")


def test_z_by_the_order_of_drawing_is_for_meshes_in_space(run, posed, tmp_path):
    for name, option in (("a.obj", "--no-z-order"), ("a.glb", "--z-order")):
        assert run("export", posed, "-o", name, option)[0] == 0
    assert_one_line(run("export", posed, "-o", "a.svg", "--z-order"), "--z-order", ".obj", ".svg")


def test_a_picture_is_exported_at_rest(run, picture, tmp_path):
    assert run("export", picture, "-o", "bar.glb")[0] == 0
    assert run("export", picture, "-o", "bar.obj")[0] == 0
    count = len(open_document(picture).drawing.mesh.vertices)
    assert pygltflib.GLTF2().load("bar.glb").accessors[0].count == count
    assert len(trimesh.load("bar.obj", process=False, maintain_order=True).vertices) == count
    assert read_image(picture)[0, 0].tolist() == [0, 0, 0, 0], "it is still there"


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (["-o", "a.jpg"], ["a.jpg", ".png, .svg, .glb, .obj, .spine.json or .json", "got .jpg"]),
        (["-o", "a"], ["got none"]),
        (["-o", "a.glb", "--scale", "2"], ["--scale", ".glb"]),
        (["-o", "a.json", "--crop", "pose"], ["--crop", ".json"]),
        (["-o", "a.obj", "--background", "#000000"], ["--background", ".obj"]),
        (["-o", "a.png", "--scale", "0"], ["scale", "positive"]),
        (["-o", "a.svg", "--scale", "1e4"], ["8192", "smaller scale"]),
        (["-o", "a.png", "--crop", "tight"], ["--crop", "'tight'"]),
        (["-o", "a.png", "--background", "red"], ["--background", "#RRGGBB"]),
        ([], ["--output"]),
    ],
)
def test_bad_options(run, posed, tmp_path, options, parts):
    before = sorted(tmp_path.iterdir())
    assert_one_line(run("export", posed, *options), *parts)
    assert sorted(tmp_path.iterdir()) == before


def test_the_largest_picture(run, tmp_path):
    """8192 pixels wide, in tiles: a flat color is flat across all seams."""
    image = np.zeros((12, 256, 4), dtype=np.uint8)
    image[2:10, 8:248] = (250, 130, 20, 255)
    write_png(tmp_path / "bar.png", image)
    code, said, _ = run("export", "bar.png", "-o", "a.png", "--scale", "32", "--crop", "frame")
    assert (code, said) == (0, "a.png: 8192 × 384 pixels\n")
    image = read_image(tmp_path / "a.png")
    assert (image[90:300, 300:7900] == [250, 130, 20, 255]).all()
    assert not image[:, :190].any()


@needs_triangle
def test_the_mesh_of_a_picture_is_made_by_the_mesher_asked_for(run, picture, tmp_path):
    written = []
    for mesher in MESHERS:
        assert run("export", picture, "-o", f"{mesher}.obj", "--mesher", mesher)[0] == 0
        written.append(read_mesh(tmp_path / f"{mesher}.obj").mesh.vertices.tolist())
    assert written[0] != written[1]


def test_many_files_become_files_of_one_format_in_a_folder(run, posed, tmp_path):
    code, said, errors = run(
        "export", posed, tmp_path / "bar.png", "-o", "meshes", "--format", ".obj", "--json"
    )
    assert (code, errors) == (0, "")
    assert [record["files"][-1] for record in json.loads(said)] == [
        f"meshes/{name}.obj" for name in (posed.stem, "bar")
    ]
    assert len(trimesh.load(tmp_path / "meshes" / "bar.obj").faces)


def test_many_animations_are_told_as_one_list(run, posed, tmp_path):
    document = load(posed)
    keys = Keyframe(0.0, document.state.positions), Keyframe(0.1, document.state.positions + 2.0)
    for name in ("walk.akap", "wave.akap"):
        save(document.with_state(replace(document.state, animation=Animation(keys))), tmp_path / name)
    code, said, _ = run("export", "walk.akap", "wave.akap", "-o", "films", "--format", ".gif", "--json")
    assert code == 0
    assert [record["files"] for record in json.loads(said)] == [["films/walk.gif"], ["films/wave.gif"]]
    code, said, _ = run("export", "walk.akap", "wave.akap", "-o", "films", "--format", ".gif", "--overwrite")
    assert (code, len(said.splitlines())) == (0, 2)


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        (("bar.png", "-o", "meshes"), ["--format", "got none"]),
        (("bar.png", "-o", "a.obj", "--format", ".obj"), ["a folder for the results of 2 files", "a.obj"]),
        (("bar.png", "-o", "meshes", "--format", ".fbx"), ["--format", ".fbx"]),
    ],
)
def test_many_files_need_a_folder_and_a_format(run, posed, tmp_path, arguments, parts):
    assert_one_line(run("export", posed, *arguments), *parts)
    assert not (tmp_path / "meshes").exists()


def test_a_format_that_contradicts_the_name_is_refused(run, posed):
    assert_one_line(run("export", posed, "-o", "a.glb", "--format", ".obj"), "--format", ".glb", ".obj")
