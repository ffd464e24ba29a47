"""Which parts of a drawing pass in front of which: depths of pins, blended over the mesh."""

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from scipy.sparse.csgraph import dijkstra

from ...errors import InputError
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.validation import Floats, Ints, frozen
from .pin import Pin

MAX_DEPTH = 999  # as far in front or behind as a pin can be
LEVELS_PER_DEPTH = 4  # levels in a depth of 1: faces of one level keep the order of the mesh, limbs as wholes
_PIN_RADIUS = 1e-6  # share of the size of the mesh: nearer than this to a pin its depth is that of the pin


def check_depths(depths: Mapping[int, int]) -> None:
    """Raise InputError on depths, by a pin's id, that are out of range."""
    for pin_id, depth in depths.items():
        if not -MAX_DEPTH <= depth <= MAX_DEPTH:
            expected = f"a whole number from -{MAX_DEPTH} to {MAX_DEPTH}"
            raise InputError(f"depth of pin {pin_id}: expected {expected}, got {depth}")


def face_order(mesh: TriMesh, pins: Sequence[Pin]) -> Ints | None:
    """(m,) int: the faces from the hindmost to the foremost; None is the order of the mesh.

    The same object for the same pins, wherever their targets are.
    """
    if len({pin.depth for pin in pins}) < 2:
        return None
    return _order(mesh, tuple((pin.face, pin.weights.tobytes(), pin.depth) for pin in pins))


def depth_at(mesh: TriMesh, pins: Sequence[Pin], point: MeshPoints) -> int:
    """The whole depth nearest to the blended one at a point of the drawing, 0 without pins."""
    if not pins:
        return 0
    depths = _blended(mesh, tuple((pin.face, pin.weights.tobytes(), pin.depth) for pin in pins))
    return round(float(point.weights[0] @ depths[mesh.faces[point.faces[0]]]))


_Places = tuple[tuple[int, bytes, int], ...]


@lru_cache(maxsize=8)
def _order(mesh: TriMesh, pins: _Places) -> Ints:
    levels = np.rint(LEVELS_PER_DEPTH * _blended(mesh, pins)[mesh.faces].mean(axis=1))
    return frozen(np.argsort(levels, kind="stable"))


def _blended(mesh: TriMesh, pins: _Places) -> Floats:
    """(n,): mean of the pins' depths with weights 1/d², d being the way to a pin through the drawing."""
    ways = np.stack([_ways(mesh, face, weights) for face, weights, _ in pins])
    shares = 1.0 / np.maximum(ways, _PIN_RADIUS * mesh.length) ** 2
    depths: Floats = np.array([depth for *_, depth in pins]) @ shares / shares.sum(axis=0)
    return depths


@lru_cache(maxsize=128)
def _ways(mesh: TriMesh, face: int, weights: bytes) -> Floats:
    """(n,): length of the way from a point of the mesh at rest to each vertex, along edges and over gaps."""
    corners = mesh.faces[face]
    point = np.frombuffer(weights) @ mesh.vertices[corners]
    first = np.linalg.norm(mesh.vertices[corners] - point, axis=1)
    return (dijkstra(mesh.bridged_edge_graph, indices=corners) + first[:, None]).min(axis=0)
