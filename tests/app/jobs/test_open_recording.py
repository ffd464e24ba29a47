"""Recordings saved from the window."""

import numpy as np

from akap_editor.app import files
from akap_editor.editor.session.replay import replay
from akap_editor.io.akap.recording import read_recording, recorded_drawing, write_recording
from tests.support.window_driver import one_step


def test_what_was_done_by_hand_is_saved_and_done_again_to_the_last_bit(ui, tmp_path):
    ui.state.folder = tmp_path
    for place in ((50.0, 80.0), (130.0, 80.0), (210.0, 80.0)):
        ui.click(ui.to_screen(place))
    start = ui.to_screen((210.0, 80.0))
    ui.drag(start, (start[0] - 30, start[1] - 90))
    ui.menu("Edit", "Undo")
    ui.menu("Edit", "Redo")
    ui.menu("File", "Save Recording...")
    ui.type_name("Save recording", "wave")
    ui.settle()
    assert ui.state.notice.startswith("Saved wave.akaprec")
    recording = read_recording(tmp_path / "wave.akaprec")
    *_, last = replay(recording, recorded_drawing(recording))
    np.testing.assert_array_equal(last.state.positions, ui.session.state.positions)
    assert ui.session.is_posed


def recorded(ui, tmp_path):
    """A recording of three pins, a drag, an undo and a drag; and the session that it was made of."""
    ui.state.timeline.session_playback.follow(ui.session)
    for place in ((50.0, 80.0), (130.0, 80.0), (210.0, 80.0)):
        ui.click(ui.to_screen(place))
    start = ui.to_screen((210.0, 80.0))
    ui.drag(start, (start[0] - 30, start[1] - 90))
    ui.menu("Edit", "Undo")
    ui.drag(start, (start[0] - 10, start[1] + 50))
    session = ui.session
    write_recording(session.recording, tmp_path / "wave.akaprec", session.drawing)
    return session


def test_a_recording_opens_in_its_final_pose_with_all_of_it_on_the_timeline(ui, tmp_path):
    session = recorded(ui, tmp_path)
    ui.editor.mark_saved(None)
    ui.drop(tmp_path / "wave.akaprec")
    again, playback = ui.session, ui.state.timeline.session_playback
    assert again is not session
    assert not ui.state.error
    np.testing.assert_array_equal(again.state.positions, session.state.positions)
    assert list(again.recording.events) == list(session.recording.events)
    assert again.history.labels == session.history.labels
    assert not ui.editor.is_modified
    assert ui.state.timeline.is_shown
    assert playback.snapshots[-1].state is again.state
    playback.scrub(0.0)
    np.testing.assert_array_equal(again.state.positions, again.drawing.mesh.vertices)
    playback.show_present()


def test_a_recording_that_was_opened_is_gone_on_with_and_branched(ui, tmp_path):
    recorded(ui, tmp_path)
    ui.editor.mark_saved(None)
    ui.drop(tmp_path / "wave.akaprec")
    playback = ui.state.timeline.session_playback
    playback.scrub(0.5 * playback.duration)
    ui.settle()
    start = ui.to_screen(ui.pin_position(1))
    ui.drag(start, (start[0] + 20, start[1] + 30))
    assert ui.session.history.labels[-2:] == ["Go Back in Time", "Drag Pin"]
    times = [event["t"] for event in ui.session.recording.events]
    assert times == sorted(times)
    write_recording(ui.session.recording, tmp_path / "more.akaprec", ui.session.drawing)
    again = read_recording(tmp_path / "more.akaprec")
    *_, last = replay(again, recorded_drawing(again))
    np.testing.assert_array_equal(last.state.positions, ui.session.state.positions)


def test_opening_a_recording_is_stopped_half_way_or_cancelled(ui, tmp_path, monkeypatch):
    session = recorded(ui, tmp_path)
    ui.editor.mark_saved(None)
    monkeypatch.setattr("akap_editor.app.jobs.task.SLICE", 0.0)
    monkeypatch.setattr("akap_editor.app.jobs.task.Task.advance", one_step)
    files.open_path(ui.state, tmp_path / "wave.akaprec")
    ui.frame_until(lambda: ui.state.task.progress.share > 0)
    assert ui.state.task.progress.share < 1
    ui.dialog("Opening wave.akaprec", "Cancel")
    assert ui.state.task is None
    assert ui.session is session
    files.open_path(ui.state, tmp_path / "wave.akaprec")
    ui.frame_until(lambda: ui.state.task.progress.share > 0)
    ui.dialog("Opening wave.akaprec", "Stop Here")
    assert ui.session is not session
    assert 0 < len(ui.session.recording.events) < len(session.recording.events)


def test_a_bad_recording_is_refused_with_its_line_and_nothing_is_lost(ui, tmp_path):
    session = recorded(ui, tmp_path)
    ui.editor.mark_saved(None)
    text = (tmp_path / "wave.akaprec").read_text()
    lines = text.splitlines()
    (tmp_path / "bad.akaprec").write_text("\n".join([*lines[:5], '{"t": 0, "do": "dance"}', *lines[5:]]))
    ui.drop(tmp_path / "bad.akaprec")
    assert "bad.akaprec”. Recording line 6: expected one of" in ui.state.error
    ui.dialog("Error", "OK")
    number = 1 + next(k for k, line in enumerate(lines) if '"targets"' in line)
    lines[number - 1] = lines[number - 1].replace('"targets":{"3"', '"targets":{"9"')
    (tmp_path / "bad.akaprec").write_text("\n".join(lines))
    ui.drop(tmp_path / "bad.akaprec")
    assert f"bad.akaprec”. Recording line {number}: cannot be replayed" in ui.state.error
    ui.dialog("Error", "OK")
    assert ui.session is session
