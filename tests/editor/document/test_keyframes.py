"""Keyframes and the animations made of them: adding, moving, deleting, easing, and what lies between."""

import numpy as np
import pytest

from akap_editor.editor.document.keyframes import Animation, Keyframe, as_keyframe_time
from akap_editor.errors import InputError


def pose(x):
    """A pose of three vertices that can be told by its x."""
    return np.full((3, 2), float(x))


@pytest.fixture
def animation():
    """Keyframes at 0, 1 and 3 seconds; the second one holds."""
    return Animation((Keyframe(0.0, pose(0)), Keyframe(1.0, pose(1), "hold"), Keyframe(3.0, pose(3))), "none")


def listed(animation):
    """Time, x of the pose and easing of each keyframe."""
    return [(key.time, key.positions[0, 0], key.ease) for key in animation.keyframes]


@pytest.mark.parametrize(
    ("time", "start", "end", "share"),
    [
        (-1.0, 0, 0, 0.0),
        (0.0, 0, 1, 0.0),
        (0.25, 0, 1, 0.25),
        (1.0, 1, 3, 0.0),
        (2.9, 1, 3, 0.0),
        (3.0, 3, 3, 0.0),
        (9.0, 3, 3, 0.0),
    ],
)
def test_the_keyframes_around_a_time(animation, time, start, end, share):
    before, after, eased_share = animation.keyframes_around(time)
    assert (before.time, after.time) == (start, end)
    assert eased_share == pytest.approx(share)


def test_a_keyframe_replaces_one_at_its_time_and_keeps_its_easing(animation):
    assert listed(animation.with_keyframe(Keyframe(2.0, pose(9)))) == [
        (0.0, 0, None),
        (1.0, 1, "hold"),
        (2.0, 9, None),
        (3.0, 3, None),
    ]
    assert listed(animation.with_keyframe(Keyframe(1.0, pose(9))))[1] == (1.0, 9, "hold")
    assert listed(animation.with_keyframe(Keyframe(1.0, pose(9), "in")))[1] == (1.0, 9, "in")
    assert len(animation.keyframes) == 3


def test_deleting_ignores_times_without_a_keyframe(animation):
    assert animation.without_keyframes([1.0, 2.0]).times == (0.0, 3.0)
    assert animation.without_keyframes(animation.times).duration == 0.0


def test_moving_replaces_keyframes_that_are_there_and_copying_leaves_the_originals(animation):
    assert listed(animation.with_moved_keyframes({0.0: 3.0, 7.0: 8.0})) == [(1.0, 1, "hold"), (3.0, 0, None)]
    assert animation.with_moved_keyframes({0.0: 1.0, 1.0: 0.0}).keyframes[0].ease == "hold", "they may swap"
    copied = animation.with_moved_keyframes({1.0: 2.0}, copy=True)
    assert listed(copied)[1:3] == [(1.0, 1, "hold"), (2.0, 1, "hold")]


def test_easing_of_keyframes_or_of_the_animation(animation):
    assert [key.ease for key in animation.with_easing([0.0, 1.0], "in").keyframes] == ["in", "in", None]
    general = animation.with_easing(None, "out")
    assert (general.ease, listed(general)) == ("out", listed(animation))
    with pytest.raises(InputError, match="ease: expected one of"):
        animation.with_easing(None, None)


def test_keyframes_that_share_a_pose_share_the_changed_one():
    shared = Keyframe(0.0, pose(0)).positions
    animation = Animation((Keyframe(0.0, shared), Keyframe(1.0, shared), Keyframe(2.0, pose(2))))
    first, second, third = animation.map_poses(lambda positions: positions + 5).keyframes
    assert first.positions is second.positions
    assert (first.positions[0, 0], third.positions[0, 0]) == (5.0, 7.0)


def test_times_are_whole_milliseconds():
    assert as_keyframe_time(0.12345) == 0.123
    assert Keyframe(1 / 3, pose(0)).time == 0.333


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda pose: Keyframe(-1, pose), "time of a keyframe: expected"),
        (lambda pose: Keyframe(1e9, pose), "time of a keyframe: expected"),
        (lambda pose: Keyframe(0, pose, "up"), "ease: expected one of"),
        (lambda pose: Keyframe(0, pose[:, :1]), "keyframe: expected"),
        (lambda pose: Animation((Keyframe(1, pose), Keyframe(0, pose))), "times that grow"),
        (lambda pose: Animation((Keyframe(1, pose), Keyframe(1, pose))), "times that grow"),
        (lambda pose: Animation(ease="up"), "ease: expected one of"),
    ],
)
def test_bad_keyframes_are_refused(drawing, make, message):
    with pytest.raises(InputError, match=message):
        make(drawing.mesh.vertices)
