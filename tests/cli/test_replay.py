"""`akap-editor replay` with all that it can write; what it shares with other commands is in test_cli.py."""

import json
import sys
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from akap_editor import cli
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.io.akap.project import save
from akap_editor.io.akap.recording import write_recording
from akap_editor.io.images import read_image
from akap_editor.io.open_document import open_document
from akap_editor.render.offscreen import OffscreenRenderer


@pytest.fixture(scope="module")
def session():
    """One second of bending a small bar at 12 moves a second."""
    image = np.zeros((40, 80, 4), dtype=np.uint8)
    image[10:30, 6:74] = (250, 130, 20, 255)
    now = [0.0]
    session = Session(new_document(make_drawing(image, vertices=80, name="bar")), clock=lambda: now[0])
    session.begin("Bend")
    add_pin(session, (12.0, 20.0))
    pin = add_pin(session, (68.0, 20.0))
    for step in range(1, 13):
        now[0] = step / 12
        session.apply(SetTargets({pin: (68.0 - step, 20.0 + 2 * step)}))
        for _ in range(5):
            session.step()
    session.commit()
    return session


@pytest.fixture
def run(monkeypatch, capfd, tmp_path, session):
    """Replays bar.akaprec with options in an empty folder: (exit code, stdout, stderr)."""
    monkeypatch.chdir(tmp_path)
    write_recording(session.recording, tmp_path / "bar.akaprec", session.drawing)

    def call(*options, recording="bar.akaprec"):
        monkeypatch.setattr(sys, "argv", ["akap-editor", "replay", recording, *map(str, options)])
        code = 0
        try:
            cli.main()
        except SystemExit as leaving:
            code = leaving.code or 0
        return code, *capfd.readouterr()

    return call


def test_the_drawing_inside_is_used_and_the_last_pose_is_the_session_s(run, session, tmp_path):
    code, output, errors = run("-o", "last.png", "--size", 8192)
    assert (code, errors) == (0, "")
    assert "last.png" in output
    with OffscreenRenderer() as renderer:
        expected = renderer.render(session.drawing, session.state.positions)
    np.testing.assert_array_equal(read_image(tmp_path / "last.png"), expected)


def test_a_rate_above_that_of_the_recording_moves_in_every_frame(run, tmp_path):
    """12 recorded moves a second, 48 frames."""
    assert run("-o", "frames", "--fps", 48)[0] == 0
    frames = [read_image(path).astype(int) for path in sorted((tmp_path / "frames").iterdir())]
    assert len(frames) == 49
    assert all((a != b).any() for a, b in pairwise(frames[1:]))


@pytest.mark.parametrize(
    ("options", "frames"),
    [
        (["--fps", 10], 11),
        (["--fps", 10, "--speed", 2], 6),
        (["--fps", 10, "--from", 0.5], 6),
        (["--fps", 10, "--from", 0.25, "--to", 0.75], 6),
        (["--fps", 10, "--to", 99], 11),
        (["--fps", 10, "--ping-pong"], 20),
        (["--fps", 10, "--ease", "in-out"], 11),
        (["--fps", 12, "--pause", 0], 1),
    ],
)
def test_how_many_frames_there_are(run, tmp_path, options, frames):
    assert run("-o", "frames", *options)[0] == 0
    assert len(list((tmp_path / "frames").iterdir())) == frames


def test_ping_pong_ends_where_it_began(run, tmp_path):
    assert run("-o", "frames", "--fps", 6, "--ping-pong")[0] == 0
    frames = [read_image(path) for path in sorted((tmp_path / "frames").iterdir())]
    np.testing.assert_array_equal(frames[1], frames[-1])


def test_a_sheet_and_its_index(run, tmp_path):
    assert run("-o", "bar.png", "--sheet", "--fps", 8, "--size", 64)[0] == 0
    index = json.loads((tmp_path / "bar.json").read_text())
    with Image.open(tmp_path / "bar.png") as sheet:
        assert sheet.size == (index["meta"]["size"]["w"], index["meta"]["size"]["h"])
    assert len(index["frames"]) == 9


