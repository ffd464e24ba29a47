"""Components of a drawing in the order in which they are drawn, split where they pass over and under."""

import heapq
from collections import defaultdict

import numpy as np

from ...geometry.validation import Ints


def component_runs(components: Ints, order: Ints, low: Ints, high: Ints) -> list[tuple[int, Ints]]:
    """Components and some of their faces each, from back to front, so that all overlapping pairs hold.

    components: (m,) of the faces; order: (m,) faces from back to front, which decides where the pairs ``low``
    and ``high`` (p,) do not. A component appears more than once only if it passes both behind and in front of
    another one.
    """
    rank = np.empty(len(order), dtype=int)
    rank[order] = np.arange(len(order))
    waiting = np.bincount(high, minlength=len(order)).tolist()
    crossing = components[low] != components[high]
    blocked = np.bincount(components[high[crossing]], minlength=int(components.max()) + 1).tolist()
    above: dict[int, list[int]] = defaultdict(list)
    for lower, upper in zip(low.tolist(), high.tolist(), strict=True):
        above[lower].append(upper)
    free: dict[int, list[int]] = {}  # ranks of the faces that may be drawn now, by component
    counts = np.bincount(components)
    means = np.bincount(components, rank) / np.maximum(counts, 1)
    order_of_components = np.argsort(means, kind="stable").tolist()
    for component in [number for number in order_of_components if counts[number]]:  # from back to front
        free[component] = sorted(rank[f] for f in np.flatnonzero(components == component) if not waiting[f])
    runs: list[tuple[int, Ints]] = []
    while any(free.values()):
        ready = [component for component, ranks in free.items() if ranks]
        chosen = next((component for component in ready if not blocked[component]), ready[0])
        faces = []
        while free[chosen]:
            face = int(order[heapq.heappop(free[chosen])])
            faces.append(face)
            for upper in above[face]:
                waiting[upper] -= 1
                blocked[components[upper]] -= components[upper] != chosen
                if not waiting[upper]:
                    heapq.heappush(free[int(components[upper])], rank[upper])
        runs.append((chosen, np.array(faces)))
    return runs
