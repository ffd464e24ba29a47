"""The Killing matrix of a mesh at a pose, and other sums over faces with the same nonzeros.

The matrices are symmetric, 2n × 2n, with interleaved unknowns: 2 i and 2 i + 1 are x and y of vertex i. The
2 × 2 block of a vertex couples its own x and y; the block of an edge couples those of its two vertices.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from .edges import coupled_pairs, unique_edges
from .jit import compiled
from .mesh import TriMesh
from .validation import Complexes, Floats, Indices, Ints


class Slots(NamedTuple):  # numba's caches on disk refer to this name: renamed, they fail to load
    """Indices into the nonzeros at which a loop over faces adds to the blocks, all uint32.

    vertices: (n, 2) first nonzero of each column of a vertex's block; edges: (e, 2) the same for the block of
    an edge; face_edges: (m, 3) the edge from each corner of a face to the next, as 2 e, or as 2 e + 1 if the
    next corner has the lower number.
    """

    vertices: Indices
    edges: Indices
    face_edges: Indices


@dataclass(frozen=True, eq=False)
class Triangles:
    """Part of a mesh, which need be no mesh itself: vertices (v, 2) and faces (q, 3).

    edges: (e, 2) and face_edges: (q, 3), as those of a `TriMesh`.
    """

    vertices: Floats
    faces: Ints

    @cached_property
    def _edges_and_sides(self) -> tuple[Ints, Ints]:
        return unique_edges(self.faces, len(self.vertices))

    @property
    def edges(self) -> Ints:
        return self._edges_and_sides[0]

    @property
    def face_edges(self) -> Ints:
        return self._edges_and_sides[1]


class VertexBlocks:
    """The sparsity pattern: one block for each vertex and each edge of a mesh, and for each of its links.

    links: (l, 2) further pairs of vertices that are coupled, the lower one first.

    Nonzeros are those of the lower triangle, column by column: first the block of the vertex itself, then the
    blocks of its neighbors with higher numbers.

    rows, columns: (z,) int32 of the nonzeros; slots: where a face adds to them.
    """

    def __init__(self, mesh: TriMesh | Triangles, links: Ints | None = None) -> None:
        n, pairs, edge_numbers = len(mesh.vertices), mesh.edges.astype(np.int64), mesh.face_edges
        if links is not None and len(links):
            pairs, to_key = coupled_pairs(pairs, links, n), np.array([n, 1])
            edge_numbers = np.searchsorted(pairs @ to_key, mesh.edges @ to_key)[edge_numbers]
        low, high = np.ascontiguousarray(pairs.T)
        higher_neighbors = np.bincount(low, minlength=n)
        x_counts = 2 + 2 * higher_neighbors  # nonzeros in the column of x; one less in that of y
        ends = np.cumsum(2 * x_counts - 1)
        first = ends - (2 * x_counts - 1)
        rank = np.arange(len(low)) - (np.cumsum(higher_neighbors) - higher_neighbors)[low]  # edges are sorted
        vertices = np.stack([first, first + x_counts], axis=1)
        edges = np.stack([first[low] + 2, vertices[low, 1] + 1], axis=1) + 2 * rank[:, None]
        x, later = 2 * np.arange(n, dtype=np.int32), 2 * high.astype(np.int32)
        counts = np.stack([x_counts, x_counts - 1], axis=1).ravel()
        self.columns = np.repeat(np.arange(2 * n, dtype=np.int32), counts)
        self.rows = np.empty(ends[-1], dtype=np.int32)
        for slots, row in [
            (vertices[:, 0], x),
            (vertices[:, 0] + 1, x + 1),
            (vertices[:, 1], x + 1),
            (edges[:, 0], later),
            (edges[:, 0] + 1, later + 1),
            (edges[:, 1], later),
            (edges[:, 1] + 1, later + 1),
        ]:
            self.rows[slots] = row
        face_edges = 2 * edge_numbers + (mesh.faces > mesh.faces[:, [1, 2, 0]])
        self.slots = Slots(*(indices.astype(np.uint32) for indices in (vertices, edges, face_edges)))


class KillingMatrix:
    """K = Pᵀ P of a mesh at any pose (paper, eqs. 5–7 and Appendix A).

    P has three rows per face, each weighted by the root of its area: 2 ∂x U1, √2 (∂y U1 + ∂x U2), 2 ∂y U2.
    The printed eq. 6 stacks the whole gradient G instead of ∂x and ∂y, which would penalize rotations.
    Written out, the entry of component a at corner i and b at corner j is 2 A (∂b hᵢ ∂a hⱼ + δ_ab ∇hᵢ·∇hⱼ).

    links: see `VertexBlocks`. blocks: the sparsity pattern of K.
    """

    def __init__(self, mesh: TriMesh | Triangles, links: Ints | None = None) -> None:
        self.blocks = VertexBlocks(mesh, links)
        self._faces = mesh.faces.astype(np.uint32)
        self._ones, self._zeros = np.ones(len(mesh.faces)), np.zeros(len(mesh.faces))

    def nonzeros(
        self,
        positions: Complexes,
        stiffness: Floats | None = None,
        rotation_weights: Floats | None = None,
    ) -> Floats:
        """The nonzeros (z,) of K at a pose (n,); not finite if a face has collapsed.

        stiffness: (m,) factors of the faces' energies, 1 by default. rotation_weights: (m,) weights c of
        further energies c A ω², where ω = (∂x U2 − ∂y U1) / 2 is the rate at which a field rotates a face; 0
        by default.
        """
        factors = self._ones if stiffness is None else stiffness
        weights = self._zeros if rotation_weights is None else rotation_weights
        result = np.zeros(len(self.blocks.rows))
        _add_faces(positions, self._faces, factors, weights, self.blocks.slots, result)
        return result


@compiled
def _add_faces(
    positions: Complexes,
    faces: Indices,
    stiffness: Floats,
    rotation_weights: Floats,
    slots: Slots,
    result: Floats,
) -> None:
    vertices, edges, face_edges = slots
    for f in range(len(faces)):
        p, q, r = positions[faces[f, 0]], positions[faces[f, 1]], positions[faces[f, 2]]
        # gradients of the hat functions, rotated by 90° and times twice the area
        a, b, c = r - q, p - r, q - p
        double_area = abs(a.real * b.imag - a.imag * b.real)
        weight, rotation = stiffness[f] / double_area, 0.125 * rotation_weights[f] / double_area
        for k in range(3):
            xx, yy = a.imag * a.imag, a.real * a.real
            first, second = vertices[faces[f, k], 0], vertices[faces[f, k], 1]
            result[first] += weight * (2 * xx + yy) + rotation * yy
            result[first + 1] += (rotation - weight) * a.real * a.imag
            result[second] += weight * (xx + 2 * yy) + rotation * xx
            # component a of this corner with b of the next: ∂b here times ∂a there, and more where a = b
            xx, yy = a.imag * b.imag, a.real * b.real
            upper, lower = (rotation - weight) * a.real * b.imag, (rotation - weight) * a.imag * b.real
            if face_edges[f, k] & 1 == 0:  # the row is that of the next corner
                upper, lower = lower, upper
            first, second = edges[face_edges[f, k] >> 1, 0], edges[face_edges[f, k] >> 1, 1]
            result[first] += weight * (2 * xx + yy) + rotation * yy
            result[first + 1] += lower
            result[second] += upper
            result[second + 1] += weight * (xx + 2 * yy) + rotation * xx
            a, b, c = b, c, a


@compiled
def add_face(result: Floats, f: int, corners: Indices, matrix: Floats, slots: Slots) -> None:
    """Add the matrix of face ``f`` to the nonzeros (z,).

    corners: (3,) vertices of the face; matrix: (6, 6) symmetric, over x0 y0 x1 y1 x2 y2 of the corners.
    """
    vertices, edges, face_edges = slots
    for k in range(3):
        first, second = vertices[corners[k], 0], vertices[corners[k], 1]
        result[first] += matrix[2 * k, 2 * k]
        result[first + 1] += matrix[2 * k + 1, 2 * k]
        result[second] += matrix[2 * k + 1, 2 * k + 1]
        row, column = 2 * k, 2 * ((k + 1) % 3)
        if face_edges[f, k] & 1 == 0:
            row, column = column, row
        first, second = edges[face_edges[f, k] >> 1, 0], edges[face_edges[f, k] >> 1, 1]
        result[first] += matrix[row, column]
        result[first + 1] += matrix[row + 1, column]
        result[second] += matrix[row, column + 1]
        result[second + 1] += matrix[row + 1, column + 1]
