"""Where a region is cut in which no single decision can hold: along the least visible seam."""

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints
from .common_area import common_areas
from .face_pairs import FacePairs, pair_index, stretch_inside
from .topology import Topology

HIDDEN_SEAM = 0.1  # cost of a seam under a third sheet, as a share of its cost in the open
BAND = 8  # steps from pair to pair by which a seam can move at once
_PIXELS_TO_UNITS = 64.0  # capacities of the flow are whole numbers
_FIXED = np.int32(2**28)


@compiled
def adjacent_pairs(  # type: ignore[no-untyped-def]
    i: int,
    begin: int,
    end: int,
    first: Ints,
    second: Ints,
    neighbors: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
    result: Ints,
):
    """Write to ``result`` (6,) the pairs beside pair i, −1 for none: three across edges of each face.

    begin, end: the region's pairs, which are consecutive; faces side by side may overlap in two regions.
    A pair j whose sheets are exchanged, as around a point where the pose winds twice, is written as −2 − j.
    """
    f, g = first[i], second[i]
    for k in range(6):
        target = neighbors[f, k] if k < 3 else neighbors[g, k - 3]
        result[k] = -1
        if target >= 0:
            a, b = (target, g) if k < 3 else (f, target)
            j = pair_index(a, b, second, heads, starts, links)
            if begin <= j < end:
                result[k] = j
            elif heads[b] >= 0:
                j = pair_index(b, a, second, heads, starts, links)
                if begin <= j < end:
                    result[k] = -2 - j


@compiled
def spread_signs(  # type: ignore[no-untyped-def]
    members: Ints,
    signs: Ints,
    first: Ints,
    second: Ints,
    neighbors: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
    is_exchanged: bool,
):
    """Give each of ``members`` without a sign that of the nearest pair with one; changes ``signs``.

    members: indices of all pairs of one region; is_exchanged: see `FacePairs.exchanged`. Without it, pairs
    that `adjacent_pairs` calls exchanged only meet at a corner.
    """
    begin, end = members[0], members[-1] + 1
    queue, size = np.empty(len(members), dtype=np.int64), 0
    beside = np.empty(6, dtype=np.int64)
    is_source = np.zeros(end - begin, dtype=np.bool_)  # pairs beside one without a sign
    for i in members:
        if signs[i] == 0:
            adjacent_pairs(i, begin, end, first, second, neighbors, heads, starts, links, beside)
            for j in beside:
                if j >= 0 or (is_exchanged and j < -1):
                    is_source[(j if j >= 0 else -2 - j) - begin] = True
    for i in members:
        if signs[i] != 0 and is_source[i - begin]:
            queue[size] = i
            size += 1
    reached = 0
    while reached < size:
        i = queue[reached]
        reached += 1
        adjacent_pairs(i, begin, end, first, second, neighbors, heads, starts, links, beside)
        for j in beside:
            sign = signs[i] if j >= 0 else -signs[i]
            if is_exchanged and j < -1:
                j = -2 - j
            if j >= 0 and signs[j] == 0:
                signs[j] = sign
                queue[size] = j
                size += 1


@compiled
def seam_pairs(  # type: ignore[no-untyped-def]
    members: Ints,
    signs: Ints,
    first: Ints,
    second: Ints,
    neighbors: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
    steps: int,
    is_exchanged: bool,
):
    """The pairs of a region that are at most ``steps`` pairs from one of the other sign, (q,), seam first.

    members: indices of all pairs of the region; is_exchanged: see `FacePairs.exchanged`.
    """
    begin, end = members[0], members[-1] + 1
    sides = np.zeros(len(neighbors), dtype=np.int8)  # of each first face: 1 with a positive pair, 2 negative
    for i in members:
        sides[first[i]] |= 1 if signs[i] > 0 else 2
    distance = np.empty(len(first), dtype=np.int32)
    for i in range(len(first)):
        distance[i] = -1
    queue, size = np.empty(len(members), dtype=np.int64), 0
    beside = np.empty(6, dtype=np.int64)
    for i in members:
        around = sides[first[i]]
        for k in range(3):
            if neighbors[first[i], k] >= 0:
                around |= sides[neighbors[first[i], k]]
        if around != 3 and not is_exchanged:
            continue
        adjacent_pairs(i, begin, end, first, second, neighbors, heads, starts, links, beside)
        for j in beside:
            is_turned = is_exchanged and j < -1 and signs[-2 - j] == signs[i]
            if is_turned or (j >= 0 and signs[j] == -signs[i]):
                distance[i] = 0
                queue[size] = i
                size += 1
                break
    reached = 0
    while reached < size and distance[queue[reached]] < steps:
        i = queue[reached]
        reached += 1
        adjacent_pairs(i, begin, end, first, second, neighbors, heads, starts, links, beside)
        for j in beside:
            if j >= 0 and distance[j] < 0:
                distance[j] = distance[i] + 1
                queue[size] = j
                size += 1
    return queue[:size].copy()


