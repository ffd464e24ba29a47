"""No command replaces what it reads, nor a file that was not named, unless --overwrite says so."""

import pytest

from akap_editor.io.images import write_png
from akap_editor.resources import resource
from tests.support.command_line import assert_one_line

WAVE = resource("assets", "recordings", "elephant.akaprec")

# Command, files that exist before, and the one that its message names.
CASES = {
    "export over its picture": (["export", "bar.png", "-o", "bar.png"], ["bar.png"]),
    "render over its picture": (["render", "bar.png", "-o", "./bar.png"], ["bar.png"]),
    "export over a picture by another path": (["export", "bar.png", "-o", "../DIR/bar.png"], ["bar.png"]),
    "mesh over a link to its picture": (["mesh", "bar.png", "-o", "link.obj"], ["bar.png"]),
    "mesh over a link to its mask": (
        ["mesh", "bar.png", "--mask", "two.png", "-o", "to-mask.obj"],
        ["two.png"],
    ),
    "render over the texture of a mesh": (["render", "tile.obj", "-o", "tile.png"], ["tile.png"]),
    "export over the texture of a mesh": (["export", "tile.obj", "-o", "tile.png"], ["tile.png"]),
    "a layer of a folder": (["render", "layers", "-o", "layers/1.png"], ["layers/1.png"]),
    "the drawing of a recording": (["replay", WAVE, "--drawing", "bar.png", "-o", "bar.png"], ["bar.png"]),
    "the last pose over the drawing": (
        ["replay", WAVE, "--drawing", "bar.png", "-o", "a.gif", "--pose", "bar.png", "--to", "0.1"],
        ["bar.png"],
    ),
    "a material": (["export", "bar.png", "-o", "bar.obj"], ["bar.mtl"]),
    "a texture": (["export", "bar.png", "-o", "bar.obj"], ["bar-texture.png"]),
    "the texture of a skeleton": (["export", "bar.png", "-o", "bar.spine.json"], ["bar-texture.png"]),
    "pictures in a folder": (["render", "bar.png", "two.png", "-o", "out"], ["out/two.png"]),
    "a picture in a folder": (["render", "bar.png", "-o", "out"], ["out/bar.png"]),
    "exports in a folder": (
        ["export", "bar.png", "two.png", "-o", "out", "--format", ".svg"],
        ["out/bar.svg", "out/two.svg"],
    ),
    "an export beside its picture": (["export", "bar.png", "-o", ".", "--format", ".png"], ["bar.png"]),
    "meshes in a folder": (
        ["mesh", "bar.png", "two.png", "-o", "meshes"],
        ["meshes/bar.obj", "meshes/two.obj"],
    ),
    "the index of a sheet": (["replay", WAVE, "--sheet", "-o", "e.png", "--to", "0.1"], ["e.json"]),
    "frames of another animation": (
        ["replay", WAVE, "-o", "frames/", "--to", "0.1"],
        ["frames/frame-0099.png"],
    ),
    "a page in the folder of a report": (["compare", WAVE, "-m", "mls", "-o", "site"], ["site/index.html"]),
}
# Not repeated with --overwrite: they are slow, or what is read does not fit.
ONCE = {
    "a page in the folder of a report",
    "the drawing of a recording",
    "the last pose over the drawing",
}


@pytest.fixture
def pictures(tmp_path, image):
    (tmp_path / "layers").mkdir()
    for name in ("bar.png", "two.png", "tile.png", "layers/1.png"):
        write_png(tmp_path / name, image)
    (tmp_path / "tile.obj").write_text("v 0 0 0\nv 90 0 0\nv 90 60 0\nf 1 2 3\n")
    (tmp_path / "link.obj").symlink_to("bar.png")
    (tmp_path / "to-mask.obj").symlink_to("two.png")


@pytest.mark.parametrize("case", CASES)
def test_files_that_were_not_named_are_replaced_only_on_demand(run, pictures, tmp_path, case):
    arguments, names = CASES[case]
    arguments = [str(word).replace("DIR", tmp_path.name) for word in arguments]
    kept = {}
    for name in names:
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        if not path.exists():
            path.write_bytes(b"of somebody")
        kept[path] = path.read_bytes(), path.stat().st_ino
    before = sorted(tmp_path.rglob("*"))
    result = run(*arguments)
    assert_one_line(result, "--overwrite", "choose another name")
    assert {path: (path.read_bytes(), path.stat().st_ino) for path in kept} == kept
    assert sorted(tmp_path.rglob("*")) == before, "nothing was written"
    if case not in ONCE:
        code, _, errors = run(*arguments, "--overwrite")
        assert code == 0, errors
        assert not any(path.exists() and path.stat().st_ino == number for path, (_, number) in kept.items())


@pytest.mark.parametrize(
    "arguments",
    [
        ["export", "bar.png", "-o", "a.svg"],
        ["render", "bar.png", "-o", "a.png"],
        ["mesh", "bar.png", "-o", "a.obj"],
        ["replay", WAVE, "-o", "a.png", "--to", "0.1"],
        ["replay", WAVE, "-o", "a.webp", "--to", "0.1", "--pose", "pose.png"],
    ],
)
def test_the_file_that_is_named_is_replaced(run, pictures, tmp_path, arguments):
    named = [tmp_path / word for word in arguments if str(word).startswith(("a.", "pose"))]
    for path in named:
        path.write_bytes(b"of yesterday")
    assert run(*arguments)[0] == 0
    for path in named:
        assert path.read_bytes() != b"of yesterday"


@pytest.mark.parametrize("pose", ["a.png", "./a.png"])
def test_animation_and_last_pose_are_different_files(run, tmp_path, pose):
    assert_one_line(run("replay", WAVE, "-o", "a.png", "--sheet", "--pose", pose), "--pose: expected another")
    assert list(tmp_path.iterdir()) == []


def test_a_thumbnail_is_not_written_over_its_drawing(run, posed):
    before = posed.read_bytes()
    assert_one_line(run("thumbnail", posed, posed), "posed.akap", "It is the file that is read")
    assert posed.read_bytes() == before


@pytest.mark.parametrize("command", ["export", "render", "replay", "mesh"])
def test_the_help_says_what_is_replaced(run, command):
    text = " ".join(run(command, "--help")[1].split())
    assert "or to replace" in text
    assert (
        "--overwrite Replace also files that are read, and existing files that --output does not name" in text
    )


def test_an_export_can_be_repeated(run, pictures, tmp_path):
    """The material and texture that an earlier export has left are those that this one would write."""
    for _ in range(2):
        code, _, errors = run("export", "bar.png", "-o", "bar.obj")
        assert (code, errors) == (0, "")
    for _ in range(2):
        assert run("export", "bar.png", "-o", "bar.svg")[0] == 0