@pytest.mark.parametrize("suffix", [".mp4", ".webm"])
def test_a_video(run, tmp_path, suffix):
    av = pytest.importorskip("av", reason="the extra [video] is not installed")
    assert run("-o", f"bar{suffix}", "--fps", 24)[0] == 0
    with av.open(str(tmp_path / f"bar{suffix}")) as container:
        assert sum(1 for _ in container.decode(video=0)) == 25


def test_background_and_plays(run, tmp_path):
    assert run("-o", "bar.webp", "--fps", 5, "--background", "#336699", "--plays", 3)[0] == 0
    with Image.open(tmp_path / "bar.webp") as opened:
        assert opened.info["loop"] == 3
        assert opened.convert("RGBA").getpixel((0, 0)) == (0x33, 0x66, 0x99, 255)


@pytest.mark.parametrize(
    ("options", "method", "parameters"),
    [
        (["--method", "mls"], "mls", {}),
        (["--method", "arap:converge"], "arap", {"converge": True}),
        (["--method", "akap"], "akap", {"memory": 1.0}),
        (["--variant", "no-memory"], "akap", {"memory": 0.0}),
        (
            ["--variant", "no-dirichlet, linear,no-memory"],
            "akap",
            {"dirichlet": False, "trajectory": "linear", "memory": 0.0},
        ),
    ],
)
def test_methods_and_variants(run, session, tmp_path, monkeypatch, options, method, parameters):
    used = []

    def watched(recording, drawing, change):
        for moment in replay(recording, drawing, change):
            used.append(moment.state.settings)
            yield moment

    monkeypatch.setattr("akap_editor.cli.replay.replay", watched)
    assert run("-o", "last.png", *options)[0] == 0
    assert {(settings.method, settings.parameters) for settings in used} == {
        (method, tuple(sorted(parameters.items())))
    }


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (["--from", 2], ["--from", "the end at 1 s", "got 2"]),
        (["--from", -1], ["--from", "got -1"]),
        (["--from", 0.5, "--to", 0.2], ["--to", "0.5 s or later", "got 0.2"]),
        (["--speed", 0], ["--speed", "0.01 to 100"]),
        (["--plays", -1], ["--plays", "0 to 65535"]),
        (["--pause", "nan"], ["--pause", "got nan"]),
        (["--ease", "bounce"], ["--ease", "in-out"]),
        (["--variant", "curly"], ["--variant", "no-dirichlet", "'curly'"]),
        (["--method", "magic"], ["akap", "mls", "'magic'"]),
        (["--background", "red"], ["--background", "'red'"]),
        (["--sheet"], [".png", ".gif"]),
    ],
)
def test_bad_options_are_one_line_and_nothing_is_written(run, tmp_path, options, parts):
    code, _, errors = run("-o", "bar.gif", *options)
    assert code == 2
    assert errors.count("\n") == 1
    for part in parts:
        assert part in errors
    assert [path.name for path in tmp_path.iterdir()] == ["bar.akaprec"]


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (lambda lines: [*lines[:5], '{"t":-1,"do":"step"}'], "line 6: expected a time of 0"),
        (lambda lines: [*lines[:5], '{"t":1,"do":"explode"}'], "line 6: expected one of begin, "),
        (lambda lines: [lines[0].replace('"akap":"', '"akap":"!'), *lines[1:]], "line 1: the drawing inside"),
    ],
)
def test_a_bad_recording_is_told_with_its_line(run, tmp_path, change, part):
    lines = (tmp_path / "bar.akaprec").read_text().splitlines()
    (tmp_path / "bad.akaprec").write_text("\n".join(change(lines)) + "\n")
    code, _, errors = run("-o", "bar.gif", recording="bad.akaprec")
    assert code == 2
    assert errors.count("\n") == 1
    assert part in errors
    assert not (tmp_path / "bar.gif").exists()


