"""Which parts of a drawing are limbs: how much of it lies beyond each place, seen from its middle."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.sparse.csgraph import dijkstra

from ..geometry.jit import compiled
from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints

_ROOM = 0.12  # share of the mesh's length by which a branch reaches from a place towards the middle


@dataclass(frozen=True, eq=False)
class Limbs:
    """distances: (m,) of each face from the middle of its component, through the drawing, in pixels; shares:
    (m,) area of the branch that begins at each face, as a share of the whole drawing.
    """

    distances: Floats
    shares: Floats


@lru_cache(maxsize=8)
def mesh_limbs(mesh: TriMesh) -> Limbs:
    """The limbs of a mesh at rest; cached.

    The branch of a place is what remains connected to it of all that is not much nearer to the middle: of a
    hand the forearm and the hand, of the chest nearly everything.
    """
    middles = []
    for number in range(int(mesh.component.max()) + 1):
        vertices = np.flatnonzero(mesh.component == number)
        offsets = mesh.vertices[vertices] - mesh.vertices[vertices].mean(axis=0)
        middles.append(int(vertices[np.argmin((offsets**2).sum(axis=1))]))
    distances = dijkstra(mesh.edge_graph, directed=False, indices=middles, min_only=True)
    n = len(mesh.vertices)
    areas: Floats = np.bincount(mesh.faces.ravel(), np.repeat(mesh.rest_areas / 3, 3), n).astype(float)
    graph = mesh.edge_graph.tocsr()
    order = np.argsort(-distances, kind="stable")
    sizes, parents = _merge_tree(order, graph.indptr, graph.indices, areas)
    shares = _branch_areas(distances, parents, sizes, _ROOM * mesh.length) / areas.sum()
    return Limbs(distances[mesh.faces].mean(axis=1), shares[mesh.faces].mean(axis=1))


@compiled
def _merge_tree(order: Ints, starts: Ints, neighbors: Ints, areas: Floats):  # type: ignore[no-untyped-def]
    """Area of what is connected to each vertex when it is added, (n,), and the vertex that joins it, (n,).

    order: (n,) vertices as they are added, the farthest first; a vertex that nothing joins has itself.
    """
    n = len(order)
    roots, latest = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    sizes, parents, added = areas.copy(), np.empty(n, dtype=np.int64), np.zeros(n, dtype=np.bool_)
    for v in range(n):  # union-find, and the newest vertex of each set
        roots[v] = latest[v] = parents[v] = v
    for v in order:
        added[v] = True
        for j in range(starts[v], starts[v + 1]):
            u = neighbors[j]
            if not added[u]:
                continue
            while roots[u] != u:
                roots[u] = roots[roots[u]]
                u = roots[u]
            if u == v or latest[u] == v:
                continue
            w = v
            while roots[w] != w:
                roots[w] = roots[roots[w]]
                w = roots[w]
            parents[latest[u]] = v
            sizes[v] += sizes[latest[u]]
            roots[u] = w
            latest[w] = v
    return sizes, parents


@compiled
def _branch_areas(distances: Floats, parents: Ints, sizes: Floats, room: float) -> Floats:
    """The size of the last ancestor of each vertex that is at most ``room`` nearer to the middle, (n,)."""
    n = len(parents)
    height = 1
    while 1 << height < n:
        height += 1
    ancestors = np.empty((height + 1, n), dtype=np.int64)  # 2^k generations up
    for v in range(n):
        ancestors[0, v] = parents[v]
    for k in range(height):
        for v in range(n):
            ancestors[k + 1, v] = ancestors[k, ancestors[k, v]]
    result = np.empty(n)
    for v in range(n):
        u = v
        for k in range(height, -1, -1):
            if distances[ancestors[k, u]] >= distances[v] - room:
                u = ancestors[k, u]
        result[v] = sizes[u]
    return result
