"""Ties between the components of a mesh in layers: which one lies on which.

The nearest rims say little where layers overlap: an eye in the middle of a head is nearer to the rim of the
neck below. A component that lies almost wholly on larger ones of layers behind it is tied to the foremost of
them. The others form the tree of largest overlaps (Prim 1957), and what overlaps nothing is tied across the
narrowest gap.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely

from .validation import Floats, Ints

INSIDE = 0.85  # share of a component's area on another one from which on it lies on that one


def layer_ties(
    vertices: Floats, layers: Ints, component: Ints, boundary_loops: Sequence[Ints]
) -> tuple[Ints, Floats]:
    """The ties of a mesh, (t, 2) int32 pairs of vertices, the lower component first, and their widths (t,).

    vertices: (n, 2); layers, component: (n,) of the vertices; boundary_loops: of the components. There is one
    tie fewer than there are components, and all are joined. The width is 0 from a component to the one it
    lies on, less than 1 for others that overlap, the smaller the more they do, and 1 and the distance in
    pixels for those that do not.
    """
    shapes = _component_shapes(vertices, component, boundary_loops)
    layer = np.zeros(len(shapes), dtype=np.int64)
    layer[component] = layers
    areas = shapely.area(shapes)
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    once = (first < second) & (layer[first] != layer[second])
    first, second = first[once], second[once]
    common = shapely.intersection(shapes[first], shapes[second])
    overlap = shapely.area(common)
    has_area = overlap > 0
    first, second, common, overlap = first[has_area], second[has_area], common[has_area], overlap[has_area]
    share = overlap / np.minimum(areas[first], areas[second])
    rides_on = _carriers(first, second, overlap, areas, layer)
    ties: list[tuple[int, int, float, Floats]] = []  # two components, width, place
    groups = _Groups(len(shapes))
    for above, row in rides_on.items():
        below = int(first[row] + second[row] - above)
        groups.join(above, below)
        ties.append((above, below, 0.0, shapely.get_coordinates(shapely.centroid(shapes[above]))[0]))
    for row in np.argsort(-share, kind="stable").tolist():
        a, b = int(first[row]), int(second[row])
        if a not in rides_on and b not in rides_on and groups.join(a, b):
            place = shapely.get_coordinates(shapely.centroid(common[row]))[0]
            ties.append((a, b, float(1 - min(share[row], 1.0)), place))
    members = [np.flatnonzero(component == number) for number in range(len(shapes))]
    pairs, widths = [], []
    for a, b, width, place in ties:
        pairs.append([_nearest(vertices, members[number], place) for number in (a, b)])
        widths.append(width)
    for i, j, width in _narrowest_gaps(vertices, component, groups):
        pairs.append([i, j])
        widths.append(1 + width)
    table = np.array(pairs, dtype=np.int32).reshape(-1, 2)
    is_lower_first = component[table[:, 0]] < component[table[:, 1]]
    table = np.where(is_lower_first[:, None], table, table[:, ::-1])
    order = np.argsort(widths, kind="stable")
    return table[order], np.array(widths)[order]


class _Groups:
    """Sets of components that are joined already."""

    def __init__(self, count: int) -> None:
        self.count = count
        self._parents = list(range(count))

    def root(self, number: int) -> int:
        """The number of a component's set."""
        while self._parents[number] != number:
            self._parents[number] = self._parents[self._parents[number]]
            number = self._parents[number]
        return number

    def join(self, a: int, b: int) -> bool:
        """Join two sets; whether they were apart."""
        a, b = self.root(a), self.root(b)
        self._parents[a] = b
        self.count -= a != b
        return a != b


def _component_shapes(vertices: Floats, component: Ints, loops: Sequence[Ints]) -> np.ndarray:
    """The shape of each component, with its holes."""
    rings: list[list[shapely.LinearRing]] = [[] for _ in range(int(component.max()) + 1)]
    for loop in loops:
        rings[component[loop[0]]].append(shapely.LinearRing(vertices[loop]))
    shapes = []
    for mine in rings:
        outer, *holes = sorted(mine, key=lambda ring: -shapely.Polygon(ring).area)
        shapes.append(shapely.Polygon(outer, holes))
    return np.asarray(shapely.make_valid(np.array(shapes)))


def _carriers(first: Ints, second: Ints, overlap: Floats, areas: Floats, layer: Ints) -> dict[int, int]:
    """For each component that lies on another one, the row of this pair.

    first, second, overlap: (p,) pairs of components and their common area; areas, layer: of each component.
    """
    carriers: dict[int, int] = {}
    for row, (a, b) in enumerate(zip(first.tolist(), second.tolist(), strict=True)):
        above, below = (a, b) if layer[a] > layer[b] else (b, a)
        if areas[below] <= areas[above] or overlap[row] < INSIDE * areas[above]:
            continue
        known = carriers.get(above)
        if known is None or layer[below] > layer[first[known] + second[known] - above]:
            carriers[above] = row
    return carriers


def _nearest(vertices: Floats, members: Ints, place: Floats) -> int:
    """The vertex among ``members`` that is nearest to a place (2,)."""
    return int(members[np.argmin(((vertices[members] - place) ** 2).sum(axis=1))])


def _narrowest_gaps(vertices: Floats, component: Ints, groups: _Groups) -> list[tuple[int, int, float]]:
    """Pairs of vertices that join the sets of components which are still apart, and their distances."""
    from scipy.spatial import Delaunay

    found: list[tuple[int, int, float]] = []
    if groups.count > 1:
        _, places = np.unique(vertices, axis=0, return_index=True)
        corners = places[Delaunay(vertices[places] - vertices.mean(axis=0)).simplices]
        pairs = corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        pairs = pairs[component[pairs[:, 0]] != component[pairs[:, 1]]]
        widths = np.linalg.norm(vertices[pairs[:, 0]] - vertices[pairs[:, 1]], axis=1)
        for row in np.argsort(widths, kind="stable").tolist():
            i, j = pairs[row].tolist()
            if groups.join(int(component[i]), int(component[j])):
                found.append((i, j, float(widths[row])))
    starts = np.unique(component, return_index=True)[1].tolist()
    for i, j in pairwise(starts):  # components all of whose places belong to others, too
        if groups.join(int(component[i]), int(component[j])):
            found.append((i, j, float(np.linalg.norm(vertices[i] - vertices[j]))))
    return found
