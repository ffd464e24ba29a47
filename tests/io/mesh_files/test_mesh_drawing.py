"""OBJ and OFF files as drawings."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from akap_editor.editor.document.drawing import make_drawing
from akap_editor.errors import InputError
from akap_editor.io.export.obj import encode_obj
from akap_editor.io.mesh_files.mesh_drawing import read_mesh
from akap_editor.io.mesh_files.obj_off import PARSERS
from akap_editor.io.open_document import open_document

SQUARE = "v 0 0 0\nv 200 0 0\nv 200 100 0\nv 0 100 0\n"
TEXTURED = (
    "mtllib a.mtl\n"
    + SQUARE
    + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\nf 1/1/1 3/3/1 4/4/1\n"
)


def written(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def picture_at(path, size=(200, 100)):
    pixels = np.zeros((size[1], size[0], 4), np.uint8)
    pixels[..., :2] = np.stack(np.meshgrid(np.arange(size[0]) % 256, np.arange(size[1]) % 256), axis=2)
    pixels[..., 3] = 255
    Image.fromarray(pixels).save(path)
    return pixels


def test_obj_with_its_texture(tmp_path):
    written(tmp_path, "a.mtl", "newmtl m\nKd 1 1 1\nmap_Kd  some picture.png\n")
    pixels = picture_at(tmp_path / "some picture.png")
    drawing = read_mesh(written(tmp_path, "fish.obj", TEXTURED))
    assert drawing.name == "fish"
    assert drawing.image.tolist() == pixels.tolist()
    assert drawing.mesh.vertices == pytest.approx(np.array([[0, 100], [200, 100], [200, 0], [0, 0]]))
    assert drawing.uv.tolist() == [[0, 1], [1, 1], [1, 0], [0, 0]]
    assert drawing.mesh.tied


def test_texture_of_the_same_name_beside_it_and_other_units(tmp_path):
    picture_at(tmp_path / "a.png")
    small = TEXTURED.replace("200", "2").replace("100", "1").replace("mtllib a.mtl\n", "")
    drawing = read_mesh(written(tmp_path, "a.obj", small))
    assert drawing.mesh.vertices == pytest.approx(np.array([[0, 100], [200, 100], [200, 0], [0, 0]]))


def test_pixels_without_texture_coordinates(tmp_path):
    picture_at(tmp_path / "a.png")
    plain = SQUARE + "f 1 2 3 4\n"
    drawing = read_mesh(written(tmp_path, "a.obj", plain))
    assert drawing.size == (200, 100)
    assert drawing.uv.tolist() == [[0, 1], [1, 1], [1, 0], [0, 0]]
    assert len(drawing.mesh.faces) == 2


def test_without_a_texture_a_grid_is_drawn(tmp_path):
    drawing = read_mesh(written(tmp_path, "a.obj", SQUARE + "f -4 -3 -2 -1\n"))
    assert drawing.size == (240, 140)
    assert len(np.unique(drawing.image.reshape(-1, 4), axis=0)) == 2
    assert drawing.uv == pytest.approx(drawing.mesh.vertices / [240, 140])
    tiny = read_mesh(
        written(tmp_path, "b.obj", SQUARE.replace("200", "0.2").replace("100", "0.1") + "f 1 2 3 4")
    )
    assert np.ptp(tiny.mesh.vertices, axis=0) == pytest.approx([1000, 500])


@pytest.mark.parametrize("winding", ["3 0 1 2\n3 0 2 3", "3 2 1 0\n3 3 2 0", "4 0 1 2 3 255 0 0"])
def test_off_of_either_winding(tmp_path, winding):
    count = winding.count("\n") + 1
    body = f"# a square\n4 {count} 0\n0 0 0\n200 0 0 # right\n200 100 0\n0 100 0\n{winding}\n"
    for head in ("OFF\n", "OFF ", "COFF\n"):
        drawing = read_mesh(written(tmp_path, "a.off", head + body.removeprefix("# a square\n")))
        assert (drawing.mesh.rest_areas == 10000).all()
    assert open_document(tmp_path / "a.off").drawing.name == "a"


def test_what_is_exported_comes_back(tmp_path):
    alpha = np.zeros((120, 160), np.uint8)
    alpha[20:100, 30:130] = 255
    image = np.dstack([alpha, alpha, alpha, alpha])
    drawing = make_drawing(image, vertices=100, name="box")
    for name, data in encode_obj(drawing, drawing.mesh.vertices, "box").items():
        (tmp_path / name).write_bytes(data)
    back = read_mesh(tmp_path / "box.obj")
    assert back.mesh.faces.shape == drawing.mesh.faces.shape
    assert np.abs(back.mesh.vertices - drawing.mesh.vertices).max() < 1e-5
    assert np.abs(back.uv - drawing.uv).max() < 1e-6
    assert back.image[..., 3].tolist() == alpha.tolist()


GOOD_OBJ = {
    "byte order mark": "\ufeff" + SQUARE + "f 1 2 3 4\n",
    "capitals": SQUARE.upper() + "F 1 2 3 4\n",
    "carriage returns": (SQUARE + "f 1 2 3 4\n").replace("\n", "\r\n"),
    "old line ends": (SQUARE + "f 1 2 3 4\n").replace("\n", "\r"),
    "continued": SQUARE + "f 1 2 \\\n 3 \\ \r\n 4\n",
    "continued to the end": SQUARE + "f 1 2 3 4\\",
    "a comment that ends in a backslash": "# from C:\\\n" + SQUARE + "f 1 2 3 4\n",
    "relative at its line": "v 0 0\nv 200 0\nv 200 100\nf -3 -2 -1\nv 0 100\nf 1 3 -1\n",
    "faces first": "f 1 2 3 4\n" + SQUARE,
    "colors of vertices": SQUARE.replace(" 0\n", " 0 0.5 0.5 1\n") + "f 1 2 3 4\n",
    "groups, smoothing, lines and points": "o a\ng b\ns off\n" + SQUARE + "f 1 2 3 4\nl 1 2\np 1\n",
    "plus signs and exponents": SQUARE.replace("200", "+2.E2") + "f +1 2 3 4\n",
}


@pytest.mark.parametrize("kind", GOOD_OBJ)
def test_obj_as_other_programs_write_it(tmp_path, kind):
    path = tmp_path / "a.obj"
    path.write_bytes(GOOD_OBJ[kind].encode())
    mesh = read_mesh(path).mesh
    assert (len(mesh.vertices), len(mesh.faces), mesh.rest_areas.sum()) == (4, 2, 20_000)


def test_obj_in_utf_16(tmp_path):
    (tmp_path / "a.obj").write_bytes((SQUARE + "f 1 2 3 4\n").encode("utf-16"))
    assert len(read_mesh(tmp_path / "a.obj").mesh.faces) == 2


BODY = "0 0 0\n200 0 0\n200 100 0\n0 100 0\n4 0 1 2 3\n"
GOOD_OFF = {
    "byte order mark": "\ufeffOFF\n4 1 0\n" + BODY,
    "small letters": "off\n4 1 0\n" + BODY,
    "no header": "4 1 0\n" + BODY,
    "no number of edges": "OFF 4 1\n" + BODY,
    "normals": "NOFF\n4 1 0\n" + BODY.replace("00 0\n", "00 0 0 0 1\n"),
    "comments and empty lines": "# a\nOFF\n\n4 1 0 # b\n" + BODY.replace("\n", "\n\n# c\n"),
}


@pytest.mark.parametrize("kind", GOOD_OFF)
def test_off_as_other_programs_write_it(tmp_path, kind):
    mesh = read_mesh(written(tmp_path, "a.OFF", GOOD_OFF[kind])).mesh
    assert (len(mesh.vertices), len(mesh.faces), mesh.rest_areas.sum()) == (4, 2, 20_000)


LIBRARIES = {
    "one": ("mtllib a.mtl", {"a.mtl": "newmtl m\nmap_Kd tex.png"}),
    "several in a line": ("mtllib b.mtl a.mtl", {"b.mtl": "newmtl n", "a.mtl": "newmtl m\nmap_Kd tex.png"}),
    "several lines": (
        "mtllib b.mtl\nmtllib a.mtl",
        {"b.mtl": "newmtl n\nmap_Kd no.png", "a.mtl": "newmtl m\nmap_Kd tex.png"},
    ),
    "a missing one": ("mtllib gone.mtl a.mtl", {"a.mtl": "newmtl m\nmap_Kd tex.png"}),
    "a name with spaces": ("mtllib my #1 file.mtl", {"my #1 file.mtl": "newmtl m\nmap_Kd tex.png"}),
    "the material that is used": (
        "mtllib a.mtl",
        {"a.mtl": "newmtl other\nmap_Kd no.png\nnewmtl m\nmap_Kd tex.png"},
    ),
    "any letter case": ("MTLLIB A.MTL", {"a.mtl": "NEWMTL m\nMAP_KD TEX.PNG"}),
    "options": (
        "mtllib a.mtl",
        {"a.mtl": "newmtl m\nmap_Kd -s 1 1 1 -o 0 0 -clamp on -mm 0 1 -bm 0.5 tex.png"},
    ),
    "quotes": ("mtllib a.mtl", {"a.mtl": 'newmtl m\nmap_Kd "tex.png"'}),
    "a folder of another computer": ("mtllib a.mtl", {"a.mtl": "newmtl m\nmap_Kd C:\\art\\tex.png"}),
    "byte order mark": ("mtllib a.mtl", {"a.mtl": "\ufeffnewmtl m\nmap_Kd tex.png"}),
}


@pytest.mark.parametrize("kind", LIBRARIES)
def test_the_texture_is_found_by_its_material(tmp_path, kind):
    head, files = LIBRARIES[kind]
    pixels = picture_at(tmp_path / "tex.png")
    for name, text in files.items():
        written(tmp_path, name, text)
    drawing = read_mesh(written(tmp_path, "fish.obj", TEXTURED.replace("mtllib a.mtl", head)))
    assert drawing.image.tolist() == pixels.tolist()


@pytest.mark.parametrize("name", ["Textures/tex.png", "textures\\TEX.png", "./textures//tex.png"])
def test_textures_in_folders_below_the_mesh(tmp_path, name):
    (tmp_path / "textures").mkdir()
    pixels = picture_at(tmp_path / "textures" / "tex.png")
    written(tmp_path, "a.mtl", f"newmtl m\nmap_Kd {name}")
    assert read_mesh(written(tmp_path, "fish.obj", TEXTURED)).image.tolist() == pixels.tolist()


def test_a_texture_whose_name_is_not_utf_8(tmp_path):
    pixels = picture_at(tmp_path / "caf\udce9.png")
    (tmp_path / "a.mtl").write_bytes(b"newmtl m\nmap_Kd caf\xe9.png\n")
    assert read_mesh(written(tmp_path, "fish.obj", TEXTURED)).image.tolist() == pixels.tolist()


@pytest.mark.parametrize("name", ["../tex.png", "link/tex.png", "..\\tex.png"])
def test_no_texture_outside_the_folder_of_the_mesh_is_read(tmp_path, name):
    (tmp_path / "inside").mkdir()
    picture_at(tmp_path / "tex.png")
    (tmp_path / "inside" / "link").symlink_to(tmp_path)
    written(tmp_path, "inside/a.mtl", f"newmtl m\nmap_Kd {name}")
    with pytest.raises(InputError, match="no such file"):
        read_mesh(written(tmp_path, "inside/fish.obj", TEXTURED))


@pytest.mark.parametrize("head", ["mtllib .", "mtllib ..", "mtllib /", "mtllib", "mtllib " + "x" * 5000])
def test_a_library_that_is_none_is_no_reason_to_refuse_a_mesh(tmp_path, head):
    drawing = read_mesh(written(tmp_path, "a.obj", head + "\n" + SQUARE + "f 1 2 3 4\n"))
    assert drawing.size == (240, 140)


BAD_OBJ = {
    "superscript": (SQUARE + "f ¹ ² ³\n", "line 5: expected an index, got '¹'"),
    "5,000 digits": (SQUARE + "f 1 2 " + "9" * 5000 + "\n", "line 5: expected a vertex from 1 to 4, got 999"),
    "underscores": ("v 1_0 2 3\n", "line 1: expected numbers, got '1_0 2 3'"),
    "nothing": ("", "expected a mesh with faces, got none|expected a mesh with vertices, got none"),
    "no faces": (SQUARE, "expected a mesh with faces, got none"),
    "index too large": (SQUARE + "f 1 2 9\n", "line 5: expected a vertex from 1 to 4, got 9"),
    "index zero": (SQUARE + "f 0 1 2\n", "line 5: expected a vertex from 1 to 4, got 0"),
    "index from the end": (SQUARE + "f -5 1 2\n", "line 5: expected a vertex from 1 to 4, got -5"),
    "no index": (SQUARE + "f a b c\n", "line 5: expected an index, got 'a'"),
    "two corners": (SQUARE + "f 1 2\n", "line 5: expected a face with 3 corners or more, got 2"),
    "no number": ("v 1 x 3\n", "line 1: expected numbers, got '1 x 3'"),
    "one number": ("v 1\n", "line 1: expected x and y of a vertex, got 1 numbers"),
    "infinite": (
        SQUARE.replace("200", "inf") + "f 1 2 3\n",
        "expected finite coordinates up to 1e9, got othe",
    ),
    "3D": (
        SQUARE.replace("100 0\n", "100 30\n") + "f 1 2 3 4\n",
        "expected a flat mesh, got one in 3D, with z f",
    ),
    "unused": (SQUARE + "f 1 2 3\n", "expected each to belong to a face, but vertex 3 does not"),
    "no area": (SQUARE + "v 100 0 0\nf 1 2 3 4\nf 1 5 2\n", "face 2 has no area"),
    "three faces on an edge": (
        SQUARE + "v 90 200 0\nv 90 50 0\nf 1 2 3\nf 1 3 4\nf 1 3 5\nf 1 2 6\n",
        "faces: edge .* has two faces on one side",
    ),
    "in one point": (
        SQUARE + "v 300 100 0\nv 300 200 0\nf 1 2 3 4\nf 3 5 6\n",
        "at vertex 2 they meet in one point only",
    ),
    "at one place": (SQUARE + "v 200 100 0\nv 300 50 0\nf 1 2 3 4\nf 2 6 5\n", "are at the same place"),
    "texture index": (
        SQUARE + "vt 0 0\nf 1/1 2/2 3/1\n",
        "line 6: expected a texture coordinate from 1 to 1, go",
    ),
    "half textured": (
        SQUARE + "vt 0 0\nf 1/1 2 3\nf 1 3 4\n",
        "expected texture coordinates at every corner",
    ),
    "a seam": (
        SQUARE + "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1/2 3/3 4/1\n",
        "expected one place in the texture for each vertex, but vertex 1 has several",
    ),
}


@pytest.mark.parametrize("kind", BAD_OBJ)
def test_each_bad_obj_has_its_sentence(tmp_path, kind):
    text, sentence = BAD_OBJ[kind]
    with pytest.raises(InputError, match=f"(?i){sentence}") as caught:
        read_mesh(written(tmp_path, "bad.obj", text))
    assert str(caught.value).startswith(f"Couldn't open “{tmp_path / 'bad.obj'}”. ")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "line 1: expected OFF, got ''"),
        ("PLY\n", "line 1: expected OFF, got 'PLY'"),
        ("OFF\n-3 1 0\n", "line 2: expected the numbers of vertices and faces, got '-3 1 0'"),
        ("OFF\n9999999999 1 0\n", "line 2: expected the numbers of vertices and faces"),
        ("OFF\n3 1 0\n0 0 0\n", "expected 3 vertices and 1 faces, but the file ends before"),
        ("OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1 3\n", "line 6: expected vertices from 0 to 2, got 0 1 3"),
        (
            "OFF\n3 1 0\n0 0 0\n9 0 0\n0 9 0\n3 0 1\n",
            "line 6: expected a face with 3 corners or more, got '3'",
        ),
    ],
)
def test_each_bad_off_has_its_sentence(tmp_path, text, sentence):
    with pytest.raises(InputError, match=f"(?i){sentence}"):
        read_mesh(written(tmp_path, "bad.off", text))


def test_textures_that_do_not_fit(tmp_path):
    written(tmp_path, "a.mtl", "map_Kd none.png\n")
    with pytest.raises(InputError, match=r"a\.obj”\. Couldn't open “.*none\.png”\. There is no such file"):
        read_mesh(written(tmp_path, "a.obj", TEXTURED))
    written(tmp_path, "a.mtl", "map_Kd small.png\n")
    picture_at(tmp_path / "small.png", (20, 10))
    with pytest.raises(InputError, match="Expected texture coordinates, as the material has a texture"):
        read_mesh(written(tmp_path, "a.obj", "mtllib a.mtl\n" + SQUARE + "f 1 2 3 4\n"))
    mirrored = TEXTURED.replace("vt 0", "vt _").replace("vt 1", "vt 0").replace("vt _", "vt 1")
    with pytest.raises(InputError, match="the right way round, got a mirrored or rotated one"):
        read_mesh(written(tmp_path, "a.obj", mirrored.replace("v 200", "v 90").replace("vt 0 1", "vt -4 1")))


def test_a_mask_needs_a_picture(tmp_path):
    path = written(tmp_path, "a.obj", SQUARE + "f 1 2 3 4\n")
    with pytest.raises(InputError, match=r"mask\.png”\. A mask needs a picture, but a\.obj is none\."):
        open_document(path, tmp_path / "mask.png")


WORDS = st.sampled_from(
    ["v", "vt", "f", "OFF", "1", "2", "-1", "3/3", "1//2", "0.5", "nan", "1e999", "x", "/", "\\"]
)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.lists(st.lists(WORDS, max_size=6).map(" ".join), max_size=12).map("\n".join), st.booleans())
def test_any_text_gives_a_mesh_or_a_sentence(tmp_path_factory, text, is_off):
    folder = tmp_path_factory.getbasetemp()
    head, name = ("OFF\n3 1 0\n0 0 0\n9 0 0\n", "any.off") if is_off else ("v 0 0\nv 9 0\nv 0 9\n", "any.obj")
    path = written(folder, name, head + text)
    with suppress(InputError):
        assert np.isfinite(read_mesh(path).mesh.vertices).all()


def test_parsers_by_suffix():
    assert set(PARSERS) == {".obj", ".off"}
