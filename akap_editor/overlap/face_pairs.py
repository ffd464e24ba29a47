"""All pairs of faces that overlap in a pose, by connected region."""

from dataclasses import dataclass

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints, read_only
from .seeds import enlarged, overlap_seeds
from .topology import Topology

MAX_PAIRS_PER_FACE = 30  # a pose with more is crumpled beyond any order; two sheets have about eight
_SHORTEST_STRETCH = 1e-9  # share of an edge that must lie inside a face for the overlap to go on across it


@dataclass(frozen=True, eq=False)
class FacePairs:
    """Overlapping pairs of faces of one pose, grouped by their first face; index arrays int32.

    first, second: (p,) the faces of each pair, on the region's sheets 0 and 1; regions: (p,) the number of
    the region, ascending; heads: (m,) the last block of pairs of each first face, −1 without; starts:
    (b + 1,) where the blocks begin; links: (b,) the block before with the same first face, −1 for none;
    exchanged: (r,) whether two pairs side by side in a region have their sheets exchanged, as around a point
    where the pose winds twice; is_complete: whether the search ended, which it does not in crumpled poses.
    """

    first: Ints
    second: Ints
    regions: Ints
    heads: Ints
    starts: Ints
    links: Ints
    exchanged: Ints
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
    return FacePairs(none, none, none, heads, np.zeros(1, dtype=np.int32), none, np.zeros(0, dtype=bool))


