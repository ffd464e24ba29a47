"""Poses that a drawing remembers by name."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...geometry.validation import Floats, as_points, frozen

MAX_NAME = 80


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
        if not self.name.strip() or len(self.name) > MAX_NAME:
            raise InputError(f"pose: expected a name of 1 to {MAX_NAME} characters, got {self.name[:99]!r}")
        object.__setattr__(self, "positions", as_pose(self.positions, "pose"))


def with_pose(poses: Sequence[NamedPose], pose: NamedPose) -> tuple[NamedPose, ...]:
    """These poses and another one, in the place of one of the same name."""
    if any(each.name == pose.name for each in poses):
        return tuple(pose if each.name == pose.name else each for each in poses)
    return (*poses, pose)


def free_name(poses: Sequence[NamedPose]) -> str:
    """Pose 1, Pose 2, ...: the first that is not taken."""
    taken = {pose.name for pose in poses}
    return next(name for number in range(1, len(taken) + 2) if (name := f"Pose {number}") not in taken)


def changed(
    poses: Sequence[NamedPose], do: str, values: Mapping[str, Any], pose: Floats
) -> tuple[NamedPose, ...]:
    """What an edit makes of poses; pose (n, 2): the present one.

    do: "keep" remembers the pose, or values["positions"], as values["name"]; "forget" that of this name, if
    there is one; "rename" calls it values["to"]; "order" brings them into the order of values["names"].
    Raises InputError on bad values, KeyError where some are missing.
    """
    known = {each.name: each for each in poses}
    if do == "keep":
        positions = as_pose(values.get("positions", pose), "positions", len(pose))
        return with_pose(poses, NamedPose(str(values["name"]), positions))
    if do == "order":
        names = list(values["names"])
        if sorted(names) != sorted(known):
            raise InputError(f"poses: expected each of {sorted(known)} once, got {names}")
        return tuple(known[name] for name in names)
    name = values["name"]
    if do == "forget":
        return tuple(each for each in poses if each.name != name)
    if name not in known:
        raise InputError(f"pose: expected one of {sorted(known)}, got {name!r}")
    to = str(values["to"])
    if to != name and to in known:
        raise InputError(f"pose: expected a name that is not taken, got {to!r}")
    return tuple(replace(each, name=to) if each.name == name else each for each in poses)
