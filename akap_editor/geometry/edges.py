"""Edges of a triangle mesh, found from its faces."""

import numpy as np

from .validation import Ints


def half_edges(faces: Ints) -> Ints:
    """(3m, 2), the directed edges of faces (m, 3): from each corner to the next."""
    return faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)


def unique_edges(faces: Ints, n: int) -> tuple[Ints, Ints]:
    """`TriMesh.edges` and `TriMesh.face_edges` of faces (m, 3) with n vertices."""
    keys = np.sort(half_edges(faces), axis=1) @ np.array([n, 1], dtype=np.int64)
    unique, inverse = np.unique(keys, return_inverse=True)
    edges = np.stack(np.divmod(unique, n), axis=1)
    return edges.astype(np.int32), inverse.astype(np.int32).reshape(-1, 3)


def coupled_pairs(edges: Ints, links: Ints, n: int) -> Ints:
    """The edges (e, 2) of a mesh and further pairs (l, 2) of its n vertices, each once, (e + l, 2).

    Both have the lower vertex first; edges and result are in lexicographic order.
    """
    factors = np.array([n, 1], dtype=np.int64)
    keys, more = edges @ factors, np.unique(links @ factors)
    places = np.searchsorted(keys, more)
    is_new = keys[np.minimum(places, len(keys) - 1)] != more
    return np.insert(edges, places[is_new], np.stack(np.divmod(more[is_new], n), axis=1), axis=0)