def overlapping_faces(topology: Topology, pose: Floats, expected: int = 0) -> FacePairs:
    """All pairs of faces with common area in a pose (n, 2), those that share an edge excepted.

    expected: about how many pairs there are, to reserve memory. The result depends on mesh and pose only. In
    a pose with flipped faces some pairs may be missing.
    """
    pose = read_only(pose)
    seeds, m = overlap_seeds(topology, pose), len(topology.faces)
    if not len(seeds):
        return no_face_pairs(m)
    capacity, most = max(1024, expected + expected // 4), MAX_PAIRS_PER_FACE * m
    while True:
        found = _flood(pose, topology.faces, topology.neighbors, seeds, capacity)
        if found[-1] or capacity >= most:
            return FacePairs(*found)
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
    return positive_stretch(
        (bx - ax) * (py - ay) - (by - ay) * (px - ax),
        (bx - ax) * (qy - ay) - (by - ay) * (qx - ax),
        (cx - bx) * (py - by) - (cy - by) * (px - bx),
        (cx - bx) * (qy - by) - (cy - by) * (qx - bx),
        (ax - cx) * (py - cy) - (ay - cy) * (px - cx),
        (ax - cx) * (qy - cy) - (ay - cy) * (qx - cx),
    )


@compiled
def positive_stretch(ap: float, aq: float, bp: float, bq: float, cp: float, cq: float) -> float:
    """The share of a segment from p to q on which three linear functions are positive.

    Their values at p and q: ap and aq of the first one, and so on.
    """
    # Bitwise operators and selections: branches here would be mispredicted half of the time
    if ((ap <= 0) & (aq <= 0)) | ((bp <= 0) & (bq <= 0)) | ((cp <= 0) & (cq <= 0)):
        return 0.0
    a, b, c = ap / (ap - aq), bp / (bp - bq), cp / (cp - cq)
    begin = a if ap < 0 else 0.0
    end = a if aq < 0 else 1.0
    begin = b if (bp < 0) & (b > begin) else begin
    end = b if (bq < 0) & (b < end) else end
    begin = c if (cp < 0) & (c > begin) else begin
    end = c if (cq < 0) & (c < end) else end
    return end - begin


@compiled
def _flood(pose: Floats, faces: Ints, neighbors: Ints, seeds: Ints, capacity: int):  # type: ignore[no-untyped-def]
    """Walk from the seeds over edges of either face that have a stretch inside the other face.

    A block holds the second faces of one first face that are connected inside it. Returns the arrays of
    `FacePairs`, and whether they are complete.
    """
    m = len(faces)
    heads = np.empty(m, dtype=np.int32)
    for f in range(m):
        heads[f] = -1
    first, second = np.empty(capacity, dtype=np.int32), np.empty(capacity, dtype=np.int32)
    regions, crossed = np.empty(capacity, dtype=np.int32), np.empty(capacity, dtype=np.int8)
    starts, links = np.empty(capacity + 1, dtype=np.int32), np.empty(capacity, dtype=np.int32)
    visited = np.zeros(m, dtype=np.int32)  # the last block that reached each second face
    exchanged = np.zeros(len(seeds), dtype=np.bool_)
    stack, depth = np.empty((256, 2), dtype=np.int32), 0  # where new blocks may begin
    corners = _face_corners(pose, faces)
    size, blocks, count = 0, 0, 0
    starts[0] = 0
    for seed in range(len(seeds)):
        stack[0, 0], stack[0, 1], depth = seeds[seed, 0], seeds[seed, 1], 1
        is_new = True
        while depth > 0:
            depth -= 1
            f, g = stack[depth, 0], stack[depth, 1]
            if pair_index(f, g, second, heads, starts, links) >= 0:
                continue
            if heads[g] >= 0 and pair_index(g, f, second, heads, starts, links) >= 0:
                exchanged[count - 1] |= not is_new
                continue
            if is_new:
                count += 1
                is_new = False
            begin = starts[blocks]
            size, is_exchanged = _fill_block(
                f, g, begin, blocks + 1, corners, neighbors, second, heads, starts, links, crossed, visited
            )
            if size < 0:
                return first, second, regions, heads, starts, links, exchanged[:0], False
            exchanged[count - 1] |= is_exchanged
            for i in range(begin, size):
                first[i], regions[i] = f, count - 1
            links[blocks] = heads[f]
            heads[f] = blocks
            blocks += 1
            starts[blocks] = size
            if depth + 3 * (size - begin) > len(stack):
                stack = enlarged(stack, 2 * (depth + 3 * (size - begin)))
            depth = _cross_edges(
                f, begin, size, corners, neighbors, second, heads, starts, links, crossed, stack, depth
            )
    return (
        first[:size],
        second[:size],
        regions[:size],
        heads,
        starts[: blocks + 1],
        links[:blocks],
        exchanged[:count],
        True,
    )


@compiled
def _face_corners(pose: Floats, faces: Ints) -> Floats:
    """The corners of each face side by side, (m, 6): x and y of the first one, and so on."""
    corners = np.empty((len(faces), 6))
    for f in range(len(faces)):
        for k in range(3):
            corners[f, 2 * k], corners[f, 2 * k + 1] = pose[faces[f, k], 0], pose[faces[f, k], 1]
    return corners


@compiled
def _fill_block(  # type: ignore[no-untyped-def]
    f: int,
    g: int,
    begin: int,
    stamp: int,
    corners: Floats,
    neighbors: Ints,
    second: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
    crossed: Ints,
    visited: Ints,
):
    """Write all second faces that are connected inside the face f with g to ``second`` from ``begin`` on.

    crossed: bit k is set where edge k of f may run through the second face. Returns the end of the block, −1
    if there is no room, and whether the block touches one with its sheets exchanged.
    """
    if begin >= len(second):
        return -1, False
    ax, ay, bx, by = corners[f, 0], corners[f, 1], corners[f, 2], corners[f, 3]
    cx, cy = corners[f, 4], corners[f, 5]
    second[begin], visited[g] = g, stamp
    reached, size, is_exchanged = begin, begin + 1, False
    while reached < size:
        other = second[reached]
        ux, uy, vx, vy = corners[other, 0], corners[other, 1], corners[other, 2], corners[other, 3]
        wx, wy = corners[other, 4], corners[other, 5]
        # On which side of each line of f the corners of the other face are, 9 distances times a length
        au = (bx - ax) * (uy - ay) - (by - ay) * (ux - ax)
        av = (bx - ax) * (vy - ay) - (by - ay) * (vx - ax)
        aw = (bx - ax) * (wy - ay) - (by - ay) * (wx - ax)
        bu = (cx - bx) * (uy - by) - (cy - by) * (ux - bx)
        bv = (cx - bx) * (vy - by) - (cy - by) * (vx - bx)
        bw = (cx - bx) * (wy - by) - (cy - by) * (wx - bx)
        cu = (ax - cx) * (uy - cy) - (ay - cy) * (ux - cx)
        cv = (ax - cx) * (vy - cy) - (ay - cy) * (vx - cx)
        cw = (ax - cx) * (wy - cy) - (ay - cy) * (wx - cx)
        bits = 1 if (((au < 0) | (av < 0) | (aw < 0)) & ((au > 0) | (av > 0) | (aw > 0))) else 0
        bits |= 2 if (((bu < 0) | (bv < 0) | (bw < 0)) & ((bu > 0) | (bv > 0) | (bw > 0))) else 0
        bits |= 4 if (((cu < 0) | (cv < 0) | (cw < 0)) & ((cu > 0) | (cv > 0) | (cw > 0))) else 0
        crossed[reached] = bits
        reached += 1
        for k in range(3):
            target = neighbors[other, k]
            if target < 0 or target == f or visited[target] == stamp:
                continue
            if k == 0:
                share = positive_stretch(au, av, bu, bv, cu, cv)
            elif k == 1:
                share = positive_stretch(av, aw, bv, bw, cv, cw)
            else:
                share = positive_stretch(aw, au, bw, bu, cw, cu)
            if share <= _SHORTEST_STRETCH:
                continue
            if heads[target] >= 0 and pair_index(target, f, second, heads, starts, links) >= 0:
                is_exchanged = True  # the same pair with its sheets exchanged
                continue
            if size >= len(second):
                return -1, False
            visited[target] = stamp
            second[size] = target
            size += 1
    return size, is_exchanged


@compiled
def _cross_edges(  # type: ignore[no-untyped-def]
    f: int,
    begin: int,
    end: int,
    corners: Floats,
    neighbors: Ints,
    second: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
    crossed: Ints,
    stack: Ints,
    depth: int,
):
    """Put the pairs beyond the edges of f on the stack that are not there yet; returns its new depth."""
    for k in range(3):
        target = neighbors[f, k]
        if target < 0:
            continue
        j = k + 1 if k < 2 else 0
        px, py, qx, qy = corners[f, 2 * k], corners[f, 2 * k + 1], corners[f, 2 * j], corners[f, 2 * j + 1]
        is_there = heads[target] >= 0
        for i in range(begin, end):
            other = second[i]
            if not crossed[i] & (1 << k) or target == other:
                continue
            if is_there and pair_index(target, other, second, heads, starts, links) >= 0:
                continue
            ax, ay, bx, by = corners[other, 0], corners[other, 1], corners[other, 2], corners[other, 3]
            cx, cy = corners[other, 4], corners[other, 5]
            if stretch_inside(px, py, qx, qy, ax, ay, bx, by, cx, cy) > _SHORTEST_STRETCH:
                stack[depth, 0], stack[depth, 1] = target, other
                depth += 1
    return depth
