"""Edits of the layer list, and of the joints between layers."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

from ....display_text import display_text
from ....errors import InputError
from ....geometry.validation import as_number, as_points, as_switch
from ....layers.drawing_layer import DrawingLayer
from ....layers.layered_picture import MAX_NAME
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.rig.joint import Joint, check_joints, make_joint
from .edit import Edit, Effect, Json, ReplayTarget

_SWITCHES = ("visible", "solo", "locked")


@dataclass(frozen=True)
class SetLayers(Edit):
    """Change layers: name, opacity, visible, solo, locked; None leaves a value as it is.

    layers: their numbers in `Drawing.layers`. No vertex moves.
    """

    name = "layers"
    fields = ("layers",)

    layers: Sequence[int]
    title: str | None = None
    opacity: float | None = None
    visible: bool | None = None
    solo: bool | None = None
    locked: bool | None = None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        count = len(drawing.layers)
        unknown = [number for number in self.layers if type(number) is not int or not 0 <= number < count]
        if unknown:
            raise InputError(f"layers: expected numbers from 0 to {count - 1}, got {unknown[0]!r}")
        chosen = set(self.layers)
        layers = tuple(
            self._changed(layer) if number in chosen else layer for number, layer in enumerate(drawing.layers)
        )
        if all(a is b for a, b in zip(layers, drawing.layers, strict=True)):
            return state
        return replace(state, drawing=replace(drawing, layers=layers))

    def _changed(self, layer: DrawingLayer) -> DrawingLayer:
        values: Json = {
            name: as_switch(getattr(self, name), name)
            for name in _SWITCHES
            if getattr(self, name) is not None
        }
        if self.opacity is not None:
            values["opacity"] = as_number(self.opacity, "opacity", 0, 1)
        if self.title is not None:
            values["name"] = _as_title(self.title)
        if all(getattr(layer, name) == value for name, value in values.items()):
            return layer
        return replace(layer, **values)

    def to_json(self, drawing: Drawing) -> Json:
        names = ("title", "opacity", *_SWITCHES)
        given = {name: getattr(self, name) for name in names if getattr(self, name) is not None}
        return {"layers": list(self.layers), **given}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        names = ("title", "opacity", *_SWITCHES)
        return cls(tuple(event["layers"]), **{name: event[name] for name in names if name in event})


def _as_title(value: object) -> str:
    if not isinstance(value, str) or not 0 < len(value.strip()) <= MAX_NAME:
        raise InputError(f"name: expected a name of 1 to {MAX_NAME} characters, got {value!r:.60}")
    return display_text(value.strip())


@dataclass(frozen=True)
class OrderLayers(Edit):
    """Set the order of the layers, their numbers from back to front. No vertex moves."""

    name = "layer-order"
    fields = ("order",)

    order: Sequence[int]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        order, count = tuple(self.order), len(drawing.layers)
        if any(type(number) is not int for number in order) or sorted(order) != list(range(count)):
            raise InputError(f"order: expected each of {count} layers once, got {list(order)!r:.60}")
        if order == drawing.layer_order:
            return state
        return replace(state, drawing=replace(drawing, layer_order=order))

    def to_json(self, drawing: Drawing) -> Json:
        return {"order": list(self.order)}


@dataclass(frozen=True)
class SetJoints(Edit):
    """Replace all joints; no vertex moves, but gaps of new joints close with the next motion."""

    name = "joints"
    fields = ("joints",)
    effect = Effect.JOINTS

    joints: tuple[Joint, ...]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        check_joints(self.joints, drawing.mesh)
        if not self.joints and not state.joints:
            return state
        return replace(state, joints=tuple(self.joints))

    def to_json(self, drawing: Drawing) -> Json:
        """The joints with faces and weights, for an equal mesh, and layers and rest places for others."""
        mesh = drawing.mesh
        return {
            "joints": [
                {
                    **joint.to_json(),
                    "layers": list(joint.layers(mesh)),
                    "rest": joint.places(mesh, mesh.vertices).mean(axis=0).tolist(),
                }
                for joint in self.joints
            ]
        }

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        records, mesh = event["joints"], drawing.mesh
        if target.same_mesh and mesh is target.mesh:
            return cls(tuple(map(_joint_from_json, records)))
        places = target.points([record["rest"] for record in records], "rest", len(records))
        joints = []
        for record, place in zip(records, places, strict=True):
            limb, carrier = map(int, record["layers"])
            joint = make_joint(mesh, int(record["id"]), limb, carrier, place)
            kind, proposed = record.get("kind", "hinge"), record.get("proposed", False) is True
            joints.append(replace(joint, kind=kind, is_proposed=proposed))
        return cls(tuple(joints))


def _joint_from_json(record: Json) -> Joint:
    limb, carrier = map(int, record["faces"])
    weights = as_points(record["weights"], "weights", 2, columns=3)
    kind, proposed = record.get("kind", "hinge"), record.get("proposed", False) is True
    return Joint(int(record["id"]), (limb, carrier), weights, kind, proposed)
