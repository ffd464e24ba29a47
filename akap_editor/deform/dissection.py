"""Nested dissection of a mesh: the order of elimination that keeps Cholesky factors small.

A separator is a set of vertices whose removal leaves two halves without an edge between them. If both halves
are eliminated before it, they fill no entries between them (George 1973, "Nested Dissection of a Regular
Finite Element Mesh"). Applied to the halves again and again, this gives factors with O(n log n) nonzeros.
"""

from typing import NamedTuple

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Indices, Ints

_DIRECTIONS = 4  # of the lines that are tried as a cut; even, so that each has a perpendicular one
_MIN_SHARE = 0.25  # of a region's vertices on the smaller side of a cut
_IMBALANCE_COST = 4.0  # the cost of a separator grows by this factor times the squared imbalance, 0 to 1


class Dissection(NamedTuple):
    """An order of elimination, cut into the groups of vertices that are eliminated together.

    order: (n,) int32, the vertices in the order of elimination; starts: (f + 1,) int32, where each group
    begins in it, and n. A group is a separator or a part that was too small to be cut.
    """

    order: Ints
    starts: Ints


def dissect(points: Floats, edges: Ints, smallest: int = 10) -> Dissection:
    """Nested dissection of a graph with vertices at ``points`` (n, 2) and ``edges`` (e, 2), each once.

    smallest: number of vertices up to which a part is not cut. Cuts are straight lines in four directions.
    Of all lines that leave a quarter of the vertices on either side, the one with the smallest separator
    wins.
    """
    angles = np.arange(_DIRECTIONS) * (np.pi / _DIRECTIONS)
    along = points @ np.stack([np.cos(angles), np.sin(angles)])
    sorted_vertices = np.argsort(along.T, axis=1, kind="stable").astype(np.uint32)
    return Dissection(*_dissect(sorted_vertices, edges.astype(np.uint32), smallest))


@compiled
def _neighbors(n: int, edges: Indices) -> tuple[Ints, Ints, Indices]:
    """Where the neighbors of each vertex start and end, (n,) each, in an array of all neighbors (2e,)."""
    starts = np.zeros(n + 1, dtype=np.int32)
    for e in range(len(edges)):
        starts[edges[e, 0] + 1] += 1
        starts[edges[e, 1] + 1] += 1
    for v in range(n):
        starts[v + 1] += starts[v]
    ends = starts[:-1].copy()
    neighbors = np.empty(2 * len(edges), dtype=np.uint32)
    for e in range(len(edges)):
        for side in range(2):
            v = edges[e, side]
            neighbors[ends[v]] = edges[e, 1 - side]
            ends[v] += 1
    return starts[:-1], ends, neighbors


