"""Changes of a session's pins: each builds an edit from the current state and applies it."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..document.crossings import check_depths, depth_at
from ..document.drawing import point_of_layer, visible_point
from ..document.pin import Pin, check_pins
from ..document.pin_angles import with_held_angles
from .edits import SetPins, SetTargets
from .session import Session
from .stepper import PIN_TOLERANCE


def add_pin(session: Session, position: tuple[float, float], layer: int | None = None) -> int | None:
    """Add a pin at a position of the current pose, pixels; returns its id, None outside the drawing.

    Where parts overlap it goes to the front one, or to one on ``layer``, if that is there. It gets the depth
    of its surroundings. Raises InputError if the position is not finite, SolverError if a pending step
    failed.
    """
    session.finish_step()
    mesh, pins = session.drawing.mesh, session.state.pins
    order, pose = session.document.face_order, session.state.positions
    point = None if layer is None else point_of_layer(session.drawing, position, pose, order, layer)
    if point is None:
        point = visible_point(session.drawing, position, pose, order, unlocked=True)
    if point is None:
        return None
    pin_id = 1 + max((pin.id for pin in pins), default=0)
    target = np.array(position, dtype=np.float64)
    depth = depth_at(mesh, pins, point)
    session.apply(SetPins((*pins, Pin(pin_id, int(point.faces[0]), point.weights[0], target, depth))))
    return pin_id


def remove_pins(session: Session, ids: Iterable[int]) -> None:
    """Remove pins; unknown ids are ignored."""
    removed = set(ids)
    session.apply(SetPins(tuple(pin for pin in session.state.pins if pin.id not in removed)))


def set_depths(session: Session, depths: Mapping[int, int]) -> None:
    """Set the depths of pins, by id; unknown ids are ignored. Raises InputError on a depth out of range."""
    check_depths(depths)
    pins = (replace(pin, depth=depths.get(pin.id, pin.depth)) for pin in session.state.pins)
    session.apply(SetPins(tuple(pins)))


def change_pin(session: Session, pin: int, **changes: Any) -> None:
    """Replace fields of a pin that no step depends on: name, is_hidden, is_locked. Raises InputError."""
    pins = tuple(replace(each, **changes) if each.id == pin else each for each in session.state.pins)
    check_pins(pins, len(session.drawing.mesh.faces))
    session.apply(SetPins(pins))


def hold_angles(session: Session, ids: Iterable[int], hold: bool = True) -> None:
    """Let pins hold their current angles, or rotate freely if not ``hold``; unknown ids are ignored."""
    session.finish_step()
    mesh, state = session.drawing.mesh, session.state
    session.apply(SetPins(with_held_angles(mesh, state.pins, state.positions, set(ids), hold)))


def hold_stopped_pins(session: Session) -> None:
    """Set the targets of pins to their positions if the motion was stopped before they arrived.

    Undo and Escape stop a motion. Without this, the next drag would let all pins move on.
    """
    session.finish_step()
    if not session.is_moving and session.pin_error() > PIN_TOLERANCE:
        positions = session.pin_positions().tolist()
        targets = {pin.id: (x, y) for pin, (x, y) in zip(session.state.pins, positions, strict=True)}
        session.apply(SetTargets(targets))
