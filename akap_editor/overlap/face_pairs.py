"""All pairs of faces that overlap in a pose, by connected region."""

from dataclasses import dataclass

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints
from .seeds import overlap_seeds
from .topology import Topology

MAX_PAIRS_PER_FACE = 30  # a pose with more is crumpled beyond any order; two sheets have about eight
_SHORTEST_STRETCH = 1e-9  # share of an edge that must lie inside a face for the overlap to go on across it


@dataclass(frozen=True, eq=False)
class FacePairs:
    """Overlapping pairs of faces of one pose, grouped by their first face; index arrays int32.

    first, second: (p,) the faces of each pair, on the region's sheets 0 and 1; regions: (p,) the number of
    the region, ascending; heads: (m,) the last block of pairs of each first face, −1 without; starts:
    (b + 1,) where the blocks begin; links: (b,) the block before with the same first face, −1 for none;
    is_complete: whether the search ended, which it does not in crumpled poses.
    """

    first: Ints
    second: Ints
    regions: Ints
    heads: Ints
    starts: Ints
    links: Ints
    is_complete: bool = True

    def __len__(self) -> int:
        return len(self.first)

    @property
    def region_count(self) -> int:
        """Number of regions."""
        return int(self.regions[-1]) + 1 if len(self.regions) else 0


def no_face_pairs(face_count: int) -> FacePairs:
    """The pairs of a pose that does not overlap."""
    none = np.zeros(0, dtype=np.int32)
    heads = np.full(face_count, -1, dtype=np.int32)
    return FacePairs(none, none, none, heads, np.zeros(1, dtype=np.int32), none)


