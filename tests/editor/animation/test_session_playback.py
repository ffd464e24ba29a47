"""The session looked at again: nothing is edited by looking, and going on from there branches."""

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
def player(pinned, clock):
    """Has watched a drag, a shot every twentieth of a second after a long pause."""
    player = SessionPlayback(clock)
    player.follow(pinned.session)
    clock.now += 100
    pinned.press(END)
    pinned.move((90.0, 60.0))
    while pinned.editor.is_moving:
        pinned.advance()
        player.follow(pinned.session)
        clock.now += 0.05
    pinned.release((90.0, 60.0))
    player.follow(pinned.session)
    return player


def recorded(session, drawing):
    *_, last = replay(parse_recording(session.recording.to_text()), drawing)
    return last.state


def test_pauses_are_shortened_and_every_state_is_there(player, pinned, drawing):
    times = [shot.time for shot in player.snapshots]
    assert times == sorted(times)
    assert times[0] == 0
    assert times[1] == MAX_PAUSE_SECONDS
    assert len(times) > 5
    assert np.diff(times[1:]).max() <= 0.06
    np.testing.assert_array_equal(player.snapshots[0].state.positions, drawing.mesh.vertices)
    assert player.snapshots[-1].state is pinned.state


def test_scrubbing_shows_every_moment_and_changes_nothing(player, pinned):
    session, now = pinned.session, bits(pinned.state)
    lines, depth, modified = len(session.recording.events), session.history.depth, session.is_modified
    for shot in [*player.snapshots[:-1], *reversed(player.snapshots[:-1])]:
        player.scrub(shot.time)
        assert bits(session.state) == bits(shot.state)
        assert session.is_previewing
        player.follow(session)
    player.scrub(player.duration)
    assert not session.is_previewing
    assert bits(session.state) == now
    assert (len(session.recording.events), session.history.depth, session.is_modified) == (
        lines,
        depth,
        modified,
    )


def test_dragging_from_an_earlier_moment_branches(player, pinned, drawing):
    session, old = pinned.session, bits(pinned.state)
    before = player.snapshots[: len(player.snapshots) // 2 + 1]
    middle = before[-1]
    player.scrub(middle.time)
    start = pinned.where(3)
    pinned.drag(start, (start[0] - 5, start[1] - 30))
    player.follow(session)
    pinned.settle()
    player.follow(session)
    assert player.time is None
    assert player.snapshots[: len(before)] == before
    assert len(player.snapshots) > len(before)
    assert bits(recorded(session, drawing)) == bits(session.state)
    session.undo()
    assert bits(session.state) == bits(middle.state)
    session.undo()
    assert bits(session.state) == old, "the old branch"
    assert bits(recorded(session, drawing)) == old


def test_looking_does_not_change_the_last_bits_of_what_comes_after(player, pinned, drawing):
    session = pinned.session
    for number in range(4):
        for shot in player.snapshots[:: 3 + number]:
            player.scrub(shot.time)
        player.show_present()
        start = pinned.where(3)
        pinned.press(start)
        pinned.move((start[0] + (-8) ** (number % 2) * 2, start[1] - 9.0))
        for _ in range(3):
            pinned.advance()
            player.follow(session)
        pinned.release((start[0], start[1] - 9.0))
        player.follow(session)
        assert bits(recorded(session, drawing)) == bits(session.state)


def test_a_pose_that_is_settling_goes_on_after_a_look_back(player, pinned, drawing):
    session = pinned.session
    start = pinned.where(3)
    pinned.press(start)
    pinned.move((start[0] - 20.0, start[1] + 25.0))
    pinned.release((start[0] - 20.0, start[1] + 25.0))
    player.follow(session)
    assert session.is_moving
    player.scrub(0.0)
    assert not session.is_moving
    player.show_present()
    assert session.is_moving
    pinned.click((30.0, 40.0))
    assert bits(recorded(session, drawing)) == bits(session.state)


def test_undo_while_looking_undoes_from_the_present(player, pinned, drawing):
    player.scrub(player.duration / 2)
    pinned.undo()
    assert not pinned.session.is_previewing
    assert bits(recorded(pinned.session, drawing)) == bits(pinned.state)
    np.testing.assert_array_equal(pinned.state.positions, drawing.mesh.vertices)


def test_playing_goes_through_the_range_and_stops_or_starts_over(player, pinned, clock):
    player.mark_range(1.0, 1.2)
    player.loop = False
    player.toggle_playing()
    assert player.is_playing
    assert player.time == 1.0
    clock.now += 0.1
    player.advance()
    assert player.time == pytest.approx(1.1)
    clock.now += 1
    player.advance()
    assert not player.is_playing
    assert player.time == 1.2
    player.loop = True
    player.toggle_playing()
    clock.now += 0.25
    player.advance()
    assert player.time == pytest.approx(1.05), "it starts over without losing time"
    player.toggle_playing()
    assert not player.is_playing


def test_a_take_is_the_part_between_its_ends(player, pinned, clock):
    before = player.duration
    player.start_take()
    pinned.press((90.0, 60.0))
    pinned.move((95.0, 50.0))
    for _ in range(5):
        clock.now += 0.05
        pinned.advance()
        player.follow(pinned.session)
    pinned.release((95.0, 50.0))
    player.end_take()
    assert player.marked_range == (before, player.duration)
    assert player.duration > before


@pytest.mark.parametrize(("start", "end"), [(2.0, 1.0), (5.0, 5.0)])
def test_an_empty_range_is_all_there_is(player, start, end):
    player.mark_range(start, end)
    assert player.played_range == (0.0, player.duration)


def test_frames_between_shots_are_in_betweens(player):
    before, after = player.snapshots[2:4]
    middle = player.frame(0.5 * (before.time + after.time)).pose
    np.testing.assert_array_equal(player.frame(before.time).pose, before.state.positions)
    np.testing.assert_array_equal(player.frame(after.time).pose, after.state.positions)
    moved = np.abs(after.state.positions - before.state.positions).max()
    mean = 0.5 * (before.state.positions + after.state.positions)
    assert moved > 1
    assert np.abs(middle - mean).max() < 0.1 * moved, "on an arc near the chord's middle"


def test_another_session_starts_anew(player, new_driver):
    other = new_driver()
    player.follow(other.session)
    assert [shot.state for shot in player.snapshots] == [other.state]
    player.follow(None)
    assert player.snapshots == []


def test_long_sessions_keep_to_their_memory(player, pinned, clock, monkeypatch):
    size = pinned.state.positions.nbytes
    monkeypatch.setattr("akap_editor.editor.animation.session_playback.MAX_BYTES", 20 * size)
    for step in range(100):
        clock.now += 0.1
        gestures.set_pose(pinned.editor, pinned.state.positions + 0.01 * step)
        player.follow(pinned.session)
    assert len(player.snapshots) <= 20
    assert player.snapshots[0].time == 0
    assert player.snapshots[-1].state is pinned.state


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
