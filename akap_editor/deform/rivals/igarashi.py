"""As-rigid-as-possible deformation by two linear solves, without iteration: Igarashi, Moscovich and Hughes
2005, "As-Rigid-As-Possible Shape Manipulation".

With points as complex numbers, p at rest and v in the pose, corner k of a face with the corners i, j, k is at
rest p_k = p_i + c (p_j − p_i). The first step finds v' that minimizes

    Σ_f Σ_k |v'_k − v'_i − c (v'_j − v'_i)|²                                   (section 4.1)

in which rotating and scaling a face costs nothing. The second step fits to each of these faces the face at
rest, rotated but not scaled, and finds v that minimizes

    Σ_f Σ_ij |(v_j − v_i) − r_f (p_j − p_i)|²                                  (section 4.2)

with the rotations r_f of the fitted faces. Handles have the energy λ² Σ |w·v − q|² in both steps; they may be
anywhere on faces, with barycentric weights (Igarashi and Igarashi 2009, "Implementing As-Rigid-As-Possible
Shape Manipulation and Surface Flattening").
"""

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from ...geometry.mesh import TriMesh
from ...geometry.operators import NEXT, PREVIOUS, to_complex, to_points
from ...geometry.validation import Complexes, Floats, as_number
from ..cholesky import SparseCholesky, SummedPattern
from ..dissection import Dissection, dissect
from .rest_based import RestBasedDeformer, product


class IgarashiDeformer(RestBasedDeformer):
    """As-rigid-as-possible shape manipulation (Igarashi, Moscovich and Hughes 2005).

    mesh: the rest pose.
    pin_weight: λ, 1000 as in the note of 2009. The larger it is, the closer pins come to their targets.
    Both matrices are factorized when pins change, and a step solves with each. Pins at one place move their
    component without rotating it. All edges have the same weight, so the result depends on the mesh. It does
    not depend on the current pose. Faces may flip.
    Raises InputError for arguments out of range.
    """

    def __init__(self, mesh: TriMesh, pin_weight: float = 1000.0) -> None:
        self._dissection = dissect(mesh.vertices, mesh.edges)
        self._pin_weight = as_number(pin_weight, "pin_weight", 1.0, 1e5) ** 2
        n, faces = len(mesh.vertices), mesh.faces
        corners = to_complex(mesh.vertices)[faces]
        opposite = corners[:, PREVIOUS] - corners[:, NEXT]
        # The terms of a face are multiples of Σ e_k v_k, where e_k is the edge opposite to corner k: the only
        # linear form that is 0 for all similarities. The term of corner k has the factor 1 / |e_k|².
        scale = np.sqrt((np.abs(opposite) ** -2.0).sum(axis=1, keepdims=True))
        rows = np.repeat(np.arange(len(faces)), 3)
        forms = csr_array(((scale * opposite).ravel(), (rows, faces.ravel())), shape=(len(faces), n))
        self._similar = forms.conj().T @ forms
        starts, ends = faces.ravel(), faces[:, NEXT].ravel()
        edge = np.arange(len(starts))
        signs = np.concatenate([np.ones(len(edge)), -np.ones(len(edge))])
        self._edges = csr_array(
            (signs, (np.tile(edge, 2), np.concatenate([ends, starts]))), shape=(len(edge), n)
        )
        self._rest_edges = (corners[:, NEXT] - corners).ravel()
        arms = corners - corners.mean(axis=1, keepdims=True)
        self._fit = csr_array((arms.conj().ravel(), (rows, faces.ravel())), shape=forms.shape)
        super().__init__(mesh)

    def _prepare(self) -> None:
        """Factorize both systems, without the components that are only translated or not moved."""
        self._is_solved = np.zeros(len(self._rest), dtype=bool)
        self._shift = np.zeros((len(self._rest), len(self._pins)))
        for _, own, pins, at_one_place in self._pinned_components():
            if at_one_place:
                self._shift[np.ix_(own, pins)] = 1 / len(pins)
            else:
                self._is_solved[own] = True
        identity = diags_array((~self._is_solved).astype(np.float64))
        pinned = self._pin_weight * (self._weights.T @ self._weights)
        self._first = _factorize(_interleave(self._similar + pinned + identity), self._dissection)
        self._second = _factorize(self._edges.T @ self._edges + pinned + identity, self._dissection)

    def _deform(self, pose: Complexes, goals: Complexes) -> Complexes:
        # The unknowns are displacements from rest: exact zeros at rest, and full precision near it.
        pin_force = self._pin_weight * (self._weights.T @ (goals - self._pins))
        similar = self._rest + to_complex(self._first.solve(to_points(pin_force).ravel()).reshape(-1, 2))
        rotation = self._fit @ similar
        size = np.abs(rotation)
        rotation = np.divide(rotation, size, out=np.ones_like(rotation), where=size > 0)
        right = pin_force + self._edges.T @ (np.repeat(rotation - 1, 3) * self._rest_edges)
        x, y = (self._second.solve(np.ascontiguousarray(axis)) for axis in (right.real, right.imag))
        shift = product(self._shift, goals - self._pins)
        return self._rest + np.where(self._is_solved, x + 1j * y, shift)


def _interleave(matrix: csr_array) -> coo_array:
    """The real matrix (2n, 2n) that acts on x0 y0 x1 y1 ... as a Hermitian one (n, n) on complex numbers."""
    entries = matrix.tocoo()
    re, im = entries.data.real, entries.data.imag
    rows, columns = 2 * entries.row, 2 * entries.col
    return coo_array(
        (
            np.concatenate([re, re, -im, im]),
            (
                np.concatenate([rows, rows + 1, rows, rows + 1]),
                np.concatenate([columns, columns + 1, columns + 1, columns]),
            ),
        ),
        shape=(2 * matrix.shape[0],) * 2,
    )


def _factorize(matrix: csr_array | coo_array, dissection: Dissection) -> SparseCholesky:
    """Factorize a real symmetric matrix."""
    entries = matrix.tocoo()
    lower = entries.row >= entries.col
    pattern = SummedPattern(entries.row[lower], entries.col[lower], matrix.shape[0])
    cholesky = SparseCholesky(pattern, dissection)
    values: Floats = entries.data[lower]
    cholesky.factorize(pattern.sum_entries(values))
    return cholesky
