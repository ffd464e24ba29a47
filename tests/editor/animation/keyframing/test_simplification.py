"""Few keyframes of a take, which stay within the tolerance of all its poses."""

import numpy as np
import pytest

from akap_editor.editor.animation.keyframe_poses import KeyframePoses
from akap_editor.editor.animation.keyframing.simplification import Simplification, TakePose
from akap_editor.editor.document.crossings import no_crossings
from akap_editor.editor.document.keyframes import Animation
from akap_editor.geometry.mesh import TriMesh


@pytest.fixture(scope="module")
def mesh():
    """Two faces of a square."""
    square = np.array([[0.0, 0.0], [10, 0], [10, 10], [0, 10]])
    return TriMesh(square, np.array([[0, 1, 2], [0, 2, 3]]))


def take(mesh, moves, jumps=()):
    """Poses at 20 a second, moved to the right by so many pixels."""
    return [
        TakePose(number / 20, mesh.vertices + np.array([move, 0.0]), no_crossings(), number in jumps)
        for number, move in enumerate(moves)
    ]


def simplified(mesh, poses, tolerance):
    simplification = Simplification(mesh, poses)
    assert simplification.count(tolerance) is None
    for _ in simplification.refine(tolerance):
        pass
    return simplification


WAVE = 60 * np.sin(np.linspace(0, 7, 90)) + 8 * np.sin(np.linspace(0, 40, 90))


@pytest.mark.parametrize("tolerance", [0.5, 2.0, 10.0])
def test_the_motion_through_the_keyframes_is_within_the_tolerance_of_all_poses(mesh, tolerance):
    poses = take(mesh, WAVE)
    keyframes = simplified(mesh, poses, tolerance).keyframes(tolerance, start=1.5)
    animation, between = Animation(tuple(keyframes), "in-out", False), KeyframePoses()
    for pose in poses:
        shown = between.moment(mesh, animation, 1.5 + pose.time).pose
        assert np.linalg.norm(shown - pose.positions, axis=1).max() <= tolerance + 1e-6
    assert keyframes[0].time == 1.5
    assert 2 < len(keyframes) < 60


def test_a_lower_tolerance_adds_keyframes_and_keeps_the_others(mesh):
    poses = take(mesh, WAVE)
    simplification = simplified(mesh, poses, 0.5)
    times = {}
    for tolerance in (0.5, 2.0, 10.0):
        times[tolerance] = [each.time for each in simplification.keyframes(tolerance)]
        assert len(times[tolerance]) == simplification.count(tolerance)
        alone = simplified(mesh, poses, tolerance)
        assert times[tolerance] == [each.time for each in alone.keyframes(tolerance)]
    assert set(times[10.0]) < set(times[2.0]) < set(times[0.5])
    assert simplification.count(0.1) is None, "it has not come so far"


def test_a_refinement_that_was_abandoned_is_taken_up_again(mesh):
    poses = take(mesh, WAVE)
    simplification = Simplification(mesh, poses)
    for _, _ in zip(range(130), simplification.refine(8.0), strict=False):
        pass
    for _ in simplification.refine(2.0):
        pass
    assert simplification.count(2.0) == simplified(mesh, poses, 2.0).count(2.0)


def test_a_pose_that_appears_at_once_is_held_before(mesh):
    moves = [0.0] * 10 + [50.0] * 10
    keyframes = simplified(mesh, take(mesh, moves, jumps={10}), 1.0).keyframes(1.0)
    assert [(each.time, each.ease) for each in keyframes] == [
        *((0.0, "smooth"), (0.45, "hold")),
        *((0.5, "smooth"), (0.95, "smooth")),
    ]
