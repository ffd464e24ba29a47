"""Edits of the layer list, and of the joints between layers."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

from ....display_text import display_text
from ....errors import InputError
from ....geometry.validation import as_number, as_points, as_switch
from ....layers.drawing_layer import DrawingLayer, closed_groups
from ....layers.layer_view import LayerView, view_with_one_shown, with_one_shown
from ....layers.layered_picture import MAX_GROUPS, MAX_NAME
from ....words import tr
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.rig.joint import Joint, check_joints, make_joint
from .edit import Edit, Effect, Json, ReplayTarget, layer_view_from_json, layer_view_to_json

_SWITCHES = ("visible", "solo", "locked")
_VALUES = ("title", "opacity", *_SWITCHES, "slot", "groups")


@dataclass(frozen=True)
class SetLayers(Edit):
    """Change layers: name, opacity, visible, solo, locked, slot, groups; None leaves a value as it is.

    layers: their numbers in `Drawing.layers`; slot: the name of the slot that they are put into, empty for
    none. Of each slot at most one layer stays visible, also in keyframes: the one that is made so, or the
    foremost. groups: the names of the groups that they are put into, the outermost first; the eyes of these
    groups stay as they are. No vertex moves.
    """

    name = "layers"
    fields = ("layers",)

    layers: Sequence[int]
    title: str | None = None
    opacity: float | None = None
    visible: bool | None = None
    solo: bool | None = None
    locked: bool | None = None
    slot: str | None = None
    groups: Sequence[str] | None = None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        count = len(drawing.layers)
        unknown = [number for number in self.layers if type(number) is not int or not 0 <= number < count]
        if unknown:
            raise InputError(
                tr(
                    "layers: expected numbers from 0 to {last}, got {unknown!r}",
                    last=count - 1,
                    unknown=unknown[0],
                )
            )
        chosen = set(self.layers)
        values = self._new_values(drawing)
        layers = tuple(
            _with_values(layer, values) if number in chosen else layer
            for number, layer in enumerate(drawing.layers)
        )
        layers = with_one_shown(layers, drawing.layer_order, chosen if self.visible else ())
        if all(a is b for a, b in zip(layers, drawing.layers, strict=True)):
            return state
        animation = state.animation
        if self.slot:
            animation = animation.map_layers(lambda view: view_with_one_shown(view, layers))
        return replace(state, drawing=replace(drawing, layers=layers), animation=animation)

    def _new_values(self, drawing: Drawing) -> Json:
        """The values of `DrawingLayer` that change, by name."""
        values: Json = {
            name: as_switch(getattr(self, name), name)
            for name in _SWITCHES
            if getattr(self, name) is not None
        }
        if self.opacity is not None:
            values["opacity"] = as_number(self.opacity, "opacity", 0, 1)
        if self.title is not None:
            values["name"] = _as_title(self.title)
        if self.slot is not None:
            values["slot"] = _as_title(self.slot) if self.slot else ""
        if self.groups is not None:
            groups = values["groups"] = _as_groups(self.groups)
            values["closed_groups"] = closed_groups(drawing.layers, groups)
        return values

    def to_json(self, drawing: Drawing) -> Json:
        given = {name: getattr(self, name) for name in _VALUES if getattr(self, name) is not None}
        if self.groups is not None:
            given["groups"] = list(self.groups)
        return {"layers": list(self.layers), **given}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls(tuple(event["layers"]), **{name: event[name] for name in _VALUES if name in event})


def _with_values(layer: DrawingLayer, values: Json) -> DrawingLayer:
    """The layer with other values; itself if it has them."""
    if all(getattr(layer, name) == value for name, value in values.items()):
        return layer
    return replace(layer, **values)


def _as_groups(value: object) -> tuple[str, ...]:
    if not isinstance(value, (list, tuple)):
        raise InputError(tr("group: expected the names of one around layers, got {path!r:.60}", path=value))
    if len(value) > MAX_GROUPS:
        raise InputError(tr("expected groups in groups at most {most} deep, got more", most=MAX_GROUPS))
    return tuple(map(_as_title, value))


def _as_title(value: object) -> str:
    if not isinstance(value, str) or not 0 < len(value.strip()) <= MAX_NAME:
        raise InputError(
            tr(
                "name: expected a name of 1 to {most} characters, got {value!r:.60}",
                most=MAX_NAME,
                value=value,
            )
        )
    return display_text(value.strip())


@dataclass(frozen=True)
class ShowGroup(Edit):
    """Open or close the eye of a group of layers; those of its layers stay. No vertex moves.

    path: the names of the groups from the outermost one to this one.
    """

    name = "group"
    fields = ("path", "visible")

    path: Sequence[str]
    visible: bool

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        path, visible = tuple(self.path), as_switch(self.visible, "visible")
        index = len(path) - 1
        if index < 0 or not any(layer.groups[: len(path)] == path for layer in drawing.layers):
            raise InputError(
                tr("group: expected the names of one around layers, got {path!r:.60}", path=list(path))
            )

        def changed(layer: DrawingLayer) -> DrawingLayer:
            if layer.groups[: len(path)] != path or (index not in layer.closed_groups) is visible:
                return layer
            closed = set(layer.closed_groups) ^ {index}
            return replace(layer, closed_groups=tuple(closed))

        layers = tuple(map(changed, drawing.layers))
        if all(a is b for a, b in zip(layers, drawing.layers, strict=True)):
            return state
        return replace(state, drawing=replace(drawing, layers=layers))

    def to_json(self, drawing: Drawing) -> Json:
        return {"path": list(self.path), "visible": self.visible}


@dataclass(frozen=True)
class SetLayerView(Edit):
    """Set which layers are visible, and their order, for example those of a keyframe. No vertex moves."""

    name = "layer-view"
    fields = ("view",)

    view: LayerView

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        changed = drawing.with_layer_view(self.view)
        return state if changed is drawing else replace(state, drawing=changed)

    def to_json(self, drawing: Drawing) -> Json:
        return {"view": layer_view_to_json(self.view)}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls(layer_view_from_json(event["view"]))


@dataclass(frozen=True)
class KeyLayers(Edit):
    """Make layers visible or invisible in all keyframes, too. No vertex moves.

    layers: their numbers. Of each slot at most one layer stays visible.
    """

    name = "key-layers"
    fields = ("layers", "visible")

    layers: Sequence[int]
    visible: bool

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        state = SetLayers(self.layers, visible=self.visible).apply(state, drawing)
        layers, chosen = drawing.layers, set(self.layers)

        def changed(view: LayerView) -> LayerView:
            seen = [
                replace(layer, visible=self.visible if number in chosen else on)
                for number, (layer, on) in enumerate(zip(layers, view.visible, strict=True))
            ]
            seen = list(with_one_shown(seen, view.order, chosen if self.visible else ()))
            return replace(view, visible=tuple(layer.visible for layer in seen))

        return replace(state, animation=state.animation.map_layers(changed))

    def to_json(self, drawing: Drawing) -> Json:
        return {"layers": list(self.layers), "visible": self.visible}


@dataclass(frozen=True)
class OrderLayers(Edit):
    """Set the order of the layers, their numbers from back to front. No vertex moves."""

    name = "layer-order"
    fields = ("order",)

    order: Sequence[int]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        order, count = tuple(self.order), len(drawing.layers)
        if any(type(number) is not int for number in order) or sorted(order) != list(range(count)):
            raise InputError(
                tr(
                    "order: expected each of {count} layers once, got {order!r:.60}",
                    count=count,
                    order=list(order),
                )
            )
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
