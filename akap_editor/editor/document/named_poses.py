"""Poses that a drawing remembers by name."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...geometry.validation import Floats, as_points, frozen

MAX_POSE_NAME = 80


def as_pose(value: ArrayLike, name: str, count: int | None = None) -> Floats:
    """``value`` as a frozen pose (n, 2) float64; itself where it is one, so that poses are told by identity.

    Raises InputError on another shape, another count where one is given, or numbers that are not finite.
    """
    pose = as_points(value, name, count)
    if isinstance(value, np.ndarray) and value.dtype == np.float64 and not value.flags.writeable:
        return value
    return frozen(pose)


@dataclass(frozen=True, eq=False)
class NamedPose:
    """name: not empty, unique in its drawing; positions: (n, 2) float64 of the mesh's vertices, in pixels."""

    name: str
    positions: Floats

    def __post_init__(self) -> None:
        if not self.name.strip() or len(self.name) > MAX_POSE_NAME:
            raise InputError(
                f"pose: expected a name of 1 to {MAX_POSE_NAME} characters, got {self.name[:99]!r}"
            )
        object.__setattr__(self, "positions", as_pose(self.positions, "pose"))


def with_pose(poses: Sequence[NamedPose], pose: NamedPose) -> tuple[NamedPose, ...]:
    """These poses and another one, in the place of one of the same name."""
    if any(each.name == pose.name for each in poses):
        return tuple(pose if each.name == pose.name else each for each in poses)
    return (*poses, pose)


def unused_pose_name(poses: Sequence[NamedPose]) -> str:
    """Pose 1, Pose 2, ...: the first that is not taken."""
    taken = {pose.name for pose in poses}
    return next(name for number in range(1, len(taken) + 2) if (name := f"Pose {number}") not in taken)
