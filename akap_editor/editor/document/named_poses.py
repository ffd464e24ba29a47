"""Named poses: poses that a document stores under a name."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from ...display_text import display_text
from ...errors import InputError
from ...geometry.validation import Floats, Ints, as_pixels, freeze
from ...words import tr
from .crossings import as_crossings, no_crossings

MAX_POSE_NAME = 80  # characters


def as_pose(value: ArrayLike, name: str, count: int | None = None) -> Floats:
    """``value`` as a read-only pose (n, 2) float64.

    A pose that is read-only already is returned itself, because poses are compared by identity.
    Raises InputError on another shape, coordinates that are not finite or above `MAX_COORDINATE`, or n other
    than ``count`` if given.
    """
    pose = as_pixels(value, name, count)
    if isinstance(value, np.ndarray) and value.dtype == np.float64 and not value.flags.writeable:
        return value
    return freeze(pose)


@dataclass(frozen=True, eq=False)
class NamedPose:
    """A pose (n, 2) float64, in pixels, with a name that is not empty and unique in its document.

    crossings: which part passes in front, (s, 2), see `EditState`.
    Characters of the name that cannot be shown are escaped. Raises InputError on an empty or too long name,
    or a bad pose.
    """

    name: str
    positions: Floats
    crossings: Ints = field(default_factory=no_crossings)

    def __post_init__(self) -> None:
        if not self.name.strip() or len(self.name) > MAX_POSE_NAME:
            expected = tr("a name of 1 to {most} characters", most=MAX_POSE_NAME)
            raise InputError(
                tr("pose: expected {expected}, got {name!r}", expected=expected, name=self.name[:99])
            )
        object.__setattr__(self, "name", display_text(self.name))
        object.__setattr__(self, "positions", as_pose(self.positions, "pose"))
        object.__setattr__(self, "crossings", as_crossings(self.crossings))


def with_pose(poses: Sequence[NamedPose], pose: NamedPose) -> tuple[NamedPose, ...]:
    """The poses with one more at the end, or in place of the one with the same name."""
    if any(each.name == pose.name for each in poses):
        return tuple(pose if each.name == pose.name else each for each in poses)
    return (*poses, pose)


def unused_pose_name(poses: Sequence[NamedPose]) -> str:
    """The first of "Pose 1", "Pose 2", ... that no pose has."""
    names = {pose.name for pose in poses}
    return next(
        name
        for number in range(1, len(names) + 2)
        if (name := tr("Pose {number}", number=number)) not in names
    )
