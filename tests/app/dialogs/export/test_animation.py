"""Exports of the timeline: the dialog, what it remembers, and every format."""

import json
import re
from dataclasses import replace
from itertools import pairwise
from threading import Event
from threading import enumerate as enumerate_threads

import numpy as np
import pytest
from imgui_bundle import imgui
from PIL import Image

from akap_editor.app.commands.command import CTRL, SHIFT
from akap_editor.app.dialogs.export.animation import (
    DIALOG_FORMATS,
    PREFERENCE,
    AnimationExportOptions,
    ExportAnimationDialog,
    export_animation,
    frame_times_in_order,
    size_text,
)
from akap_editor.app.dialogs.export.animation_size import AnimationSize
from akap_editor.app.preferences import Preferences
from akap_editor.errors import InputError
from tests.support.window_driver import one_step

TITLE = "Export animation"


@pytest.fixture
def keyed(pinned):
    pinned.add_keyframes(0.4)
    return pinned


def frames_of(path):
    with Image.open(path) as opened:
        for number in range(opened.n_frames):
            opened.seek(number)
            yield np.array(opened.convert("RGBA"))


def test_the_dialog_asks_and_then_a_file_is_written(keyed, tmp_path):
    keyed.state.folder = tmp_path
    keyed.key(CTRL | SHIFT | imgui.Key.e)
    keyed.dialog(TITLE, "**/APNG", "**/60", "Export...")
    keyed.type_name(TITLE, "wave")
    keyed.settle()
    assert not keyed.state.error
    assert keyed.state.notice == "Exported wave.apng, 25 frames, at 60 frames per second"
    frames = list(frames_of(tmp_path / "wave.apng"))
    assert len(frames) == 25
    assert all((one != other).any() for one, other in pairwise(frames))
    assert AnimationExportOptions.remembered(keyed.state.preferences).format == "APNG"
    assert AnimationExportOptions.remembered(keyed.state.preferences).fps == 60


def test_after_an_export_a_button_shows_the_file(keyed, tmp_path, monkeypatch):
    shown = []
    monkeypatch.setattr("akap_editor.app.jobs.file_manager.show_in_folder", shown.append)
    export_animation(keyed.state, AnimationExportOptions("GIF", fps=5, size=40), tmp_path / "wave.gif")
    keyed.settle()
    keyed.do(lambda hand: hand.item_click("//Status/###Show in Folder"))
    assert shown == [tmp_path / "wave.gif"]
    keyed.state.notice = "Saved figure.akap"
    keyed.settle()
    keyed.do(lambda hand: [] if not hand.item_exists("//Status/###Show in Folder") else pytest.fail("shown"))


def test_asking_does_not_change_what_is_seen(keyed):
    keyed.state.timeline.keyframe_playback.show_present()
    before = keyed.session.state
    keyed.state.part(ExportAnimationDialog).open(keyed.state)
    keyed.dialog(TITLE, "Cancel")
    assert keyed.session.state is before
    assert not keyed.session.is_previewing


@pytest.mark.parametrize("kind", DIALOG_FORMATS, ids=[each.label for each in DIALOG_FORMATS])
def test_every_format_is_written(keyed, tmp_path, kind):
    if kind.suffix in (".mp4", ".webm"):
        pytest.importorskip("av")
    options = AnimationExportOptions(kind.label, fps=10, size=60, speed=2.0, ease="in-out", ping_pong=True)
    export_animation(keyed.state, options, tmp_path / f"out{kind.suffix}")
    keyed.settle()
    assert not keyed.state.error
    assert "4 frames" in keyed.state.notice
    if kind.is_sheet:
        index = json.loads((tmp_path / "out.json").read_text())
        assert len(index["frames"]) == 4
    elif not kind.suffix:
        assert len(list((tmp_path / "out").glob("frame-*.png"))) == 4
    else:
        assert (tmp_path / f"out{kind.suffix}").stat().st_size > 100


