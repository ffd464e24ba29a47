"""The triangle mesh of a drawing at rest, and points on it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from .edges import half_edges, unique_edges
from .layer_ties import layer_ties
from .validation import Floats, Ints, as_indices, as_instance, as_points, freeze

_ROUNDING = 1e-12  # barycentric weight below zero that still counts as on the face


def signed_areas(positions: Floats, faces: Ints) -> Floats:
    """Signed area of each face in square pixels, (m,), at ``positions`` (n, 2); positive in a `TriMesh`."""
    corners = np.ascontiguousarray(positions, dtype=np.float64).view(np.complex128)[:, 0].take(faces)
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return 0.5 * (a.real * b.imag - a.imag * b.real)


@dataclass(frozen=True, eq=False)
class MeshPoints:
    """Points on a mesh by face and barycentric weights, so that they move with any pose.

    faces: (k,) int32; weights: (k, 3) float64, each row sums to 1; a point at a vertex has the weights
    (1, 0, 0). The paper pins vertices only; weights inside one face change no sparsity pattern.
    Arrays are read-only. Raises InputError if the weights of a row do not sum to 1.
    """

    faces: Ints
    weights: Floats

    def __post_init__(self) -> None:
        faces = as_indices(self.faces, "faces", None, np.iinfo(np.int32).max)
        weights = as_points(self.weights, "weights", len(faces), columns=3)
        if not np.allclose(weights.sum(axis=1), 1.0, atol=1e-9):
            raise InputError("weights: expected barycentric weights that sum to 1 in each row")
        object.__setattr__(self, "faces", freeze(faces))
        object.__setattr__(self, "weights", freeze(weights))

    def __len__(self) -> int:
        return len(self.faces)


NO_POINTS = MeshPoints(np.zeros(0, dtype=np.int32), np.zeros((0, 3)))


@dataclass(frozen=True, eq=False)
class TriMesh:
    """A triangle mesh in its rest pose, in drawing units: image pixels, x right, y down.

    vertices: (n, 2) float64, each used by a face, no two of a layer at one place, unless the mesh is cut.
    faces: (m, 3) int32, each with a positive signed area, at most one on each side of an edge. No two faces
    meet in a vertex only, because they could rotate freely about it.
    tied: whether a component without pins moves with the nearest one that has pins, see `deform.islands`;
    otherwise it stays where it is.
    layers: (n,) int32 the layer of each vertex, from 0, the hindmost first; None if all lie on one sheet. A
    face has its corners on one layer.
    is_cut: whether the mesh is open along slits, on whose two lips vertices are at one place.
    Arrays are read-only. Raises InputError if one of these conditions is violated.
    """

    vertices: Floats
    faces: Ints
    tied: bool = False
    layers: Ints | None = None
    is_cut: bool = False

    def __post_init__(self) -> None:
        vertices = as_points(self.vertices, "vertices")
        faces = as_indices(self.faces, "faces", 3, len(vertices))
        if not len(vertices) or not len(faces):
            raise InputError(f"mesh: expected vertices and faces, got {len(vertices)} and {len(faces)}")
        areas = signed_areas(vertices, faces)
        if areas.min() <= 0:
            worst = int(np.argmin(areas))
            kind = "has no area" if areas[worst] == 0 else f"is flipped ({areas[worst]:g})"
            raise InputError(f"faces: expected positive signed areas, but face {worst} {kind}")
        unused = np.flatnonzero(np.bincount(faces.ravel(), minlength=len(vertices)) == 0)
        if len(unused):
            raise InputError(f"vertices: expected each to belong to a face, but vertex {unused[0]} does not")
        object.__setattr__(self, "vertices", freeze(vertices))
        object.__setattr__(self, "faces", freeze(faces))
        if self.layers is not None:
            object.__setattr__(self, "layers", freeze(_as_layers(self.layers, vertices, faces)))
        self._check_places()
        self._check_edges()

    def _check_places(self) -> None:
        if self.is_cut:
            return
        places = self.vertices if self.layers is None else np.column_stack([self.vertices, self.layers])
        order = np.lexsort(places.T)
        same = (places[order[1:]] == places[order[:-1]]).all(axis=1)
        if same.any():
            first = int(np.argmax(same))
            raise InputError(f"vertices: {order[first]} and {order[first + 1]} are at the same place")

    def _check_edges(self) -> None:
        counts = np.bincount((2 * self.face_edges + (self.faces > self.faces[:, [1, 2, 0]])).ravel())
        if counts.max() > 1:
            edge = self.edges[np.argmax(counts) // 2].tolist()
            raise InputError(f"faces: edge {edge} has two faces on one side, expected one face on each side")
        leaving = np.bincount(self._boundary_half_edges[:, 0])
        if leaving.max(initial=0) > 1:
            raise InputError(
                f"faces: expected parts to meet along edges, but at vertex {int(np.argmax(leaving))} "
                "they meet in one point only"
            )

    def renumber(self, vertex_order: Ints, face_order: Ints) -> "TriMesh":
        """The same mesh with its vertices and faces in another order, each given by its index here.

        vertex_order: (n,); face_order: (m,). The corners of a face keep their order.
        """
        numbers = np.empty(len(vertex_order), dtype=np.int32)
        numbers[vertex_order] = np.arange(len(vertex_order))
        edges = np.sort(numbers[self.edges], axis=1)
        order = np.argsort(edges @ np.array([len(numbers), 1], dtype=np.int64))
        edge_numbers = np.empty(len(edges), dtype=np.int32)
        edge_numbers[order] = np.arange(len(edges))
        layers = None if self.layers is None else self.layers[vertex_order]
        return self._derived(
            *(vertex_order, numbers[self.faces[face_order]], self.tied, layers, edges[order]),
            *(edge_numbers[self.face_edges[face_order]], numbers[self._boundary_half_edges]),
            self.component[vertex_order],
        )

    def part(self, vertices: Ints, faces: Ints) -> "TriMesh":
        """The mesh of some whole components, each on a layer of its own if there are several; not tied.

        vertices: (v,), faces: (q,) ascending, all of those components, which keep their order.
        """
        numbers = np.full(len(self.vertices), -1, dtype=np.int32)
        numbers[vertices] = np.arange(len(vertices))
        own = self.component[vertices]
        is_present = np.bincount(own) > 0
        edges, rim = numbers[self.edges], numbers[self._boundary_half_edges]
        is_own = edges[:, 0] >= 0
        face_edges = (np.cumsum(is_own, dtype=np.int32) - 1)[self.face_edges[faces]]
        return self._derived(
            *(vertices, numbers[self.faces[faces]], False, own if is_present.sum() > 1 else None),
            *(edges[is_own], face_edges, rim[rim[:, 0] >= 0], (np.cumsum(is_present) - 1)[own]),
        )

    def _derived(
        self,
        chosen: Ints,
        faces: Ints,
        tied: bool,
        layers: Ints | None,
        edges: Ints,
        face_edges: Ints,
        boundary_half_edges: Ints,
        component: Ints,
    ) -> "TriMesh":
        """A mesh of the ``chosen`` vertices; for its arrays see the properties of their names.

        Nothing is checked or sorted again, because this mesh was.
        """
        mesh = object.__new__(TriMesh)
        for name, array in (("vertices", self.vertices[chosen]), ("faces", faces), ("layers", layers)):
            object.__setattr__(mesh, name, None if array is None else freeze(array))
        object.__setattr__(mesh, "tied", tied)
        object.__setattr__(mesh, "is_cut", self.is_cut)
        mesh.__dict__["_edges_and_sides"] = freeze(edges), freeze(face_edges)
        mesh.__dict__["_boundary_half_edges"] = boundary_half_edges
        mesh.__dict__["component"] = freeze(component.astype(np.int32))
        return mesh
        return mesh

    @cached_property
    def _boundary_half_edges(self) -> Ints:
        """(b, 2) int32, directed edges without a face on their other side."""
        edges = self.face_edges.ravel()
        return half_edges(self.faces)[np.bincount(edges)[edges] == 1]

    @cached_property
    def _edges_and_sides(self) -> tuple[Ints, Ints]:
        edges, face_edges = unique_edges(self.faces, len(self.vertices))
        return freeze(edges), freeze(face_edges)

    @property
    def edges(self) -> Ints:
        """(e, 2) int32, each edge once, the smaller index first, in lexicographic order."""
        return self._edges_and_sides[0]

    @property
    def face_edges(self) -> Ints:
        """(m, 3) int32, the edge from each corner of a face to the next, as an index of `edges`."""
        return self._edges_and_sides[1]

    @cached_property
    def boundary_loops(self) -> tuple[Ints, ...]:
        """Closed loops of boundary vertices, outer contours and holes, each (q,) int32."""
        following: dict[int, int] = dict(self._boundary_half_edges.tolist())
        loops = []
        while following:
            loop, at = [], next(iter(following))
            while at in following:
                loop.append(at)
                at = following.pop(at)
            loops.append(freeze(np.array(loop, dtype=np.int32)))
        return tuple(loops)

    @cached_property
    def boundary_vertices(self) -> Ints:
        """(b,) int32, ascending: vertices of all boundary loops (the paper's B in eq. 8)."""
        return freeze(np.unique(self._boundary_half_edges[:, 0]).astype(np.int32))

    @cached_property
    def component(self) -> Ints:
        """(n,) int32: number of each vertex's connected component, from 0."""
        return freeze(connected_components(self.edge_graph, directed=False)[1].astype(np.int32))

    @cached_property
    def face_layers(self) -> Ints:
        """(m,) int32: the layer of each face; 0 if the mesh has no layers."""
        if self.layers is None:
            return freeze(np.zeros(len(self.faces), dtype=np.int32))
        return freeze(self.layers[self.faces[:, 0]])

    @cached_property
    def edge_graph(self) -> csr_array:
        """(n, n) symmetric: lengths of the rest edges in pixels, a graph for `scipy.sparse.csgraph`."""
        return self._graph(self.edges)

    @cached_property
    def bridged_edge_graph(self) -> csr_array:
        """`edge_graph` with the `gaps` as further edges, so that all components are connected."""
        return self._graph(np.concatenate([self.edges, self.gaps]))

    def _graph(self, edges: Ints) -> csr_array:
        n, (i, j) = len(self.vertices), edges.T
        lengths = np.abs((self.vertices[i] - self.vertices[j]).view(np.complex128)[:, 0])
        if self.layers is not None or self.is_cut:  # gaps may have length 0, which edges of a graph must not
            lengths = np.maximum(lengths, np.finfo(np.float64).tiny)
        return csr_array((np.tile(lengths, 2), (np.r_[i, j], np.r_[j, i])), shape=(n, n))

    @cached_property
    def gaps(self) -> Ints:
        """(g, 2) int32, the narrowest first: the nearest vertices of each two adjacent components.

        Only edges of the Delaunay triangulation are candidates: it joins each set of points to the point
        nearest to the set. With layers, components are joined where they overlap instead, see `layer_ties`.
        """
        from scipy.spatial import Delaunay

        if not self.component.any():
            return np.zeros((0, 2), dtype=np.int32)
        if self.layers is not None:
            return self._ties[0]
        boundary = self.boundary_vertices
        centered = self.vertices[boundary] - self.vertices[boundary].mean(axis=0)
        corners = boundary[Delaunay(centered).simplices]
        pairs = corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        pairs = pairs[self.component[pairs[:, 0]] < self.component[pairs[:, 1]]]
        widths = np.linalg.norm(self.vertices[pairs[:, 0]] - self.vertices[pairs[:, 1]], axis=1)
        pairs = pairs[np.argsort(widths, kind="stable")]
        _, first = np.unique(self.component[pairs], axis=0, return_index=True)
        return freeze(pairs[np.sort(first)])

    @cached_property
    def gap_widths(self) -> Floats:
        """(g,) the distance over each of the `gaps` in pixels; with layers, see `layer_ties`."""
        if self.layers is not None and self.component.any():
            return self._ties[1]
        (x, y), (u, v) = (self.vertices[ends].T for ends in self.gaps.T)
        return freeze(np.hypot(x - u, y - v))

    @cached_property
    def _ties(self) -> tuple[Ints, Floats]:
        assert self.layers is not None
        pairs, widths = layer_ties(self.vertices, self.layers, self.component, self.boundary_loops)
        return freeze(pairs), freeze(widths)

    @cached_property
    def rest_areas(self) -> Floats:
        """(m,) areas of the faces at rest, square pixels."""
        return freeze(signed_areas(self.vertices, self.faces))

    @cached_property
    def length(self) -> float:
        """Square root of the total rest area, in pixels: the unit in which solvers state their tolerances."""
        return float(np.sqrt(self.rest_areas.sum()))

    def find(
        self, point: ArrayLike, positions: ArrayLike | None = None, order: Ints | None = None
    ) -> MeshPoints | None:
        """The point of the mesh that is visible at ``point`` (2,), or None if no face covers it.

        positions: (n, 2) the pose, by default at rest; order: the faces in the order in which they are drawn,
        by default all by index: the last one that covers the point is visible. Raises InputError.
        """
        found = self.find_all(point, positions, order)
        return MeshPoints(found.faces[-1:], found.weights[-1:]) if len(found) else None

    def find_all(
        self, point: ArrayLike, positions: ArrayLike | None = None, order: Ints | None = None
    ) -> MeshPoints:
        """All points of the mesh at ``point`` (2,), from back to front; for the arguments see `find`."""
        q = as_points([point], "point", 1)[0]  # type: ignore[arg-type]
        return self._find_all(q, self._as_pose(positions), order)

    def _as_pose(self, positions: ArrayLike | None) -> Floats:
        return self.vertices if positions is None else as_points(positions, "positions", len(self.vertices))

    @cached_property
    def _corners(self) -> Ints:
        """(3, m) the transposed faces, in the layout and dtype that numpy indexes with fastest."""
        return np.ascontiguousarray(self.faces.T, dtype=np.intp)

    def _find_all(self, point: Floats, pose: Floats, order: Ints | None = None) -> MeshPoints:
        margin = _ROUNDING * np.abs(point).max()
        sides = np.zeros(len(pose), dtype=np.uint8)  # bits: left, right, above, below the point
        for axis in (0, 1):
            sides |= (pose[:, axis] <= point[axis] + margin).view(np.uint8) << np.uint8(2 * axis)
            sides |= (pose[:, axis] >= point[axis] - margin).view(np.uint8) << np.uint8(2 * axis + 1)
        a, b, c = self._corners
        candidates = np.flatnonzero((sides.take(a) | sides.take(b) | sides.take(c)) == 0b1111)
        weights = barycentric(pose[self.faces[candidates]], point)
        hits = np.flatnonzero(weights.min(axis=1) >= -_ROUNDING)
        if order is not None and len(hits):
            rank = np.full(len(self.faces), -1, dtype=np.int64)  # faces that are not drawn keep −1
            rank[order] = np.arange(len(order))
            ranks = rank[candidates[hits]]
            hits = hits[np.argsort(ranks)][int((ranks < 0).sum()) :]
        return MeshPoints(candidates[hits], weights[hits])

    def locate(
        self, points: ArrayLike, positions: ArrayLike | None = None, layers: ArrayLike | None = None
    ) -> MeshPoints:
        """The points of the mesh that are visible at ``points`` (k, 2), see `find`.

        positions: (n, 2) the pose, by default at rest; layers: (k,) the layer on which each point is to lie,
        −1 for the foremost one there. Raises InputError for a point outside the mesh, or outside its layer.
        """
        pose, q_layers = self._as_pose(positions), None
        wanted = as_points(points, "points")
        if layers is not None:
            q_layers = np.broadcast_to(np.asarray(layers, dtype=np.int64), len(wanted))
        faces, weights = [], []
        for index, q in enumerate(wanted):
            hit = self._find_all(q, pose)
            if q_layers is not None and q_layers[index] >= 0:
                mine = self.face_layers[hit.faces] == q_layers[index]
                hit = MeshPoints(hit.faces[mine], hit.weights[mine])
            if not len(hit):
                nearest = pose[int(np.argmin(((pose - q) ** 2).sum(axis=1)))]
                raise InputError(
                    f"points: point {index} at ({q[0]:g}, {q[1]:g}) lies outside the drawing; "
                    f"the nearest vertex is at ({nearest[0]:.1f}, {nearest[1]:.1f})"
                )
            faces.append(hit.faces[-1])
            weights.append(hit.weights[-1])
        return MeshPoints(np.array(faces, dtype=np.int32), np.array(weights).reshape(-1, 3))

    def evaluate(self, points: MeshPoints, values: Floats) -> Floats:
        """Interpolate ``values`` (n, 2) at the vertices to ``points``, (k, 2): e.g. the positions of pins.

        Raises InputError for points with faces that the mesh does not have.
        """
        as_instance(points, "points", MeshPoints)
        as_indices(points.faces, "points.faces", None, len(self.faces))
        if not isinstance(values, np.ndarray) or values.shape != self.vertices.shape:
            came = values.shape if isinstance(values, np.ndarray) else type(values).__name__
            raise InputError(f"values: expected an array of shape {self.vertices.shape}, got {came}")
        return np.einsum("kc,kcd->kd", points.weights, values[self.faces[points.faces]])


def _as_layers(value: ArrayLike, vertices: Floats, faces: Ints) -> Ints:
    """The layers (n,) of vertices. Raises InputError for other shapes, or a face on two of them."""
    layers = as_indices(value, "layers", None, len(vertices)).astype(np.int32)
    if len(layers) != len(vertices):
        raise InputError(f"layers: expected one for each of {len(vertices)} vertices, got {len(layers)}")
    torn = (layers[faces] != layers[faces[:, :1]]).any(axis=1)
    if torn.any():
        raise InputError(f"layers: expected faces on one layer, but face {int(np.argmax(torn))} is on two")
    return layers


def barycentric(corners: Floats, point: Floats) -> Floats:
    """Barycentric weights (m, 3) of ``point``, (2,) or (m, 2), in triangles ``corners`` (m, 3, 2).

    Triangles without area get weights of -1, as if the point were outside.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    u, v, offset = b - a, c - a, point - a
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        scale = 1.0 / (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
        second = (offset[:, 0] * v[:, 1] - offset[:, 1] * v[:, 0]) * scale
        third = (u[:, 0] * offset[:, 1] - u[:, 1] * offset[:, 0]) * scale
        weights = np.stack([1.0 - second - third, second, third], axis=1)
    return np.where(np.isfinite(weights), weights, -1.0)
