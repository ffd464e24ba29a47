from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.animation.motion import MAX_MOVE_SECONDS, Motion, shorten_pauses
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import SetPins, SetPose
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import Recording
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session

END = (105.0, 40.0)


def motion(recording, drawing, change=None):
    return Motion(drawing, replay(recording, drawing, change))


def poses(recording, drawing, times, change=None):
    return [frame.pose for frame in motion(recording, drawing, change).frames(times)]


@pytest.fixture
def slow(pinned):
    """A recording of few steps a second: the neck's end is moved around an arc in 12 steps of 1/12 s."""
    session = pinned.session
    recording = Recording(session.recording.header, list(session.recording.events))
    start = recording.duration
    for step in range(1, 13):
        angle = np.pi / 3 * step / 12
        at = [62 + 43 * np.cos(angle), 40 + 43 * np.sin(angle)]
        t = start + step / 12
        recording.events += [{"t": t, "do": "targets", "targets": {"3": at}}]
        recording.events += [{"t": t, "do": "step"}] * 3
    return recording


def test_at_recorded_times_the_pose_is_the_recorded_one_to_the_last_bit(slow, drawing):
    recorded = {moment.time: moment.state.positions for moment in replay(slow, drawing)}
    for time, pose in zip(recorded, poses(slow, drawing, recorded), strict=True):
        np.testing.assert_array_equal(pose, recorded[time])


def test_twelve_recorded_steps_a_second_play_as_sixty_along_arcs(slow, drawing):
    """Between recorded times the movement is divided evenly, and edges keep their lengths."""
    start = slow.duration - 1
    times = [start + frame / 60 for frame in range(61)]
    seen = np.array(poses(slow, drawing, times))
    ways = np.linalg.norm(np.diff(seen, axis=0), axis=2).max(axis=1)
    assert ways.min() > 0
    between = [ways[k : k + 5].max() / ways[k : k + 5].sum() for k in range(0, 60, 5)]
    assert max(between) < 0.4, "a fifth each, where all were alike"
    i, j = drawing.mesh.edges.T
    lengths = np.linalg.norm(seen[:, i] - seen[:, j], axis=2)
    size = lengths.sum(axis=1)
    shorter = np.minimum(size[:-5:5], size[5::5]).repeat(5)
    assert (size[:-1] / shorter).min() > 0.999


def test_a_method_without_trajectories_is_filled_in_by_rotating_edges(slow, drawing):
    start = slow.duration - 1
    times = [start + frame / 24 for frame in range(25)]
    rigid = poses(slow, drawing, times, lambda _: Settings("arap", ()))
    for before, middle, after in zip(rigid[0:-2:2], rigid[1:-1:2], rigid[2::2], strict=True):
        assert 0 < np.abs(middle - before).max() <= np.abs(after - before).max() * 1.01


def test_what_moved_after_a_pause_moved_in_the_last_of_it(slow, drawing):
    late = Recording(
        slow.header, [{**e, "t": e["t"] + (10 if e["t"] > 0.99 * slow.duration else 0)} for e in slow.events]
    )
    end = late.duration
    still, almost, moved = poses(
        late, drawing, [end - MAX_MOVE_SECONDS - 1, end - MAX_MOVE_SECONDS, end - 0.1]
    )
    np.testing.assert_array_equal(still, almost)
    assert np.abs(moved - still).max() > 0.1


def test_a_pose_that_was_set_comes_at_once(pinned, drawing):
    session = pinned.session
    session.begin("Pose")
    session.apply(SetPose(drawing.mesh.vertices + 5.0))
    session.commit()
    t = next(event["t"] for event in session.recording.events if event["do"] == "pose")
    before, then = poses(session.recording, drawing, [t - 1e-4, t])
    np.testing.assert_array_equal(before, drawing.mesh.vertices)
    np.testing.assert_array_equal(then, drawing.mesh.vertices + 5.0)


def test_pauses_are_shortened_and_nothing_else():
    events = [{"t": t, "do": "step"} for t in (0.0, 0.5, 5.5, 6.0, 100.0)]
    short = shorten_pauses(Recording({}, events), 1.0)
    assert [event["t"] for event in short.events] == [0.0, 0.5, 1.5, 2.0, 3.0]
    assert events[-1]["t"] == 100.0


def test_frames_are_drawn_in_the_order_that_depths_ask_for(drawing):
    session = Session(new_document(drawing))
    session.begin("Pins")
    left, right = drawing.mesh.vertices.min(axis=0), drawing.mesh.vertices.max(axis=0)
    middle = drawing.mesh.vertices[drawing.mesh.faces].mean(axis=1)
    near = [middle[np.argmin(np.hypot(*(middle - place).T))] for place in (left, right)]
    ids = [add_pin(session, tuple(place)) for place in near]
    session.apply(SetPins(tuple(replace(pin, depth=2 * (pin.id == ids[0])) for pin in session.state.pins)))
    session.commit()
    recorded = session.recording
    frames = list(motion(recorded, drawing, None).frames([0.0, recorded.duration + 1.0]))
    assert frames[0].order is None
    assert frames[1].order.tolist() == session.document.face_order.tolist()
