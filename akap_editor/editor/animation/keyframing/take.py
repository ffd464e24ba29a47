"""The poses of a part of the session, to be made into keyframes."""

from collections.abc import Sequence

import numpy as np

from ....errors import InputError
from ....words import tr
from ...document.drawing import Drawing
from ...document.keyframes import TIME_DECIMALS
from ..frames import POSE_TOLERANCE
from ..session_playback import Snapshot
from .simplification import TakePose

_MIN_DISTANCE = 1 / 30  # seconds between poses; a hand moves no faster
_MIN_STEP = 10.0**-TIME_DECIMALS


def take_poses(snapshots: Sequence[Snapshot], start: float, end: float, drawing: Drawing) -> list[TakePose]:
    """The poses of a session from ``start`` to ``end`` seconds, at most 30 a second, and all jumps.

    The first has the time 0. Raises InputError if the drawing had another mesh in that time, or if it did
    not move.
    """
    before = [each for each in snapshots if each.time <= start][-1:]
    part = before + [each for each in snapshots if start < each.time <= end]
    if any(each.drawing is not drawing for each in part):
        raise InputError(tr("The take has poses of another mesh; set a range after the change of the mesh"))
    poses: list[TakePose] = []
    for number, (snapshot, last) in enumerate(zip(part, [*part[:1], *part], strict=False)):
        time = round(max(snapshot.time - start, 0.0), TIME_DECIMALS)
        if poses:
            time = max(time, round(poses[-1].time + _MIN_STEP, TIME_DECIMALS))
        is_jump = number > 0 and snapshot.discontinuities != last.discontinuities
        poses.append(TakePose(time, snapshot.state.positions, snapshot.state.crossings, is_jump))
    first = poses[0].positions if poses else None
    if first is None or all(np.abs(pose.positions - first).max() <= POSE_TOLERANCE for pose in poses):
        raise InputError(tr("The drawing does not move in this part of the session"))
    return _thinned(poses)


def _thinned(poses: Sequence[TakePose]) -> list[TakePose]:
    """Poses at a distance in time, with the first, the last, and those on both sides of a jump."""
    kept = [poses[0]]
    for pose, following in zip(poses[1:], [*poses[2:], None], strict=True):
        is_needed = pose.is_jump or following is None or following.is_jump
        if is_needed or pose.time - kept[-1].time >= _MIN_DISTANCE:
            kept.append(pose)
    return kept
