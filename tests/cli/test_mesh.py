"""`akap-editor mesh`: what it writes, what it says, and how it goes on past bad pictures."""

import json
import subprocess
import sys

import numpy as np
import pytest

from akap_editor.io.images import write_png
from akap_editor.io.mesh_files.mesh_drawing import read_mesh
from akap_editor.meshing.meshers import MESHERS
from tests.support.command_line import assert_one_line
from tests.support.layered_files import ora_bytes
from tests.support.meshers import needs_triangle


@pytest.fixture
def image():
    """(90, 130, 4): a ring, an island and a speck."""
    y, x = np.mgrid[0:90, 0:130] + 0.5
    away = np.hypot(x - 50, y - 45)
    alpha = np.clip(np.minimum(36 - away, away - 15), 0, 1) + np.clip(10 - np.hypot(x - 112, y - 30), 0, 1)
    alpha[80:82, 120:122] = 1
    rgba = np.full((90, 130, 4), 200, dtype=np.uint8)
    rgba[..., 3] = np.rint(255 * alpha)
    return rgba


@pytest.fixture
def picture(tmp_path, image):
    write_png(tmp_path / "ring.png", image)
    return tmp_path / "ring.png"


def test_one_picture(run, picture, tmp_path, image):
    code, out, err = run("mesh", picture, "-o", "new/ring.obj", "--vertices", 300)
    assert (code, err) == (0, "")
    first, angle, covered, seconds, specks, wrote = out.splitlines()
    assert first.startswith(f"{picture}: 2 parts, 1 hole, ")
    assert angle.split()[:2] == ["smallest", "angle"]
    assert covered.split()[1] == "99.90%"  # without the speck
    assert seconds.endswith(" s")
    assert specks.split()[:4] == ["left", "out", "1", "speck,"]
    assert wrote == "Wrote new/ring.obj"
    write_png(tmp_path / "new" / "ring.png", image)  # the texture beside it
    drawing = read_mesh(tmp_path / "new" / "ring.obj")
    vertices, faces = len(drawing.mesh.vertices), len(drawing.mesh.faces)
    assert f"{vertices} vertices, {faces} faces" in first
    assert vertices == pytest.approx(300, rel=0.1)
    np.testing.assert_allclose(drawing.mesh.vertices, drawing.uv * [130, 90], atol=1e-4)
    np.testing.assert_allclose(drawing.mesh.vertices[:, 0].max(), 124, atol=0.7)  # where it was, 2 pixels out


def test_y_is_up_in_the_file(run, picture, tmp_path):
    run("mesh", picture, "-o", "ring.obj")
    lines = [line.split() for line in (tmp_path / "ring.obj").read_text("utf-8").splitlines()]
    points = np.array([words[1:3] for words in lines if words[0] == "v"], dtype=float)
    faces = np.array([[int(corner.split("/")[0]) for corner in w[1:]] for w in lines if w[0] == "f"]) - 1
    island = points[points[:, 0] > 98]
    assert island[:, 1].mean() == pytest.approx(60, abs=1)  # 30 below the upper edge of 90
    a, b, c = points[faces].transpose(1, 0, 2)
    assert ((b - a)[:, 0] * (c - a)[:, 1] > (b - a)[:, 1] * (c - a)[:, 0]).all()  # counterclockwise


def test_json(run, picture):
    code, out, err = run("mesh", picture, "--json", "--vertices", 500, "--expand", 1, "--threshold", 0.25)
    (row,) = json.loads(out)
    assert (code, err) == (0, "")
    assert (row["picture"], row["parts"], row["holes"], row["specks"], row["mesh"]) == (
        str(picture),
        2,
        1,
        1,
        None,
    )
    assert row["vertices"] == pytest.approx(500, rel=0.1)
    assert row["covered"] + row["speck_share"] >= 0.999
    assert 25 < row["worst_angle"] <= row["low_angle"] < 60
    assert 0 < row["outside"] < 0.2
    assert row["seconds"] > 0
    assert row["cut_out"] is True


def test_a_faint_picture_gets_a_threshold_that_suits_it_unless_one_is_given(run, tmp_path, image):
    image = image.copy()
    image[..., 3] //= 4
    write_png(tmp_path / "faint.png", image)
    (row,) = json.loads(run("mesh", "faint.png", "--json")[1])
    assert row["covered"] > 0.9
    assert_one_line(run("mesh", "faint.png", "--threshold", 0.5), "faint.png", "transparent")


def test_expansion_and_threshold_change_the_mesh(run, picture):
    def outside(*options):
        return json.loads(run("mesh", picture, "--json", *options)[1])[0]["outside"]

    assert outside("--expand", 0) < outside("--expand", 1) < outside("--expand", 4)
    assert outside("--expand", 4, "--threshold", 0.9) > 0


def test_many_pictures_go_on_past_bad_ones(run, picture, tmp_path, image):
    folder = tmp_path / "more"
    folder.mkdir()
    for name in ("a", "b"):
        write_png(folder / f"{name}.png", image)
    (folder / "broken.png").write_bytes(picture.read_bytes()[:200])
    (folder / "notes.txt").write_text("not a picture")
    image[..., 3] = 0
    write_png(folder / "empty.png", image)
    code, out, err = run("mesh", folder, picture, "missing.png", "-o", "meshes")
    assert code == 1
    head, *rows, total = out.splitlines()
    assert head.split()[:4] == ["picture", "parts", "holes", "specks"]
    assert [row.split()[0] for row in rows] == [str(folder / "a.png"), str(folder / "b.png"), str(picture)]
    assert all(row.split()[1:4] == ["2", "1", "1"] for row in rows)
    assert total.startswith("3 meshes, 3 failed; median ")
    messages = [line for line in err.splitlines() if line.startswith("akap-editor: ")]
    assert len(messages) == 3
    for line, name in zip(messages, ("broken.png", "empty.png", "missing.png"), strict=True):
        assert name in line
    assert sorted(path.name for path in (tmp_path / "meshes").iterdir()) == ["a.obj", "b.obj", "ring.obj"]


