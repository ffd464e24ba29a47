"""Pins: the points of a drawing that the artist controls."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...errors import InputError
from ...geometry.json_numbers import MAX_INTEGER
from ...geometry.mesh import MeshPoints
from ...geometry.validation import MAX_COORDINATE, Floats, as_floats
from ...words import tr

MAX_PINS = 10_000
MAX_DEPTH = 999  # in front of the drawing or behind it
MAX_PIN_NAME = 100  # characters
MIN_PIN_SCALE, MAX_PIN_SCALE = 0.25, 4.0
MAX_PIN_ANGLE = 20 * math.pi  # radians, in either direction
WEIGHT_TOLERANCE = 1e-9


PinDepths = tuple[tuple[int, int], ...]  # ids of pins and their depths, with ascending ids


@dataclass(frozen=True, eq=False)
class Pin:
    """A point of the drawing that the artist controls; arrays are copied and read-only.

    id: unique in its document; face, weights: its place on the mesh, weights (3,) float64 barycentric;
    target: (2,) float64, where it is to go, pixels; depth: higher is nearer to the viewer, see
    `crossings.face_order`; angle: to which the drawing around the pin is to rotate, radians from the rest
    pose, clockwise on the screen; None lets it rotate freely; name: empty for “Pin” and its id; is_hidden:
    whether it is left out on the canvas, where it still holds the drawing; is_locked: whether the hand can
    neither move nor remove it; scale: by how much the drawing around the pin is to be larger than at rest,
    see `rig.pin_scales`; None counts as 1.
    """

    id: int
    face: int
    weights: Floats
    target: Floats
    depth: int = 0
    angle: float | None = None
    name: str = ""
    is_hidden: bool = False
    is_locked: bool = False
    scale: float | None = None

    @property
    def label(self) -> str:
        """The name on the screen."""
        return self.name or tr("Pin {number}", number=self.id)

    def __post_init__(self) -> None:
        object.__setattr__(self, "weights", as_floats(self.weights, "weights"))
        object.__setattr__(self, "target", as_floats(self.target, "target"))

    def to_json(self) -> dict[str, Any]:
        """The pin as an object of a document or recording; docs/file-format.md describes it."""
        return {
            "id": int(self.id),
            "face": int(self.face),
            "weights": self.weights.tolist(),
            "target": self.target.tolist(),
            **({"depth": int(self.depth)} if self.depth else {}),
            **({"angle": float(self.angle)} if self.angle is not None else {}),
            **({"name": self.name} if self.name else {}),
            **({"hidden": True} if self.is_hidden else {}),
            **({"locked": True} if self.is_locked else {}),
            **({"scale": float(self.scale)} if self.scale is not None else {}),
        }


def pin_points(pins: Sequence[Pin]) -> MeshPoints:
    """The places of pins on the mesh, (k,), in order. Raises InputError on weights that do not sum to 1."""
    return MeshPoints(
        np.array([pin.face for pin in pins], dtype=np.int32),
        np.array([pin.weights for pin in pins]).reshape(-1, 3),
    )


def pin_depths(pins: Sequence[Pin]) -> PinDepths:
    """The depths of pins."""
    return tuple(sorted((pin.id, pin.depth) for pin in pins))


def with_depths(pins: Sequence[Pin], depths: PinDepths) -> tuple[Pin, ...]:
    """Pins with other depths; those without one among them keep theirs, and ids without a pin are ignored."""
    by_id = dict(depths)
    return tuple(
        pin if by_id.get(pin.id, pin.depth) == pin.depth else replace(pin, depth=by_id[pin.id])
        for pin in pins
    )


def as_pin_depths(values: Mapping[int, int] | PinDepths) -> PinDepths:
    """Depths by the ids of pins, checked. Raises InputError on values out of range."""
    depths = dict(values)
    for pin_id, depth in depths.items():
        if type(pin_id) is not int or type(depth) is not int:
            raise InputError(tr("depths: expected integers, got {value!r:.60}", value=(pin_id, depth)))
        if abs(pin_id) > MAX_INTEGER or abs(depth) > MAX_DEPTH:
            raise InputError(
                tr(
                    "depths: expected depths up to {most}, got {value!r:.60}",
                    most=MAX_DEPTH,
                    value=(pin_id, depth),
                )
            )
    if len(depths) > MAX_PINS:
        raise InputError(tr("expected at most {most} pins, got {count}", most=MAX_PINS, count=len(depths)))
    return tuple(sorted(depths.items()))


def check_pins(pins: Sequence[Pin], faces: int) -> None:
    """Check that pins can be those of a mesh with ``faces`` faces.

    Raises InputError on more than `MAX_PINS`, an id that occurs twice, or a value out of range.
    """
    if len(pins) > MAX_PINS:
        raise InputError(tr("expected at most {most} pins, got {count}", most=MAX_PINS, count=len(pins)))
    for pin in pins:
        _check_pin(pin, faces)
    for pin_id, count in Counter(pin.id for pin in pins).items():
        if count > 1:
            raise InputError(
                tr("expected each pin once, got pin {pin_id} {count} times", pin_id=pin_id, count=count)
            )


def _check_pin(pin: Pin, faces: int) -> None:
    if abs(pin.id) > MAX_INTEGER:
        raise InputError(tr("pins: expected ids up to {most}, got {id}", most=MAX_INTEGER, id=_short(pin.id)))
    if not 0 <= pin.face < faces:
        raise InputError(
            tr(
                "pin {pin}: expected a face from 0 to {last}, got {face}",
                pin=pin.id,
                last=faces - 1,
                face=_short(pin.face),
            )
        )
    if pin.weights.shape != (3,) or pin.target.shape != (2,):
        actual = f"{pin.weights.size} and {pin.target.size}"
        raise InputError(
            tr(
                "pin {pin}: expected 3 weights and a target of 2 coordinates, got {actual}",
                pin=pin.id,
                actual=actual,
            )
        )
    low, high = -WEIGHT_TOLERANCE, 1 + WEIGHT_TOLERANCE
    inside = all(low <= weight <= high for weight in pin.weights)
    if not inside or abs(pin.weights.sum() - 1) > WEIGHT_TOLERANCE:
        actual = str(pin.weights.tolist())
        raise InputError(
            tr(
                "pin {pin}: expected weights from 0 to 1 that sum to 1, got {actual}",
                pin=pin.id,
                actual=actual,
            )
        )
    if abs(pin.depth) > MAX_DEPTH:
        expected = tr("a depth from -{most} to {most}", most=MAX_DEPTH)
        raise InputError(
            tr(
                "pin {pin}: expected {expected}, got {depth}",
                pin=pin.id,
                expected=expected,
                depth=_short(pin.depth),
            )
        )
    if pin.angle is not None and not abs(pin.angle) <= MAX_PIN_ANGLE:
        expected = tr("an angle from -{most:.5g} to {most:.5g} radians", most=MAX_PIN_ANGLE)
        raise InputError(
            tr("pin {pin}: expected {expected}, got {angle}", pin=pin.id, expected=expected, angle=pin.angle)
        )
    if pin.scale is not None and not MIN_PIN_SCALE <= pin.scale <= MAX_PIN_SCALE:
        expected = tr("a scale from {least:g} to {most:g}", least=MIN_PIN_SCALE, most=MAX_PIN_SCALE)
        raise InputError(
            tr("pin {pin}: expected {expected}, got {scale}", pin=pin.id, expected=expected, scale=pin.scale)
        )
    if len(pin.name) > MAX_PIN_NAME:
        raise InputError(
            tr(
                "pin {pin}: expected a name of up to {most} characters, got {count}",
                pin=pin.id,
                most=MAX_PIN_NAME,
                count=len(pin.name),
            )
        )
    if not np.isfinite(pin.target).all():
        raise InputError(
            tr("pin {pin}: expected a finite target, got {target}", pin=pin.id, target=pin.target.tolist())
        )
    if (np.abs(pin.target) > MAX_COORDINATE).any():
        expected = tr("a target with coordinates up to {most:g} pixels", most=MAX_COORDINATE)
        raise InputError(
            tr(
                "pin {pin}: expected {expected}, got {target}",
                pin=pin.id,
                expected=expected,
                target=pin.target.tolist(),
            )
        )


def _short(value: int) -> str:
    """An integer for a message, however large it is."""
    return str(value) if value.bit_length() < 100 else tr("one of {bits} bits", bits=value.bit_length())
