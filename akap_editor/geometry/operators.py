"""Differential operators of piecewise linear functions on a triangle mesh.

In formulas a point or vector (x, y) is the complex number x + iy, as in the paper's section 2.3.
"""

import numpy as np
from scipy.sparse import csr_array

from .checks import Complexes, Floats, Ints
from .mesh import TriMesh, signed_areas

_NEXT, _AFTER = [1, 2, 0], [2, 0, 1]  # the other two corners of a face, seen from each


def to_complex(points: Floats) -> Complexes:
    """(n, 2) float64 as (n,) complex128; a view where the array is contiguous."""
    return np.ascontiguousarray(points).view(np.complex128)[:, 0]


def to_points(values: Complexes) -> Floats:
    """(n,) complex128 as (n, 2) float64; a view where the array is contiguous."""
    return np.ascontiguousarray(values).view(np.float64).reshape(-1, 2)


def hat_gradients(positions: Floats, faces: Ints) -> tuple[Floats, Floats, Floats]:
    """Gradients of the three hat functions on each face: ∂x (m, 3), ∂y (m, 3), and the face areas (m,).

    The gradient of a hat function is the opposite edge turned by 90° over twice the area (Botsch et al. 2010,
    chapter 3). Areas of flipped faces are negative.
    """
    areas = signed_areas(positions, faces)
    x, y = positions[:, 0][faces], positions[:, 1][faces]
    scale = 0.5 / areas[:, None]
    dx = (y[:, _NEXT] - y[:, _AFTER]) * scale
    dy = (x[:, _AFTER] - x[:, _NEXT]) * scale
    return dx, dy, areas


def gradient_matrices(mesh: TriMesh) -> tuple[csr_array, csr_array]:
    """Sparse (m, n) matrices G_x, G_y: derivatives on each rest face of a function given at the vertices."""
    dx, dy, _ = hat_gradients(mesh.vertices, mesh.faces)
    m, n = len(mesh.faces), len(mesh.vertices)
    rows = np.repeat(np.arange(m), 3)
    columns = mesh.faces.ravel()
    return (
        csr_array((dx.ravel(), (rows, columns)), shape=(m, n)),
        csr_array((dy.ravel(), (rows, columns)), shape=(m, n)),
    )


def jacobians(mesh: TriMesh, positions: Floats) -> Floats:
    """(m, 2, 2) Jacobians J[:, component, derivative] of the map from the rest pose to ``positions``."""
    gx, gy = gradient_matrices(mesh)
    return np.stack([gx @ positions, gy @ positions], axis=2)


def killing_energy(positions: Floats, faces: Ints, field: Floats) -> float:
    """∫‖J + Jᵀ‖² of a vector field (n, 2) on a mesh at ``positions`` (paper, eq. 2): 0 for rigid motions."""
    dx, dy, areas = hat_gradients(positions, faces)
    u, v = field[:, 0][faces], field[:, 1][faces]
    stretch_x, stretch_y = (dx * u).sum(axis=1), (dy * v).sum(axis=1)
    shear = (dy * u).sum(axis=1) + (dx * v).sum(axis=1)
    return float(np.abs(areas) @ (4 * stretch_x**2 + 4 * stretch_y**2 + 2 * shear**2))


# The lower triangle of a face's 6×6 matrix, degrees of freedom in the order x0 y0 x1 y1 x2 y2.
_LOWER_ROWS, _LOWER_COLUMNS = np.tril_indices(6)


def element_pattern(faces: Ints) -> tuple[Ints, Ints]:
    """Rows and columns, (21 m,) each, of all entries of the faces' matrices, as 2n × 2n indices.

    First entry of all faces, then the second, ... Degrees of freedom are interleaved: 2 i and 2 i + 1 are x
    and y of vertex i. An entry may lie above the diagonal; its mirror image is the one meant.
    """
    dofs = (2 * faces.T[:, None, :] + np.arange(2)[:, None]).reshape(6, -1)
    return dofs[_LOWER_ROWS].ravel(), dofs[_LOWER_COLUMNS].ravel()


def element_entries(rows: Floats, weights: Floats) -> Floats:
    """Entries (21 m,) of the faces' matrices Σ w r rᵀ, in the order of the pattern.

    rows: (q, 6, m), over the degrees of freedom of each face; weights: (q, m).
    """
    entries = np.zeros((21, rows.shape[2]))
    weighted = weights[:, None] * rows
    for entry, i, j in zip(entries, _LOWER_ROWS.tolist(), _LOWER_COLUMNS.tolist(), strict=True):
        for row, other in zip(rows, weighted, strict=True):
            entry += row[i] * other[j]
    return entries.ravel()


