"""Clips on the command line."""

import pytest

from akap_editor.io.akap.clip import load_clip
from akap_editor.io.akap.project import load
from akap_editor.resources import resource

GINGERBREAD = str(resource("assets", "drawings", "gingerbread.png"))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("clips")


def test_a_clip_is_applied_saved_and_applied_to_another_drawing(run, folder):
    waving, clip, alien = (str(folder / name) for name in ("w.akap", "w.clip.json", "a.akap"))
    code, output, errors = run(
        "clip", "apply", "nod", GINGERBREAD, "-o", waving, "--at", "1", "--repeat", "2"
    )
    assert (code, errors) == (0, "")
    assert "9 keyframes, 3.20 s" in output
    animation = load(waving).state.animation
    assert (animation.times[0], animation.ease) == (1.0, "smooth")
    code, output, errors = run("clip", "save", waving, "-o", clip, "--to", "2.1", "--name", "Yes")
    assert (code, errors) == (0, "")
    saved = load_clip(clip)
    assert (saved.name, len(saved.keys), saved.duration) == ("Yes", 5, pytest.approx(1.1))
    code, _, errors = run(
        "clip", "apply", clip, str(resource("assets", "drawings", "alien.png")), "-o", alien
    )
    assert (code, errors) == (0, "")
    assert len(load(alien).state.animation.keyframes) == 5


def test_the_bundled_clips_are_listed(run):
    code, output, _ = run("clip", "list")
    assert code == 0
    assert [line.split("  ")[0] for line in output.splitlines()] == [
        *("Hop", "Nod", "Tail Wag", "Walk in Place", "Wave")
    ]


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["apply", "fly", GINGERBREAD, "-o", "x.akap"], "expected a bundled clip"),
        (["apply", "none.clip.json", GINGERBREAD, "-o", "x.akap"], "none.clip.json"),
        (["apply", "wave", GINGERBREAD, "-o", "x.gif"], "ends in .akap"),
        (["apply", "wave", GINGERBREAD, "-o", "x.akap", "--speed", "0"], "--speed"),
        (["apply", "wave", "none.akap", "-o", "x.akap"], "none.akap"),
        (["save", GINGERBREAD, "-o", "x.clip.json"], "pins with names"),
        (["save", GINGERBREAD, "-o", "x.json"], "ends in .clip.json"),
    ],
)
def test_what_is_wrong_is_told_in_one_line(run, arguments, part):
    code, output, errors = run("clip", *arguments)
    assert (code, output) == (2, "")
    assert part in errors
    assert errors.count("\n") == 1
