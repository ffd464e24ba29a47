"""Reads pins and settings from untrusted JSON, and checks states, for .akap files and pose files."""

import reprlib
from collections import Counter
from typing import Any

import numpy as np

from ...editor.document.crossings import MAX_DEPTH, as_crossings
from ...editor.document.document import EditState
from ...editor.document.pin import Pin
from ...editor.document.pin_angles import MAX_PIN_ANGLE
from ...editor.document.settings import Settings
from ...editor.document.stiffness import as_stiffness
from ...errors import InputError
from ...geometry.validation import Ints, as_points
from .json_records import MAX_INTEGER, Json, numbers, optional, require

WEIGHT_TOLERANCE = 1e-9
MAX_PINS = 10_000
MAX_CROSSINGS = 100_000


def read_pins(records: list[Any]) -> tuple[Pin, ...]:
    """The pins that `Pin.to_json` wrote. Raises InputError on values of other types."""
    _check_pin_count(len(records))
    return tuple(map(_read_pin, records))


def _check_pin_count(count: int) -> None:
    if count > MAX_PINS:
        raise InputError(f"expected at most {MAX_PINS} pins, got {count}")


def _read_pin(record: Any) -> Pin:
    if not isinstance(record, dict):
        raise InputError(f"expected pins to be objects, got {reprlib.repr(record)}")
    weights, target = (numbers(require(record, name, list), name) for name in ("weights", "target"))
    depth = optional(record, "depth", int, 0)
    angle = float(numbers([record["angle"]], "angle")[0]) if "angle" in record else None
    return Pin(require(record, "id", int), require(record, "face", int), weights, target, depth, angle)


def read_crossings(record: Json) -> Ints:
    """The crossings (s, 2) of a record, none if absent. Raises InputError on values of other kinds."""
    rows = optional(record, "crossings", list, [])
    if len(rows) > MAX_CROSSINGS:
        raise InputError(f"expected at most {MAX_CROSSINGS} crossings, got {len(rows)}")
    for row in rows:
        if type(row) is not list or len(row) != 2 or any(type(face) is not int for face in row):
            raise InputError(f"crossings: expected pairs of faces, got {reprlib.repr(row)}")
        if not 0 <= min(row) <= max(row) <= np.iinfo(np.int32).max:
            raise InputError(f"crossings: expected indices of faces, got {row}")
    return as_crossings(rows)


def write_crossings(crossings: Ints) -> Json:
    """The entry of a record for crossings (s, 2); empty if there are none."""
    return {"crossings": crossings.tolist()} if len(crossings) else {}


def read_settings(record: Json) -> Settings:
    """The settings that `Settings.to_json` wrote, parameters in the file's order.

    Raises InputError on values of other types.
    """
    return Settings(require(record, "method", str), tuple(require(record, "parameters", dict).items()))


def check_state(state: EditState, vertices: int, faces: int) -> None:
    """Raise InputError if a state does not fit a mesh with so many vertices and faces, or is not valid."""
    as_points(state.positions, "positions", vertices)
    _check_pin_count(len(state.pins))
    check_crossings(state.crossings, faces)
    if state.stiffness is not None:
        as_stiffness(state.stiffness, faces)
    for pin in state.pins:
        _check_pin(pin, faces)
    for name, value in state.settings.parameters:
        _check_parameter(name, value)
    _check_unique("pin", [pin.id for pin in state.pins])
    _check_unique("parameter", [name for name, _ in state.settings.parameters])


def check_crossings(crossings: Ints, faces: int) -> None:
    """Check that crossings (s, 2) are of a mesh with ``faces`` faces, and not too many. Raises InputError."""
    as_crossings(crossings, faces)
    if len(crossings) > MAX_CROSSINGS:
        raise InputError(f"expected at most {MAX_CROSSINGS} crossings, got {len(crossings)}")


def _check_unique(kind: str, names: list[Any]) -> None:
    for name, count in Counter(names).items():
        if count > 1:
            raise InputError(f"expected each {kind} once, got {kind} {reprlib.repr(name)} {count} times")


def _check_pin(pin: Pin, faces: int) -> None:
    if abs(pin.id) > MAX_INTEGER:
        raise InputError(f"pins: expected ids up to {MAX_INTEGER}, got {pin.id}")
    if not 0 <= pin.face < faces:
        raise InputError(f"pin {pin.id}: expected a face from 0 to {faces - 1}, got {pin.face}")
    if pin.weights.shape != (3,) or pin.target.shape != (2,):
        came = f"{pin.weights.size} and {pin.target.size}"
        raise InputError(f"pin {pin.id}: expected 3 weights and a target of 2 coordinates, got {came}")
    low, high = -WEIGHT_TOLERANCE, 1 + WEIGHT_TOLERANCE
    are_shares = all(low <= weight <= high for weight in pin.weights)
    if not are_shares or abs(pin.weights.sum() - 1) > WEIGHT_TOLERANCE:
        came = str(pin.weights.tolist())
        raise InputError(f"pin {pin.id}: expected weights from 0 to 1 that sum to 1, got {came}")
    if abs(pin.depth) > MAX_DEPTH:
        raise InputError(f"pin {pin.id}: expected a depth from -{MAX_DEPTH} to {MAX_DEPTH}, got {pin.depth}")
    if pin.angle is not None and not abs(pin.angle) <= MAX_PIN_ANGLE:
        expected = f"an angle from -{MAX_PIN_ANGLE:.5g} to {MAX_PIN_ANGLE:.5g} radians"
        raise InputError(f"pin {pin.id}: expected {expected}, got {pin.angle}")
    if not np.isfinite(pin.target).all():
        raise InputError(f"pin {pin.id}: expected a finite target, got {pin.target.tolist()}")


def _check_parameter(name: str, value: object) -> None:
    if not isinstance(name, str) or not isinstance(value, bool | int | float | str | None):
        came = f"{type(value).__name__} for {reprlib.repr(name)}"
        raise InputError(f"parameters: expected names and numbers, texts, true, false or null, got {came}")
    if isinstance(value, float) and not np.isfinite(value):
        raise InputError(f"parameter {reprlib.repr(name)}: expected a finite number, got {value}")
    if isinstance(value, int) and abs(value) > MAX_INTEGER:
        came = f"one of {value.bit_length()} bits"
        raise InputError(
            f"parameter {reprlib.repr(name)}: expected an integer up to {MAX_INTEGER}, got {came}"
        )
