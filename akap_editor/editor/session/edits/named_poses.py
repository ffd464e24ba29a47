"""Edits of named poses."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

from numpy.typing import ArrayLike

from ....errors import InputError
from ....words import tr
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.named_poses import NamedPose, with_pose
from .edit import (
    Edit,
    Json,
    ReplayTarget,
    crossings_from_json,
    crossings_to_json,
    pose_and_crossings,
    positions_from_json,
    positions_to_json,
)


@dataclass(frozen=True, eq=False)
class AddPose(Edit):
    """Add a pose (n, 2), by default the current one, with a name; replaces the pose of the same name.

    crossings: which part passes in front in ``positions``, see `EditState`.
    """

    name = "keep"
    fields = ("name",)

    pose_name: str
    positions: ArrayLike | None = None
    crossings: ArrayLike | None = None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        pose = pose_and_crossings(self.positions, self.crossings, state, drawing)
        return replace(state, poses=with_pose(state.poses, NamedPose(self.pose_name, *pose)))

    def to_json(self, drawing: Drawing) -> Json:
        pose = {**positions_to_json(self.positions), **crossings_to_json(self.crossings)}
        return {"name": self.pose_name, **pose}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        positions = positions_from_json(event, target, drawing)
        return cls(str(event["name"]), positions, crossings_from_json(event))


@dataclass(frozen=True)
class DeletePose(Edit):
    """Delete a named pose; an unknown name changes nothing."""

    name = "forget"
    fields = ("name",)

    pose_name: str

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        return replace(state, poses=tuple(pose for pose in state.poses if pose.name != self.pose_name))

    def to_json(self, drawing: Drawing) -> Json:
        return {"name": self.pose_name}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls(event["name"])


@dataclass(frozen=True)
class RenamePose(Edit):
    """Rename a pose. Applying it raises InputError on an unknown name or if the new name is taken."""

    name = "rename"
    fields = ("name", "to")

    pose_name: str
    new_name: str

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        names = {pose.name for pose in state.poses}
        if self.pose_name not in names:
            raise InputError(
                tr("pose: expected one of {poses}, got {name!r}", poses=sorted(names), name=self.pose_name)
            )
        if self.new_name != self.pose_name and self.new_name in names:
            raise InputError(tr("pose: expected a name that is not taken, got {name!r}", name=self.new_name))
        poses = (
            replace(pose, name=self.new_name) if pose.name == self.pose_name else pose for pose in state.poses
        )
        return replace(state, poses=tuple(poses))

    def to_json(self, drawing: Drawing) -> Json:
        return {"name": self.pose_name, "to": self.new_name}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls(event["name"], str(event["to"]))


@dataclass(frozen=True)
class ReorderPoses(Edit):
    """Put the poses in the order of ``names``. Applying it raises InputError unless each occurs once."""

    name = "order"
    fields = ("names",)

    names: Sequence[str]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        by_name, names = {pose.name: pose for pose in state.poses}, list(self.names)
        if sorted(names) != sorted(by_name):
            raise InputError(
                tr("poses: expected each of {poses} once, got {names}", poses=sorted(by_name), names=names)
            )
        return replace(state, poses=tuple(by_name[name] for name in names))

    def to_json(self, drawing: Drawing) -> Json:
        return {"names": list(self.names)}