def overlapping_faces(topology: Topology, pose: Floats, expected: int = 0) -> FacePairs:
    """All pairs of faces with common area in a pose (n, 2), those that share an edge excepted.

    expected: about how many pairs there are, to reserve memory. The result depends on mesh and pose only. In
    a pose with flipped faces some pairs may be missing.
    """
    seeds, m = overlap_seeds(topology, pose), len(topology.faces)
    if not len(seeds):
        return no_face_pairs(m)
    capacity, most = max(1024, expected + expected // 4), MAX_PAIRS_PER_FACE * m
    while True:
        found = _flood(pose, topology.faces, topology.neighbors, seeds, capacity)
        first, second, regions, heads, starts, links, is_complete = found
        if is_complete or capacity >= most:
            return FacePairs(first, second, regions, heads, starts, links, bool(is_complete))
        capacity = min(4 * capacity, most)


@compiled
def pair_index(first: int, second: int, seconds: Ints, heads: Ints, starts: Ints, links: Ints) -> int:
    """The index of a pair in `FacePairs`, −1 if it is not there in this order."""
    block = heads[first]
    while block >= 0:
        for i in range(starts[block], starts[block + 1]):
            if seconds[i] == second:
                return i
        block = links[block]
    return -1


@compiled
def stretch_inside(
    px: float,
    py: float,
    qx: float,
    qy: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    cx: float,
    cy: float,
) -> float:
    """The share of the segment from p to q that lies inside the triangle a, b, c of positive area."""
    begin, end = 0.0, 1.0
    d = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
    e = (bx - ax) * (qy - ay) - (by - ay) * (qx - ax)
    if d <= 0 and e <= 0:
        return 0.0
    if d < 0:
        begin = d / (d - e)
    elif e < 0:
        end = d / (d - e)
    d = (cx - bx) * (py - by) - (cy - by) * (px - bx)
    e = (cx - bx) * (qy - by) - (cy - by) * (qx - bx)
    if d <= 0 and e <= 0:
        return 0.0
    if d < 0:
        begin = max(begin, d / (d - e))
    elif e < 0:
        end = min(end, d / (d - e))
    d = (ax - cx) * (py - cy) - (ay - cy) * (px - cx)
    e = (ax - cx) * (qy - cy) - (ay - cy) * (qx - cx)
    if d <= 0 and e <= 0:
        return 0.0
    if d < 0:
        begin = max(begin, d / (d - e))
    elif e < 0:
        end = min(end, d / (d - e))
    return end - begin


@compiled
def _flood(pose: Floats, faces: Ints, neighbors: Ints, seeds: Ints, capacity: int):  # type: ignore[no-untyped-def]
    """Walk from the seeds over edges of either face that have a stretch inside the other face.

    A block holds the second faces of one first face that are connected inside it. Returns the arrays of
    `FacePairs`, and whether they are complete.
    """
    m = len(faces)
    heads = np.full(m, -1, dtype=np.int32)
    first, second = np.empty(capacity, dtype=np.int32), np.empty(capacity, dtype=np.int32)
    regions = np.empty(capacity, dtype=np.int32)
    starts, links = np.empty(capacity + 1, dtype=np.int32), np.empty(capacity, dtype=np.int32)
    visited = np.zeros(m, dtype=np.int32)  # the last block that reached each second face
    size, blocks, count = 0, 0, 0
    starts[0] = 0
    for seed in range(len(seeds)):
        f, g = seeds[seed, 0], seeds[seed, 1]
        if (
            pair_index(f, g, second, heads, starts, links) >= 0
            or pair_index(g, f, second, heads, starts, links) >= 0
        ):
            continue
        count += 1
        pending, walked = True, size  # `walked`: pairs whose first face has been walked on from
        while True:
            if pending:  # a new block of the first face f, from the second face g on
                pending = False
                begin, reached = size, size
                ax, ay = pose[faces[f, 0], 0], pose[faces[f, 0], 1]
                bx, by = pose[faces[f, 1], 0], pose[faces[f, 1], 1]
                cx, cy = pose[faces[f, 2], 0], pose[faces[f, 2], 1]
                if size >= capacity:
                    return first[:size], second[:size], regions[:size], heads, starts, links, False
                second[size] = g
                size += 1
                visited[g] = blocks + 1
                while reached < size:
                    other = second[reached]
                    reached += 1
                    for k in range(3):
                        target = neighbors[other, k]
                        if target < 0 or target == f or visited[target] == blocks + 1:
                            continue
                        p, q = faces[other, k], faces[other, k + 1 if k < 2 else 0]
                        share = stretch_inside(
                            pose[p, 0], pose[p, 1], pose[q, 0], pose[q, 1], ax, ay, bx, by, cx, cy
                        )
                        if share <= _SHORTEST_STRETCH:
                            continue
                        if heads[target] >= 0 and pair_index(target, f, second, heads, starts, links) >= 0:
                            continue  # the same pair with its sheets exchanged
                        if size >= capacity:
                            return first[:size], second[:size], regions[:size], heads, starts, links, False
                        visited[target] = blocks + 1
                        second[size] = target
                        size += 1
                for i in range(begin, size):
                    first[i], regions[i] = f, count - 1
                links[blocks] = heads[f]
                heads[f] = blocks
                blocks += 1
                starts[blocks] = size
            if walked == size:
                break
            f0, other = first[walked], second[walked]
            ax, ay = pose[faces[other, 0], 0], pose[faces[other, 0], 1]
            bx, by = pose[faces[other, 1], 0], pose[faces[other, 1], 1]
            cx, cy = pose[faces[other, 2], 0], pose[faces[other, 2], 1]
            for k in range(3):
                target = neighbors[f0, k]
                if target < 0 or target == other:
                    continue
                p, q = faces[f0, k], faces[f0, k + 1 if k < 2 else 0]
                share = stretch_inside(pose[p, 0], pose[p, 1], pose[q, 0], pose[q, 1], ax, ay, bx, by, cx, cy)
                if (
                    share <= _SHORTEST_STRETCH
                    or pair_index(target, other, second, heads, starts, links) >= 0
                    or (heads[other] >= 0 and pair_index(other, target, second, heads, starts, links) >= 0)
                ):
                    continue
                f, g, pending = target, other, True
                break
            if not pending:
                walked += 1
    return first[:size], second[:size], regions[:size], heads, starts[: blocks + 1], links[:blocks], True
