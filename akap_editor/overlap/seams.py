"""Seams drawn as smooth lines: the faces that a seam crosses are cut along it."""

from collections import defaultdict
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from ..geometry.jit import compiled
from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints
from .circles import face_levels, low_and_high
from .face_pairs import FacePairs, pair_index
from .overlaps import Overlaps
from .topology import mesh_topology

_BAND = 6  # faces on each side of a seam within which it is straightened
_ROUNDS = 24  # of smoothing
_NEAREST_CUT = 0.02  # share of an edge: a cut is not nearer to a corner


@dataclass(frozen=True, eq=False)
class CutMesh:
    """A mesh with some faces cut, in the order in which its faces are drawn.

    order: (m,) the faces of the mesh from back to front, for what does not know cuts; faces: (q, 3) int32
    corners from back to front, n + i for the i-th new vertex; sources: (q,) int32 the face of the mesh that
    each one is a part of; edges: (e, 2) int32 the vertices between which the new ones are; shares: (e,) how
    far they are from the first to the second.
    """

    order: Ints
    faces: Ints
    sources: Ints
    edges: Ints
    shares: Floats

    def values(self, values: Floats) -> Floats:
        """Values (n, k) at the vertices of the mesh, followed by those at the new vertices, (n + e, k)."""
        start, end = values[self.edges[:, 0]], values[self.edges[:, 1]]
        new = start + self.shares[:, None] * (end - start)
        return np.concatenate([values, new])


def cut_along_seams(mesh: TriMesh, overlaps: Overlaps, order: Ints) -> CutMesh | None:
    """The mesh cut along the seams of its overlaps; None if there is no seam, or it cannot be straightened.

    order: (m,) the faces from back to front in which all decisions hold.
    """
    pairs = overlaps.pairs
    signs = overlaps.signs.copy()
    sides: dict[int, list[tuple[int, Floats]]] = defaultdict(list)  # blocks and corner values by face
    blocks = np.repeat(np.arange(len(pairs.links)), np.diff(pairs.starts))
    for region in range(pairs.region_count):
        members = np.flatnonzero(pairs.regions == region)
        if signs[members].min() == signs[members].max():
            continue
        for block, corners in _block_values(mesh, pairs, signs, members, blocks):
            inside = slice(pairs.starts[block], pairs.starts[block + 1])
            if corners.min() >= 0:
                signs[inside] = 1
            elif corners.max() <= 0:
                signs[inside] = -1
            else:
                sides[int(pairs.first[pairs.starts[block]])].append((block, corners))
    cut = {face: blocks_[0] for face, blocks_ in sides.items() if len(blocks_) == 1}
    return _cut(mesh, pairs, signs, blocks, cut, order) if cut else None


def _block_values(
    mesh: TriMesh, pairs: FacePairs, signs: Ints, members: Ints, blocks: Ints
) -> list[tuple[int, Floats]]:
    """Blocks of pairs near the seams of a region, and a smooth value at the corners of their first faces.

    The value is positive where the first sheet is in front; its zeros are the straightened seams.
    """
    topology = mesh_topology(mesh)
    links = _block_links(
        members,
        blocks,
        pairs.first,
        pairs.second,
        topology.neighbors,
        pairs.heads,
        pairs.starts,
        pairs.links,
    )
    first_block = blocks[members[0]]
    count = blocks[members[-1]] + 1 - first_block
    graph = csr_array(
        (np.ones(len(links)), (links[:, 0] - first_block, links[:, 1] - first_block)), shape=(count, count)
    )
    graph = (graph + graph.T).tocsr()
    graph.data[:] = 1.0
    sizes = np.bincount(blocks[members] - first_block, minlength=count)
    means: Floats = np.bincount(blocks[members] - first_block, signs[members], count) / sizes
    degree = np.maximum(graph.sum(axis=1), 1)
    near = (np.abs(means) < 1) | (np.abs(graph @ means) < degree)
    for _ in range(_BAND):
        near = near | (graph @ near.astype(float) > 0)
    inner = near & (graph @ near.astype(float) == degree)
    values = means.copy()
    for _ in range(_ROUNDS):
        values = np.where(inner, 0.25 * values + 0.75 * (graph @ values) / degree, values)
    band = np.flatnonzero(near)
    labels = connected_components(graph[band][:, band], directed=False)[1]
    faces = pairs.first[pairs.starts[band + first_block]]
    corners = mesh.faces[faces]
    keys = labels[:, None].astype(np.int64) * len(mesh.vertices) + corners
    unique, inverse = np.unique(keys, return_inverse=True)
    inverse = inverse.reshape(-1)
    totals = np.bincount(inverse, np.repeat(values[band], 3), len(unique)) / np.bincount(inverse)
    by_corner = totals[inverse].reshape(-1, 3)
    # A face that is there twice in one band has no single value at its corners.
    face_keys, counts = np.unique(labels.astype(np.int64) * len(mesh.faces) + faces, return_counts=True)
    is_single = np.isin(labels.astype(np.int64) * len(mesh.faces) + faces, face_keys[counts == 1])
    return [
        (int(block), corner)
        for block, corner, single in zip(band + first_block, by_corner, is_single, strict=True)
        if single
    ]


