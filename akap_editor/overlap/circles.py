"""Levels of faces that satisfy all decisions, and decisions that contradict one another in a circle."""

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints

MAX_ROUNDS = 30


@compiled
def satisfies(levels: Ints, low: Ints, high: Ints) -> bool:
    """Whether each face of ``low`` (p,) is on a lower level (m,) than that of ``high`` (p,)."""
    for i in range(len(low)):  # noqa: SIM110 (a generator does not compile)
        if levels[low[i]] >= levels[high[i]]:
            return False
    return True


@compiled
def face_levels(face_count: int, low: Ints, high: Ints):  # type: ignore[no-untyped-def]
    """The least levels (m,) int32 that satisfy all pairs, and whether each face has one, (m,).

    Faces that are in a circle, or above one, have none (Kahn 1962).
    """
    starts, waiting = np.zeros(face_count + 1, dtype=np.int32), np.zeros(face_count, dtype=np.int32)
    for i in range(len(low)):
        starts[low[i] + 1] += 1
        waiting[high[i]] += 1
    for f in range(face_count):
        starts[f + 1] += starts[f]
    fill, uppers = starts[:-1].copy(), np.empty(len(low), dtype=np.int32)
    for i in range(len(low)):
        uppers[fill[low[i]]] = high[i]
        fill[low[i]] += 1
    levels, placed = np.zeros(face_count, dtype=np.int32), np.zeros(face_count, dtype=np.bool_)
    queue, reached, size = np.empty(face_count, dtype=np.int32), 0, 0
    for f in range(face_count):
        if waiting[f] == 0:
            placed[f] = True
            queue[size] = f
            size += 1
    while reached < size:
        f = queue[reached]
        reached += 1
        for j in range(starts[f], starts[f + 1]):
            g = uppers[j]
            levels[g] = max(levels[g], levels[f] + 1)
            waiting[g] -= 1
            if waiting[g] == 0:
                placed[g] = True
                queue[size] = g
                size += 1
    return levels, placed


def circular_pairs(face_count: int, low: Ints, high: Ints, placed: Ints) -> Ints:
    """Indices of the pairs that are part of a circle; placed: (m,) as `face_levels` returns it."""
    left = np.flatnonzero(~placed[low] & ~placed[high])
    graph = csr_array(
        (np.ones(len(left), dtype=np.int8), (low[left], high[left])), shape=(face_count, face_count)
    )
    labels = connected_components(graph, directed=True, connection="strong")[1]
    return left[labels[low[left]] == labels[high[left]]]


@compiled
def least_violating_order(face_count: int, low: Ints, high: Ints, weights: Floats):  # type: ignore[no-untyped-def]
    """A rank (m,) of faces, from below to above, that violates little weight (p,) where pairs are circular.

    Pairs of weight 0 are never violated; they must not contradict one another. Where no face is free, the one
    goes first whose pairs above lower faces weigh least.
    """
    starts, waiting = np.zeros(face_count + 1, dtype=np.int32), np.zeros(face_count, dtype=np.int32)
    firm, cost = np.zeros(face_count, dtype=np.int32), np.zeros(face_count)
    for i in range(len(low)):
        starts[low[i] + 1] += 1
        waiting[high[i]] += 1
        firm[high[i]] += weights[i] == 0
        cost[high[i]] += weights[i]
    for f in range(face_count):
        starts[f + 1] += starts[f]
    fill, uppers = starts[:-1].copy(), np.empty(len(low), dtype=np.int32)
    for i in range(len(low)):
        uppers[fill[low[i]]] = i
        fill[low[i]] += 1
    rank, placed = np.zeros(face_count, dtype=np.int32), np.zeros(face_count, dtype=np.bool_)
    queue, reached, size = np.empty(face_count, dtype=np.int32), 0, 0
    for f in range(face_count):
        if waiting[f] == 0:
            placed[f] = True
            queue[size] = f
            size += 1
    while reached < face_count:
        if reached == size:
            best = -1
            for f in range(face_count):
                if not placed[f] and firm[f] == 0 and (best < 0 or cost[f] < cost[best]):
                    best = f
            placed[best] = True
            queue[size] = best
            size += 1
        f = queue[reached]
        rank[f] = reached
        reached += 1
        for j in range(starts[f], starts[f + 1]):
            i = uppers[j]
            g = high[i]
            if placed[g]:
                continue
            waiting[g] -= 1
            firm[g] -= weights[i] == 0
            cost[g] -= weights[i]
            if waiting[g] == 0:
                placed[g] = True
                queue[size] = g
                size += 1
    return rank


def without_circles(
    face_count: int, first: Ints, second: Ints, regions: Ints, signs: Ints, ages: Ints, firm: Ints
) -> tuple[Ints, Ints]:
    """Signs (p,) int8 without circles, and the levels of faces (m,) that satisfy them.

    ages: (r,) rank of each region, the oldest 0; firm: (p,) signs that must stay or come back, 0 for pairs
    that may turn over. The firm ones must not contradict one another, as those of the last pose do not. On a
    circle the youngest region gives way: as a whole if none of it is firm, else the pairs on the circle.
    """
    wanted, turned, whole = np.where(firm, firm, signs), firm != 0, np.zeros(len(ages), dtype=bool)
    signs = wanted.copy()
    firm_regions = np.bincount(regions[turned], minlength=len(ages)) > 0
    for _ in range(MAX_ROUNDS):
        low, high = low_and_high(first, second, signs)
        levels, placed = face_levels(face_count, low, high)
        if placed.all():
            return signs, levels
        circle = circular_pairs(face_count, low, high, placed)
        free = circle[~turned[circle]]
        if not len(free):
            break
        fresh = free[~firm_regions[regions[free]] & ~whole[regions[free]]]
        if len(fresh):
            youngest = regions[fresh[np.argmax(ages[regions[fresh]])]]
            whole[youngest] = True
            members = np.flatnonzero(regions == youngest)
            turned_signs = signs.copy()
            turned_signs[members] *= -1
            if _circle_size(face_count, first, second, turned_signs) < len(circle):
                signs = turned_signs
            continue
        youngest = regions[free[np.argmax(ages[regions[free]])]]
        chosen = free[regions[free] == youngest]
        signs[chosen] *= -1
        turned[chosen] = True
    # Circles within single regions, or too many of them: adopt an order of faces that turns over little.
    low, high = low_and_high(first, second, wanted)
    weights = np.where(firm, 0.0, 1.0 + ages.max() - ages[regions])
    rank = least_violating_order(face_count, low, high, weights)
    signs = np.where(rank[first] > rank[second], 1, -1).astype(np.int8)
    return signs, face_levels(face_count, *low_and_high(first, second, signs))[0]


def _circle_size(face_count: int, first: Ints, second: Ints, signs: Ints) -> int:
    low, high = low_and_high(first, second, signs)
    placed = face_levels(face_count, low, high)[1]
    return 0 if placed.all() else len(circular_pairs(face_count, low, high, placed))


@compiled
def low_and_high(first: Ints, second: Ints, signs: Ints):  # type: ignore[no-untyped-def]
    """The lower and the upper face, (p,) int32 each, of pairs whose first face is above where signs are 1."""
    low, high = np.empty(len(first), dtype=np.int32), np.empty(len(first), dtype=np.int32)
    for i in range(len(first)):
        if signs[i] > 0:
            low[i], high[i] = second[i], first[i]
        else:
            low[i], high[i] = first[i], second[i]
    return low, high
