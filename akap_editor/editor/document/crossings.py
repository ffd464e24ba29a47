"""Which part of a drawing passes in front where the pose overlaps itself, and the depths of pins."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from threading import Lock
from typing import overload

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.csgraph import dijkstra

from ...errors import InputError
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.validation import Floats, Ints, as_indices, freeze
from ...layers.drawing_layer import stacked_faces
from ...overlap.overlaps import (
    NO_CROSSINGS,
    Overlaps,
    asked_overlaps,
    next_overlaps,
    overlaps_by_depth,
    restored_overlaps,
)
from ...overlap.rules import Rules
from ...overlap.seams import CutMesh, cut_along_seams
from ...words import tr
from .drawing import Drawing
from .pin import MAX_DEPTH, Pin

LEVELS_PER_DEPTH = 4  # faces of one level keep the order of the mesh, so that a limb is drawn as a whole
PIN_RADIUS = 1e-6  # share of √area: a vertex nearer than this to a pin has the pin's depth

_PinDepths = tuple[tuple[int, bytes, int], ...]  # face, weights and depth of each pin, as a key of a cache

MAX_FACES = int(np.iinfo(np.int32).max)
_CACHE_SIZE = 12  # poses whose overlaps are kept


class _IdentityCache:
    """Results by the identity of their arguments, the least recently used dropped first; for all threads."""

    def __init__(self) -> None:
        self._entries: dict[tuple[int, ...], tuple[tuple[object, ...], object]] = {}
        self._lock = Lock()

    def get(self, *arguments: object) -> object | None:
        key = tuple(map(id, arguments))
        with self._lock:
            entry = self._entries.pop(key, None)
            if entry is None:
                return None
            self._entries[key] = entry
            return entry[1]

    def put(self, result: object, *arguments: object) -> None:
        with self._lock:
            self._entries[tuple(map(id, arguments))] = arguments, result  # the arguments keep their ids
            while len(self._entries) > _CACHE_SIZE:
                del self._entries[next(iter(self._entries))]


_overlaps, _orders, _cuts, _stacks = (_IdentityCache() for _ in range(4))


def as_crossings(value: ArrayLike, face_count: int = MAX_FACES) -> Ints:
    """``value`` as read-only pairs of faces (s, 2) int32; one that is read-only already is returned itself.

    Raises InputError on another shape or dtype, or faces that are not below ``face_count``.
    """
    is_ready = isinstance(value, np.ndarray) and value.dtype == np.int32 and not value.flags.writeable
    if not is_ready and np.size(value) == 0:
        return NO_CROSSINGS
    pairs = as_indices(value, "crossings", 2, face_count)
    if is_ready:
        return value  # type: ignore[return-value]
    return freeze(pairs.astype(np.int32))


def no_crossings() -> Ints:
    """The crossings (0, 2) of a pose that does not overlap itself."""
    return NO_CROSSINGS


def overlaps_of(mesh: TriMesh, pins: Sequence[Pin], positions: Floats, crossings: Ints) -> Overlaps:
    """The overlaps of a pose (n, 2) with the decisions ``crossings``, see `EditState`; cached by identity.

    The depths of pins decide on overlaps without a decision.
    """
    found = _overlaps.get(mesh, positions, crossings)
    if not isinstance(found, Overlaps):
        rules = Rules(face_depths(mesh, pins))
        found = restored_overlaps(mesh, positions, crossings, lambda: rules)
        _overlaps.put(found, mesh, positions, crossings)
    return found


def remember_overlaps(mesh: TriMesh, positions: Floats, overlaps: Overlaps) -> None:
    """Keep the overlaps of a pose (n, 2), so that `overlaps_of` need not compute them again."""
    _overlaps.put(overlaps, mesh, positions, overlaps.crossings)


def following_overlaps(
    mesh: TriMesh,
    pins: Sequence[Pin],
    before: Overlaps,
    positions: Floats,
    dragged_ids: Collection[int] = (),
    other: Overlaps | None = None,
) -> Overlaps:
    """The overlaps of a pose (n, 2) that follows another one with the overlaps ``before``.

    dragged_ids: the pins that were moved; what they drag passes in front of what it meets. other: overlaps
    that decide where those ``before`` do not.
    """

    def rules() -> Rules:
        dragged = [pin for pin in pins if pin.id in dragged_ids]
        distances = None
        if dragged:
            distances = pin_distances(mesh, dragged).min(axis=0)[mesh.faces].mean(axis=1)
        return Rules(face_depths(mesh, pins), distances)

    return next_overlaps(mesh, positions, before, rules, other)


def crossings_in_pose(
    mesh: TriMesh, pins: Sequence[Pin], positions: Floats, crossings: Ints, new_positions: Floats
) -> Ints:
    """The crossings (s, 2) after a pose (n, 2) was replaced by another one at once."""
    overlaps = following_overlaps(mesh, pins, overlaps_of(mesh, pins, positions, crossings), new_positions)
    remember_overlaps(mesh, new_positions, overlaps)
    return overlaps.crossings


def limb_faces(mesh: TriMesh, pins: Sequence[Pin], ids: Collection[int]) -> Ints:
    """Whether each face is nearer to a pin of ``ids`` than to any other pin, through the drawing, (m,)."""
    nearest = pin_distances(mesh, pins)[:, mesh.faces].mean(axis=2).argmin(axis=0)
    limb: Ints = np.array([pin.id in ids for pin in pins])[nearest]
    return limb


def crossings_with_limb(
    mesh: TriMesh,
    pins: Sequence[Pin],
    positions: Floats,
    crossings: Ints,
    ids: Collection[int],
    to_front: bool,
) -> Ints:
    """The crossings (s, 2) with the limb of some pins in front of, or behind, all that it overlaps."""
    overlaps = overlaps_of(mesh, pins, positions, crossings)
    asked = asked_overlaps(mesh, positions, overlaps, limb_faces(mesh, pins, ids), to_front)
    if asked is overlaps:
        return crossings
    remember_overlaps(mesh, positions, asked)
    return asked.crossings


def crossings_by_depth(
    mesh: TriMesh, old_pins: Sequence[Pin], pins: Sequence[Pin], positions: Floats, crossings: Ints
) -> Ints:
    """The crossings (s, 2) after depths of pins have changed."""
    before, after = face_depths(mesh, old_pins), face_depths(mesh, pins)
    if before is after:
        return crossings
    overlaps = overlaps_of(mesh, old_pins, positions, crossings)
    changed = overlaps_by_depth(mesh, positions, overlaps, Rules(before), Rules(after))
    if changed is overlaps:
        return crossings
    remember_overlaps(mesh, positions, changed)
    return changed.crossings


def overlap_order(mesh: TriMesh, pins: Sequence[Pin], overlaps: Overlaps) -> Ints | None:
    """Indices of the faces from back to front, (m,) int; None stands for the order of the mesh.

    Faces that do not overlap are in the order of the pins' depths. The same object as long as neither these
    nor the overlaps require another order.
    """
    order = depth_order(mesh, pins)
    if overlaps.levels is None:
        return order
    found = _orders.get(overlaps.levels, order)
    if not isinstance(found, np.ndarray):
        levels = overlaps.levels if order is None else overlaps.levels[order]
        sorting = np.argsort(levels.astype(np.int16), kind="stable")
        found = freeze(sorting if order is None else order[sorting])
        _orders.put(found, overlaps.levels, order)
    return found


def face_order(drawing: Drawing, pins: Sequence[Pin], positions: Floats, crossings: Ints) -> Ints | None:
    """Indices of the faces from back to front in a pose (n, 2); None stands for the order of the mesh.

    Faces of hidden layers are left out.
    """
    mesh = drawing.mesh
    order = overlap_order(mesh, pins, overlaps_of(mesh, pins, positions, crossings))
    return _stacked(order, drawing)


def draw_order(
    drawing: Drawing, pins: Sequence[Pin], positions: Floats, crossings: Ints
) -> Ints | CutMesh | None:
    """What is drawn in a pose (n, 2), from back to front: `face_order`, or the mesh cut along its seams."""
    mesh = drawing.mesh
    overlaps = overlaps_of(mesh, pins, positions, crossings)
    order = overlap_order(mesh, pins, overlaps)
    if order is None or not overlaps.has_seam:
        return _stacked(order, drawing)
    found = _cuts.get(overlaps, order)
    if found is None:
        found = cut_along_seams(mesh, overlaps, order) or order
        _cuts.put(found, overlaps, order)
    assert isinstance(found, CutMesh | np.ndarray)
    return _stacked(found, drawing)


@overload
def _stacked(order: Ints | None, drawing: Drawing) -> Ints | None: ...
@overload
def _stacked(order: Ints | CutMesh | None, drawing: Drawing) -> Ints | CutMesh | None: ...
def _stacked(order: Ints | CutMesh | None, drawing: Drawing) -> Ints | CutMesh | None:
    """What is drawn within each layer, stacked layer by layer without hidden ones; cached by identity."""
    if not drawing.layers:
        return order
    arguments = order, drawing.mesh, drawing.layers, drawing.layer_order
    found = _stacks.get(*arguments)
    if found is None:
        layers, layer_order = drawing.layers, drawing.layer_order
        if isinstance(order, CutMesh):
            faces = stacked_faces(None, drawing.face_layers[order.sources], layers, layer_order)
            faces = np.arange(len(order.faces)) if faces is None else faces
            kept = _stacked(order.order, drawing)
            assert kept is not None
            found = replace(order, order=kept, faces=order.faces[faces], sources=order.sources[faces])
        else:
            found = stacked_faces(order, drawing.face_layers, layers, layer_order)
        _stacks.put(found, *arguments)
    assert found is None or isinstance(found, CutMesh | np.ndarray)
    return found


# -- depths of pins -----------------------------------------------------------------------------------------


def check_depths(depths: Mapping[int, int]) -> None:
    """Check depths by the ids of pins. Raises InputError on one out of range."""
    for pin_id, depth in depths.items():
        if not -MAX_DEPTH <= depth <= MAX_DEPTH:
            expected = tr("a whole number from -{most} to {most}", most=MAX_DEPTH)
            raise InputError(
                tr(
                    "depth of pin {pin_id}: expected {expected}, got {depth}",
                    pin_id=pin_id,
                    expected=expected,
                    depth=depth,
                )
            )


def depth_order(mesh: TriMesh, pins: Sequence[Pin]) -> Ints | None:
    """Indices of the faces from back to front by depths alone, (m,) int; None stands for that of the mesh.

    Pins with the same places and depths give the same array object, whatever their targets are.
    """
    if len({pin.depth for pin in pins}) < 2:
        return None
    return _face_order(mesh, _pin_depths(pins))


def depth_at(mesh: TriMesh, pins: Sequence[Pin], point: MeshPoints) -> int:
    """Blended depth at one point of the mesh, rounded; 0 without pins."""
    if not pins:
        return 0
    if mesh.layers is None and len({pin.depth for pin in pins}) == 1:  # needs no distances from the pins
        return pins[0].depth
    depths = _vertex_depths(mesh, _pin_depths(pins))
    return round(float(point.weights[0] @ depths[mesh.faces[point.faces[0]]]))


def _pin_depths(pins: Sequence[Pin]) -> _PinDepths:
    return tuple((pin.face, pin.weights.tobytes(), pin.depth) for pin in pins)


def face_depths(mesh: TriMesh, pins: Sequence[Pin]) -> Floats | None:
    """Level of each face by the depths of the pins, (m,), whole numbers; None if all depths are equal."""
    return None if len({pin.depth for pin in pins}) < 2 else _face_depths(mesh, _pin_depths(pins))


@lru_cache(maxsize=8)
def _face_depths(mesh: TriMesh, pins: _PinDepths) -> Floats:
    return freeze(np.rint(LEVELS_PER_DEPTH * _vertex_depths(mesh, pins)[mesh.faces].mean(axis=1)))


@lru_cache(maxsize=8)
def _face_order(mesh: TriMesh, pins: _PinDepths) -> Ints:
    return freeze(np.argsort(_face_depths(mesh, pins), kind="stable"))


def _vertex_depths(mesh: TriMesh, pins: _PinDepths) -> Floats:
    """Depth of each vertex, (n,): mean of the pins' depths with weights 1/d², d the geodesic distance.

    Pins count within their layers only, because the order of the layers decides between them; vertices of
    layers without pins get 0.

    Inverse distance weighting: Shepard, "A two-dimensional interpolation function for irregularly-spaced
    data", 1968.
    """
    distances = np.stack([_point_distances(mesh, face, weights) for face, weights, _ in pins])
    weights = 1.0 / np.maximum(distances, PIN_RADIUS * mesh.length) ** 2
    if mesh.layers is not None:
        weights *= mesh.layers == mesh.face_layers[[face for face, *_ in pins]][:, None]
    sums = weights.sum(axis=0)
    blended = np.array([depth for *_, depth in pins]) @ weights
    depths: Floats = np.divide(blended, sums, out=np.zeros_like(sums), where=sums > 0)
    return depths


def pin_distances(mesh: TriMesh, pins: Sequence[Pin]) -> Floats:
    """Distance of each vertex from each pin along edges of the rest pose and over gaps, (k, n) pixels."""
    return np.stack([_point_distances(mesh, pin.face, pin.weights.tobytes()) for pin in pins])


@lru_cache(maxsize=128)
def _point_distances(mesh: TriMesh, face: int, weights: bytes) -> Floats:
    """Distance of each vertex from a point of the rest pose along edges and over gaps, (n,) pixels."""
    corners = mesh.faces[face]
    point = np.frombuffer(weights) @ mesh.vertices[corners]
    to_corners = np.linalg.norm(mesh.vertices[corners] - point, axis=1)
    return (dijkstra(mesh.bridged_edge_graph, indices=corners) + to_corners[:, None]).min(axis=0)