@compiled
def _dissect(lists: Indices, edges: Indices, smallest: int) -> tuple[Ints, Ints]:
    """The order and the starts of a `Dissection`.

    lists: (directions, n) the vertices sorted along each direction; overwritten. A region is the same range
    low:high of all lists. It is split stably, so that nothing is sorted again. The neighbors of a vertex are
    those in its region.
    """
    n = lists.shape[1]
    graph = _neighbors(n, edges)
    order, starts = np.empty(n, dtype=np.int32), np.zeros(2 * n + 2, dtype=np.int32)
    rank, part = np.empty(n, dtype=np.int32), np.empty(n, dtype=np.int8)
    count = 0
    stack = np.empty((2 * n + 1, 3), dtype=np.int32)  # low, high, and 1 if the range is a separator
    stack[0, 0], stack[0, 1], stack[0, 2] = 0, n, 0
    depth = 1
    while depth > 0:
        depth -= 1
        low, high, is_separator = stack[depth, 0], stack[depth, 1], stack[depth, 2] == 1
        if high == low:
            continue
        if is_separator or high - low <= smallest:
            if not is_separator:
                for k in range(low, high):
                    order[k] = lists[0, k]
            count += 1
            starts[count] = high
            continue
        direction, cut, from_lower = _best_cut(lists[:, low:high], rank, graph)
        _mark_parts(lists[direction, low:high], cut, from_lower, rank, part, graph)
        left, right = _split(lists[:, low:high], part)
        middle, end = low + left, low + left + right
        # along the cut, so that what a part touches of its separators are a few contiguous stretches
        along = (direction + len(lists) // 2) % len(lists)
        for k in range(end, high):
            order[k] = lists[along, k]
        stack[depth, 0], stack[depth, 1], stack[depth, 2] = end, high, 1
        stack[depth + 1, 0], stack[depth + 1, 1], stack[depth + 1, 2] = middle, end, 0
        stack[depth + 2, 0], stack[depth + 2, 1], stack[depth + 2, 2] = low, middle, 0
        depth += 3
    return order, starts[: count + 1].copy()


@compiled
def _best_cut(lists: Indices, rank: Ints, graph: tuple[Ints, Ints, Indices]) -> tuple[int, int, bool]:
    """The direction and position of the cheapest cut of a region, and whether the separator lies below it.

    Either side of a cut has a separator: its vertices with a neighbor on the other side. A vertex of rank k
    with neighbors of ranks from a to b is in the lower separator of the cuts after k, ..., b − 1, and in the
    upper one of those after a, ..., k − 1. So one sweep counts the separators of all cuts.
    """
    neighbor_starts, neighbor_ends, neighbors = graph
    size = lists.shape[1]
    lower, upper = np.empty(size + 1, dtype=np.int32), np.empty(size + 1, dtype=np.int32)
    best, best_direction, best_cut, from_lower = np.inf, 0, size // 2, True
    for direction in range(len(lists)):
        vertices = lists[direction]
        for k in range(size):
            rank[vertices[k]] = k
        for k in range(size + 1):
            lower[k] = upper[k] = 0
        for k in range(size):
            first = last = k
            v = vertices[k]
            for q in range(neighbor_starts[v], neighbor_ends[v]):
                other = rank[neighbors[q]]
                first, last = min(first, other), max(last, other)
            lower[k] += 1
            lower[last] -= 1
            upper[first] += 1
            upper[k] -= 1
        below = above = 0
        margin = max(int(_MIN_SHARE * size), 1)
        for k in range(size - margin):
            below += lower[k]
            above += upper[k]
            if k + 1 < margin:
                continue
            imbalance = 2.0 * (k + 1) / size - 1.0
            cost = min(below, above) * (1.0 + _IMBALANCE_COST * imbalance * imbalance)
            if cost < best:
                best, best_direction, best_cut, from_lower = cost, direction, k + 1, below <= above
    return best_direction, best_cut, from_lower


@compiled
def _mark_parts(
    vertices: Indices, cut: int, from_lower: bool, rank: Ints, part: Ints, graph: tuple[Ints, Ints, Indices]
) -> None:
    """Set ``part`` of a region's vertices, sorted across the cut: 0 below it, 1 above it, 2 separator.

    From then on, neighbors are those in the same part.
    """
    neighbor_starts, neighbor_ends, neighbors = graph
    for k in range(len(vertices)):
        rank[vertices[k]] = k
    for k in range(len(vertices)):
        v, is_lower = vertices[k], k < cut
        part[v] = 0 if is_lower else 1
        if is_lower == from_lower:
            for q in range(neighbor_starts[v], neighbor_ends[v]):
                if (rank[neighbors[q]] < cut) != is_lower:
                    part[v] = 2
                    break
    for k in range(len(vertices)):
        v = vertices[k]
        end = neighbor_starts[v]
        for q in range(neighbor_starts[v], neighbor_ends[v]):
            if part[neighbors[q]] == part[v]:
                neighbors[end] = neighbors[q]
                end += 1
        neighbor_ends[v] = end


@compiled
def _split(lists: Indices, part: Ints) -> tuple[int, int]:
    """Reorder each list by ``part``, stably; returns the numbers of vertices in parts 0 and 1."""
    size = lists.shape[1]
    other = np.empty(size, dtype=np.uint32)
    left = right = 0
    for direction in range(len(lists)):
        vertices = lists[direction]
        left = right = separator = 0
        for k in range(size):
            v = vertices[k]
            vertices[left] = other[right] = v  # overwritten where it is the other part's
            left += part[v] == 0
            right += part[v] == 1
            if part[v] == 2:
                separator += 1
                other[size - separator] = v  # backwards
        for k in range(right):
            vertices[left + k] = other[k]
        for k in range(separator):
            vertices[left + right + k] = other[size - 1 - k]
    return left, right
