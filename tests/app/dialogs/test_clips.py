"""The dialog of clips, clips as files, and the buttons of the start page."""

from dataclasses import replace

import pytest
from imgui_bundle import imgui

from akap_editor.app.dialogs.clips import ClipsDialog, start_clip, write_clip
from akap_editor.editor.session.edits import SetPins
from akap_editor.editor.session.replay import replay
from akap_editor.io.akap.clip import bundled_clips, load_clip


@pytest.fixture
def named(pinned):
    """The drawing has pins with names that the clip “Nod” moves."""
    session = pinned.session
    names = ("Body", "Chest", "Head")
    pins = tuple(
        replace(pin, name=names[number] if number < 3 else "")
        for number, pin in enumerate(session.state.pins)
    )
    pinned.editor.apply("Names", SetPins(pins))
    return pinned


def test_a_clip_becomes_keyframes_in_one_undo_step(named):
    state, before = named.state, named.session.present
    state.part(ClipsDialog).open(state)
    named.settle()
    dialog = state.part(ClipsDialog)
    dialog.chosen = next(k for k, clip in enumerate(dialog.clips) if clip.name == "Nod")
    named.key(imgui.Key.enter)
    named.settle()
    playback = state.timeline.keyframe_playback
    assert not state.error
    assert named.session.present.animation.times == (0.0, 0.25, 0.5, 0.75, 1.1)
    assert playback.selected == {0.0, 0.25, 0.5, 0.75, 1.1}
    *_, last = replay(named.session.recording, named.session.drawing)
    assert last.state.animation.times == named.session.present.animation.times
    named.editor.undo()
    assert named.session.present.animation is before.animation


def test_a_drawing_without_such_pins_says_so(pinned):
    start_clip(pinned.state, bundled_clips()[0])
    pinned.settle()
    assert "no pin of the drawing has one of them" in pinned.state.error
    assert not pinned.session.present.animation.keyframes


def test_selected_keyframes_are_saved_as_a_clip(named, tmp_path):
    write_clip(named.state, tmp_path / "none.clip.json")
    assert "needs keyframes" in named.state.error
    named.state.error = ""
    playback = named.state.timeline.keyframe_playback
    for time in (0.5, 1.0, 2.0):
        playback.set_keyframe(time)
    playback.selected = frozenset({0.5, 2.0})
    write_clip(named.state, tmp_path / "two.clip.json")
    clip = load_clip(tmp_path / "two.clip.json")
    assert (clip.name, clip.names) == ("two", ("Body", "Chest", "Head"))
    assert [key.time for key in clip.keys] == [0.0, 1.5]
