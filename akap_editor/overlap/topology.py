"""The parts of a mesh's topology that the search for overlaps reads: neighbors, rim edges and fans."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints


@dataclass(frozen=True, eq=False)
class Topology:
    """Neighbors of faces and edges of the rim; index arrays int32.

    faces: (m, 3); neighbors: (m, 3) the face across the edge from corner k to corner k + 1, −1 on the rim;
    rim: (b, 2) directed edges without a neighbor; rim_faces: (b,) their faces; rim_previous: (b,) the rim
    edge that ends where each one starts; fans: (c, 2) faces and corners at the vertices of the rim;
    fan_edges: (c,) the rim edge that starts at each of them; components: (m,) the connected component of each
    face; layers: (m,) its layer, whose faces alone it can cross; loops: (l,) one rim edge of each boundary
    loop; is_cut: (1,) whether the rim has lips of slits, which touch.
    """

    faces: Ints
    neighbors: Ints
    rim: Ints
    rim_faces: Ints
    rim_previous: Ints
    fans: Ints
    fan_edges: Ints
    components: Ints
    layers: Ints
    loops: Ints
    is_cut: Ints


@lru_cache(maxsize=8)
def mesh_topology(mesh: TriMesh) -> Topology:
    """The topology of a mesh; cached."""
    faces, n = mesh.faces.astype(np.int64), len(mesh.vertices)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key, reverse = start * n + end, end * n + start
    order = np.argsort(key)
    match = order[np.minimum(np.searchsorted(key, reverse, sorter=order), len(key) - 1)]
    neighbors = np.where(key[match] == reverse, match // 3, -1)
    edge = np.flatnonzero(neighbors < 0)
    rim = np.stack([start[edge], end[edge]], axis=1)
    leaving = np.full(n, -1)
    leaving[rim[:, 0]] = np.arange(len(rim))
    previous = np.empty(len(rim), dtype=np.int64)
    previous[leaving[rim[:, 1]]] = np.arange(len(rim))
    corner = np.flatnonzero(leaving[start] >= 0)
    arrays = (
        faces,
        neighbors.reshape(-1, 3),
        rim,
        edge // 3,
        previous,
        np.stack(np.divmod(corner, 3), axis=1),
        leaving[start[corner]],
        mesh.component[faces[:, 0]],
        mesh.face_layers,
        np.array([leaving[loop[0]] for loop in mesh.boundary_loops]),
        np.array([mesh.is_cut]),
    )
    return Topology(*(np.ascontiguousarray(array, dtype=np.int32) for array in arrays))


@lru_cache(maxsize=8)
def face_centers(mesh: TriMesh) -> Floats:
    """The centers of the faces of a mesh at rest, (m, 2) pixels; cached."""
    return np.ascontiguousarray(mesh.vertices[mesh.faces].mean(axis=1))
