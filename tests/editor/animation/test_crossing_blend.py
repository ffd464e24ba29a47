"""Between two poses that disagree on what is in front, the change is where they overlap least."""

from itertools import pairwise

import numpy as np

from akap_editor.editor.animation.crossing_blend import CrossingBlend
from akap_editor.editor.document.crossings import overlaps_of
from akap_editor.editor.document.keyframes import Keyframe
from akap_editor.overlap.overlaps import asked_overlaps, next_overlaps, no_overlaps
from tests.overlap.test_overlaps import ROPE, decided, rope_pose


def test_both_poses_decide_and_what_they_disagree_on_changes_once() -> None:
    overlaps = no_overlaps(ROPE)
    for share in np.linspace(0, 1, 41)[1:]:
        overlaps = next_overlaps(ROPE, rope_pose(share), overlaps)
    pose = rope_pose(1.0)
    middles = ROPE.vertices[ROPE.faces].mean(axis=1)[:, 0]
    low, _ = overlaps.low_and_high
    mine = overlaps.pairs.regions == 0
    limb = np.abs(middles - middles[low[mine]].mean()) < 60
    turned = asked_overlaps(ROPE, pose, overlaps, limb, to_front=True)
    start, end = (Keyframe(k, pose, None, each.crossings) for k, each in enumerate((overlaps, turned)))

    def pose_at(share: float) -> np.ndarray:
        """Crossed at both ends, and nearly open at 70 %."""
        return rope_pose(1.0 - 0.3 * np.exp(-(((share - 0.7) / 0.2) ** 2)))

    blend, states = CrossingBlend(), []
    for share in np.linspace(0, 1, 21):
        found, crossings = blend.crossings(ROPE, (), start, end, float(share), pose_at)
        pairs = decided(overlaps_of(ROPE, (), found, crossings))
        ends = len(pairs & decided(overlaps)), len(pairs & decided(turned))
        states.append((float(share), ends[0] >= ends[1], len(pairs & (decided(overlaps) ^ decided(turned)))))
    at_start = [first for _, first, disputed in states if disputed]
    assert at_start[0]
    assert not at_start[-1]
    changes = [share for (share, a, _), (_, b, _) in pairwise(states) if a != b]
    assert len(changes) == 1
    assert 0.5 < changes[0] < 0.9
