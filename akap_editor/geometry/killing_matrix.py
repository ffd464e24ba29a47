"""The Killing matrix of a mesh at a pose, and other sums over faces with the same nonzeros."""

from typing import NamedTuple

import numpy as np

from .jit import compiled
from .mesh import TriMesh
from .validation import Complexes, Floats, Ints


class Slots(NamedTuple):
    """Where the nonzeros are that a loop over faces adds to, all int32.

    own (n, 2): the first nonzero of a vertex's own block, in either column; edges (e, 2): the same for the
    block of an edge; sides (m, 3): which edge leads from each corner of a face to the next, as 2 e, or as
    2 e + 1 where to a lower number.
    """

    own: Ints
    edges: Ints
    sides: Ints


class VertexBlocks:
    """The nonzeros of a symmetric 2n × 2n matrix that couples x and y of each vertex and of its neighbors.

    Unknowns are interleaved: 2 i and 2 i + 1 are x and y of vertex i. Nonzeros are those of the lower
    triangle, column by column: below the block of a vertex come those of its neighbors with higher numbers.

    rows, columns: (z,) int32 of the nonzeros; slots: how a face finds its own.
    """

    def __init__(self, mesh: TriMesh) -> None:
        n, low, high = len(mesh.vertices), *mesh.edges.T.astype(np.int64)
        above = np.bincount(low, minlength=n)
        ends = np.cumsum(3 + 4 * above)
        first = ends - (3 + 4 * above)
        below = np.arange(len(low)) - (np.cumsum(above) - above)[low]  # in the order of the sorted edges
        own = np.stack([first, first + 2 + 2 * above], axis=1)
        edges = np.stack([first[low] + 2, own[low, 1] + 1], axis=1) + 2 * below[:, None]
        self.rows, self.columns = np.empty((2, ends[-1]), dtype=np.int32)
        each = 2 * np.arange(n)
        for slots, row, column in [
            (own[:, 0], each, each),
            (own[:, 0] + 1, each + 1, each),
            (own[:, 1], each + 1, each + 1),
            (edges[:, 0], 2 * high, 2 * low),
            (edges[:, 0] + 1, 2 * high + 1, 2 * low),
            (edges[:, 1], 2 * high, 2 * low + 1),
            (edges[:, 1] + 1, 2 * high + 1, 2 * low + 1),
        ]:
            self.rows[slots], self.columns[slots] = row, column
        start, end = mesh.faces.astype(np.int64), mesh.faces[:, [1, 2, 0]].astype(np.int64)
        number = np.searchsorted(low * n + high, np.minimum(start, end) * n + np.maximum(start, end))
        sides = 2 * number + (start > end)
        self.slots = Slots(*(indices.astype(np.int32) for indices in (own, edges, sides)))


class KillingMatrix:
    """K = Pᵀ P of a mesh at any pose (paper, eqs. 5-7, App. A); symmetric, 2n × 2n, x and y interleaved.

    Rows of P per face, each weighted by the root of its area: 2 ∂x U1, √2 (∂y U1 + ∂x U2), 2 ∂y U2. Unlike in
    the printed eq. 6, the gradient is split into ∂x and ∂y: the whole stacked G would penalize rotations.
    Written out, the entry of component a at corner i and b at corner j is 2 A (∂b hᵢ ∂a hⱼ + δ_ab ∇hᵢ·∇hⱼ).

    blocks: where its nonzeros are.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self.blocks = VertexBlocks(mesh)
        self._faces = mesh.faces.copy()
        self._alike, self._free = np.ones(len(mesh.faces)), np.zeros(len(mesh.faces))

    def nonzeros(
        self, positions: Complexes, stiffness: Floats | None = None, spin: Floats | None = None
    ) -> Floats:
        """The nonzeros (z,) at a pose (n,); not finite where a face has collapsed.

        stiffness: (m,) factors of the faces' energies; spin: (m,) weights c of further energies c A ω², where
        ω = (∂x U2 − ∂y U1) / 2 is how fast a field turns on a face.
        """
        stiff = self._alike if stiffness is None else stiffness
        free = self._free if spin is None else spin
        result = np.zeros(len(self.blocks.rows))
        _add_faces(positions, self._faces, stiff, free, self.blocks.slots, result)
        return result


@compiled
def _add_faces(
    positions: Complexes, faces: Ints, stiffness: Floats, spin: Floats, slots: Slots, result: Floats
) -> None:
    own, edges, sides = slots
    for f in range(len(faces)):
        p, q, r = positions[faces[f, 0]], positions[faces[f, 1]], positions[faces[f, 2]]
        # gradients of the hat functions, turned by 90° and times twice the area
        a, b, c = r - q, p - r, q - p
        twice = abs(a.real * b.imag - a.imag * b.real)
        weight, turning = stiffness[f] / twice, 0.125 * spin[f] / twice
        for k in range(3):
            xx, yy = a.imag * a.imag, a.real * a.real
            block, comparison = own[faces[f, k], 0], own[faces[f, k], 1]
            result[block] += weight * (2 * xx + yy) + turning * yy
            result[block + 1] += (turning - weight) * a.real * a.imag
            result[comparison] += weight * (xx + 2 * yy) + turning * xx
            # component a of this corner with b of the next: ∂b here times ∂a there, and more where a = b
            xx, yy = a.imag * b.imag, a.real * b.real
            upper, lower = (turning - weight) * a.real * b.imag, (turning - weight) * a.imag * b.real
            if sides[f, k] & 1 == 0:  # the row is that of the next corner
                upper, lower = lower, upper
            block, comparison = edges[sides[f, k] >> 1, 0], edges[sides[f, k] >> 1, 1]
            result[block] += weight * (2 * xx + yy) + turning * yy
            result[block + 1] += lower
            result[comparison] += upper
            result[comparison + 1] += weight * (xx + 2 * yy) + turning * xx
            a, b, c = b, c, a


@compiled
def add_face(result: Floats, f: int, corners: Ints, matrix: Floats, slots: Slots) -> None:
    """Add the matrix (6, 6) of the face ``f`` over x0 y0 x1 ... of its ``corners`` to the nonzeros."""
    own, edges, sides = slots
    for k in range(3):
        here, there = own[corners[k], 0], own[corners[k], 1]
        result[here] += matrix[2 * k, 2 * k]
        result[here + 1] += matrix[2 * k + 1, 2 * k]
        result[there] += matrix[2 * k + 1, 2 * k + 1]
        row, column = 2 * k, 2 * ((k + 1) % 3)
        if sides[f, k] & 1 == 0:
            row, column = column, row
        here, there = edges[sides[f, k] >> 1, 0], edges[sides[f, k] >> 1, 1]
        result[here] += matrix[row, column]
        result[here + 1] += matrix[row + 1, column]
        result[there] += matrix[row, column + 1]
        result[there + 1] += matrix[row + 1, column + 1]