def test_the_session_moves_between_its_shots_too(keyed, tmp_path):
    state = keyed.state
    state.timeline.set_mode("session")
    snapshots = state.timeline.session_playback.snapshots
    index = next(
        k
        for k in range(1, len(snapshots))
        if snapshots[k].discontinuities == snapshots[k - 1].discontinuities
        and (snapshots[k].state.positions != snapshots[k - 1].state.positions).any()
    )
    before, after = snapshots[index - 1].state.positions, snapshots[index].state.positions
    start = max(snapshots[index - 1].time, snapshots[index].time - 0.25)
    middle = state.timeline.frame(0.5 * (start + snapshots[index].time)).pose
    assert (middle != before).any()
    assert (middle != after).any()
    assert np.abs(middle - 0.5 * (before + after)).max() < 0.2 * np.abs(after - before).max()


def test_what_plays_over_and_over_shows_its_ends_once(keyed, tmp_path):
    playback = keyed.state.timeline.keyframe_playback
    playback.set_keyframe(0.8, playback.animation.keyframes[0].positions)
    for options, count in (
        (AnimationExportOptions("APNG", fps=10), 8),
        (AnimationExportOptions("APNG", fps=10, loop=False), 9),
    ):
        export_animation(keyed.state, options, tmp_path / "out.apng")
        keyed.settle()
        assert f"{count} frames" in keyed.state.notice
    playback.mark_range(end=0.4)
    assert len(frame_times_in_order(keyed.state, AnimationExportOptions("APNG", fps=10))) == 5


@pytest.fixture
def round_trip(keyed):
    """A third keyframe, which equals the first one."""
    playback = keyed.state.timeline.keyframe_playback
    playback.set_keyframe(0.8, playback.animation.keyframes[0].positions)
    return keyed


@pytest.mark.parametrize("longest", [45, 8192])
@pytest.mark.parametrize("kind", DIALOG_FORMATS, ids=[each.label for each in DIALOG_FORMATS])
def test_what_the_dialog_says_is_what_is_written(round_trip, tmp_path, kind, longest):
    if kind.is_video:
        pytest.importorskip("av")
    state = round_trip.state
    options = AnimationExportOptions(kind.label, fps=10, size=longest)
    count = len(frame_times_in_order(state, options))
    times = options.frame_times(*state.timeline.playback.played_range)
    measured = AnimationSize(clock=lambda: 0.0)
    said = size_text(options, measured.framing(state, times, longest, kind.is_video))
    export_animation(state, options, tmp_path / f"out{kind.suffix}")
    round_trip.settle()
    assert not state.error
    assert (count, size_of(tmp_path / f"out{kind.suffix}")) == (8, said)
    assert "8 frames" in state.notice


def size_of(path):
    """The size of what was exported, in the dialog's words."""
    if path.with_suffix(".json").exists():
        size = json.loads(path.with_suffix(".json").read_text())["frames"][0]["sourceSize"]
        return f"at most {size['w']} × {size['h']} px"
    if path.suffix in (".mp4", ".webm"):
        import av

        with av.open(str(path)) as container:
            return f"{container.streams.video[0].width} × {container.streams.video[0].height} px"
    if path.suffix == ".html":
        width, height = re.search(r"aspect-ratio: (\d+) / (\d+)", path.read_text("utf-8")).groups()
        return f"{width} × {height} px"
    with Image.open(path / "frame-0000.png" if path.is_dir() else path) as opened:
        return f"{opened.size[0]} × {opened.size[1]} px"


def test_the_progress_of_a_long_encoding_is_shown(keyed, tmp_path):
    state, shares, texts = keyed.state, [], []
    options = AnimationExportOptions("WebP", fps=10, size=60)
    export_animation(state, options, tmp_path / "out.webp")
    steps = None
    while steps is None:  # the task begins after the next frame
        keyed.frame()
        steps = state.task and state.task.steps
    for progress in steps:
        shares.append(progress.share)
        texts.append(progress.text)
    assert shares == sorted(shares)
    drawing = [share for share, text in zip(shares, texts, strict=True) if text.startswith("Drawing")]
    assert all(share <= 0.35 for share in drawing), "most of the time is still to come"


