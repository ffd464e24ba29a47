"""The command line: what it writes, what it says, and its one line for everything that goes wrong."""

import importlib
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import akap_editor
from akap_editor import cli
from akap_editor.cli import replay as replaying
from akap_editor.errors import InputError
from akap_editor.io.akap.project import save
from akap_editor.io.akap.recording import read_recording
from akap_editor.io.images import read_image, write_png
from akap_editor.io.open_document import open_document
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.resources import resource

ROOT = Path(__file__).parents[1]
RECORDING = resource("assets", "recordings", "elephant.akaprec")


@pytest.fixture
def run(monkeypatch, capfd, tmp_path):
    """Runs the program in an empty folder without display: (exit code, stdout, stderr)."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["akap-editor", *map(str, arguments)])
        code = 0
        try:
            cli.main()
        except SystemExit as leaving:
            code = leaving.code or 0
        return code, *capfd.readouterr()

    return call


@pytest.fixture
def image():
    """(60, 90, 4): an orange bar with a soft rim."""
    y, x = np.mgrid[0:60, 0:90] + 0.5
    alpha = np.clip(np.minimum(20 - abs(y - 30), 36 - abs(x - 45)), 0, 1)
    rgba = np.zeros((60, 90, 4), dtype=np.uint8)
    rgba[..., 3] = np.rint(255 * alpha)
    rgba[alpha > 0, :3] = (250, 130, 20)
    return rgba


@pytest.fixture
def picture(tmp_path, image):
    write_png(tmp_path / "bar.png", image)
    return tmp_path / "bar.png"


@pytest.fixture
def posed(tmp_path, picture):
    """A saved drawing, sheared out of its frame, so that its picture needs a larger one."""
    document = open_document(picture)
    pose = document.state.positions @ [[1.0, 0.4], [0.3, 1.0]] - [20.0, 5.0]
    state = akap_editor.EditState((), pose, document.state.settings)
    save(document.with_state(state), tmp_path / "posed.akap")
    return tmp_path / "posed.akap"


def picture_of(path, **options):
    document = open_document(path)
    with OffscreenRenderer() as renderer:
        return renderer.render(document.drawing, document.state.positions, **options)


def assert_one_line(result, *parts):
    """Exit code 2, and one line on stderr that holds all ``parts``."""
    code, _, errors = result
    assert code == 2
    assert errors.startswith("akap-editor: ")
    assert errors.count("\n") == 1
    assert errors.endswith("\n")
    for part in parts:
        assert part in errors


# -- help ---------------------------------------------------------------------------------------------------


def test_as_a_program():
    """The installed entry point, once, in a process of its own."""
    command = [sys.executable, "-m", "akap_editor.cli", "--version"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    result = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert result.returncode == 0
    assert result.stdout.strip() == f"akap-editor, version {akap_editor.__version__}"
    assert result.stderr == ""


def test_the_entry_point_is_there():
    scripts = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["scripts"]
    module, _, name = scripts["akap-editor"].partition(":")
    assert getattr(importlib.import_module(module), name) is cli.main


@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_names_every_command(run, option):
    code, output, errors = run(option)
    assert (code, errors) == (0, "")
    for name in ("edit", "render", "replay", "FILE"):
        assert name in output


@pytest.mark.parametrize("command", ["edit", "render", "replay"])
def test_each_command_has_help_with_an_example(run, command):
    code, output, errors = run(command, "--help")
    assert (code, errors) == (0, "")
    assert f"Example: akap-editor {command}" in output


# -- render -------------------------------------------------------------------------------------------------


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


# -- replay -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".webp", ".gif"])
def test_replay_writes_an_animation_and_the_last_pose(run, tmp_path, suffix):
    animation = tmp_path / "new" / f"wave{suffix}"
    code, output, errors = run(
        "replay", RECORDING, "-o", animation, "--pose", "last.png", "--size", "64", "--fps", "5"
    )
    assert (code, errors) == (0, "")
    duration = read_recording(RECORDING).duration
    with Image.open(animation) as opened:
        assert max(opened.size) == 64
        assert 0.5 * duration * 5 < opened.n_frames <= duration * 5 + 1
        opened.seek(0)
        first = np.asarray(opened.convert("RGBA")).astype(int)
        opened.seek(opened.n_frames // 2)
        middle = np.asarray(opened.convert("RGBA")).astype(int)
    assert (first[..., 3] > 127).any()
    assert (abs(first - middle).max(axis=2) > 60).mean() > 0.02, "the drawing moves"
    assert str(animation) in output
    last = read_image(tmp_path / "last.png")
    rest = read_image(resource("assets", "drawings", "elephant.png"))
    assert min(last.shape[:2]) >= min(rest.shape[:2])
    assert last.shape != rest.shape or (last != rest).any()


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (["--fps", "0"], ["--fps", "1 to 120"]),
        (["--fps", "nan"], ["--fps", "1 to 120"]),
        (["--fps", "fast"], ["--fps", "'fast'"]),
        (["--size", "5"], ["--size", "16 to 8192"]),
        (["--size", "-64"], ["--size", "16 to 8192"]),
        (["--size", "1.5"], ["--size", "'1.5'"]),
    ],
)
def test_replay_refuses_bad_options(run, tmp_path, options, parts):
    assert_one_line(run("replay", RECORDING, "-o", "wave.webp", *options), *parts)
    assert list(tmp_path.iterdir()) == []


def test_replay_of_an_unknown_drawing_says_how_to_name_it(run, tmp_path):
    text = RECORDING.read_text().replace('"name":"elephant"', '"name":"unicorn"', 1)
    (tmp_path / "other.akaprec").write_text(text)
    assert_one_line(run("replay", "other.akaprec", "-o", "wave.webp"), "'unicorn'", "--drawing", "elephant")
    assert not (tmp_path / "wave.webp").exists()


@pytest.mark.parametrize(
    ("content", "part"),
    [
        (None, "no such file"),
        (b"not a recording\n", "line 1"),
        (b"\xff\xfe\x00", "recording"),
        (b"", "line 1"),
    ],
)
def test_replay_of_a_bad_recording(run, tmp_path, content, part):
    if content is not None:
        (tmp_path / "bad.akaprec").write_bytes(content)
    assert_one_line(run("replay", "bad.akaprec", "-o", "wave.webp"), "bad.akaprec", part)
    assert not (tmp_path / "wave.webp").exists()


def test_replay_to_an_unknown_kind_of_animation(run, tmp_path):
    assert_one_line(run("replay", RECORDING, "-o", "wave.avi"), "wave.avi", ".webp")
    assert not (tmp_path / "wave.avi").exists()


# -- edit without a display ---------------------------------------------------------------------------------


@pytest.mark.parametrize("arguments", [(), ("edit", "--bundled", "elephant")], ids=["alone", "make run"])
def test_a_first_run_without_display_replays_the_bundled_recording(run, tmp_path, monkeypatch, arguments):
    wanted = {}

    def smaller(*arguments, **options):
        wanted.update(options)
        replay(*arguments, fps=6.0, size=96)

    replay = replaying.replay_recording
    monkeypatch.setattr(replaying, "replay_recording", smaller)
    code, output, errors = run(*arguments)
    assert (code, errors) == (0, "")
    assert "there is no display" in output.splitlines()[0]
    with Image.open(tmp_path / "out" / "elephant.webp") as animation:
        assert animation.n_frames > 10
    assert wanted == {"fps": 24.0, "size": 480}
    pose = read_image(tmp_path / "out" / "elephant.png")
    assert (pose[..., 3] > 127).sum() > 10_000
    assert "elephant.png" in output
    assert "elephant.webp" in output


def test_an_unknown_bundled_drawing_is_an_error_that_names_those_there_are(run, tmp_path):
    assert_one_line(run("edit", "--bundled", "mammoth"), "mammoth", "elephant")
    assert not (tmp_path / "out").exists()


def test_a_picture_without_display_is_an_error(run, picture, tmp_path):
    before = sorted(tmp_path.iterdir())
    assert_one_line(run(picture), "no display")
    assert sorted(tmp_path.iterdir()) == before


# -- files that are no good ---------------------------------------------------------------------------------


def bad_files(folder, image):
    write_png(folder / "whole.png", image)
    whole = (folder / "whole.png").read_bytes()
    (folder / "whole.png").unlink()
    (folder / "text.png").write_text("This is no picture.\n")
    (folder / "truncated.png").write_bytes(whole[: len(whole) // 2])
    write_png(folder / "transparent.png", np.zeros_like(image))
    write_png(folder / "pixel.png", np.zeros((1, 1, 4), dtype=np.uint8))
    (folder / "corrupt.akap").write_bytes(b"PK\x03\x04" + bytes(200))
    (folder / "folder.png").mkdir()


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("nothing.png", "no such file"),
        ("nothing.akap", "no such file"),
        ("text.png", "picture"),
        ("truncated.png", "truncated"),
        ("transparent.png", "transparent"),
        ("pixel.png", "expected"),
        ("corrupt.akap", "expected"),
        ("folder.png", "a folder"),
    ],
)
@pytest.mark.parametrize("command", ["edit", "render"])
def test_a_bad_file_is_told_in_one_line(run, tmp_path, image, name, part, command):
    bad_files(tmp_path, image)
    before = sorted(tmp_path.iterdir())
    arguments = (name,) if command == "edit" else ("render", name, "-o", "pose.png")
    result = run(*arguments)
    assert_one_line(result, name, part)
    assert "no display" not in result[2]
    assert sorted(tmp_path.iterdir()) == before


def test_a_picture_is_written_as_png_only(run, picture, tmp_path):
    before = sorted(tmp_path.iterdir())
    code, output, errors = run("render", picture, "-o", tmp_path / "pose.jpg")
    assert (code, output) == (2, "")
    assert errors.count("\n") == 1
    assert "expected a name that ends in .png, got .jpg" in errors
    assert sorted(tmp_path.iterdir()) == before


def test_a_mask_is_put_on_the_picture_that_is_opened(run, picture, tmp_path, monkeypatch):
    opened = []
    module = importlib.import_module("akap_editor.cli.edit")  # the name in the package is the command
    monkeypatch.setattr(module, "_edit", lambda document, *_: opened.append(document))
    mask = np.zeros((60, 90), np.uint8)
    mask[20:40, 20:60] = 255
    write_png(tmp_path / "mask.png", np.dstack([mask, mask, mask, np.full_like(mask, 255)]))
    assert run("edit", picture, "--mask", tmp_path / "mask.png") == (0, "", "")
    alpha = opened[0].drawing.image[..., 3]
    assert (alpha[20:40, 20:60] == 255).all()
    assert (alpha[mask == 0] == 0).all()
    write_png(tmp_path / "small.png", np.full((5, 5, 4), 255, np.uint8))
    with pytest.raises(InputError, match="mask: expected the size of the picture, 90 x 60 pixels, got 5 x 5"):
        open_document(picture, tmp_path / "small.png")