@compiled
def _block_links(  # type: ignore[no-untyped-def]
    members: Ints,
    blocks: Ints,
    first: Ints,
    second: Ints,
    neighbors: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
):
    """Blocks of a region whose first faces are side by side over the same second face, (l, 2)."""
    result, size = np.empty((3 * len(members), 2), dtype=np.int64), 0
    begin, end = members[0], members[-1] + 1
    for i in members:
        for k in range(3):
            target = neighbors[first[i], k]
            if target < 0:
                continue
            j = pair_index(target, second[i], second, heads, starts, links)
            if begin <= j < end and j > i:
                result[size, 0], result[size, 1] = blocks[i], blocks[j]
                size += 1
    return result[:size]


def _cut(
    mesh: TriMesh,
    pairs: FacePairs,
    signs: Ints,
    blocks: Ints,
    cut: dict[int, tuple[int, Floats]],
    order: Ints,
) -> CutMesh | None:
    """Cut faces where the values at their corners are zero, and arrange the parts; None on a circle."""
    n, m = len(mesh.vertices), len(mesh.faces)
    new_vertices: dict[tuple[int, int], int] = {}
    edges: list[tuple[int, int]] = []
    shares: list[float] = []

    def new_vertex(a: int, b: int, value_a: float, value_b: float) -> int:
        if a > b:
            a, b, value_a, value_b = b, a, value_b, value_a
        if (a, b) not in new_vertices:
            new_vertices[a, b] = n + len(edges)
            edges.append((a, b))
            share = value_a / (value_a - value_b)
            shares.append(float(np.clip(share, _NEAREST_CUT, 1 - _NEAREST_CUT)))
        return new_vertices[a, b]

    # The first part of a cut face keeps its number, the others get new ones; both sides of each in `parts`.
    part_faces, part_sources = mesh.faces.copy(), np.arange(m)
    extra_faces: list[tuple[int, int, int]] = []
    extra_sources: list[int] = []
    parts: dict[int, list[tuple[int, int]]] = {}  # number and sign of each part, by face
    for face, (_, values) in cut.items():
        positive = values > 0
        single = int(np.flatnonzero(positive == (positive.sum() == 1))[0])
        a, b, c = (int(mesh.faces[face, (single + k) % 3]) for k in range(3))
        u, v, w = (float(values[(single + k) % 3]) for k in range(3))
        p, q = new_vertex(a, b, u, v), new_vertex(a, c, u, w)
        sign = 1 if u > 0 else -1
        part_faces[face] = a, p, q
        parts[face] = [(face, sign)]
        for triangle in ((p, b, c), (p, c, q)):
            parts[face].append((m + len(extra_faces), -sign))
            extra_faces.append(triangle)
            extra_sources.append(face)
    first, second, new_signs = [pairs.first], [pairs.second], [signs.copy()]
    cut_faces = np.zeros(m, dtype=bool)
    cut_faces[list(cut)] = True
    for i in np.flatnonzero(cut_faces[pairs.first] | cut_faces[pairs.second]):
        f, g = int(pairs.first[i]), int(pairs.second[i])
        for part_f, sign_f in parts.get(f, [(f, 0)]):
            for part_g, _ in parts.get(g, [(g, 0)]):
                is_cut_here = f in cut and cut[f][0] == blocks[i]
                sign = sign_f if is_cut_here else int(signs[i])
                if (part_f, part_g) == (f, g):
                    new_signs[0][i] = sign
                else:
                    first.append(np.array([part_f], dtype=np.int32))
                    second.append(np.array([part_g], dtype=np.int32))
                    new_signs.append(np.array([sign], dtype=np.int8))
    total = m + len(extra_faces)
    low, high = low_and_high(np.concatenate(first), np.concatenate(second), np.concatenate(new_signs))
    levels, placed = face_levels(total, low, high)
    if not placed.all():
        return None
    rank = np.empty(m, dtype=np.int64)
    rank[order] = np.arange(m)
    all_sources = np.concatenate([part_sources, np.array(extra_sources, dtype=np.int64)])
    sorting = np.lexsort((rank[all_sources], levels))
    all_faces = np.concatenate([part_faces, np.array(extra_faces, dtype=np.int32).reshape(-1, 3)])
    return CutMesh(
        order,
        all_faces[sorting].astype(np.int32),
        all_sources[sorting].astype(np.int32),
        np.array(edges, dtype=np.int32),
        np.array(shares),
    )