@compiled
def _borders(  # type: ignore[no-untyped-def]
    members: Ints,
    begin: int,
    end: int,
    pose: Floats,
    faces: Ints,
    first: Ints,
    second: Ints,
    neighbors: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
):
    """Borders of the pairs ``members``: the pairs on both sides, (b, 2), and lengths (b,) in pixels.

    begin, end: the region's pairs.
    """
    inside = np.zeros(len(first), dtype=np.bool_)
    for i in members:
        inside[i] = True
    sides, lengths = np.empty((6 * len(members), 2), dtype=np.int64), np.empty(6 * len(members))
    beside = np.empty(6, dtype=np.int64)
    size = 0
    for i in members:
        adjacent_pairs(i, begin, end, first, second, neighbors, heads, starts, links, beside)
        for k in range(6):
            j = beside[k]
            if j < 0 or (inside[j] and j < i):
                continue
            walker, other = (first[i], second[i]) if k < 3 else (second[i], first[i])
            corner = k if k < 3 else k - 3
            p, q = faces[walker, corner], faces[walker, (corner + 1) % 3]
            a, b, c = faces[other, 0], faces[other, 1], faces[other, 2]
            share = stretch_inside(
                pose[p, 0],
                pose[p, 1],
                pose[q, 0],
                pose[q, 1],
                pose[a, 0],
                pose[a, 1],
                pose[b, 0],
                pose[b, 1],
                pose[c, 0],
                pose[c, 1],
            )
            sides[size, 0], sides[size, 1] = i, j
            lengths[size] = share * np.hypot(pose[q, 0] - pose[p, 0], pose[q, 1] - pose[p, 1])
            size += 1
    return sides[:size], lengths[:size]


def cut_signs(
    topology: Topology,
    pose: Floats,
    pairs: FacePairs,
    members: Ints,
    signs: Ints,
    firmness: Floats,
    hidden: Ints,
    steps: int = BAND,
) -> Ints:
    """The signs (p,) int8 with the seams of one region moved to where they are seen least.

    members: indices of the region's pairs; signs: (p,) wanted, none 0; firmness: (p,) cost per square pixel
    of a pair that comes out otherwise, in pixels of a seam; hidden: (p,) whether a third sheet covers a pair.
    A least cut (Boykov and Jolly 2001) among the pairs that are at most ``steps`` from a seam.
    """
    arrays = pairs.first, pairs.second, topology.neighbors, pairs.heads, pairs.starts, pairs.links
    is_exchanged = bool(pairs.exchanged[pairs.regions[members[0]]])
    band = seam_pairs(members, signs, *arrays, steps, is_exchanged)
    if not len(band):
        return signs
    sides, lengths = _borders(band, members[0], members[-1] + 1, pose, topology.faces, *arrays)
    n = len(band)
    local = np.full(len(pairs), -1)
    local[band] = np.arange(n)
    areas = common_areas(pose, topology.faces, pairs.first[band], pairs.second[band])
    pull = np.minimum(_PIXELS_TO_UNITS * firmness[band] * areas, float(_FIXED)).astype(np.int32)
    beyond = local[sides[:, 1]] < 0  # the band ends here
    fixed = np.zeros(n, dtype=bool)
    fixed[local[sides[beyond, 0]]] = True
    pull[fixed] = _FIXED
    i, j = local[sides[~beyond]].T
    covered = hidden[sides[~beyond]].all(axis=1)
    costs = lengths[~beyond] * np.where(covered, HIDDEN_SEAM, 1.0)
    capacities = np.minimum(_PIXELS_TO_UNITS * costs, float(_FIXED)).astype(np.int32) + 1
    source, sink = n, n + 1
    above, below = np.flatnonzero(signs[band] > 0), np.flatnonzero(signs[band] < 0)
    rows = np.concatenate([i, j, np.full(len(above), source), below])
    columns = np.concatenate([j, i, above, np.full(len(below), sink)])
    values = np.concatenate([capacities, capacities, pull[above], pull[below]])
    graph = csr_array((values, (rows, columns)), shape=(n + 2, n + 2), dtype=np.int32)
    graph.sum_duplicates()
    residual = graph - maximum_flow(graph, source, sink).flow
    residual.data = np.maximum(residual.data, 0)
    residual.eliminate_zeros()
    reached = breadth_first_order(residual, source, return_predecessors=False)
    result = signs.copy()
    result[band] = -1
    result[band[reached[reached < n]]] = 1
    return result
