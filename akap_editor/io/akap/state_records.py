"""Reads pins and settings from untrusted JSON, and checks states, for .akap files and pose files."""

import re
import reprlib
from typing import Any

import numpy as np

from ...display_text import display_text
from ...editor.document.crossings import as_crossings
from ...editor.document.document import EditState
from ...editor.document.named_poses import as_pose
from ...editor.document.pin import MAX_PINS, Pin, PinDepths, as_pin_depths, check_pins
from ...editor.document.rig.mirror import Mirror
from ...editor.document.settings import Settings
from ...editor.document.stiffness import as_stiffness
from ...errors import InputError
from ...geometry.validation import Ints
from ...words import tr
from .json_records import Json, numbers, optional, require

MAX_CROSSINGS = 100_000
_PIN_ID = re.compile(r"-?[0-9]{1,19}")


def read_pins(records: list[Any]) -> tuple[Pin, ...]:
    """The pins that `Pin.to_json` wrote. Raises InputError on values of other types."""
    if len(records) > MAX_PINS:
        raise InputError(tr("expected at most {most} pins, got {count}", most=MAX_PINS, count=len(records)))
    return tuple(map(_read_pin, records))


def _read_pin(record: Any) -> Pin:
    if not isinstance(record, dict):
        raise InputError(tr("expected pins to be objects, got {value}", value=reprlib.repr(record)))
    weights, target = (numbers(require(record, name, list), name) for name in ("weights", "target"))
    depth = optional(record, "depth", int, 0)
    angle = float(numbers([record["angle"]], "angle")[0]) if "angle" in record else None
    return Pin(
        require(record, "id", int),
        require(record, "face", int),
        weights,
        target,
        depth,
        angle,
        display_text(optional(record, "name", str, "")),
        optional(record, "hidden", bool, False),
        optional(record, "locked", bool, False),
        float(numbers([record["scale"]], "scale")[0]) if "scale" in record else None,
    )


def read_crossings(record: Json) -> Ints:
    """The crossings (s, 2) of a record, none if absent. Raises InputError on values of other kinds."""
    rows = optional(record, "crossings", list, [])
    if len(rows) > MAX_CROSSINGS:
        raise InputError(
            tr(
                "expected at most {most} crossings, got {count}",
                most=MAX_CROSSINGS,
                count=len(rows),
            )
        )
    for row in rows:
        if type(row) is not list or len(row) != 2 or any(type(face) is not int for face in row):
            raise InputError(tr("crossings: expected pairs of faces, got {value}", value=reprlib.repr(row)))
        if not 0 <= min(row) <= max(row) <= np.iinfo(np.int32).max:
            raise InputError(tr("crossings: expected indices of faces, got {row}", row=row))
    return as_crossings(rows)


def write_crossings(crossings: Ints) -> Json:
    """The entry of a record for crossings (s, 2); empty if there are none."""
    return {"crossings": crossings.tolist()} if len(crossings) else {}


def read_depths(record: Json) -> PinDepths:
    """The depths of pins in a record, none if absent. Raises InputError on values of other kinds."""
    depths = optional(record, "depths", dict, {})
    if not all(_PIN_ID.fullmatch(name) for name in depths):
        raise InputError(tr("depths: expected ids of pins, got {names}", names=reprlib.repr(list(depths))))
    return as_pin_depths({int(name): depth for name, depth in depths.items()})


def write_depths(depths: PinDepths) -> Json:
    """The entry of a record for depths of pins; empty if there are none."""
    return {"depths": {str(pin): depth for pin, depth in depths}} if depths else {}


def read_mirror(record: Json, pins: tuple[Pin, ...]) -> Mirror | None:
    """The mirror of a record with pairs of these pins, None if absent. Raises InputError on bad values."""
    return Mirror.from_json(record["mirror"]).of_pins(pin.id for pin in pins) if "mirror" in record else None


def read_settings(record: Json) -> Settings:
    """The settings that `Settings.to_json` wrote, parameters in the file's order.

    Raises InputError on values of other types.
    """
    return Settings(require(record, "method", str), tuple(require(record, "parameters", dict).items()))


def check_state(state: EditState, vertices: int, faces: int) -> None:
    """Raise InputError if a state does not fit a mesh with so many vertices and faces, or is not valid."""
    as_pose(state.positions, "positions", vertices)
    check_pins(state.pins, faces)
    check_crossings(state.crossings, faces)
    if state.stiffness is not None:
        as_stiffness(state.stiffness, faces)
    state.settings.check()


def check_crossings(crossings: Ints, faces: int) -> None:
    """Check that crossings (s, 2) are of a mesh with ``faces`` faces, and not too many. Raises InputError."""
    as_crossings(crossings, faces)
    if len(crossings) > MAX_CROSSINGS:
        raise InputError(
            tr(
                "expected at most {most} crossings, got {count}",
                most=MAX_CROSSINGS,
                count=len(crossings),
            )
        )
