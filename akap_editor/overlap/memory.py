"""Signs of overlapping pairs that are carried over from the pose before."""

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints
from .face_pairs import pair_index

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
    signs, sources = np.zeros(count, dtype=np.int8), np.full(count, -1, dtype=np.int32)
    known = np.zeros(count, dtype=np.bool_)
    limit = (_REACH * length) ** 2
    for i in range(count):
        f, g = first[i], second[i]
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
    ages = np.full(count, len(old_ages), dtype=np.int64)
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
