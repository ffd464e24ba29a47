"""Edits of pins, their targets and angles."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from ....display_text import display_text
from ....errors import InputError
from ....geometry.mesh import MeshPoints, TriMesh
from ....geometry.validation import as_number, as_points
from ....words import tr
from ...document.crossings import crossings_by_depth
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.pin import MAX_PIN_ANGLE, MAX_PIN_SCALE, MIN_PIN_SCALE, Pin, check_pins
from ...document.rig.mirror import Mirror
from .edit import Edit, Effect, Json, ReplayTarget

Target = tuple[float, float]
REST_TOLERANCE = 1e-6  # pixels between the recorded and the actual rest position of a pin on an equal mesh
MAX_TARGET_DISTANCE = 1000.0  # times √area: a drawing would travel there for minutes


@dataclass(frozen=True, eq=False)
class SetPins(Edit):
    """Replace all pins; no vertex moves."""

    name = "pins"
    fields = ("pins",)
    effect = Effect.PINS

    pins: tuple[Pin, ...]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        mesh, pins = drawing.mesh, state.pins
        crossings = crossings_by_depth(mesh, pins, self.pins, state.positions, state.crossings)
        mirror = None if state.mirror is None else state.mirror.of_pins(pin.id for pin in self.pins)
        return replace(state, pins=self.pins, crossings=crossings, mirror=mirror)

    def fixed_at_pose(self, state: EditState, drawing: Drawing) -> "SetPins":
        """This edit with the current positions of existing pins as their targets, to stop a motion."""
        ids = (pin.id for pin in state.pins)
        positions = dict(zip(ids, state.pin_positions(drawing.mesh), strict=True))
        return SetPins(tuple(replace(pin, target=positions.get(pin.id, pin.target)) for pin in self.pins))

    def to_json(self, drawing: Drawing) -> Json:
        """The pins with face and weights, for an equal mesh, and their rest positions, for any other.

        On a mesh in layers, with the layer, too.
        """
        mesh = drawing.mesh

        def rest_position(pin: Pin) -> list[float]:
            position: list[float] = (pin.weights @ mesh.vertices[mesh.faces[pin.face]]).tolist()
            return position

        def layer(pin: Pin) -> Json:
            return {} if mesh.layers is None else {"layer": int(mesh.face_layers[pin.face])}

        return {"pins": [{**pin.to_json(), "rest": rest_position(pin), **layer(pin)} for pin in self.pins]}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        pins, mesh = event["pins"], drawing.mesh
        if len({int(pin["id"]) for pin in pins}) < len(pins):
            raise InputError(tr("expected pins with ids of their own, got one id twice"))
        if target.same_mesh and (mesh is target.mesh or _lie_on(mesh, pins)):
            points = [(int(pin["face"]), pin["weights"]) for pin in pins]
        else:
            layers = None if mesh.layers is None else [int(pin.get("layer", -1)) for pin in pins]
            rest = target.points([pin["rest"] for pin in pins], "rest", len(pins))
            located = mesh.locate(rest, layers=layers)
            points = list(zip(located.faces.tolist(), located.weights, strict=True))
        targets = target.points([pin["target"] for pin in pins], "target", len(pins))
        edit = cls(
            tuple(
                Pin(
                    int(pin["id"]),
                    face,
                    weights,
                    goal,
                    int(pin.get("depth", 0)),
                    _angle(pin.get("angle")),
                    display_text(pin.get("name", "")),
                    pin.get("hidden", False) is True,
                    pin.get("locked", False) is True,
                    None if pin.get("scale") is None else as_pin_scale(pin["scale"]),
                )
                for pin, (face, weights), goal in zip(pins, points, targets, strict=True)
            )
        )
        check_pins(edit.pins, len(mesh.faces))
        return edit


def _lie_on(mesh: TriMesh, pins: list[Any]) -> bool:
    """Whether faces and weights of recorded pins give their rest positions on a mesh from remeshing."""
    if any(not 0 <= int(pin["face"]) < len(mesh.faces) for pin in pins):
        return False
    weights = as_points([pin["weights"] for pin in pins], "weights", len(pins), columns=3)
    points = MeshPoints(np.array([int(pin["face"]) for pin in pins], dtype=np.int32), weights)
    rest = as_points([pin["rest"] for pin in pins], "rest", len(pins))
    return bool(np.abs(mesh.evaluate(points, mesh.vertices) - rest).max(initial=0.0) < REST_TOLERANCE)


def _angle(value: Any) -> float | None:
    return None if value is None else as_number(value, "angle", -MAX_PIN_ANGLE, MAX_PIN_ANGLE)


@dataclass(frozen=True, eq=False)
class SetTargets(Edit):
    """Set the targets of pins, by id, in pixels; steps move the pins there."""

    name = "targets"
    fields = ("targets",)
    effect = Effect.TARGETS
    may_overlap_step = True

    targets: Mapping[int, Target]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        _check_ids("targets", self.targets, state.pins)
        points = as_points(list(self.targets.values()), "targets", len(self.targets))
        limit = MAX_TARGET_DISTANCE * drawing.mesh.length
        if np.abs(points).max(initial=0.0) > limit:
            raise InputError(
                tr(
                    "targets: expected points within {limit:,.0f} pixels of the picture's corner, "
                    "got {point}",
                    limit=limit,
                    point=points[np.abs(points).max(axis=1).argmax()].tolist(),
                )
            )
        targets = dict(zip(self.targets, points, strict=True))
        pins = (replace(pin, target=targets.get(pin.id, pin.target)) for pin in state.pins)
        return replace(state, pins=tuple(pins))

    def to_json(self, drawing: Drawing) -> Json:
        return {"targets": {str(pin): [float(x), float(y)] for pin, (x, y) in self.targets.items()}}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        targets = event["targets"]
        points = target.points(list(targets.values()), "targets", len(targets)).tolist()
        return cls({int(pin): (x, y) for pin, (x, y) in zip(targets, points, strict=True)})


@dataclass(frozen=True, eq=False)
class SetAngles(Edit):
    """Let pins, by id, hold angles in radians from the rest pose; steps rotate the drawing around them.

    Within one gesture full turns count, up to `MAX_PIN_ANGLE`.
    """

    name = "angles"
    fields = ("angles",)
    effect = Effect.TARGETS
    may_overlap_step = True

    angles: Mapping[int, float]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        _check_ids("angles", self.angles, state.pins)
        limits = -MAX_PIN_ANGLE, MAX_PIN_ANGLE
        held = {pin: as_number(angle, f"angle of pin {pin}", *limits) for pin, angle in self.angles.items()}
        pins = (replace(pin, angle=held.get(pin.id, pin.angle)) for pin in state.pins)
        return replace(state, pins=tuple(pins))

    def to_json(self, drawing: Drawing) -> Json:
        return {"angles": {str(pin): float(angle) for pin, angle in self.angles.items()}}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls({int(pin): angle for pin, angle in event["angles"].items()})


@dataclass(frozen=True, eq=False)
class SetMirror(Edit):
    """Set the mirror; None removes it. Pairs of unknown pins are left out."""

    name = "mirror"
    fields = ("mirror",)
    effect = Effect.NONE

    mirror: Mirror | None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        mirror = None if self.mirror is None else self.mirror.of_pins(pin.id for pin in state.pins)
        return replace(state, mirror=mirror)

    def to_json(self, drawing: Drawing) -> Json:
        return {"mirror": None if self.mirror is None else self.mirror.to_json()}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        record = event["mirror"]
        return cls(None if record is None else Mirror.from_json(record, target.scale))


@dataclass(frozen=True, eq=False)
class SetScales(Edit):
    """Let the drawing around pins, by id, grow to these multiples of its rest size; steps make it so."""

    name = "scales"
    fields = ("scales",)
    effect = Effect.TARGETS
    may_overlap_step = True

    scales: Mapping[int, float]

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        _check_ids("scales", self.scales, state.pins)
        scales = {pin: as_pin_scale(scale) for pin, scale in self.scales.items()}
        pins = (replace(pin, scale=scales.get(pin.id, pin.scale)) for pin in state.pins)
        return replace(state, pins=tuple(pins))

    def to_json(self, drawing: Drawing) -> Json:
        return {"scales": {str(pin): float(scale) for pin, scale in self.scales.items()}}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls({int(pin): scale for pin, scale in event["scales"].items()})


def as_pin_scale(value: Any) -> float:
    """``value`` as the scale of a pin. Raises InputError out of range."""
    return as_number(value, "scale of a pin", MIN_PIN_SCALE, MAX_PIN_SCALE)


def _check_ids(name: str, ids: Iterable[int], pins: Sequence[Pin]) -> None:
    known_ids = [pin.id for pin in pins]
    for pin_id in ids:
        if pin_id not in known_ids:
            raise InputError(
                tr(
                    "{name}: expected ids of pins {ids}, got {pin_id}",
                    name=name,
                    ids=sorted(known_ids),
                    pin_id=pin_id,
                )
            )
