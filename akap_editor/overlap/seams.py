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
    none = np.zeros(0, dtype=np.int32)
    found = cut_for_motion(mesh, overlaps, order, none, none)
    return None if found is None else found[0]


def cut_for_motion(
    mesh: TriMesh, overlaps: Overlaps, order: Ints, low: Ints, high: Ints
) -> tuple[CutMesh, Ints, Ints] | None:
    """The mesh cut along the seams of one pose of a motion, in an order that holds in all its poses.

    low, high: (q,) lower and upper faces that overlap in some pose, which with the decisions in ``overlaps``
    are in no circle. Returns the pairs of the faces of the cut mesh, too, lower and upper (p,) each; None if
    there is no seam, or no order.
    """
    pairs = overlaps.pairs
    signs = overlaps.signs.copy()
    candidates: dict[int, list[tuple[int, Floats]]] = defaultdict(list)  # blocks and corner values by face
    blocks = np.repeat(np.arange(len(pairs.links)), np.diff(pairs.starts))
    for region in range(pairs.region_count):
        members = np.flatnonzero(pairs.regions == region)
        if signs[members].min() == signs[members].max():
            continue
        band, corners = _block_values(mesh, pairs, signs, members, blocks)
        sides = np.zeros(len(pairs.links), dtype=np.int8)  # of each block in the band that is not cut
        sides[band] = (corners.min(axis=1) >= 0).astype(np.int8) - (corners.max(axis=1) <= 0)
        signs = np.where(sides[blocks], sides[blocks], signs)
        is_cut = sides[band] == 0
        for block, values in zip(band[is_cut].tolist(), corners[is_cut], strict=True):
            candidates[int(pairs.first[pairs.starts[block]])].append((block, values))
    cut = {face: found[0] for face, found in candidates.items() if len(found) == 1}
    return _cut(mesh, pairs, signs, blocks, cut, order, low, high) if cut else None


def _block_values(
    mesh: TriMesh, pairs: FacePairs, signs: Ints, members: Ints, blocks: Ints
) -> tuple[Ints, Floats]:
    """Blocks of pairs near the seams of a region, (b,), and a smooth value at their faces' corners, (b, 3).

    The value is positive where the first sheet is in front; its zeros are the straightened seams.
    """
    topology = mesh_topology(mesh)
    links = _block_links(
        members,
        blocks,
        signs,
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
    band, smoothed = _straightened(graph.indptr, graph.indices, means)
    values = smoothed[band]
    labels = connected_components(graph[band][:, band], directed=False)[1]
    faces = pairs.first[pairs.starts[band + first_block]]
    corners = mesh.faces[faces]
    keys = labels[:, None].astype(np.int64) * len(mesh.vertices) + corners
    unique, inverse = np.unique(keys, return_inverse=True)
    inverse = inverse.reshape(-1)
    totals = np.bincount(inverse, np.repeat(values, 3), len(unique)) / np.bincount(inverse)
    by_corner = totals[inverse].reshape(-1, 3)
    # A face that is there twice in one band has no single value at its corners.
    face_keys, counts = np.unique(labels.astype(np.int64) * len(mesh.faces) + faces, return_counts=True)
    is_single = np.isin(labels.astype(np.int64) * len(mesh.faces) + faces, face_keys[counts == 1])
    return (band + first_block)[is_single], by_corner[is_single]


@compiled
def _straightened(starts: Ints, neighbors: Ints, means: Floats):  # type: ignore[no-untyped-def]
    """The blocks near a change of sign, (b,) ascending, and the mean signs (n,), smoothed between those.

    starts, neighbors: the graph of blocks by rows; means: (n,) mean sign of each block.
    """
    distance = np.empty(len(means), dtype=np.int64)
    queue, size, reached = np.empty(len(means), dtype=np.int64), 0, 0
    for i in range(len(means)):
        distance[i] = -1
        total = 0.0
        for j in range(starts[i], starts[i + 1]):
            total += means[neighbors[j]]
        if abs(means[i]) < 1 or abs(total) < starts[i + 1] - starts[i]:
            distance[i] = 0
            queue[size] = i
            size += 1
    while reached < size:
        i = queue[reached]
        reached += 1
        for j in range(starts[i], starts[i + 1]):
            if distance[i] < _BAND and distance[neighbors[j]] < 0:
                distance[neighbors[j]] = distance[i] + 1
                queue[size] = neighbors[j]
                size += 1
    size = 0
    for i in range(len(means)):
        if distance[i] >= 0:
            queue[size] = i
            size += 1
    band = queue[:size]
    values, smoothed = means.copy(), means.copy()
    for _ in range(_ROUNDS):
        for i in band:
            total, is_inner = 0.0, starts[i + 1] > starts[i]
            for j in range(starts[i], starts[i + 1]):
                is_inner &= distance[neighbors[j]] >= 0
                total += values[neighbors[j]]
            if is_inner:
                smoothed[i] = 0.25 * values[i] + 0.75 * total / (starts[i + 1] - starts[i])
        for i in band:
            values[i] = smoothed[i]
    return band, values


@compiled
def _block_links(  # type: ignore[no-untyped-def]
    members: Ints,
    blocks: Ints,
    signs: Ints,
    first: Ints,
    second: Ints,
    neighbors: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
):
    """Blocks of a region whose first faces are side by side over the same second face, (l, 2).

    Only those not much farther from a seam than the band in which it is straightened; signs: (p,) of pairs.
    """
    sides = np.zeros(len(neighbors), dtype=np.int8)  # of each first face: 1 with a positive pair, 2 negative
    for i in members:
        sides[first[i]] |= 1 if signs[i] > 0 else 2
    distance = np.empty(len(neighbors), dtype=np.int64)
    queue, size, reached = np.empty(len(neighbors), dtype=np.int64), 0, 0
    for f in range(len(neighbors)):
        around, distance[f] = sides[f], -1
        for k in range(3):
            if around and neighbors[f, k] >= 0:
                around |= sides[neighbors[f, k]]
        if around == 3:
            distance[f] = 0
            queue[size] = f
            size += 1
    while reached < size:
        f = queue[reached]
        reached += 1
        for k in range(3):
            target = neighbors[f, k]
            if distance[f] < _BAND + 2 and target >= 0 and sides[target] and distance[target] < 0:
                distance[target] = distance[f] + 1
                queue[size] = target
                size += 1
    result, size = np.empty((3 * len(members), 2), dtype=np.int64), 0
    begin, end = members[0], members[-1] + 1
    for i in members:
        for k in range(3):
            target = neighbors[first[i], k]
            if distance[first[i]] < 0 or target < 0 or distance[target] < 0:
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
    other_low: Ints,
    other_high: Ints,
) -> tuple[CutMesh, Ints, Ints] | None:
    """Cut faces where the values at their corners are zero, and arrange the parts; None on a circle.

    other_low, other_high: (q,) pairs of other poses. Returns the lower and upper face of all pairs, too.
    """
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
    # Of a cut face, the pairs of its first part replace those of the face, the others are added.
    signs, added = signs.copy(), list[tuple[int, int, int]]()
    cut_faces = np.zeros(m, dtype=bool)
    cut_faces[list(cut)] = True
    touched = np.flatnonzero(cut_faces[pairs.first] | cut_faces[pairs.second])
    columns = (touched, pairs.first[touched], pairs.second[touched], signs[touched], blocks[touched])
    for i, f, g, old_sign, block in zip(*(column.tolist() for column in columns), strict=True):
        is_cut_here = f in cut and cut[f][0] == block
        for part_f, sign_f in parts.get(f, [(f, 0)]):
            for part_g, _ in parts.get(g, [(g, 0)]):
                sign = sign_f if is_cut_here else old_sign
                if (part_f, part_g) == (f, g):
                    signs[i] = sign
                else:
                    added.append((part_f, part_g, sign))
    others = _pairs_of_parts(mesh, pairs, cut, parts, other_low, other_high)
    total = m + len(extra_faces)
    extra = np.concatenate([np.array(added, dtype=np.int32).reshape(-1, 3), others])
    first, second = np.concatenate([pairs.first, extra[:, 0]]), np.concatenate([pairs.second, extra[:, 1]])
    low, high = low_and_high(first, second, np.concatenate([signs, extra[:, 2].astype(np.int8)]))
    levels, placed = face_levels(total, low, high)
    if not placed.all():
        return None
    rank = np.empty(m, dtype=np.int64)
    rank[order] = np.arange(m)
    all_sources = np.concatenate([part_sources, np.array(extra_sources, dtype=np.int64)])
    sorting = np.lexsort((rank[all_sources], levels))
    all_faces = np.concatenate([part_faces, np.array(extra_faces, dtype=np.int32).reshape(-1, 3)])
    sorted_rank = np.empty(total, dtype=np.int32)
    sorted_rank[sorting] = np.arange(total)
    result = CutMesh(
        order,
        all_faces[sorting].astype(np.int32),
        all_sources[sorting].astype(np.int32),
        np.array(edges, dtype=np.int32),
        np.array(shares),
    )
    return result, sorted_rank[low], sorted_rank[high]


