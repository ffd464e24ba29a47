"""Edits as values, and the table of them: a new undoable feature is one class and one row."""

from .crossings import OrderLimb, SetCrossings
from .edit import Edit, Effect, ReplayTarget
from .keyframes import DeleteKeyframes, MoveKeyframes, SetEasing, SetKeyframe, SetLoop
from .layers import KeyLayers, OrderLayers, SetJoints, SetLayers, SetLayerView, ShowGroup
from .loose_parts import PaintLoose, SetLoose, SetSwing
from .method import PaintStiffness, SetSettings, SetStiffness
from .named_poses import AddPose, DeletePose, RenamePose, ReorderPoses
from .pins import SetAngles, SetMirror, SetPins, SetScales, SetTargets
from .pose import ReloadArtwork, Remesh, ResetPose, SetPose, SetRestPose

EDITS: dict[str, type[Edit]] = {
    edit.name: edit
    for edit in (
        *(SetPins, SetTargets, SetAngles, SetScales, SetMirror),
        *(SetSettings, SetStiffness, PaintStiffness),
        *(PaintLoose, SetLoose, SetSwing),
        *(SetPose, ResetPose, SetRestPose, Remesh, ReloadArtwork),
        *(OrderLimb, SetCrossings),
        *(SetLayers, OrderLayers, SetLayerView, KeyLayers, ShowGroup, SetJoints),
        *(AddPose, DeletePose, RenamePose, ReorderPoses),
        *(SetKeyframe, DeleteKeyframes, MoveKeyframes, SetEasing, SetLoop),
    )
}

__all__ = [
    "EDITS",
    "AddPose",
    "DeleteKeyframes",
    "DeletePose",
    "Edit",
    "Effect",
    "KeyLayers",
    "MoveKeyframes",
    "OrderLayers",
    "OrderLimb",
    "PaintLoose",
    "PaintStiffness",
    "ReloadArtwork",
    "Remesh",
    "RenamePose",
    "ReorderPoses",
    "ReplayTarget",
    "ResetPose",
    "SetAngles",
    "SetCrossings",
    "SetEasing",
    "SetJoints",
    "SetKeyframe",
    "SetLayerView",
    "SetLayers",
    "SetLoop",
    "SetLoose",
    "SetMirror",
    "SetPins",
    "SetPose",
    "SetRestPose",
    "SetScales",
    "SetSettings",
    "SetStiffness",
    "SetSwing",
    "SetTargets",
    "ShowGroup",
]
