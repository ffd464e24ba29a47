"""A file on standard input or output in place of one with a name, for every command that has one."""

import json
import sys
from dataclasses import replace
from io import BytesIO
from types import SimpleNamespace

import pytest
from PIL import Image

from akap_editor import cli
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.document.pin import Pin
from akap_editor.io.akap.clip import decode_clip
from akap_editor.io.akap.project import decode_document, load, save
from akap_editor.io.streams import suffix_of
from akap_editor.resources import resource
from tests.support.pictures import bar_picture

RECORDING = resource("assets", "recordings", "bar.akaprec")
GINGERBREAD = resource("assets", "drawings", "gingerbread.png")


@pytest.fixture
def piped(monkeypatch, capfdbinary, tmp_path):
    """Runs the program with bytes on standard input: (exit code, bytes of stdout, text of stderr)."""
    monkeypatch.chdir(tmp_path)

    def call(data, *arguments):
        stdin = SimpleNamespace(buffer=BytesIO(data), isatty=lambda: False)
        monkeypatch.setattr(sys, "stdin", stdin)
        monkeypatch.setattr(sys, "argv", ["akap-editor", *map(str, arguments)])
        code = 0
        try:
            cli.main()
        except SystemExit as leaving:
            code = leaving.code or 0
        output, errors = capfdbinary.readouterr()
        return code, output, errors.decode()

    return call


@pytest.fixture(scope="module")
def waving(tmp_path_factory):
    """A small drawing with keyframes."""
    path = tmp_path_factory.mktemp("streams") / "waving.akap"
    document = load_small()
    save(document, path)
    return path


def load_small():
    """The bar with two keyframes, moved to the right in the second."""
    drawing = make_drawing(bar_picture(), name="bar", vertices=60)
    state = new_document(drawing).state
    keys = (Keyframe(0.0, state.positions), Keyframe(0.1, state.positions + 2.0))
    pins = tuple(
        Pin(number, face, [0.4, 0.3, 0.3], state.positions[0], name=name)
        for number, (face, name) in enumerate(((0, "Chest"), (20, "Head")))
    )
    return new_document(drawing).with_state(replace(state, pins=pins, animation=Animation(keys)))


def picture_size(data):
    return Image.open(BytesIO(data)).size


FROM_STDIN = {
    "render": (["render", "-", "-o", "-"], lambda data: picture_size(data) == (90, 60)),
    "export": (["export", "-", "-o", "-", "--format", ".glb"], lambda data: data[:4] == b"glTF"),
    "export an animation": (
        ["export", "-", "-o", "-", "--format", ".html"],
        lambda data: b"<canvas" in data,
    ),
    "replay": (
        ["replay", "-", "-o", "-", "--format", ".gif", "--fps", "10"],
        lambda data: data[:6] == b"GIF89a",
    ),
    "replay a still": (["replay", "-", "-o", "-", "--format", ".png"], lambda data: data[1:4] == b"PNG"),
    "info": (["info", "-", "--json"], lambda data: json.loads(data)["file"] == "-"),
    "thumbnail": (["thumbnail", "-", "-", "--size", "64"], lambda data: max(picture_size(data)) <= 64),
    "clip apply": (
        ["clip", "apply", "nod", "-", "-o", "-"],
        lambda data: len(decode_document(data).state.animation.keyframes) == 5,
    ),
    "clip save": (["clip", "save", "-", "-o", "-"], lambda data: len(decode_clip(data).keys) == 2),
}


@pytest.mark.parametrize("name", FROM_STDIN)
def test_a_drawing_on_stdin_becomes_a_file_on_stdout(piped, waving, tmp_path, name):
    arguments, is_right = FROM_STDIN[name]
    code, output, errors = piped(waving.read_bytes(), *arguments)
    assert code == 0, errors
    assert is_right(output)
    assert "akap-stream" not in errors
    assert list(tmp_path.iterdir()) == []


def test_a_picture_on_stdin_becomes_a_mesh_on_stdout(piped):
    code, output, errors = piped(GINGERBREAD.read_bytes(), "mesh", "-", "-o", "-", "--vertices", "200")
    assert code == 0, errors
    assert output.startswith(b"mtllib") or b"\nv " in output
    assert errors.startswith("-: 1 part")


def test_a_recording_on_stdin_is_replayed_to_a_file(piped, tmp_path):
    code, output, errors = piped(RECORDING.read_bytes(), "replay", "-", "-o", "last.png")
    assert code == 0, errors
    assert output.startswith(b"Wrote last.png")
    assert picture_size((tmp_path / "last.png").read_bytes())


REFUSED = {
    "nothing": (b"", ["render", "-", "-o", "a.png"], "standard input, got nothing"),
    "no file of a kind": (b"hello", ["render", "-", "-o", "a.png"], "stdin.obj"),
    "several files": (b"", ["render", GINGERBREAD, GINGERBREAD, "-o", "-"], "2 files"),
    "no format": (b"", ["export", GINGERBREAD, "-o", "-"], "--format"),
    "no format of a replay": (b"", ["replay", RECORDING, "-o", "-"], "--format"),
    "a format of a file": (b"", ["replay", RECORDING, "-o", "a.gif", "--format", ".gif"], "--format"),
    "two files": (b"", ["export", GINGERBREAD, "-o", "-", "--format", ".obj"], "several files"),
    "no keyframes": (GINGERBREAD.read_bytes(), ["replay", "-", "-o", "-", "--format", ".gif"], "stdin.png"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_piped_is_told_in_one_line(piped, name):
    data, arguments, part = REFUSED[name]
    code, output, errors = piped(data, *arguments)
    assert (code, output) == (2, b"")
    assert part in errors
    assert "akap-stream" not in errors
    assert errors.count("\n") == 1


@pytest.mark.parametrize("name", ["a.png", "a.jpg", "a.webp", "a.bmp", "a.gif", "a.tif"])
def test_pictures_are_told_by_their_first_bytes(tmp_path, name):
    Image.new("RGB", (4, 4)).save(tmp_path / name)
    assert suffix_of((tmp_path / name).read_bytes()) == name[1:]


def test_other_kinds_are_told_by_their_first_bytes(waving):
    assert suffix_of(waving.read_bytes()) == ".akap"
    assert suffix_of(RECORDING.read_bytes()) == ".akaprec"
    assert suffix_of(resource("assets", "clips", "nod.clip.json").read_bytes()) == ".clip.json"
    assert suffix_of(b"OFF\n3 1 0\n") == ".off"
    assert suffix_of(b"v 0 0 0\n") == ".obj"
    assert load(waving).drawing.name == "bar"
