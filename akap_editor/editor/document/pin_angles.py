"""How far the drawing is rotated around its pins."""

from collections.abc import Container, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ...deform.akap.pin_rotation import PinRotationConstraints
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.operators import to_complex
from ...geometry.validation import Floats
from .pin import Pin, pin_points
from .rig.pin_scales import with_measured_scales

_MeasuredPins = tuple[tuple[int, bytes, bool], ...]  # face, weights, and whether its angle is measured


def pin_angles(
    mesh: TriMesh, pins: Sequence[Pin], positions: Floats, extra_ids: Container[int] = ()
) -> Floats:
    """Rotation around each pin in the pose (n, 2), (k,) radians from rest in (−π, π].

    NaN for pins that hold no angle, except those of ``extra_ids``.
    """
    measured = tuple(
        (pin.face, pin.weights.tobytes(), pin.angle is not None or pin.id in extra_ids) for pin in pins
    )
    if not any(is_measured for *_, is_measured in measured):
        return np.full(len(pins), np.nan)
    return _rotation_constraints(mesh, measured).angles(to_complex(positions))


@lru_cache(maxsize=8)
def _rotation_constraints(mesh: TriMesh, pins: _MeasuredPins) -> PinRotationConstraints:
    faces, weights, is_measured = zip(*pins, strict=True)
    points = MeshPoints(np.array(faces, dtype=np.int32), np.array([np.frombuffer(row) for row in weights]))
    return PinRotationConstraints(mesh, points, np.array(is_measured))


def pins_fixed_at_pose(mesh: TriMesh, pins: Sequence[Pin], positions: Floats) -> tuple[Pin, ...]:
    """Pins with targets, held angles and scales equal to those in a pose (n, 2), so that they stay there."""
    targets = mesh.evaluate(pin_points(pins), positions)
    pins = with_measured_scales(mesh, pins, positions)
    angles = pin_angles(mesh, pins, positions)
    return tuple(
        replace(pin, target=target, angle=None if pin.angle is None else float(angle))
        for pin, target, angle in zip(pins, targets, angles, strict=True)
    )


def with_held_angles(
    mesh: TriMesh, pins: Sequence[Pin], positions: Floats, ids: Container[int], hold: bool
) -> tuple[Pin, ...]:
    """All pins; those with the given ids hold their angles in a pose (n, 2), or if not ``hold`` no angle."""
    angles = pin_angles(mesh, pins, positions, ids if hold else ())
    return tuple(
        replace(pin, angle=float(angle) if hold else None) if pin.id in ids else pin
        for pin, angle in zip(pins, angles, strict=True)
    )


class FullTurnCounter:
    """Adds full turns to the angles of pins from one step to the next; a single pose does not show them."""

    def __init__(self) -> None:
        self._last_angles: dict[int, float] = {}  # radians, by the pin's id

    def reset(self) -> None:
        """Start anew: the next angles are those within π of the angles that the pins hold."""
        self._last_angles = {}

    def unwrap(self, pins: Sequence[Pin], angles: Floats) -> Floats:
        """Add full turns to ``angles`` (k,) of `pin_angles` that bring each nearest to its last value."""
        last_angles = np.array([self._last_angles.get(pin.id, pin.angle or 0.0) for pin in pins])
        unwrapped = angles + 2 * np.pi * np.round((last_angles - angles) / (2 * np.pi))
        self._last_angles = {pin.id: float(angle) for pin, angle in zip(pins, unwrapped, strict=True)}
        return np.asarray(unwrapped)