def test_a_web_page_can_wait_for_the_pointer(keyed, tmp_path):
    keyed.state.folder = tmp_path
    keyed.key(CTRL | SHIFT | imgui.Key.e)
    keyed.dialog(TITLE, "**/Web page", "**/Play on hover", "Export...")
    keyed.type_name(TITLE, "wave")
    keyed.settle()
    assert not keyed.state.error
    assert '"hover":true' in (tmp_path / "wave.html").read_text("utf-8")
    assert AnimationExportOptions.remembered(keyed.state.preferences).hover


def test_the_size_is_measured_beside_the_dialog(keyed):
    state, now = keyed.state, iter(range(100))
    size, times = AnimationSize(clock=lambda: next(now)), [0.0, 0.1, 0.2, 0.4]
    assert [size.measure(state, times, 40, False) for _ in range(3)] == [None] * 3
    assert max(size.measure(state, times, 40, False)) == 40
    assert max(size.measure(state, times, 20, False)) == 20, "at once"
    assert size.measure(state, times[1:], 40, False) is None, "other poses"


def test_the_dialog_loops_if_playback_does(keyed):
    playback = keyed.state.timeline.keyframe_playback
    for loop in (False, True):
        playback.loop = loop
        keyed.state.part(ExportAnimationDialog).open(keyed.state)
        keyed.dialog(TITLE, "Cancel")
        assert AnimationExportOptions.remembered(keyed.state.preferences).loop == loop


def test_a_gif_has_the_rate_that_players_show(keyed):
    assert AnimationExportOptions("GIF", fps=60).written_fps == 50
    assert len(frame_times_in_order(keyed.state, AnimationExportOptions("GIF", fps=60))) == 21
    assert len(frame_times_in_order(keyed.state, AnimationExportOptions("APNG", fps=60))) == 25


def test_background_and_size(keyed, tmp_path):
    options = AnimationExportOptions("APNG", fps=5, size=40, opaque=True, background=(1.0, 0.0, 0.0))
    export_animation(keyed.state, options, tmp_path / "out.apng")
    keyed.settle()
    first, *_ = frames_of(tmp_path / "out.apng")
    assert max(first.shape[:2]) == 40
    assert first[0, 0].tolist() == [255, 0, 0, 255]


@pytest.mark.parametrize(
    ("label", "output", "other"),
    [("Pictures", "frames", "frames/frame-0099.png"), ("Sprite sheet", "walk.png", "walk.json")],
)
@pytest.mark.parametrize("button", ["Replace", "Cancel"])
def test_files_that_were_not_named_are_replaced_only_on_demand(keyed, tmp_path, label, output, other, button):
    (tmp_path / "frames").mkdir()
    (tmp_path / other).write_bytes(b"of somebody")
    export_animation(keyed.state, AnimationExportOptions(label, fps=5, size=40), tmp_path / output)
    keyed.settle()
    assert (tmp_path / other).read_bytes() == b"of somebody"
    keyed.dialog("Replace files", button)
    keyed.settle()
    assert not keyed.state.error
    is_kept = (tmp_path / other).exists() and (tmp_path / other).read_bytes() == b"of somebody"
    assert is_kept == (button == "Cancel")
    assert (tmp_path / "frames" / "frame-0000.png").exists() == (label == "Pictures" and not is_kept)
    assert (tmp_path / "walk.png").exists() == (label == "Sprite sheet" and not is_kept)


@pytest.mark.parametrize("button", ["Replace", "Cancel"])
def test_the_file_that_the_drawing_was_opened_from_is_replaced_only_on_demand(keyed, tmp_path, button):
    source = tmp_path / "cat.webp"
    source.write_bytes(b"a picture")
    session = keyed.session
    session.document = replace(session.document, sources=(source,))
    export_animation(keyed.state, AnimationExportOptions(DIALOG_FORMATS[0].label, fps=5, size=40), source)
    keyed.settle()
    assert source.read_bytes() == b"a picture"
    keyed.dialog("Replace files", button)
    keyed.settle()
    assert not keyed.state.error
    assert (source.read_bytes() == b"a picture") == (button == "Cancel")