def _pairs_of_parts(
    mesh: TriMesh,
    pairs: FacePairs,
    cut: dict[int, tuple[int, Floats]],
    parts: dict[int, list[tuple[int, int]]],
    low: Ints,
    high: Ints,
) -> Ints:
    """First and second part and sign of each pair of other poses that is not among the ``pairs``, (r, 3).

    A part of a cut face is in front of faces beside those that the cut is for, or behind them, as it is of
    these: there the seam of the other pose is replaced by that of this one.
    """
    m = len(mesh.faces)
    known = pairs.first.astype(np.int64) * m + pairs.second, pairs.second.astype(np.int64) * m + pairs.first
    codes = low.astype(np.int64) * m + high
    is_new = ~np.isin(codes, np.concatenate(known))
    low, high = low[is_new], high[is_new]
    has_parts = np.zeros(m, dtype=bool)
    has_parts[list(parts)] = True
    is_whole = ~(has_parts[low] | has_parts[high])
    neighbors = mesh_topology(mesh).neighbors
    partners: dict[int, set[int]] = {}
    for face, (block, _) in cut.items():
        faces = pairs.second[pairs.starts[block] : pairs.starts[block + 1]]
        partners[face] = {*faces.tolist(), *neighbors[faces].ravel().tolist()}
    result = []
    for lower, upper in zip(low[~is_whole].tolist(), high[~is_whole].tolist(), strict=True):
        for part, sign in parts.get(lower, [(lower, -1)]):
            for other, other_sign in parts.get(upper, [(upper, 1)]):
                if upper in partners.get(lower, ()):
                    result.append((part, other, sign))
                elif lower in partners.get(upper, ()):
                    result.append((part, other, -other_sign))
                else:
                    result.append((part, other, -1))
    whole = np.stack([low[is_whole], high[is_whole], np.full(is_whole.sum(), -1)], axis=1)
    return np.concatenate([whole.astype(np.int32), np.array(result, dtype=np.int32).reshape(-1, 3)])
