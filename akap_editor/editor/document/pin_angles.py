"""How far the drawing is turned around its pins."""

import math
from collections.abc import Container, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...deform.akap.pin_rotation import PinRotationConstraints
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.operators import to_complex
from ...geometry.validation import Floats
from .pin import Pin

MAX_PIN_ANGLE = 20 * math.pi  # radians either way that a pin can hold


def pin_angles(mesh: TriMesh, pins: Sequence[Pin], positions: Floats, also: Container[int] = ()) -> Floats:
    """(k,) radians from rest in the pose (n, 2), in (−π, π], of pins that hold an angle; NaN for the others.

    also: ids of more pins, measured as if they held one.
    """
    places = tuple((pin.face, pin.weights.tobytes(), pin.angle is not None or pin.id in also) for pin in pins)
    if not any(holds for *_, holds in places):
        return np.full(len(pins), np.nan)
    return _turning(mesh, places).angles(to_complex(positions))


@lru_cache(maxsize=8)
def _turning(mesh: TriMesh, places: tuple[tuple[int, bytes, bool], ...]) -> PinRotationConstraints:
    faces, weights, holds = zip(*places, strict=True)
    points = MeshPoints(np.array(faces, dtype=np.int32), np.array([np.frombuffer(each) for each in weights]))
    return PinRotationConstraints(mesh, points, np.array(holds))


def pins_fixed_at_pose(mesh: TriMesh, pins: Sequence[Pin], positions: Floats) -> tuple[Pin, ...]:
    """Pins that are to stay as they are in a pose (n, 2), also turned so where they hold an angle."""
    points = MeshPoints(
        np.array([pin.face for pin in pins], dtype=np.int32),
        np.array([pin.weights for pin in pins]).reshape(-1, 3),
    )
    places, angles = mesh.evaluate(points, positions), pin_angles(mesh, pins, positions)
    return tuple(
        replace(pin, target=place, angle=None if pin.angle is None else float(angle))
        for pin, place, angle in zip(pins, places, angles, strict=True)
    )


def with_held_angles(
    mesh: TriMesh, pins: Sequence[Pin], positions: Floats, ids: Container[int], hold: bool
) -> tuple[Pin, ...]:
    """Pins of which those with these ids hold the angles that they have in a pose (n, 2), or none."""
    angles = pin_angles(mesh, pins, positions, ids if hold else ())
    return tuple(
        replace(pin, angle=float(angle) if hold else None) if pin.id in ids else pin
        for pin, angle in zip(pins, angles, strict=True)
    )


class FullTurnCounter:
    """Counts full turns, of which a pose says nothing, from one step to the next."""

    def __init__(self) -> None:
        self._last: dict[int, float] = {}

    def forget(self) -> None:
        """Begin anew: pins have the shorter way to the angles that they hold."""
        self._last = {}

    def unwrap(self, pins: Sequence[Pin], angles: Floats) -> Floats:
        """What `pin_angles` has found for ``pins`` (k,), with full turns."""
        near = np.array([self._last.get(pin.id, pin.angle or 0.0) for pin in pins])
        result = angles + 2 * np.pi * np.round((near - angles) / (2 * np.pi))
        self._last = {pin.id: float(angle) for pin, angle in zip(pins, result, strict=True)}
        return np.asarray(result)