class KillingMatrix:
    """K = Pᵀ P of a mesh at any pose (paper, eqs. 5-7, App. A); symmetric, 2n × 2n, x and y interleaved.

    Rows of P per face, each weighted by the root of its area: 2 ∂x U1, √2 (∂y U1 + ∂x U2), 2 ∂y U2. Unlike in
    the printed eq. 6, the gradient is split into ∂x and ∂y: the whole stacked G would penalize rotations.
    Written out, the entry of component a at corner i and b at corner j is 2 A (∂b hᵢ ∂a hⱼ + δ_ab ∇hᵢ·∇hⱼ).
    Translations have no energy, so that the blocks of a row of blocks sum to zero: only those of the edges
    are computed.

    rows, columns: (z,) where the nonzeros of the lower triangle are, column by column.
    """

    def __init__(self, mesh: TriMesh) -> None:
        n, e, m = len(mesh.vertices), len(mesh.edges), len(mesh.faces)
        self._faces = np.ascontiguousarray(mesh.faces.T).astype(np.intp)
        low, high = mesh.edges.T.astype(np.int64)
        vertices = np.arange(n)
        # By edge the four entries of the block of its higher and lower vertex, by vertex those of its own.
        rows = np.concatenate([2 * high + a for a, _ in _BLOCK] + [2 * vertices + a for a, _ in _DIAGONAL])
        columns = np.concatenate([2 * low + b for _, b in _BLOCK] + [2 * vertices + b for _, b in _DIAGONAL])
        order = np.argsort(columns * 2 * n + rows)
        self.rows, self.columns = rows[order], columns[order]
        self._slots = np.argsort(order)
        # What the faces on both sides of an edge add; an edge of the boundary adds a zero behind the last.
        start, end = self._faces, self._faces[_NEXT]
        half_edges = np.searchsorted(
            low * n + high, (np.minimum(start, end) * n + np.maximum(start, end)).ravel()
        )
        by_edge = np.argsort(half_edges, kind="stable")
        first, second = (
            np.searchsorted(half_edges[by_edge], np.arange(e), side) for side in ("left", "right")
        )
        sides = by_edge[first], by_edge[second - 1]
        is_inner = second - first > 1
        downwards = (start > end).ravel()
        entry = np.arange(4)[:, None]
        self._sides = []
        for side in sides:  # the block is transposed where a face goes along the edge upwards
            transposed = np.array([0, 2, 1, 3])[:, None]
            self._sides.append((np.where(downwards[side], entry, transposed) * 3 * m + side).ravel())
        self._sides[1] = np.where(np.tile(is_inner, 4), self._sides[1], 12 * m)
        # Translations have no energy: a vertex's block is minus the sum of those of its edges.
        at, ones = np.arange(e), np.ones(2 * e)
        parts = [(0, low, 0), (0, high, 0), (1, low, 1), (1, high, 2), (2, low, 3), (2, high, 3)]
        summed = np.concatenate([k * n + ends for k, ends, _ in parts]).astype(np.int32)
        of = np.concatenate([block * e + at for *_, block in parts]).astype(np.int32)
        self._to_vertices = csr_array((-np.tile(ones, 3), (summed, of)), shape=(3 * n, 4 * e))

    def nonzeros(
        self, positions: Floats, stiffness: Floats | None = None, spin: Floats | None = None
    ) -> Floats:
        """The nonzeros (z,) at a pose (n, 2); not finite where a face has collapsed.

        stiffness: (m,) factors of the faces' energies; spin: (m,) weights c of further energies c A ω², where
        ω = (∂x U2 − ∂y U1) / 2 is how fast a field turns on a face.
        """
        x, y = positions[:, 0][self._faces], positions[:, 1][self._faces]
        turned_x, turned_y = y[_NEXT] - y[_AFTER], x[_AFTER] - x[_NEXT]
        root = np.sqrt(np.abs(turned_y[2] * turned_x[1] - turned_y[1] * turned_x[2]))  # of twice the area
        if stiffness is not None:
            root /= np.sqrt(stiffness)
        turned_x /= root
        turned_y /= root
        # Entry (a, b) of the block of a half-edge's start and end: ∂b h_start ∂a h_end, and more where a = b.
        next_x, next_y = turned_x[_NEXT], turned_y[_NEXT]
        faces = np.zeros(12 * x.shape[1] + 1)
        xx, yx, xy, yy = faces[:-1].reshape(4, *x.shape)
        np.multiply(turned_x, next_x, out=xx)
        np.multiply(turned_y, next_x, out=yx)
        np.multiply(turned_x, next_y, out=xy)
        np.multiply(turned_y, next_y, out=yy)
        both = xx + yy
        if spin is None:
            xx += both
            yy += both
        else:
            share = 0.125 * spin
            xx[:], yy[:] = both + xx + share * yy, both + yy + share * xx
            xy *= 1 - share
            yx *= 1 - share
        edges = faces.take(self._sides[0]) + faces.take(self._sides[1])
        result = np.empty(len(self._slots))
        result[self._slots[: len(edges)]] = edges
        result[self._slots[len(edges) :]] = self._to_vertices @ edges
        return result


_BLOCK = ((0, 0), (0, 1), (1, 0), (1, 1))
_DIAGONAL = ((0, 0), (1, 0), (1, 1))
