"""Finds the limbs of a mesh in its rest pose: where they end, where they fork, and the middle of the body."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra

from .mesh import TriMesh
from .validation import Floats, Ints

MIN_PROMINENCE = 0.1  # how far a limb reaches at least beyond its root, of the longest way in a part ...
MAX_REACH = 1.2  # ... which counts up to this many lengths of the mesh: a long tail hides no legs
MIN_SLENDERNESS = 0.4  # of the thickness at its root: how far a limb reaches at least beyond it
MIN_NECK = 0.2  # of its thickness: how much thinner the drawing is at least between a lobe and a thicker one
MIN_LOBE, MIN_BODY_LOBE = 0.1, 0.5  # of the thickest one: lobes that are hands, and that get a middle
LOBE_SHARE = 0.5  # of a limb's reach: how far the hand that it ends in is at most from its end ...
LOBE_REACH = 2.2  # ... and in times its own thickness
PLATEAU = 0.95  # of the thickness in the middle: places so thick are the middle, too
MIN_TIP_GAP = 0.2  # of the mesh's length: tips nearer to one another along the mesh are claws of one foot
MIN_PART_AREA = 0.1  # of the whole mesh: smaller parts have no limbs of their own
MIN_GAP = 0.3  # of the mesh's length: forks nearer to one another than this are one


@dataclass(frozen=True, eq=False)
class Limbs:
    """Vertices of a mesh, those of the most prominent limbs first.

    middles: (p,) the middle of each large part, where it is thickest, and of its other thick lobes, such as a
    head; tips: (k,) where limbs end, as far inside as they are thick, or the middle of a hand there; forks:
    (q,) where limbs part, if that is not near the others.
    """

    middles: Ints
    tips: Ints
    forks: Ints


@dataclass
class _Peak:
    """The end of a limb.

    prominence: how far it reaches beyond the saddle, the vertex where it meets a limb that reaches farther.
    """

    vertex: int
    prominence: float
    saddle: int


def find_limbs(mesh: TriMesh) -> Limbs:
    """Find limbs as peaks of the distance from the middle, along the edges of the mesh in its rest pose.

    A peak counts by its prominence, the height over the saddle where its limb meets one that reaches
    farther (the persistence of Edelsbrunner, Letscher, Zomorodian 2002, "Topological Persistence and
    Simplification").
    """
    from scipy.spatial import cKDTree

    rim = cKDTree(mesh.vertices[mesh.boundary_vertices])
    depth: Floats = rim.query(mesh.vertices)[0]
    area = np.bincount(mesh.component[mesh.faces[:, 0]], weights=mesh.rest_areas)
    middles: list[int] = []
    lobes: list[int] = []
    tips: list[tuple[float, int]] = []  # each with the prominence of its limb
    forks: list[tuple[float, int]] = []
    for part in np.flatnonzero(area >= MIN_PART_AREA * area.sum()):
        members = np.flatnonzero(mesh.component == part)
        middle = _middle(mesh, depth, members)
        middles.append(middle)
        part_lobes = _lobes(mesh, depth, members)
        hands = [lobe for lobe in part_lobes if depth[lobe] < MIN_BODY_LOBE * depth[middle]]
        distance = dijkstra(mesh.edge_graph, indices=middle)
        least = MIN_PROMINENCE * min(float(distance[members].max()), MAX_REACH * mesh.length)
        for peak in _peaks(mesh, distance, members, middle):
            fork = _deepest(mesh, depth, peak.saddle, depth[peak.saddle] + least)
            if peak.saddle == middle or peak.prominence >= max(least, MIN_SLENDERNESS * 2 * depth[fork]):
                tips.append((peak.prominence, _inside_tip(mesh, depth, peak, hands)))
                forks.append((peak.prominence, fork))
        lobes += part_lobes[: len(part_lobes) - len(hands)]
    inner = _apart_along(mesh, [vertex for _, vertex in sorted(tips, reverse=True)])
    for lobe in lobes:
        distances = np.linalg.norm(mesh.vertices[[*middles, *inner]] - mesh.vertices[lobe], axis=1)
        if distances.min() > depth[lobe]:
            middles.append(lobe)
    apart = _apart(mesh, [*middles, *inner], [vertex for _, vertex in sorted(forks, reverse=True)])
    return Limbs(*(np.array(vertices, dtype=np.int64) for vertices in (middles, inner, apart)))


def _peaks(mesh: TriMesh, distance: Floats, members: Ints, middle: int) -> list[_Peak]:
    """The peaks of the distance in one part, each with its saddle; the highest one has the middle."""
    graph = mesh.edge_graph
    leader: dict[int, int] = {}  # of each vertex visited so far, another one of the same limb, or its peak

    def find(vertex: int) -> int:
        while leader[vertex] != vertex:
            leader[vertex] = leader[leader[vertex]]
            vertex = leader[vertex]
        return vertex

    peaks: list[_Peak] = []
    for vertex in members[np.argsort(-distance[members], kind="stable")].tolist():
        neighbors = graph.indices[graph.indptr[vertex] : graph.indptr[vertex + 1]].tolist()
        limbs = sorted(
            {find(other) for other in neighbors if other in leader}, key=lambda peak: -distance[peak]
        )
        leader[vertex] = limbs[0] if limbs else vertex
        for peak in limbs[1:]:
            peaks.append(_Peak(peak, float(distance[peak] - distance[vertex]), vertex))
            leader[peak] = limbs[0]
    highest = int(members[np.argmax(distance[members])])
    return [_Peak(highest, float(distance[highest]), middle), *peaks]


def _middle(mesh: TriMesh, depth: Floats, members: Ints) -> int:
    """The vertex in the middle of where a part is thickest."""
    thick = members[depth[members] >= PLATEAU * depth[members].max()]
    places = mesh.vertices[thick]
    return int(thick[np.argmin(((places - places.mean(axis=0)) ** 2).sum(axis=1))])


def _lobes(mesh: TriMesh, depth: Floats, members: Ints) -> list[int]:
    """The thickest vertex of each lobe, which a neck parts from thicker ones; the thickest lobe first."""
    thickest = int(members[np.argmax(depth[members])])
    return [
        peak.vertex
        for peak in sorted(_peaks(mesh, depth, members, thickest), key=lambda peak: -depth[peak.vertex])
        if peak.vertex != thickest
        and depth[peak.vertex] >= MIN_LOBE * depth[thickest]
        and peak.prominence >= MIN_NECK * depth[peak.vertex]
    ]


def _inside_tip(mesh: TriMesh, depth: Floats, peak: _Peak, hands: list[int]) -> int:
    """The middle of the hand at the end of a limb, or where a disc that fits into it touches the end."""
    distance = dijkstra(mesh.edge_graph, indices=peak.vertex, limit=peak.prominence)
    reach = LOBE_SHARE * peak.prominence
    at_end = [hand for hand in hands if distance[hand] <= min(reach, LOBE_REACH * depth[hand])]
    if at_end:
        return min(at_end, key=lambda hand: distance[hand])
    fits = np.flatnonzero(np.isfinite(distance) & (depth >= 0.7 * distance))
    reach = float(distance[fits].max()) if len(fits) else 0.0
    near = np.flatnonzero(distance <= max(1.3 * reach, 0.15 * peak.prominence))
    thick = near[depth[near] >= PLATEAU * depth[near].max()]
    return int(thick[np.argmin(distance[thick])])


def _deepest(mesh: TriMesh, depth: Floats, vertex: int, reach: float) -> int:
    """The deepest vertex not farther than ``reach`` from a vertex."""
    near = np.flatnonzero(np.isfinite(dijkstra(mesh.edge_graph, indices=vertex, limit=reach)))
    return int(near[np.argmax(depth[near])])


def _apart_along(mesh: TriMesh, vertices: list[int]) -> list[int]:
    """Those of some vertices that are not near one before them, along the mesh."""
    kept: list[int] = []
    for vertex in vertices:
        near = dijkstra(mesh.edge_graph, indices=vertex, limit=MIN_TIP_GAP * mesh.length)
        if not np.isfinite(near[kept]).any():
            kept.append(vertex)
    return kept


def _apart(mesh: TriMesh, taken: list[int], vertices: list[int]) -> list[int]:
    """Those of some vertices that are not near one before them, or near one that is taken."""
    kept: list[int] = []
    for vertex in vertices:
        others = mesh.vertices[[*taken, *kept]]
        if np.linalg.norm(others - mesh.vertices[vertex], axis=1).min() >= MIN_GAP * mesh.length:
            kept.append(vertex)
    return kept
