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
    "a material": (["export", "bar.png", "-o", "bar.obj"], ["bar.mtl"]),
    "a texture": (["export", "bar.png", "-o", "bar.obj"], ["bar-texture.png"]),
    "the texture of a skeleton": (["export", "bar.png", "-o", "bar.spine.json"], ["bar-texture.png"]),
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
SLOW = {"a page in the folder of a report"}  # to repeat with --overwrite


@pytest.fixture
def pictures(tmp_path, image):
    for name in ("bar.png", "two.png"):
        write_png(tmp_path / name, image)


@pytest.mark.parametrize("case", CASES)
def test_files_that_were_not_named_are_replaced_only_on_demand(run, pictures, tmp_path, case):
    arguments, names = CASES[case]
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
    if case not in SLOW:
        code, _, errors = run(*arguments, "--overwrite")
        assert code == 0, errors
        assert not any(path.exists() and path.stat().st_ino == number for path, (_, number) in kept.items())


def test_an_export_can_be_repeated(run, pictures, tmp_path):
    """The material and texture that an earlier export has left are those that this one would write."""
    for _ in range(2):
        code, _, errors = run("export", "bar.png", "-o", "bar.obj")
        assert (code, errors) == (0, "")
    for _ in range(2):
        assert run("export", "bar.png", "-o", "bar.svg")[0] == 0