def test_an_export_is_cancelled_and_leaves_no_file(keyed, tmp_path, monkeypatch):
    monkeypatch.setattr("akap_editor.app.jobs.task.Task.advance", one_step)
    export_animation(keyed.state, AnimationExportOptions(), tmp_path / "out.webp")
    for _ in range(8):
        keyed.frame()
    assert keyed.state.task is not None
    keyed.dialog("Exporting out.webp", "Cancel")
    assert keyed.state.task is None
    assert "cancelled" in keyed.state.notice
    assert list(tmp_path.iterdir()) == []


def test_an_export_is_cancelled_while_all_of_it_is_encoded(keyed, tmp_path, monkeypatch):
    at_work, go_on = Event(), Event()

    def slow(_, file, *args, **options):
        at_work.set()
        go_on.wait()
        file.write(b"late")

    monkeypatch.setattr(Image.Image, "save", slow)
    export_animation(keyed.state, AnimationExportOptions(), tmp_path / "out.webp")
    while not at_work.is_set() or not keyed.state.task.progress.text.startswith("Encoding"):
        keyed.frame()
    keyed.dialog("Exporting out.webp", "Cancel")
    assert keyed.state.task is None
    go_on.set()
    for thread in enumerate_threads():
        if thread.name.startswith("encoder"):
            thread.join()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("is_exported", [False, True], ids=["estimate of the size", "export"])
def test_no_thread_stays_when_the_window_is_closed_meanwhile(keyed, tmp_path, is_exported):
    def encoders():
        return {thread for thread in enumerate_threads() if thread.name.startswith("encoder")}

    before = encoders()
    if is_exported:
        export_animation(keyed.state, AnimationExportOptions(), tmp_path / "out.webp")
    else:
        keyed.state.part(ExportAnimationDialog).open(keyed.state)
    while not (at_work := encoders() - before):
        keyed.frame()
    keyed.state.end_work()  # as `Window.close` does
    for thread in at_work:
        thread.join(60)
        assert not thread.is_alive()
    assert keyed.state.task is None
    assert list(tmp_path.iterdir()) == []


def test_where_a_picture_cannot_be_drawn_the_export_ends_with_one_sentence(keyed, tmp_path, monkeypatch):
    def fails(*_):
        raise InputError("no memory for a picture")

    monkeypatch.setattr(keyed.state.offscreen_renderer, "render", fails)
    export_animation(keyed.state, AnimationExportOptions(), tmp_path / "out.webp")
    keyed.settle()
    assert keyed.state.error == "no memory for a picture"
    assert keyed.state.task is None
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_not_there_is_one_sentence(keyed, tmp_path):
    export_animation(keyed.state, AnimationExportOptions(), tmp_path / "no" / "such" / "out.webp")
    keyed.settle()
    assert "out.webp" in keyed.state.error
    assert keyed.state.task is None


@pytest.mark.parametrize(
    "values",
    [
        {"fps": "many", "format": "AVI", "ease": "up", "background": [1, 2]},
        {"fps": None, "size": [], "loop": 3, "background": "red"},
    ],
)
def test_preferences_that_make_no_sense_are_as_at_first(keyed, values):
    keyed.state.preferences = Preferences()
    keyed.state.preferences.put(PREFERENCE, values)
    assert AnimationExportOptions.remembered(keyed.state.preferences) == AnimationExportOptions()


def test_options_are_remembered(keyed):
    options = AnimationExportOptions(
        "GIF", 12.5, 99, 2.0, "out", loop=False, ping_pong=True, opaque=True, background=(1.0, 0.5, 0.0)
    )
    options.remember(keyed.state.preferences)
    assert AnimationExportOptions.remembered(keyed.state.preferences) == options


def test_numbers_are_kept_in_their_limits(keyed):
    keyed.state.preferences.put(PREFERENCE, {"fps": 1e9, "size": -4, "speed": 0})
    assert AnimationExportOptions.remembered(keyed.state.preferences) == AnimationExportOptions(
        fps=120.0, size=16, speed=0.01
    )
