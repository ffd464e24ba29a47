"""The part of a session that becomes keyframes."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from akap_editor.editor.animation.keyframing.take import take_poses
from akap_editor.editor.animation.session_playback import Snapshot
from akap_editor.errors import InputError


@pytest.fixture
def snapshots(pinned):
    """A drawing that moves to the right by a pixel in each of 100 frames a second, and jumps at 0.5 s."""
    state, drawing = pinned.session.state, pinned.session.drawing
    return [
        Snapshot(
            number / 100,
            number,
            replace(state, positions=state.positions + np.array([float(number), 0.0])),
            drawing,
            int(number >= 50),
        )
        for number in range(101)
    ]


def test_poses_are_thinned_and_both_sides_of_a_jump_are_kept(snapshots, pinned):
    poses = take_poses(snapshots, 0.2, 0.9, pinned.session.drawing)
    times = [pose.time for pose in poses]
    assert times[0] == 0
    assert times[-1] == 0.7
    assert {0.29, 0.3} <= set(times)
    assert [pose.time for pose in poses if pose.is_jump] == [0.3]
    assert all(later - earlier >= 0.009 for earlier, later in pairwise(times))
    assert 15 < len(times) < 25
    np.testing.assert_array_equal(poses[-1].positions, snapshots[90].state.positions)


def test_poses_at_one_time_stay_in_order(snapshots, pinned):
    same = [replace(each, time=0.5, discontinuities=number) for number, each in enumerate(snapshots[:5])]
    times = [pose.time for pose in take_poses(same, 0.0, 1.0, pinned.session.drawing)]
    assert times == [0.5, 0.501, 0.502, 0.503, 0.504]


def test_what_does_not_move_or_had_another_mesh_is_refused(snapshots, pinned):
    drawing = pinned.session.drawing
    with pytest.raises(InputError, match="does not move"):
        take_poses(snapshots[:1], 0.0, 1.0, drawing)
    with pytest.raises(InputError, match="does not move"):
        take_poses([], 0.0, 1.0, drawing)
    other = replace(drawing)
    with pytest.raises(InputError, match="another mesh"):
        take_poses(snapshots, 0.0, 1.0, other)
