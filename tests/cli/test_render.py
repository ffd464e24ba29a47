"""`akap-editor render`: the PNG it writes, and bad input."""

import json
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from akap_editor import cli
from akap_editor.io.images import read_image
from akap_editor.io.open_document import open_document
from akap_editor.render.offscreen import OffscreenRenderer
from tests.support.command_line import assert_one_line


def picture_of(path, **options):
    document = open_document(path)
    with OffscreenRenderer() as renderer:
        return renderer.render(document.drawing, document.state.positions, **options)


@pytest.mark.parametrize("source", ["picture", "posed"])
def test_render_writes_the_picture_of_the_offscreen_renderer(run, request, tmp_path, source):
    path = request.getfixturevalue(source)
    expected = picture_of(path)
    code, output, errors = run("render", path, "-o", tmp_path / "new" / "pose.png")
    assert (code, errors) == (0, "")
    assert output == f"{tmp_path / 'new' / 'pose.png'}: {expected.shape[1]} × {expected.shape[0]} pixels\n"
    np.testing.assert_array_equal(read_image(tmp_path / "new" / "pose.png"), expected)


def test_render_scale_and_background(run, posed, tmp_path):
    code, _, errors = run("render", posed, "-o", "pose.png", "--scale", "2", "--background", "#336699")
    assert (code, errors) == (0, "")
    written = read_image(tmp_path / "pose.png")
    expected = picture_of(posed, scale=2.0, background=(0x33 / 255, 0x66 / 255, 0x99 / 255))
    np.testing.assert_array_equal(written, expected)
    assert written[0, 0].tolist() == [0x33, 0x66, 0x99, 255]
    plain = picture_of(posed)
    assert abs(np.array(written.shape[:2]) - 2 * np.array(plain.shape[:2])).max() == 0


def test_the_result_as_json(run, picture, tmp_path):
    code, said, errors = run("render", picture, "-o", "pose.png", "--json")
    assert (code, errors) == (0, "")
    height, width = read_image(tmp_path / "pose.png").shape[:2]
    assert json.loads(said) == {
        "format": "PNG picture",
        "files": ["pose.png"],
        "width": width,
        "height": height,
    }


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (["--background", "red"], ["--background", "#RRGGBB", "'red'"]),
        (["--background", "#12345"], ["--background", "#RRGGBB"]),
        (["--background", "#11223344"], ["--background", "#RRGGBB"]),
        (["--scale", "0"], ["scale", "positive"]),
        (["--scale", "-1"], ["scale", "positive"]),
        (["--scale", "nan"], ["scale", "positive"]),
        (["--scale", "inf"], ["scale", "positive"]),
        (["--scale", "1e6"], ["smaller scale"]),
        (["--scale", "big"], ["--scale", "'big'"]),
        (["--colour", "red"], ["--colour"]),
    ],
)
def test_render_refuses_bad_options(run, picture, tmp_path, options, parts):
    assert_one_line(run("render", picture, "-o", "pose.png", *options), *parts)
    assert not (tmp_path / "pose.png").exists()


def test_render_needs_an_output(run, picture):
    assert_one_line(run("render", picture), "--output")


def test_render_into_a_file_as_if_it_were_a_folder(run, picture):
    assert_one_line(run("render", picture, "-o", picture / "pose.png"), str(picture / "pose.png"))


def test_a_picture_is_written_as_png_only(run, picture, tmp_path):
    before = sorted(tmp_path.iterdir())
    code, output, errors = run("render", picture, "-o", tmp_path / "pose.jpg")
    assert (code, output) == (2, "")
    assert errors.count("\n") == 1
    assert "pose.jpg”. Expected a name that ends in .png, got .jpg" in errors
    assert sorted(tmp_path.iterdir()) == before


def test_pictures_of_many_files_go_to_a_folder(run, picture, posed, tmp_path):
    code, said, errors = run("render", picture, posed, "-o", "new/pictures")
    assert (code, errors) == (0, "")
    assert said.count("\n") == 2
    for path in (picture, posed):
        written = read_image(tmp_path / "new" / "pictures" / f"{path.stem}.png")
        np.testing.assert_array_equal(written, picture_of(path))
    code, said, _ = run("render", picture, posed, "-o", "new/pictures", "--json", "--overwrite")
    assert [len(record["files"]) for record in json.loads(said)] == [1, 1]


def test_a_folder_that_exists_takes_the_picture_of_one_file(run, picture, tmp_path):
    (tmp_path / "pictures").mkdir()
    assert run("render", picture, "-o", "pictures")[0] == 0
    assert [path.name for path in (tmp_path / "pictures").iterdir()] == [f"{picture.stem}.png"]


def test_a_picture_on_stdout(monkeypatch, picture, capfdbinary):
    monkeypatch.setattr("sys.argv", ["akap-editor", "render", str(picture), "-o", "-"])
    cli.main()
    written = Image.open(BytesIO(capfdbinary.readouterr().out)).convert("RGBA")
    np.testing.assert_array_equal(np.asarray(written), picture_of(picture))


@pytest.mark.parametrize(
    ("output", "parts"),
    [
        ("pose.png", ["a folder for the results of 2 files", "pose.png"]),
        ("-", ["--output", "a folder", "2 files"]),
    ],
)
def test_many_files_need_a_folder(run, picture, posed, output, parts):
    assert_one_line(run("render", picture, posed, "-o", output), *parts)


def test_two_files_of_one_name_are_refused(run, picture, tmp_path):
    (tmp_path / "other").mkdir()
    twin = tmp_path / "other" / picture.name
    twin.write_bytes(picture.read_bytes())
    assert_one_line(run("render", picture, twin, "-o", "pictures"), "different names", picture.stem)
    assert not (tmp_path / "pictures").exists()