def test_a_pin_outside_another_drawing_is_told_with_its_line(run, session, tmp_path):
    image = session.drawing.image.copy()
    image[:, 40:] = 0
    Image.fromarray(image).save(tmp_path / "half.png")
    code, _, errors = run("-o", "bar.gif", "--drawing", "half.png")
    assert code == 2
    assert "recording line 5: " in errors
    assert "outside the drawing" in errors


@pytest.fixture
def posed(session, tmp_path):
    """posed.akap, with keyframes of the rest pose at 0 and of the bent one at half a second."""
    keys = Keyframe(0, session.drawing.mesh.vertices), Keyframe(0.5, session.state.positions)
    document = new_document(session.drawing)
    save(document.with_state(replace(document.state, animation=Animation(keys))), tmp_path / "posed.akap")
    return session


@pytest.mark.parametrize("name", ["out.webp", "out.gif", "out.apng", "frames"])
def test_keyframes_are_played_like_a_recording(run, posed, tmp_path, name):
    code, out, err = run("-o", name, "--fps", 20, "--size", 60, recording="posed.akap")
    assert (code, err) == (0, "")
    assert "11 frames" in out
    assert (tmp_path / name).exists()


def test_what_plays_for_ever_and_ends_as_it_begins_shows_its_end_once(run, posed, tmp_path):
    document = open_document(tmp_path / "posed.akap")
    keys = *document.state.animation.keyframes, Keyframe(1.0, document.drawing.mesh.vertices)
    save(document.with_state(replace(document.state, animation=Animation(keys))), tmp_path / "round.akap")
    for options, count in (((), 10), (("--plays", 1), 11), (("--to", 0.5), 6), (("--ping-pong",), 20)):
        code, out, _ = run("-o", "out.gif", "--fps", 10, "--size", 60, *options, recording="round.akap")
        assert code == 0
        assert f"{count} frames" in out


def test_the_last_frame_of_keyframes_is_the_last_pose(run, posed, tmp_path):
    assert run("-o", "out.png", "--pose", "pose.png", "--size", 8000, recording="posed.akap")[0] == 0
    with OffscreenRenderer() as renderer:
        expected = renderer.render(posed.drawing, posed.state.positions)
    np.testing.assert_array_equal(read_image(tmp_path / "pose.png"), expected)
    options = ("--from", 0.2, "--to", 0.4, "--ping-pong", "--speed", 2, "--fps", 20, "--sheet")
    assert run("-o", "sheet.png", *options, recording="posed.akap")[0] == 0
    assert len(json.loads((tmp_path / "sheet.json").read_text())["frames"]) == 4


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--method", "arap"), "--method: expected a recording"),
        (("--variant", "linear"), "--variant: expected a recording"),
        (("--pause", 1), "--pause: expected a recording"),
        (("--drawing", "bar.png"), "--drawing: expected a recording"),
        (("--from", 2), "--from: expected a time from 0 to the end at 0.5 s"),
    ],
)
def test_what_is_for_recordings_only_is_refused_for_keyframes(run, posed, options, message):
    code, _, err = run("-o", "out.webp", *options, recording="posed.akap")
    assert code == 2
    assert message in err


def test_a_drawing_without_keyframes_is_refused(run, session, tmp_path):
    save(new_document(session.drawing), tmp_path / "still.akap")
    code, _, err = run("-o", "out.webp", recording="still.akap")
    assert code == 2
    assert "still.akap: expected a drawing with keyframes, or a recording, got one without any" in err


def test_a_recording_is_a_document_in_its_last_pose(session, tmp_path):
    write_recording(session.recording, tmp_path / "bar.akaprec", session.drawing)
    document = open_document(tmp_path / "bar.akaprec")
    np.testing.assert_array_equal(document.state.positions, session.state.positions)
    (tmp_path / "bad.akaprec").write_text(
        (tmp_path / "bar.akaprec").read_text() + '{"t": 99, "do": "undo", "x": 1}\n{"t": 0, "do": "undo"}\n'
    )
    with pytest.raises(InputError, match=r"bad.akaprec: recording line \d+: expected a time of 99 s"):
        open_document(tmp_path / "bad.akaprec")
