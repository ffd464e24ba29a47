"""Depths of pins, and the order in which faces are drawn that follows from them."""

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from scipy.sparse.csgraph import dijkstra

from ...errors import InputError
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.validation import Floats, Ints, freeze
from .pin import Pin

MAX_DEPTH = 999  # in front of the drawing or behind it
LEVELS_PER_DEPTH = 4  # faces of one level keep the order of the mesh, so that a limb is drawn as a whole
_PIN_RADIUS = 1e-6  # share of √area: a vertex nearer than this to a pin has the pin's depth

_PinDepths = tuple[tuple[int, bytes, int], ...]  # face, weights and depth of each pin, as a key of a cache


def check_depths(depths: Mapping[int, int]) -> None:
    """Check depths by the ids of pins. Raises InputError on one out of range."""
    for pin_id, depth in depths.items():
        if not -MAX_DEPTH <= depth <= MAX_DEPTH:
            expected = f"a whole number from -{MAX_DEPTH} to {MAX_DEPTH}"
            raise InputError(f"depth of pin {pin_id}: expected {expected}, got {depth}")


def face_order(mesh: TriMesh, pins: Sequence[Pin]) -> Ints | None:
    """Indices of the faces from back to front, (m,) int; None stands for the order of the mesh.

    Pins with the same places and depths give the same array object, whatever their targets are.
    """
    if len({pin.depth for pin in pins}) < 2:
        return None
    return _face_order(mesh, _pin_depths(pins))


def depth_at(mesh: TriMesh, pins: Sequence[Pin], point: MeshPoints) -> int:
    """Blended depth at one point of the mesh, rounded; 0 without pins."""
    if not pins:
        return 0
    depths = _vertex_depths(mesh, _pin_depths(pins))
    return round(float(point.weights[0] @ depths[mesh.faces[point.faces[0]]]))


def _pin_depths(pins: Sequence[Pin]) -> _PinDepths:
    return tuple((pin.face, pin.weights.tobytes(), pin.depth) for pin in pins)


@lru_cache(maxsize=8)
def _face_order(mesh: TriMesh, pins: _PinDepths) -> Ints:
    levels = np.rint(LEVELS_PER_DEPTH * _vertex_depths(mesh, pins)[mesh.faces].mean(axis=1))
    return freeze(np.argsort(levels, kind="stable"))


def _vertex_depths(mesh: TriMesh, pins: _PinDepths) -> Floats:
    """Depth of each vertex, (n,): mean of the pins' depths with weights 1/d², d the geodesic distance.

    Inverse distance weighting: Shepard, "A two-dimensional interpolation function for irregularly-spaced
    data", 1968.
    """
    distances = np.stack([_geodesic_distances(mesh, face, weights) for face, weights, _ in pins])
    weights = 1.0 / np.maximum(distances, _PIN_RADIUS * mesh.length) ** 2
    depths: Floats = np.array([depth for *_, depth in pins]) @ weights / weights.sum(axis=0)
    return depths


@lru_cache(maxsize=128)
def _geodesic_distances(mesh: TriMesh, face: int, weights: bytes) -> Floats:
    """Distance of each vertex from a point of the rest pose along edges and over gaps, (n,) pixels."""
    corners = mesh.faces[face]
    point = np.frombuffer(weights) @ mesh.vertices[corners]
    to_corners = np.linalg.norm(mesh.vertices[corners] - point, axis=1)
    return (dijkstra(mesh.bridged_edge_graph, indices=corners) + to_corners[:, None]).min(axis=0)
