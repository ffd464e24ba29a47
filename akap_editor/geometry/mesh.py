"""The triangle mesh of a drawing, and points on it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from .checks import Floats, Ints, as_indices, as_points, frozen


def signed_areas(positions: Floats, faces: Ints) -> Floats:
    """Signed area of each face in square pixels, (m,); positive as stored in a `TriMesh` (y down)."""
    a, b, c = positions[faces[:, 0]], positions[faces[:, 1]], positions[faces[:, 2]]
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


@dataclass(frozen=True, eq=False)
class MeshPoints:
    """Points of the drawing, wherever they are: a face and three weights each.

    faces: (k,) int32; weights: (k, 3) float64 barycentric, each row sums to 1. A point at a vertex is the
    special case (1, 0, 0). The paper pins vertices only; weights inside one face change no sparsity pattern.
    """

    faces: Ints
    weights: Floats

    def __post_init__(self) -> None:
        faces = as_indices(self.faces, "faces", None, np.iinfo(np.int32).max)
        weights = np.array(self.weights, dtype=np.float64).reshape(-1, 3)
        if len(weights) != len(faces):
            raise InputError(f"weights: expected shape ({len(faces)}, 3), got {np.shape(self.weights)}")
        if not np.isfinite(weights).all() or not np.allclose(weights.sum(axis=1), 1.0, atol=1e-9):
            raise InputError("weights: expected finite barycentric weights that sum to 1 in each row")
        object.__setattr__(self, "faces", frozen(faces))
        object.__setattr__(self, "weights", frozen(weights))

    def __len__(self) -> int:
        return len(self.faces)


@dataclass(frozen=True, eq=False)
class TriMesh:
    """A triangle mesh in drawing units (image pixels, x right, y down, origin at the top left corner).

    vertices: (n, 2) float64; faces: (m, 3) int32, every signed area positive, every vertex used, no edge in
    more than two faces, no vertex twice. Arrays are read-only. Raises InputError where that does not hold.
    """

    vertices: Floats
    faces: Ints

    def __post_init__(self) -> None:
        vertices = as_points(self.vertices, "vertices")
        faces = as_indices(self.faces, "faces", 3, len(vertices))
        if not len(vertices) or not len(faces):
            raise InputError(f"mesh: expected vertices and faces, got {len(vertices)} and {len(faces)}")
        areas = signed_areas(vertices, faces)
        if areas.min() <= 0:
            worst = int(np.argmin(areas))
            kind = "has no area" if areas[worst] == 0 else "is flipped"
            raise InputError(f"faces: expected positive signed areas, but face {worst} {kind} ({areas[worst]:g})")
        unused = np.setdiff1d(np.arange(len(vertices)), faces)
        if len(unused):
            raise InputError(f"vertices: expected each to belong to a face, but vertex {unused[0]} does not")
        order = np.lexsort(vertices.T)
        same = (vertices[order[1:]] == vertices[order[:-1]]).all(axis=1)
        if same.any():
            first = int(np.argmax(same))
            raise InputError(f"vertices: {order[first]} and {order[first + 1]} are at the same place")
        object.__setattr__(self, "vertices", frozen(vertices))
        object.__setattr__(self, "faces", frozen(faces))
        if self._edge_counts[1].max() > 2:
            edge = self.edges[int(np.argmax(self._edge_counts[1]))]
            raise InputError(f"faces: edge {edge.tolist()} belongs to more than two faces")

    @cached_property
    def _half_edges(self) -> Ints:
        """(3m, 2) directed edges, in the order of the faces."""
        return self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)

    @cached_property
    def _edge_counts(self) -> tuple[Ints, Ints]:
        edges, counts = np.unique(np.sort(self._half_edges, axis=1), axis=0, return_counts=True)
        return frozen(edges.astype(np.int32)), counts

    @property
    def edges(self) -> Ints:
        """(e, 2) int32, each edge once, smaller index first."""
        return self._edge_counts[0]

    @cached_property
    def boundary_loops(self) -> tuple[Ints, ...]:
        """Closed loops of boundary vertices, outer contours and holes alike, each (q,) int32."""
        half = self._half_edges
        key = np.sort(half, axis=1).astype(np.int64) @ [len(self.vertices), 1]
        _, inverse, counts = np.unique(key, return_inverse=True, return_counts=True)
        following: dict[int, list[int]] = {}
        for a, b in half[counts[inverse] == 1].tolist():
            following.setdefault(a, []).append(b)
        loops = []
        while following:
            start = next(iter(following))
            loop, at = [], start
            while at in following:
                loop.append(at)
                successors = following[at]
                at_next = successors.pop()
                if not successors:
                    del following[at]
                at = at_next
            loops.append(frozen(np.array(loop, dtype=np.int32)))
        return tuple(loops)

    @cached_property
    def boundary_vertices(self) -> Ints:
        """(b,) int32, ascending: the vertices of all boundary loops, holes included (the paper's B in eq. 8)."""
        return frozen(np.unique(np.concatenate(self.boundary_loops)).astype(np.int32))

    @cached_property
    def component(self) -> Ints:
        """(n,) int32: number of the connected component of each vertex."""
        n = len(self.vertices)
        i, j = self.edges.T
        _, labels = connected_components(coo_array((np.ones(len(i)), (i, j)), shape=(n, n)), directed=False)
        return frozen(labels.astype(np.int32))

    @cached_property
    def rest_areas(self) -> Floats:
        """(m,) areas of the rest faces, square pixels."""
        return frozen(signed_areas(self.vertices, self.faces))

    def find(self, point: ArrayLike, positions: Floats | None = None) -> MeshPoints | None:
        """The point of the drawing seen at ``point`` in the pose ``positions`` (default: at rest), or None.

        Where faces overlap, the one drawn last (highest index) is seen.
        """
        q = as_points(np.reshape(np.asarray(point, dtype=np.float64), (1, 2)), "point")[0]
        pose = self.vertices if positions is None else positions
        corners = pose[self.faces]
        inside = np.flatnonzero(
            ((corners.min(axis=1) <= q) & (corners.max(axis=1) >= q)).all(axis=1)
        )
        if not len(inside):
            return None
        weights = barycentric(corners[inside], q)
        hits = np.flatnonzero(weights.min(axis=1) >= -1e-12)
        if not len(hits):
            return None
        return MeshPoints(np.array([inside[hits[-1]]], dtype=np.int32), weights[hits[-1:]])

    def locate(self, points: ArrayLike, positions: Floats | None = None) -> MeshPoints:
        """`MeshPoints` of ``points`` (k, 2) in the pose ``positions`` (n, 2) (default: at rest).

        Raises InputError for a point outside the mesh.
        """
        wanted = as_points(points, "points")
        found = [self.find(q, positions) for q in wanted]
        faces, weights = [], []
        for index, (q, hit) in enumerate(zip(wanted, found, strict=True)):
            if hit is None:
                pose = self.vertices if positions is None else positions
                near = pose[int(np.argmin(((pose - q) ** 2).sum(axis=1)))]
                raise InputError(
                    f"points: point {index} at ({q[0]:g}, {q[1]:g}) lies outside the drawing; "
                    f"the nearest vertex is at ({near[0]:.1f}, {near[1]:.1f})"
                )
            faces.append(hit.faces[0])
            weights.append(hit.weights[0])
        return MeshPoints(np.array(faces, dtype=np.int32), np.array(weights).reshape(-1, 3))

    def evaluate(self, points: MeshPoints, values: Floats) -> Floats:
        """Values at ``points`` of a function given at the vertices, (n, 2) to (k, 2): e.g. where pins are."""
        return np.einsum("kc,kcd->kd", points.weights, values[self.faces[points.faces]])


def barycentric(corners: Floats, point: Floats) -> Floats:
    """Barycentric weights (m, 3) of ``point`` (2,) in each of the triangles ``corners`` (m, 3, 2)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    u, v, w = b - a, c - a, point - a
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
        second = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) * scale
        third = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) * scale
    weights = np.stack([1.0 - second - third, second, third], axis=1)
    return np.where(np.isfinite(weights), weights, -1.0)
