"""Loose parts in motions: the same at a time however it is reached, and at rest the pose itself."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.deform.follow_through import STEP_SECONDS
from akap_editor.editor.animation.loose_motion import AnimationFrames, Instant, LooseCanvas, LooseMotion
from akap_editor.editor.animation.motion import Motion
from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.document.rig.loose_parts import LooseParts
from akap_editor.editor.session.edits import PaintLoose, SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.geometry.mesh import signed_areas
from tests.support.editor_driver import Ticks


@pytest.fixture
def loose(drawing) -> Document:
    """The figure with a loose right end, and keyframes that move it up quickly."""
    document = new_document(drawing)
    mesh = drawing.mesh
    x = mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    up = mesh.vertices - [0.0, 12.0]
    keyframes = Keyframe(0.0, mesh.vertices), Keyframe(0.2, up), Keyframe(8.0, up)
    state = replace(document.state, animation=Animation(keyframes), loose=LooseParts(x > 75))
    return document.with_state(state)


def test_a_pose_depends_on_its_time_only(loose: Document) -> None:
    times = [0.1, 0.21, 0.25, 0.4, 1.0, 4.2, 7.9]
    forwards = AnimationFrames(loose)
    poses = [forwards.frame(time).pose for time in times]
    for fps in (24, 60):
        played = AnimationFrames(loose)
        for time in np.arange(0, 1, 1 / fps):
            played.frame(float(time))
        for time, pose in zip(reversed(times), reversed(poses), strict=True):
            np.testing.assert_array_equal(played.frame(time).pose, pose)
    plain = AnimationFrames(loose.with_state(replace(loose.state, loose=None)))
    lags = [np.abs(plain.frame(time).pose - pose).max() for time, pose in zip(times, poses, strict=True)]
    assert max(lags[:4]) > 2
    assert lags[-2:] == [0.0, 0.0], "at rest it is the pose exactly"
    areas = [signed_areas(pose, loose.drawing.mesh.faces).min() for pose in poses]
    assert min(areas) > 0


def test_chunks_join_without_a_jump(loose: Document) -> None:
    """A swing that goes on across the beginning of a chunk, at 4 s, looks as if there was none."""
    mesh = loose.drawing.mesh

    def at(time: float) -> Instant:
        return Instant(loose.drawing, loose.state, mesh.vertices + np.array([0.0, 6 * np.sin(9 * time)]))

    motion = LooseMotion(at)
    steps = [motion.pose(k * STEP_SECONDS) for k in range(236, 246)]
    assert all(step is not None for step in steps)
    second = np.abs(np.diff(np.array(steps), n=2, axis=0)).max(axis=(1, 2))
    assert second[3:5].max() < 1.5 * max(second[0], second[-1])


def test_a_loop_swings_on_over_its_seam(loose: Document) -> None:
    mesh = loose.drawing.mesh
    up = Keyframe(0.21, mesh.vertices - [0.0, 12.0])
    keyframes = Keyframe(0.0, mesh.vertices), up, Keyframe(0.5, mesh.vertices)
    looped = loose.with_state(replace(loose.state, animation=Animation(keyframes, loop=True)))
    frames = AnimationFrames(looped)
    at_seam = frames.frame(0.0).pose
    assert np.abs(at_seam - mesh.vertices).max() > 0.5, "it swings"
    np.testing.assert_array_equal(frames.frame(0.5).pose, at_seam)
    times = np.arange(-12, 13) / 100
    second = np.diff([frames.frame(time % 0.5).pose for time in times.tolist()], n=2, axis=0)
    jerks = np.abs(second).max(axis=(1, 2))
    assert jerks[10:13].max() < 1.5 * np.median(jerks)
    np.testing.assert_array_equal(frames.frame(0.6).pose, mesh.vertices)
    once = AnimationFrames(
        looped.with_state(replace(looped.state, animation=Animation(keyframes, loop=False)))
    )
    np.testing.assert_array_equal(once.frame(0.0).pose, mesh.vertices)


def test_the_canvas_swings_until_it_settles_and_not_after_undo(loose: Document) -> None:
    now = [0.0]
    canvas = LooseCanvas(lambda: now[0])
    state, mesh = loose.state, loose.drawing.mesh
    assert canvas.pose(loose.drawing, state) is state.positions
    assert not canvas.is_moving
    moved = replace(state, positions=mesh.vertices + np.array([0.0, 8.0]))
    shown = canvas.pose(loose.drawing, moved)
    assert np.abs(shown - moved.positions).max() > 1
    assert canvas.pose(loose.drawing, moved) is shown, "no step is due yet"
    frames = 0
    while canvas.is_moving:
        now[0] += 0.017
        shown = canvas.pose(loose.drawing, moved)
        frames += 1
        assert frames < 500
    assert frames > 10
    assert shown is moved.positions
    assert canvas.pose(loose.drawing, state, discontinuities=1) is state.positions
    assert not canvas.is_moving


def test_a_swing_goes_on_until_the_moment_at_which_a_pin_is_added(drawing) -> None:
    """A recording has no events in the pause before it."""
    ticks = Ticks()
    session = Session(new_document(drawing), ticks)
    session.begin("Drag")
    add_pin(session, (20.0, 40.0))
    session.apply(PaintLoose([(100.0, 40.0), (110.0, 40.0)], 20.0))
    session.apply(SetTargets({1: (20.0, 70.0)}))
    session.settle()
    session.commit()
    end = session.recording.duration
    ticks.now += 2.0
    add_pin(session, (40.0, 40.0))
    recording, times = session.recording, end + np.arange(0.05, 0.3, 0.05)
    plain = session.state.positions
    lags = [
        np.abs(frame.pose - plain).max()
        for frame in Motion(drawing, replay(recording, drawing)).frames(times)
    ]
    assert min(lags) > 0.02


def test_a_recording_is_replayed_with_its_loose_parts(drawing) -> None:
    session = Session(new_document(drawing), Ticks())
    session.begin("Drag")
    add_pin(session, (20.0, 40.0))
    session.apply(PaintLoose([(100.0, 40.0), (110.0, 40.0)], 20.0))
    session.apply(SetTargets({1: (20.0, 70.0)}))
    session.settle()
    session.commit()
    recording = session.recording
    times = np.arange(0, recording.duration + 0.5, 1 / 30).tolist()
    frames = list(Motion(drawing, replay(recording, drawing)).frames(times))
    fewer = list(Motion(drawing, replay(recording, drawing)).frames(times[::2]))
    for one, other in zip(frames[::2], fewer, strict=True):
        np.testing.assert_array_equal(one.pose, other.pose)
    plain = [each.state.positions for each in replay(recording, drawing)][-1]
    assert any(np.abs(frame.pose - plain).max() > 0 for frame in frames)
