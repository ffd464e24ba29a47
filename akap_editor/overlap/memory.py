"""Signs of overlapping pairs: carried over from the pose before, and the few pairs that restore all signs."""

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints, freeze
from .circles import low_and_high
from .common_area import common_areas
from .face_pairs import FacePairs, pair_index
from .least_cut import seam_pairs, spread_signs
from .topology import Topology

_REACH = 0.1  # share of the mesh's length within which the partner of a face tells of its neighbor


@compiled
def carried_signs(  # type: ignore[no-untyped-def]
    first: Ints,
    second: Ints,
    old_first: Ints,
    old_second: Ints,
    old_regions: Ints,
    old_signs: Ints,
    heads: Ints,
    starts: Ints,
    links: Ints,
    centers: Floats,
    length: float,
):
    """For each pair (p,): its old sign int8, 0 if unknown; the old region, or −1; whether the pair is old.

    A pair that was not there takes the sign of the old pair of one of its faces whose other face was nearest
    on the drawing. centers: (m, 2) of the faces at rest, pixels.
    """
    count = len(first)
    signs, sources = np.zeros(count, dtype=np.int8), np.empty(count, dtype=np.int32)
    known = np.zeros(count, dtype=np.bool_)
    limit = (_REACH * length) ** 2
    for i in range(count):
        f, g = first[i], second[i]
        sources[i] = -1
        if heads[f] < 0 and heads[g] < 0:
            continue
        at = pair_index(f, g, old_second, heads, starts, links)
        if at >= 0:
            signs[i], sources[i], known[i] = old_signs[at], old_regions[at], True
            continue
        at = pair_index(g, f, old_second, heads, starts, links)
        if at >= 0:
            signs[i], sources[i], known[i] = -old_signs[at], old_regions[at], True
            continue
        nearest = limit
        for turned in range(2):
            face, partner = (g, f) if turned else (f, g)
            x, y = centers[partner, 0], centers[partner, 1]
            block = heads[face]
            while block >= 0:
                for j in range(starts[block], starts[block + 1]):
                    dx, dy = centers[old_second[j], 0] - x, centers[old_second[j], 1] - y
                    distance = dx * dx + dy * dy
                    if distance < nearest:
                        nearest = distance
                        signs[i] = -old_signs[j] if turned else old_signs[j]
                        sources[i] = old_regions[j]
                block = links[block]
    return signs, sources, known


@compiled
def tally(regions: Ints, signs: Ints, known: Ints, sources: Ints, old_ages: Ints, count: int):  # type: ignore[no-untyped-def]
    """For each region: number of pairs (2,) with sign 1 and −1, the same of inferred ones, and the least age.

    Age is the rank of the oldest region that a pair comes from; as large as `len(old_ages)` for none.
    """
    votes, guesses = np.zeros((count, 2), dtype=np.int64), np.zeros((count, 2), dtype=np.int64)
    ages = np.empty(count, dtype=np.int64)
    for r in range(count):
        ages[r] = len(old_ages)
    for i in range(len(regions)):
        if signs[i] == 0:
            continue
        r, side = regions[i], 0 if signs[i] > 0 else 1
        if known[i]:
            votes[r, side] += 1
        else:
            guesses[r, side] += 1
        if known[i] or ages[r] == len(old_ages):
            ages[r] = min(ages[r], old_ages[sources[i]])
    return votes, guesses, ages


def deciding_pairs(
    topology: Topology, pose: Floats, pairs: FacePairs, signs: Ints, order: Ints, before: Ints
) -> Ints:
    """The pairs (s, 2), upper and lower faces, from which `recalled_signs` finds all signs (p,) again.

    order: (r,) the regions, the oldest first; before: (s, 2) those of the pose before, some of which are kept
    where they serve. The same object as ``before`` if nothing changed.
    """
    arrays = pairs.first, pairs.second, topology.neighbors, pairs.heads, pairs.starts, pairs.links
    indices, sides = find_pairs(before, pairs.second, pairs.heads, pairs.starts, pairs.links)
    valid = (indices >= 0) & (signs[indices] == sides)
    ends = np.searchsorted(pairs.regions, np.arange(pairs.region_count + 1))
    chosen = []
    for region in order:
        members = np.arange(ends[region], ends[region + 1])
        is_exchanged = bool(pairs.exchanged[region])
        is_cut = is_exchanged or signs[members].min() != signs[members].max()
        row = seam_pairs(members, signs, *arrays, 0, is_exchanged) if is_cut else members[:0]
        if len(row):
            row = np.sort(row)
        else:
            row = indices[valid & (indices >= members[0]) & (indices <= members[-1])][:1]
        if not len(row):
            candidates = members[:: max(1, len(members) // 32)]
            areas = common_areas(pose, topology.faces, pairs.first[candidates], pairs.second[candidates])
            row = candidates[np.argmax(areas)][None]
        chosen.append(row)
    low, high = low_and_high(pairs.first, pairs.second, signs)
    kept = np.concatenate(chosen)
    crossings = np.stack([high[kept], low[kept]], axis=1).astype(np.int32)
    return before if np.array_equal(crossings, before) else freeze(crossings)


def recalled_signs(topology: Topology, pairs: FacePairs, crossings: Ints) -> tuple[Ints, Ints]:
    """The signs (p,) int8 that ``crossings`` (s, 2) restore, and the rank (r,) of each region: its first row.

    A pair has the sign of the row that is nearest to it within its region; 0 in regions without one, whose
    rank is s.
    """
    signs = np.zeros(len(pairs), dtype=np.int8)
    ages = np.full(pairs.region_count, len(crossings), dtype=np.int64)
    arrays = pairs.first, pairs.second, topology.neighbors, pairs.heads, pairs.starts, pairs.links
    indices, sides = find_pairs(crossings, pairs.second, pairs.heads, pairs.starts, pairs.links)
    for row in range(len(crossings) - 1, -1, -1):
        if indices[row] >= 0:
            signs[indices[row]] = sides[row]
            ages[pairs.regions[indices[row]]] = row
    for region in np.unique(pairs.regions[indices[indices >= 0]]):
        begin, end = np.searchsorted(pairs.regions, (region, region + 1))
        spread_signs(np.arange(begin, end), signs, *arrays, bool(pairs.exchanged[region]))
    return signs, ages


@compiled
def find_pairs(rows: Ints, seconds: Ints, heads: Ints, starts: Ints, links: Ints):  # type: ignore[no-untyped-def]
    """Indices (s,) of pairs (s, 2) in either order, −1 for none, and 1 or −1 for this order or the other."""
    indices, signs = np.empty(len(rows), dtype=np.int64), np.empty(len(rows), dtype=np.int8)
    for i in range(len(rows)):
        indices[i], signs[i] = pair_index(rows[i, 0], rows[i, 1], seconds, heads, starts, links), 1
        if indices[i] < 0:
            indices[i], signs[i] = pair_index(rows[i, 1], rows[i, 0], seconds, heads, starts, links), -1
    return indices, signs
