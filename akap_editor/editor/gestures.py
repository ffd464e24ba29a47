"""Functions that edit an open session, each in one gesture: one entry of the history."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any, Protocol, TypeVar

import numpy as np

from ..geometry.validation import Floats, Ints
from ..words import mark
from .camera import Point
from .document.named_poses import unused_pose_name
from .document.pin import Pin
from .document.rig.joint import Joint, changed_joint, make_joint
from .document.settings import Settings
from .session import pin_edits
from .session.edits import (
    AddPose,
    DeletePose,
    Edit,
    KeyLayers,
    OrderLayers,
    OrderLimb,
    ResetPose,
    SetAngles,
    SetJoints,
    SetLayers,
    SetPins,
    SetPose,
    SetRestPose,
    SetScales,
    SetSettings,
    SetTargets,
    ShowGroup,
)
from .session.session import Session

T = TypeVar("T")


class EditContext(Protocol):
    """An open session with the pins that are selected, and the way to edit it in one gesture."""

    session: Session | None
    selection: frozenset[int]

    @property
    def is_busy(self) -> bool:
        """Whether a gesture is under way; no other one can start before its end."""

    def edit(self, label: str, change: Callable[[Session], T]) -> T | None:
        """Change the session in one gesture, and return what ``change`` does.

        Does nothing and returns None without a session or during a gesture.
        """

    def apply(self, label: str, *edits: Edit) -> None:
        """Apply edits in one gesture; does nothing without a session or during a gesture."""

    def select(self, pins: Iterable[int]) -> None:
        """Select exactly these pins."""


# -- pins ----------------------------------------------------------------------------------------------------


def add_pin(editor: EditContext, position: Point) -> int | None:
    """Add a pin at a position of the current pose, pixels, and select it.

    Returns its id; None outside the drawing. Raises InputError if the position is not finite.
    """
    pin = editor.edit(mark("Add Pin"), lambda session: pin_edits.add_pin(session, position))
    if pin is not None:
        editor.select({pin})
    return pin


def add_pins(
    editor: EditContext, positions: Sequence[Point], layers: Sequence[int | None] | None = None
) -> list[int]:
    """Add pins at positions of the current pose, pixels, in one gesture, and deselect all.

    layers: the layer of each, None for the front one there. If the pins were selected, a drag of one would
    move all of them. Returns their ids; positions outside the drawing are left out. Raises InputError if one
    is not finite.
    """
    layers = [None] * len(positions) if layers is None else layers

    def add_all(session: Session) -> list[int]:
        added = [
            pin_edits.add_pin(session, position, layer)
            for position, layer in zip(positions, layers, strict=True)
        ]
        return [pin for pin in added if pin is not None]

    pins = editor.edit(mark("Add Pins"), add_all) or []
    editor.select(())
    return pins


def rename_pin(editor: EditContext, pin: int, name: str) -> None:
    """Name a pin; an empty name is “Pin” and its id. Raises InputError if it is too long."""
    editor.edit(mark("Rename Pin"), lambda session: pin_edits.change_pin(session, pin, name=name.strip()))


def set_pin_hidden(editor: EditContext, pin: int, is_hidden: bool) -> None:
    """Leave a pin out on the canvas, or show it again; it holds the drawing in both cases."""
    label = mark("Hide Pin") if is_hidden else mark("Show Pin")
    editor.edit(label, lambda session: pin_edits.change_pin(session, pin, is_hidden=is_hidden))


def set_pin_locked(editor: EditContext, pin: int, is_locked: bool) -> None:
    """Protect a pin from being moved and removed by hand, or end that."""
    label = mark("Lock Pin") if is_locked else mark("Unlock Pin")
    editor.edit(label, lambda session: pin_edits.change_pin(session, pin, is_locked=is_locked))


def remove_pins(editor: EditContext, pins: Iterable[int]) -> None:
    """Remove pins by their ids; the drawing keeps its pose. Locked pins stay, unknown ids are ignored."""
    if editor.session is None:
        return
    removed = frozenset(pins) & {pin.id for pin in editor.session.state.pins if not pin.is_locked}
    if removed:
        label = mark("Remove Pin") if len(removed) == 1 else f"Remove {len(removed)} Pins"
        editor.edit(label, lambda session: pin_edits.remove_pins(session, removed))


def remove_selected_pins(editor: EditContext) -> None:
    """Remove the selected pins; the drawing keeps its pose."""
    remove_pins(editor, editor.selection)


def remove_last_pin(editor: EditContext) -> None:
    """Remove the pin that was added last; the drawing keeps its pose."""
    session = editor.session
    free = [pin.id for pin in session.state.pins if not pin.is_locked] if session is not None else []
    remove_pins(editor, free[-1:])


def move_pin(editor: EditContext, pin: int, position: Point) -> None:
    """Set the target of a pin, pixels. Raises InputError on an unknown id or if it is not finite."""
    editor.apply(mark("Move Pin"), SetTargets({pin: position}))


def set_depth(editor: EditContext, pin: int, depth: int) -> None:
    """Set the depth of a pin; greater depths are in front. Raises InputError on a depth out of range."""
    editor.edit(mark("Set Depth"), lambda session: pin_edits.set_depths(session, {pin: depth}))


def shift_depths(editor: EditContext, by: int) -> None:
    """Add to the depths of the selected pins. Raises InputError on a depth out of range."""
    if editor.session is not None and editor.selection:
        depths = {pin.id: pin.depth + by for pin in editor.session.state.pins if pin.id in editor.selection}
        label = mark("Raise Depth") if by > 0 else mark("Lower Depth")
        editor.edit(label, lambda session: pin_edits.set_depths(session, depths))


def order_limb(editor: EditContext, to_front: bool) -> None:
    """Bring the limb of the selected pins in front of all that it overlaps, or send it behind."""
    if editor.selection:
        label = mark("Bring Limb to Front") if to_front else mark("Send Limb to Back")
        editor.apply(label, OrderLimb(sorted(editor.selection), to_front))


def toggle_held_angles(editor: EditContext) -> None:
    """Let the selected pins hold their current angles; if all of them hold one already, release them."""
    if editor.session is None:
        return
    free = [pin.id for pin in editor.session.state.pins if pin.id in editor.selection and pin.angle is None]
    if free:
        editor.edit(mark("Hold Angle"), lambda session: pin_edits.hold_angles(session, free))
    else:
        editor.edit(
            mark("Release Angle"), lambda session: pin_edits.hold_angles(session, editor.selection, False)
        )


def set_pin_angle(editor: EditContext, pin: int, angle: float | None) -> None:
    """Let a pin hold an angle (radians from rest); None releases it. Raises InputError out of range."""
    if angle is None:
        editor.edit(mark("Release Angle"), lambda session: pin_edits.hold_angles(session, {pin}, False))
    else:
        editor.apply(mark("Rotate Pin"), SetAngles({pin: angle}))


def set_pin_scale(editor: EditContext, pin: int, scale: float) -> None:
    """Let the drawing around a pin grow to a multiple of its rest size. Raises InputError out of range."""
    editor.apply(mark("Scale Pin"), SetScales({pin: scale}))


# -- layers --------------------------------------------------------------------------------------------------


def set_layers(
    editor: EditContext, label: str, layers: Iterable[int], join: bool = False, **values: Any
) -> None:
    """Change values of layers, see `SetLayers`. join: merge it into the history entry before, if that is one
    of the same label and was the last one. Raises InputError.
    """
    session = editor.session
    if session is None or editor.is_busy:
        return
    joins = join and session.history.undo_label == label
    session.begin(label)
    try:
        session.apply(SetLayers(tuple(layers), **values))
    except Exception:
        session.abort()
        raise
    session.commit(join=joins)


def move_layer(editor: EditContext, layer: int, place: int, groups: Sequence[str] | None = None) -> None:
    """Move a layer to a place among the others, from 0, the hindmost. Raises InputError.

    groups: the names of the groups that it is put into, by default those that it is in.
    """
    if editor.session is not None:
        order = [number for number in editor.session.drawing.layer_order if number != layer]
        order.insert(place, layer)
        editor.apply(mark("Reorder Layers"), OrderLayers(order), SetLayers([layer], groups=groups))


def show_group(editor: EditContext, path: Sequence[str], visible: bool) -> None:
    """Open or close the eye of a group of layers, see `ShowGroup`. Raises InputError."""
    editor.apply(mark("Show Group") if visible else mark("Hide Group"), ShowGroup(tuple(path), visible))


def key_layers(editor: EditContext, layers: Iterable[int], visible: bool) -> None:
    """Show or hide layers in all keyframes, too, see `KeyLayers`. Raises InputError."""
    label = "Show in All Keyframes" if visible else "Hide in All Keyframes"
    editor.apply(label, KeyLayers(tuple(layers), visible))


def set_joints(editor: EditContext, label: str, joints: Iterable[Joint]) -> None:
    """Replace all joints, see `SetJoints`. Raises InputError."""
    editor.apply(label, SetJoints(tuple(joints)))


def add_joint(editor: EditContext, limb: int, carrier: int, place: Point) -> int | None:
    """Add a hinge between two layers at a place of the current pose, pixels; returns its id."""
    session = editor.session
    if session is None:
        return None
    state, mesh = session.state, session.drawing.mesh
    joint_id = 1 + max((joint.id for joint in state.joints), default=0)
    joint = make_joint(mesh, joint_id, limb, carrier, np.array(place), state.positions)
    set_joints(editor, mark("Add Joint"), (*state.joints, joint))
    return joint_id


def move_joint(editor: EditContext, joint_id: int, place: Point) -> None:
    """Move a joint to a place of the current pose, pixels, on its two layers."""
    session = editor.session
    if session is not None:
        state, mesh = session.state, session.drawing.mesh
        old = next(joint for joint in state.joints if joint.id == joint_id)
        moved = make_joint(mesh, joint_id, *old.layers(mesh), np.array(place), state.positions)
        values = {"faces": moved.faces, "weights": moved.weights}
        set_joints(editor, mark("Move Joint"), changed_joint(state.joints, joint_id, **values))


def hang_joint(editor: EditContext, joint_id: int, carrier: int) -> None:
    """Let the limb of a joint hang on another layer, where the joint is now."""
    session = editor.session
    if session is not None:
        state, mesh = session.state, session.drawing.mesh
        old = next(joint for joint in state.joints if joint.id == joint_id)
        place = old.places(mesh, state.positions)[0]
        moved = make_joint(mesh, joint_id, old.layers(mesh)[0], carrier, place, state.positions)
        values = {"faces": moved.faces, "weights": moved.weights}
        set_joints(editor, mark("Change Parent"), changed_joint(state.joints, joint_id, **values))


def set_joint_kind(editor: EditContext, joint_id: int, kind: str) -> None:
    """Make a joint a hinge or a weld. Raises InputError on another kind."""
    if editor.session is not None:
        joints = changed_joint(editor.session.state.joints, joint_id, kind=kind)
        set_joints(editor, mark("Make Weld") if kind == "weld" else mark("Make Hinge"), joints)


def remove_joints(editor: EditContext, ids: Iterable[int], label: str = mark("Remove Joint")) -> None:
    """Remove joints by their ids; the drawing keeps its pose."""
    if editor.session is not None:
        removed = set(ids)
        set_joints(editor, label, (j for j in editor.session.state.joints if j.id not in removed))


def accept_joints(editor: EditContext) -> None:
    """Accept all proposed joints."""
    if editor.session is not None:
        joints = (replace(joint, is_proposed=False) for joint in editor.session.state.joints)
        set_joints(editor, mark("Accept Joints"), joints)


def clear_proposed_joints(editor: EditContext) -> None:
    """Remove all joints that nobody has accepted."""
    if editor.session is not None:
        proposed = [joint.id for joint in editor.session.state.joints if joint.is_proposed]
        remove_joints(editor, proposed, mark("Clear Proposed Joints"))


# -- poses and settings --------------------------------------------------------------------------------------


def reset_pose(editor: EditContext) -> None:
    """Return to the rest pose; the pins stay on the drawing and move with it."""
    editor.apply(mark("Reset Pose"), ResetPose())


def set_rest_pose(editor: EditContext) -> None:
    """Make the current pose the rest pose; nothing moves. Raises InputError if it has flipped faces."""
    editor.apply(mark("Set Rest Pose from Current"), SetRestPose())


def add_pose(editor: EditContext, name: str | None = None) -> None:
    """Add the current pose to the named poses; it replaces one of the same name.

    name: "Pose" and a number by default. Raises InputError on a name that is empty or too long.
    """
    if editor.session is not None:
        pose_name = unused_pose_name(editor.session.state.poses) if name is None else name
        editor.apply(mark("Add Pose"), AddPose(pose_name))


def delete_pose(editor: EditContext, name: str) -> None:
    """Delete the pose of this name, if there is one."""
    editor.apply(mark("Delete Pose"), DeletePose(name))


def set_pose(
    editor: EditContext,
    positions: Floats,
    label: str = mark("Apply Pose"),
    crossings: Ints | None = None,
) -> None:
    """Set the pose (n, 2); the pins stay on the drawing and move with it. Raises InputError.

    crossings: which part passes in front, (s, 2), see `EditState`; by default the one that does now.
    """
    editor.apply(label, SetPose(positions, crossings))


def apply_pose(
    editor: EditContext, pins: tuple[Pin, ...], positions: Floats, crossings: Ints | None = None
) -> None:
    """Replace the pins and the pose (n, 2) with its crossings (s, 2), as saved from the same mesh.

    Raises InputError.
    """
    editor.apply(mark("Apply Pose"), SetPins(pins), SetPose(positions, crossings))


def set_settings(editor: EditContext, settings: Settings) -> None:
    """Change the deformation method or its parameters. Raises InputError on unknown ones."""
    if editor.session is not None and settings != editor.session.state.settings:
        editor.apply(mark("Change Settings"), SetSettings(settings))