def test_many_as_json(run, picture, tmp_path):
    code, out, _ = run("mesh", picture, "missing.png", "--json")
    good, bad = json.loads(out)
    assert code == 1
    assert good["parts"] == 2
    assert bad["picture"] == "missing.png"
    assert bad["error"] == "Couldn't open “missing.png”. There is no such file."


def test_all_bad(run):
    code, out, err = run("mesh", "one.png", "two.png")
    assert code == 1
    assert out.splitlines()[-1] == "0 meshes, 2 failed"
    assert err.count("akap-editor: ") == 2


def test_mask_and_a_picture_without_transparency(run, tmp_path, image):
    shown = image[..., 3].copy()
    image[..., 3] = 255
    write_png(tmp_path / "photo.png", image)
    code, out, _ = run("mesh", "photo.png")
    assert code == 0
    assert "no transparency" in out
    write_png(tmp_path / "mask.png", np.stack([shown] * 3 + [np.full_like(shown, 255)], axis=2))
    code, out, _ = run("mesh", "photo.png", "--mask", "mask.png")
    assert out.startswith("photo.png: 2 parts, 1 hole, ")
    assert "no transparency" not in out


REFUSED = {
    "missing": (("nothing.png",), "Couldn't open “nothing.png”. There is no such file."),
    "few vertices": (("ring.png", "--vertices", 3), "--vertices: expected a number from 20 to 200000, got 3"),
    "expansion": (("ring.png", "--expand", -1), "--expand: expected a number from 0 to 1000, got -1.0"),
    "threshold": (("ring.png", "--threshold", 1), "--threshold: expected a share between 0 and 1, got 1"),
    "name": (
        ("ring.png", "-o", "mesh.stl"),
        "Couldn't save “mesh.stl”. Expected a name that ends in .obj, got .stl.",
    ),
    "one file for many": (
        ("ring.png", "ring.png", "-o", "mesh.obj"),
        "Couldn't save “mesh.obj”. Expected a folder for the meshes of 2 pictures, got a file.",
    ),
    "same names": (
        ("ring.png", "./ring.png", "-o", "meshes"),
        "expected pictures of different names, got 2 whose mesh would be ring.obj",
    ),
    "mask for many": (
        ("ring.png", "ring.png", "--mask", "ring.png"),
        "--mask: expected one picture, got several",
    ),
    "empty folder": ((".", "--vertices", 100), "Couldn't open “.”. The folder contains no pictures."),
    "mask of another size": (("ring.png", "--mask", "small.png"), "mask: expected the size of the picture"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_in_one_line(run, picture, tmp_path, image, case):
    arguments, sentence = REFUSED[case]
    if case == "empty folder":
        picture.unlink()
    write_png(tmp_path / "small.png", image[:40]) if case == "mask of another size" else None
    code, out, err = run("mesh", *arguments)
    assert (code, out) == (2, "")
    (line,) = err.splitlines()
    assert sentence in line


def test_as_a_program(picture):
    command = [sys.executable, "-m", "akap_editor.cli", "mesh", str(picture)]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", timeout=120)
    assert done.returncode == 0
    assert "2 parts, 1 hole" in done.stdout


@needs_triangle
def test_the_mesher_is_chosen(run, picture):
    outputs = [run("mesh", picture, "-o", f"{name}.obj", "--mesher", name) for name in MESHERS]
    assert [code for code, _, _ in outputs] == [0, 0]
    assert (
        read_mesh("triangle.obj").mesh.vertices.tolist() != read_mesh("pythoncdt.obj").mesh.vertices.tolist()
    )
    code, _, err = run("mesh", picture, "--mesher", "gmsh")
    assert code == 2
    assert "'gmsh' is not one of 'triangle', 'pythoncdt'" in err


def test_a_picture_in_layers_is_measured_layer_by_layer(run, tmp_path, image):
    disk = image.copy()
    disk[:, 98:, 3] = 0
    data = ora_bytes(
        "<layer name='all' src='all.png'/><layer name='ring' src='ring.png'/>",
        {"ring.png": disk, "all.png": image},
        "w='130' h='90'",
    )
    (tmp_path / "puppet.ora").write_bytes(data)
    code, out, err = run("mesh", tmp_path / "puppet.ora", "--json", "--vertices", 400, "-o", "puppet.obj")
    (row,) = json.loads(out)
    assert (code, err) == (0, "")
    ring, both = row["layers"]
    assert (ring["name"], ring["parts"], ring["holes"]) == ("ring", 1, 1)
    assert (both["name"], both["parts"], both["holes"]) == ("all", 2, 1)
    for key in ("vertices", "faces", "parts", "holes"):
        assert row[key] == ring[key] + both[key]
    assert row["worst_angle"] == min(ring["worst_angle"], both["worst_angle"])
    assert min(ring["covered"], both["covered"]) <= row["covered"] <= 1
    lines = (tmp_path / "puppet.obj").read_text("utf-8").splitlines()
    assert sum(line.startswith("v ") for line in lines) == row["vertices"]
    _, text, _ = run("mesh", tmp_path / "puppet.ora", "--vertices", 400)
    assert [line.split()[0] for line in text.splitlines() if "vertices, smallest" in line] == ["ring", "all"]
