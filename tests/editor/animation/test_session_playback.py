"""Playback of the session: scrubbing edits nothing, and an edit at an earlier time starts a branch."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.animation.pose_blend import PoseBlend
from akap_editor.editor.animation.session_playback import MAX_PAUSE_SECONDS, SessionPlayback
from akap_editor.editor.session.recording import parse_recording
from akap_editor.editor.session.replay import replay
from tests.support.editor_driver import bits

END = (105.0, 40.0)


@pytest.fixture
def playback(pinned, clock):
    """The playback of a drag after a long pause, with a snapshot every twentieth of a second."""
    playback = SessionPlayback(clock)
    playback.follow(pinned.session)
    clock.now += 100
    pinned.press(END)
    pinned.move((90.0, 60.0))
    while pinned.editor.is_moving:
        pinned.advance()
        playback.follow(pinned.session)
        clock.now += 0.05
    pinned.release((90.0, 60.0))
    playback.follow(pinned.session)
    return playback


def recorded(session, drawing):
    *_, last = replay(parse_recording(session.recording.to_text()), drawing)
    return last.state


def test_pauses_are_shortened_and_every_state_is_there(playback, pinned, drawing):
    times = [snapshot.time for snapshot in playback.snapshots]
    assert times == sorted(times)
    assert times[0] == 0
    assert times[1] == MAX_PAUSE_SECONDS
    assert len(times) > 5
    assert np.diff(times[1:]).max() <= 0.06
    np.testing.assert_array_equal(playback.snapshots[0].state.positions, drawing.mesh.vertices)
    assert playback.snapshots[-1].state is pinned.state


def test_scrubbing_shows_every_moment_and_changes_nothing(playback, pinned):
    session, now = pinned.session, bits(pinned.state)
    lines, depth, modified = len(session.recording.events), session.history.depth, session.is_modified
    for snapshot in [*playback.snapshots[:-1], *reversed(playback.snapshots[:-1])]:
        playback.scrub(snapshot.time)
        assert bits(session.state) == bits(snapshot.state)
        assert session.is_previewing
        playback.follow(session)
    playback.scrub(playback.duration)
    assert not session.is_previewing
    assert bits(session.state) == now
    assert (len(session.recording.events), session.history.depth, session.is_modified) == (
        lines,
        depth,
        modified,
    )


def test_dragging_from_an_earlier_moment_branches(playback, pinned, drawing):
    session, old = pinned.session, bits(pinned.state)
    before = playback.snapshots[: len(playback.snapshots) // 2 + 1]
    middle = before[-1]
    playback.scrub(middle.time)
    start = pinned.where(3)
    pinned.drag(start, (start[0] - 5, start[1] - 30))
    playback.follow(session)
    pinned.settle()
    playback.follow(session)
    assert playback.time is None
    assert playback.snapshots[: len(before)] == before
    assert len(playback.snapshots) > len(before)
    assert bits(recorded(session, drawing)) == bits(session.state)
    session.undo()
    assert bits(session.state) == bits(middle.state)
    session.undo()
    assert bits(session.state) == old, "the old branch"
    assert bits(recorded(session, drawing)) == old


def test_a_gesture_at_an_earlier_moment_that_changes_nothing_leaves_everything(playback, pinned, drawing):
    snapshots, depth, now = list(playback.snapshots), pinned.depth, pinned.session.present
    time = snapshots[2].time
    playback.scrub(time)
    pinned.press((2.0, 2.0))
    assert not playback.follow(pinned.session)
    pinned.release((2.0, 2.0))
    assert not playback.follow(pinned.session)
    pinned.press(pinned.where(3))
    pinned.move((90.0, 50.0))
    assert not playback.follow(pinned.session)
    pinned.key("escape")
    assert not playback.follow(pinned.session)
    assert playback.snapshots == snapshots
    assert playback.time == time
    assert pinned.session.is_previewing
    assert pinned.session.present is now
    assert pinned.depth == depth
    playback.show_present()
    assert bits(recorded(pinned.session, drawing)) == bits(now)


def test_a_branch_is_told_once_and_undo_brings_back_what_came_later(playback, pinned, drawing):
    snapshots, now = list(playback.snapshots), pinned.state
    playback.scrub(snapshots[2].time)
    pinned.press(pinned.where(3))
    pinned.move((90.0, 50.0))
    assert not playback.follow(pinned.session), "it is not certain before the end of the gesture"
    pinned.advance()
    pinned.release((90.0, 50.0))
    assert playback.follow(pinned.session)
    assert not playback.follow(pinned.session)
    assert playback.snapshots[:2] == snapshots[:2]
    assert playback.snapshots[-1] is not snapshots[-1]
    pinned.undo()
    pinned.undo()
    assert pinned.state is now
    playback.follow(pinned.session)
    assert playback.snapshots == snapshots
    assert playback.time is None
    assert bits(recorded(pinned.session, drawing)) == bits(now)


def test_looking_does_not_change_the_last_bits_of_what_comes_after(playback, pinned, drawing):
    session = pinned.session
    for number in range(4):
        for snapshot in playback.snapshots[:: 3 + number]:
            playback.scrub(snapshot.time)
        playback.show_present()
        start = pinned.where(3)
        pinned.press(start)
        pinned.move((start[0] + (-8) ** (number % 2) * 2, start[1] - 9.0))
        for _ in range(3):
            pinned.advance()
            playback.follow(session)
        pinned.release((start[0], start[1] - 9.0))
        playback.follow(session)
        assert bits(recorded(session, drawing)) == bits(session.state)


def test_a_pose_that_is_settling_goes_on_after_a_look_back(playback, pinned, drawing):
    session = pinned.session
    start = pinned.where(3)
    pinned.press(start)
    pinned.move((start[0] - 20.0, start[1] + 25.0))
    pinned.release((start[0] - 20.0, start[1] + 25.0))
    playback.follow(session)
    assert session.is_moving
    playback.scrub(0.0)
    assert not session.is_moving
    playback.show_present()
    assert session.is_moving
    pinned.click((30.0, 40.0))
    assert bits(recorded(session, drawing)) == bits(session.state)


def test_undo_while_looking_undoes_from_the_present(playback, pinned, drawing):
    playback.scrub(playback.duration / 2)
    pinned.undo()
    assert not pinned.session.is_previewing
    assert bits(recorded(pinned.session, drawing)) == bits(pinned.state)
    np.testing.assert_array_equal(pinned.state.positions, drawing.mesh.vertices)


def test_playing_goes_through_the_range_and_stops_or_starts_over(playback, pinned, clock):
    playback.mark_range(1.0, 1.2)
    playback.loop = False
    playback.toggle_playing()
    assert playback.is_playing
    assert playback.time == 1.0
    clock.now += 0.1
    playback.advance()
    assert playback.time == pytest.approx(1.1)
    clock.now += 1
    playback.advance()
    assert not playback.is_playing
    assert playback.time == 1.2
    playback.loop = True
    playback.toggle_playing()
    clock.now += 0.25
    playback.advance()
    assert playback.time == pytest.approx(1.05), "it starts over without losing time"
    playback.toggle_playing()
    assert not playback.is_playing


def test_a_take_is_the_part_between_its_ends(playback, pinned, clock):
    before = playback.duration
    playback.start_take()
    pinned.press((90.0, 60.0))
    pinned.move((95.0, 50.0))
    for _ in range(5):
        clock.now += 0.05
        pinned.advance()
        playback.follow(pinned.session)
    pinned.release((95.0, 50.0))
    playback.end_take()
    assert playback.marked_range == (before, playback.duration)
    assert playback.duration > before


@pytest.mark.parametrize(("start", "end"), [(2.0, 1.0), (5.0, 5.0)])
def test_an_empty_range_is_all_there_is(playback, start, end):
    playback.mark_range(start, end)
    assert playback.played_range == (0.0, playback.duration)


def test_frames_between_shots_are_in_betweens(playback):
    before, after = playback.snapshots[2:4]
    middle = playback.frame(0.5 * (before.time + after.time)).pose
    np.testing.assert_array_equal(playback.frame(before.time).pose, before.state.positions)
    np.testing.assert_array_equal(playback.frame(after.time).pose, after.state.positions)
    moved = np.abs(after.state.positions - before.state.positions).max()
    mean = 0.5 * (before.state.positions + after.state.positions)
    assert moved > 1
    assert np.abs(middle - mean).max() < 0.1 * moved, "on an arc near the chord's middle"


def test_another_session_starts_anew(playback, new_driver):
    other = new_driver()
    playback.follow(other.session)
    assert [snapshot.state for snapshot in playback.snapshots] == [other.state]
    playback.follow(None)
    assert playback.snapshots == []


def test_long_sessions_keep_to_their_memory(playback, pinned, clock, monkeypatch):
    size = pinned.state.positions.nbytes
    monkeypatch.setattr("akap_editor.editor.animation.session_playback.MAX_BYTES", 20 * size)
    for step in range(100):
        clock.now += 0.1
        gestures.set_pose(pinned.editor, pinned.state.positions + 0.01 * step)
        playback.follow(pinned.session)
    assert len(playback.snapshots) <= 20
    assert playback.snapshots[0].time == 0
    assert playback.snapshots[-1].state is pinned.state


def test_the_pose_between_two_is_looked_at_and_taken(pinned, drawing):
    session, pose_blend = pinned.session, PoseBlend()
    assert pose_blend.pose(session) is None
    gestures.add_pose(pinned.editor, "Rest")
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    gestures.add_pose(pinned.editor, "Bent")
    now, events = bits(session.state), len(session.recording.events)
    for share in (0.0, 0.4, 1.0):
        pose_blend.share = share
        pose_blend.preview(session)
    np.testing.assert_array_equal(session.state.positions, session.state.poses[1].positions)
    session.end_preview()
    assert bits(session.state) == now
    assert len(session.recording.events) == events
    pose_blend.share = 0.5
    pose_blend.preview(session)
    gestures.set_pose(pinned.editor, pose_blend.pose(session), "Apply Blend")
    assert bits(recorded(session, drawing)) == bits(session.state)
    session.undo()
    assert bits(session.state) == now
