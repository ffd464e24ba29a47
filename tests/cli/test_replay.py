"""`akap-editor replay`: everything that it can write, and bad input."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.io.akap.project import save
from akap_editor.io.akap.recording import read_recording, write_recording
from akap_editor.io.images import read_image
from akap_editor.io.open_document import open_document
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.resources import resource
from tests.support.command_line import assert_one_line

RECORDING = resource("assets", "recordings", "elephant.akaprec")


@pytest.fixture(scope="module")
def session():
    """One second of bending a small bar at 12 moves a second."""
    image = np.zeros((40, 80, 4), dtype=np.uint8)
    image[10:30, 6:74] = (250, 130, 20, 255)
    now = [0.0]
    session = Session(new_document(make_drawing(image, vertices=80, name="bar")), clock=lambda: now[0])
    session.begin("Drag Pin")
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
def replay_bar(run, session, tmp_path):
    """Replays bar.akaprec, or another recording, with options: (exit code, stdout, stderr)."""
    write_recording(session.recording, tmp_path / "bar.akaprec", session.drawing)

    def call(*options, recording="bar.akaprec"):
        return run("replay", recording, *options)

    return call


# -- the bundled recording -----------------------------------------------------------------------------------


def test_replay_writes_an_animation_and_the_last_pose(run, tmp_path):
    animation = tmp_path / "new" / "wave.gif"
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
    text = RECORDING.read_text("utf-8").replace('"name":"elephant"', '"name":"unicorn"', 1)
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


# -- all options ---------------------------------------------------------------------------------------------


def test_the_drawing_inside_is_used_and_the_last_pose_is_the_session_s(replay_bar, session, tmp_path):
    code, output, errors = replay_bar("-o", "last.png", "--size", 8192)
    assert (code, errors) == (0, "")
    assert "last.png" in output
    with OffscreenRenderer() as renderer:
        expected = renderer.render(session.drawing, session.state.positions)
    np.testing.assert_array_equal(read_image(tmp_path / "last.png"), expected)


def test_a_rate_above_that_of_the_recording_moves_in_every_frame(replay_bar, tmp_path):
    """12 recorded moves a second, 48 frames."""
    assert replay_bar("-o", "frames", "--fps", 48)[0] == 0
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
def test_how_many_frames_there_are(replay_bar, tmp_path, options, frames):
    assert replay_bar("-o", "frames", *options)[0] == 0
    assert len(list((tmp_path / "frames").iterdir())) == frames


def test_ping_pong_ends_where_it_began(replay_bar, tmp_path):
    assert replay_bar("-o", "frames", "--fps", 6, "--ping-pong")[0] == 0
    frames = [read_image(path) for path in sorted((tmp_path / "frames").iterdir())]
    np.testing.assert_array_equal(frames[1], frames[-1])


def test_the_result_as_json_is_all_that_is_on_stdout(replay_bar, tmp_path):
    options = ("--fps", 8, "--size", 45, "--pose", "last.png", "--plays", 3, "--json")
    code, said, errors = replay_bar("-o", "bar.gif", *options)
    assert (code, errors) == (0, "")
    assert json.loads(said) == {
        "format": "GIF",
        "frames": 9,
        "fps": 8,
        "plays": 3,
        "files": ["bar.gif", "last.png"],
    }


def test_progress_is_not_on_stdout(replay_bar, tmp_path):
    code, said, _ = replay_bar("-o", "bar.gif", "--fps", 8, "--size", 45)
    assert code == 0
    assert said.startswith("Wrote bar.gif, 9 frames")


def test_a_lossy_webp_is_smaller(replay_bar, tmp_path):
    for name, options in (("lossless", ()), ("lossy", ("--quality", 20))):
        assert replay_bar("-o", f"{name}.webp", "--fps", 8, *options)[0] == 0
    assert (tmp_path / "lossy.webp").stat().st_size != (tmp_path / "lossless.webp").stat().st_size


def test_a_web_page(replay_bar, tmp_path):
    code, said, errors = replay_bar("-o", "bar.html", "--fps", 8, "--hover", "--background", "#fF8000")
    assert (code, errors) == (0, "")
    assert said.startswith("Wrote bar.html, 9 frames")
    text = (tmp_path / "bar.html").read_text("utf-8")
    assert '"hover":true' in text
    assert "background: #ff8000" in text


def test_only_a_web_page_waits_for_the_pointer(replay_bar, tmp_path):
    assert_one_line(replay_bar("-o", "bar.gif", "--hover"), "--hover", ".html", "GIF")
    assert not (tmp_path / "bar.gif").exists()


def test_a_sheet_and_its_index(replay_bar, tmp_path):
    assert replay_bar("-o", "bar.png", "--sheet", "--fps", 8, "--size", 64)[0] == 0
    index = json.loads((tmp_path / "bar.json").read_text("utf-8"))
    with Image.open(tmp_path / "bar.png") as sheet:
        assert sheet.size == (index["meta"]["size"]["w"], index["meta"]["size"]["h"])
    assert len(index["frames"]) == 9


@pytest.mark.parametrize("suffix", [".mp4", ".webm"])
def test_a_video(replay_bar, tmp_path, suffix):
    av = pytest.importorskip("av", reason="the extra [video] is not installed")
    assert replay_bar("-o", f"bar{suffix}", "--fps", 24)[0] == 0
    with av.open(str(tmp_path / f"bar{suffix}")) as container:
        assert sum(1 for _ in container.decode(video=0)) == 25


def test_background_and_plays(replay_bar, tmp_path):
    assert replay_bar("-o", "bar.webp", "--fps", 5, "--background", "#336699", "--plays", 3)[0] == 0
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
def test_methods_and_variants(replay_bar, session, tmp_path, monkeypatch, options, method, parameters):
    used = []

    def watched(recording, drawing, change):
        for moment in replay(recording, drawing, change):
            used.append(moment.state.settings)
            yield moment

    monkeypatch.setattr("akap_editor.editor.session.replay.replay", watched)
    assert replay_bar("-o", "last.png", *options)[0] == 0
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
        (["--quality", 50], ["--quality", ".webp", "GIF"]),
    ],
)
def test_bad_options_are_one_line_and_nothing_is_written(replay_bar, tmp_path, options, parts):
    code, _, errors = replay_bar("-o", "bar.gif", *options)
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
def test_a_bad_recording_is_told_with_its_line(replay_bar, tmp_path, change, part):
    lines = (tmp_path / "bar.akaprec").read_text("utf-8").splitlines()
    (tmp_path / "bad.akaprec").write_text("\n".join(change(lines)) + "\n")
    code, _, errors = replay_bar("-o", "bar.gif", recording="bad.akaprec")
    assert code == 2
    assert errors.count("\n") == 1
    assert part in errors
    assert not (tmp_path / "bar.gif").exists()


def test_a_pin_outside_another_drawing_is_told_with_its_line(replay_bar, session, tmp_path):
    image = session.drawing.image.copy()
    image[:, 40:] = 0
    Image.fromarray(image).save(tmp_path / "half.png")
    code, _, errors = replay_bar("-o", "bar.gif", "--drawing", "half.png")
    assert code == 2
    assert "“bar.akaprec”. Recording line 5: " in errors
    assert "outside the drawing" in errors


@pytest.fixture
def posed(session, tmp_path):
    """posed.akap, with keyframes of the rest pose at 0 and of the bent one at half a second."""
    keys = Keyframe(0, session.drawing.mesh.vertices), Keyframe(0.5, session.state.positions)
    document = new_document(session.drawing)
    save(document.with_state(replace(document.state, animation=Animation(keys))), tmp_path / "posed.akap")
    return session


@pytest.mark.parametrize("name", ["out.webp", "out.gif", "out.apng", "frames"])
def test_keyframes_are_played_like_a_recording(replay_bar, posed, tmp_path, name):
    code, out, err = replay_bar("-o", name, "--fps", 20, "--size", 60, recording="posed.akap")
    assert (code, err) == (0, "")
    assert "11 frames" in out
    assert (tmp_path / name).exists()


def test_what_plays_for_ever_and_ends_as_it_begins_shows_its_end_once(replay_bar, posed, tmp_path):
    document = open_document(tmp_path / "posed.akap")
    keys = *document.state.animation.keyframes, Keyframe(1.0, document.drawing.mesh.vertices)
    save(document.with_state(replace(document.state, animation=Animation(keys))), tmp_path / "round.akap")
    for options, count in (((), 10), (("--plays", 1), 11), (("--to", 0.5), 6), (("--ping-pong",), 20)):
        code, out, _ = replay_bar(
            "-o", "out.gif", "--fps", 10, "--size", 60, *options, recording="round.akap"
        )
        assert code == 0
        assert f"{count} frames" in out


@pytest.fixture
def round_trip(posed, tmp_path):
    """round.akap and once.akap: to the bent pose and back in a second, over and over, and once."""
    document = open_document(tmp_path / "posed.akap")
    keys = *document.state.animation.keyframes, Keyframe(1.0, document.drawing.mesh.vertices)
    for name, loop in (("round", True), ("once", False)):
        save(
            document.with_state(replace(document.state, animation=Animation(keys, loop=loop))),
            tmp_path / f"{name}.akap",
        )


FORMATS = [*(f"out{suffix}" for suffix in (".gif", ".webp", ".apng", ".mp4", ".webm")), "frames", "sheet.png"]


@pytest.mark.parametrize(
    ("output", "name", "options", "count"),
    [
        *((output, "round", (), 10) for output in FORMATS),
        *((output, "once", (), 11) for output in FORMATS),
        ("out.gif", "once", ("--plays", 0), 10),
        ("out.gif", "round", ("--plays", 1), 11),
        ("frames", "round", ("--ping-pong",), 20),
    ],
)
def test_the_frames_of_a_loop_are_the_same_in_every_format(
    replay_bar, round_trip, tmp_path, output, name, options, count
):
    if output.endswith((".mp4", ".webm")):
        pytest.importorskip("av")
    options = "-o", output, "--fps", 10, "--size", 45, *options, *(["--sheet"] if "sheet" in output else [])
    code, out, _ = replay_bar(*options, recording=f"{name}.akap")
    assert code == 0
    assert f"{count} frames" in out
    assert frames_in(tmp_path / output) == count


def frames_in(path):
    """The number of frames in a file or folder."""
    if path.is_dir():
        return len(list(path.glob("*.png")))
    if path.suffix == ".png":
        return len(json.loads(path.with_suffix(".json").read_text("utf-8"))["frames"])
    if path.suffix in (".mp4", ".webm"):
        import av

        with av.open(str(path)) as container:
            return sum(1 for _ in container.decode(video=0))
    with Image.open(path) as opened:
        return opened.n_frames


@pytest.mark.parametrize(("name", "plays"), [("once", None), ("round", 0)])
def test_a_drawing_says_how_often_its_keyframes_play(replay_bar, round_trip, tmp_path, name, plays):
    assert replay_bar("-o", "out.gif", "--fps", 10, "--size", 45, recording=f"{name}.akap")[0] == 0
    with Image.open(tmp_path / "out.gif") as opened:
        assert opened.info.get("loop") == plays


@pytest.mark.parametrize(
    ("keyframes", "options"),
    [("posed", ["--ping-pong"]), ("round", []), ("round", ["--ping-pong"])],
    ids=["ping-pong", "seamless loop", "ping-pong loop"],
)
def test_the_last_pose_is_the_end_of_the_motion(replay_bar, posed, tmp_path, keyframes, options):
    document = open_document(tmp_path / "posed.akap")
    first, last = document.state.animation.keyframes
    keys = first, last, Keyframe(1.0, first.positions)
    save(document.with_state(replace(document.state, animation=Animation(keys))), tmp_path / "round.akap")
    options = ("--fps", 10, "--size", 60, *options)
    assert replay_bar("-o", "out.gif", "--pose", "pose.png", *options, recording=f"{keyframes}.akap")[0] == 0
    end = posed.drawing.mesh.vertices if keyframes == "round" else posed.state.positions
    with OffscreenRenderer() as renderer:
        expected = renderer.render(posed.drawing, end)
    np.testing.assert_array_equal(read_image(tmp_path / "pose.png"), expected)


def test_the_last_frame_of_keyframes_is_the_last_pose(replay_bar, posed, tmp_path):
    assert replay_bar("-o", "out.png", "--pose", "pose.png", "--size", 8000, recording="posed.akap")[0] == 0
    with OffscreenRenderer() as renderer:
        expected = renderer.render(posed.drawing, posed.state.positions)
    np.testing.assert_array_equal(read_image(tmp_path / "pose.png"), expected)
    options = ("--from", 0.2, "--to", 0.4, "--ping-pong", "--speed", 2, "--fps", 20, "--sheet")
    assert replay_bar("-o", "sheet.png", *options, recording="posed.akap")[0] == 0
    assert len(json.loads((tmp_path / "sheet.json").read_text("utf-8"))["frames"]) == 4


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
def test_what_is_for_recordings_only_is_refused_for_keyframes(replay_bar, posed, options, message):
    code, _, err = replay_bar("-o", "out.webp", *options, recording="posed.akap")
    assert code == 2
    assert message in err


def test_a_drawing_without_keyframes_is_refused(replay_bar, session, tmp_path):
    save(new_document(session.drawing), tmp_path / "still.akap")
    code, _, err = replay_bar("-o", "out.webp", recording="still.akap")
    assert code == 2
    assert "Couldn't replay “still.akap”. The drawing has no keyframes; " in err


def test_a_recording_is_a_document_in_its_last_pose(session, tmp_path):
    write_recording(session.recording, tmp_path / "bar.akaprec", session.drawing)
    document = open_document(tmp_path / "bar.akaprec")
    np.testing.assert_array_equal(document.state.positions, session.state.positions)
    (tmp_path / "bad.akaprec").write_text(
        (tmp_path / "bar.akaprec").read_text("utf-8")
        + '{"t": 99, "do": "undo", "x": 1}\n{"t": 0, "do": "undo"}\n'
    )
    with pytest.raises(InputError, match=r"bad.akaprec”. Recording line \d+: expected a time of 99 s"):
        open_document(tmp_path / "bad.akaprec")
