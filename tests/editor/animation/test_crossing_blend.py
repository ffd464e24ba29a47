"""Between two poses that disagree on what is in front, the change is where they overlap least."""

from itertools import pairwise

import numpy as np
import pytest

from akap_editor.editor.animation.crossing_blend import CrossingBlend
from akap_editor.editor.document.crossings import overlaps_of
from akap_editor.editor.document.keyframes import Keyframe
from akap_editor.overlap.overlaps import Overlaps, asked_overlaps, next_overlaps, no_overlaps
from tests.overlap.test_overlaps import ROPE, decided, rope_pose


@pytest.fixture(scope="module")
def turned() -> tuple[Overlaps, Overlaps]:
    """Overlaps of the rope crossed, and those with one of its crossings turned over."""
    overlaps = no_overlaps(ROPE)
    for share in np.linspace(0, 1, 41)[1:]:
        overlaps = next_overlaps(ROPE, rope_pose(share), overlaps)
    pose = rope_pose(1.0)
    middles = ROPE.vertices[ROPE.faces].mean(axis=1)[:, 0]
    low, _ = overlaps.low_and_high
    mine = overlaps.pairs.regions == 0
    limb = np.abs(middles - middles[low[mine]].mean()) < 60
    return overlaps, asked_overlaps(ROPE, pose, overlaps, limb, to_front=True)


def keyframes(overlaps: tuple[Overlaps, Overlaps]) -> tuple[Keyframe, Keyframe]:
    """Keyframes of the crossed rope at 0 and 1 second."""
    start, end = (Keyframe(k, rope_pose(1.0), None, each.crossings) for k, each in enumerate(overlaps))
    return start, end


def test_both_poses_decide_and_what_they_disagree_on_changes_once(turned: tuple[Overlaps, Overlaps]) -> None:
    first, second = turned
    ends = keyframes(turned)

    def pose_at(share: float) -> np.ndarray:
        """Crossed at both ends, and nearly open at 70 %."""
        return rope_pose(1.0 - 0.3 * np.exp(-(((share - 0.7) / 0.2) ** 2)))

    blend, states = CrossingBlend(), []
    for share in np.linspace(0, 1, 21):
        found, crossings = blend.crossings(ROPE, (), *ends, float(share), pose_at)
        pairs = decided(overlaps_of(ROPE, (), found, crossings))
        counts = len(pairs & decided(first)), len(pairs & decided(second))
        states.append((float(share), counts[0] >= counts[1], len(pairs & (decided(first) ^ decided(second)))))
    at_start = [is_first for _, is_first, disputed in states if disputed]
    assert at_start[0]
    assert not at_start[-1]
    changes = [share for (share, a, _), (_, b, _) in pairwise(states) if a != b]
    assert len(changes) == 1
    assert 0.5 < changes[0] < 0.9


def test_where_nothing_moves_the_change_is_at_the_end(turned: tuple[Overlaps, Overlaps]) -> None:
    blend, first, second = CrossingBlend(), *turned
    for share, expected in ((0.0, first), (0.05, first), (0.5, first), (0.99, first), (1.0, second)):
        pose, crossings = blend.crossings(ROPE, (), *keyframes(turned), share, lambda _: rope_pose(1.0))
        assert decided(overlaps_of(ROPE, (), pose, crossings)) == decided(expected)
