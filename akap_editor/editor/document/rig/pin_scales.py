"""Scales of pins: by how much the drawing around each is larger than at rest, blended over the drawing."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ....geometry.mesh import TriMesh, signed_areas
from ....geometry.validation import Floats, freeze
from ..crossings import PIN_RADIUS, pin_distances
from ..pin import MAX_PIN_SCALE, MIN_PIN_SCALE, Pin

_RADIUS = 0.04  # share of √area: distance from a pin within which faces tell the scale there

_PinScales = tuple[tuple[int, bytes, float], ...]  # face, weights and scale of each pin, as a key of a cache


def face_scales(mesh: TriMesh, pins: Sequence[Pin]) -> Floats | None:
    """The scale of each face that the pins ask for, (m,); None if no pin has a scale.

    Logarithms are blended by inverse squares of the distances from the pins along the mesh and over gaps, as
    depths are (Shepard 1968); pins without a scale count as 1. Pins with the same places and scales give the
    same array object.
    """
    if all(pin.scale is None for pin in pins):
        return None
    scales = ((pin.face, pin.weights.tobytes(), pin.scale or 1.0) for pin in pins)
    return _face_scales(mesh, tuple(scales))


@lru_cache(maxsize=8)
def _face_scales(mesh: TriMesh, pins: _PinScales) -> Floats:
    points = [Pin(0, face, np.frombuffer(weights), np.zeros(2)) for face, weights, _ in pins]
    weights = 1.0 / np.maximum(pin_distances(mesh, points), PIN_RADIUS * mesh.length) ** 2
    logs = np.log([scale for *_, scale in pins]) @ weights / weights.sum(axis=0)
    return freeze(np.exp(logs[mesh.faces].mean(axis=1)))


def pin_scale(mesh: TriMesh, pin: Pin, positions: Floats) -> float:
    """By how much the drawing around a pin is larger than at rest, in a pose (n, 2)."""
    near = _faces_around(mesh, pin.face, pin.weights.tobytes())
    areas = signed_areas(positions, mesh.faces[near])
    ratio = max(float(areas.sum() / mesh.rest_areas[near].sum()), 0.0)
    return min(max(ratio**0.5, MIN_PIN_SCALE), MAX_PIN_SCALE)


@lru_cache(maxsize=128)
def _faces_around(mesh: TriMesh, face: int, weights: bytes) -> Floats:
    """The faces near a point of the mesh, among them its own."""
    place = np.frombuffer(weights) @ mesh.vertices[mesh.faces[face]]
    centers = mesh.vertices[mesh.faces].mean(axis=1)
    is_near = np.hypot(*(centers - place).T) <= _RADIUS * mesh.length
    is_near &= mesh.component[mesh.faces[:, 0]] == mesh.component[mesh.faces[face, 0]]
    is_near[face] = True
    return freeze(np.flatnonzero(is_near))


def with_measured_scales(mesh: TriMesh, pins: Sequence[Pin], positions: Floats) -> tuple[Pin, ...]:
    """Pins whose scales, where they have one, are those of a pose (n, 2), so that it stays as it is."""
    return tuple(
        pin if pin.scale is None else replace(pin, scale=pin_scale(mesh, pin, positions)) for pin in pins
    )
