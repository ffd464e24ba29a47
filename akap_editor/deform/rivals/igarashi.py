"""As-rigid-as-possible deformation by two linear solves, without iteration: Igarashi, Moscovich and Hughes
2005, "As-Rigid-As-Possible Shape Manipulation".

With points as complex numbers, p at rest and v in the pose, corner k of a face with the corners i, j, k is at
rest p_k = p_i + c (p_j − p_i). The first step finds v' with the least

    Σ_f Σ_k |v'_k − v'_i − c (v'_j − v'_i)|²                                   (section 4.1)

in which turning and scaling a face costs nothing. The second fits to each of its faces the face at rest,
turned but not scaled, and finds v with the least

    Σ_f Σ_ij |(v_j − v_i) − r_f (p_j − p_i)|²                                  (section 4.2)

with the rotations r_f of the fitted faces. Handles are held in both steps by λ² Σ |w·v − q|², points anywhere
on faces with barycentric weights (Igarashi and Igarashi 2009, "Implementing As-Rigid-As-Possible Shape
Manipulation and Surface Flattening").
"""

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from ...geometry.mesh import TriMesh
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, as_number
from ..cholesky import SparseCholesky, SummedPattern
from .rest_based import RestBasedDeformer, product

_NEXT, _AFTER = [1, 2, 0], [2, 0, 1]


class IgarashiDeformer(RestBasedDeformer):
    """As-rigid-as-possible shape manipulation (Igarashi, Moscovich and Hughes 2005).

    mesh: the rest pose.
    pin_weight: λ; 1000 as in the note of 2009. The larger, the nearer pins come to their targets.
    Both matrices are factorized when pins change, and a step solves with each. Pins at one place move their
    component without turning it. All edges count alike, so the result depends on the mesh. Only rest pose,
    pins and targets count, not the pose so far. Faces may flip.
    Raises InputError on settings out of range.
    """

    def __init__(self, mesh: TriMesh, pin_weight: float = 1000.0) -> None:
        self._pull = as_number(pin_weight, "pin_weight", 1.0, 1e5) ** 2
        n, faces = len(mesh.vertices), mesh.faces
        corners = to_complex(mesh.vertices)[faces]
        opposite = (
            corners[:, _AFTER] - corners[:, _NEXT]
        )  # of each corner, the edge from the next to the one after
        # Of the three terms of a face each is a multiple of Σ e_k v_k, with e_k the edge opposite: the only
        # linear form that is 0 for all similarities. The one of corner k has the factor 1 / |e_k|².
        size = np.sqrt((np.abs(opposite) ** -2.0).sum(axis=1, keepdims=True))
        rows = np.repeat(np.arange(len(faces)), 3)
        forms = csr_array(((size * opposite).ravel(), (rows, faces.ravel())), shape=(len(faces), n))
        self._similar = forms.conj().T @ forms
        starts, ends = faces.ravel(), faces[:, _NEXT].ravel()
        edge = np.arange(len(starts))
        signs = np.concatenate([np.ones(len(edge)), -np.ones(len(edge))])
        self._edges = csr_array(
            (signs, (np.tile(edge, 2), np.concatenate([ends, starts]))), shape=(len(edge), n)
        )
        self._rest_edges = (corners[:, _NEXT] - corners).ravel()
        arms = corners - corners.mean(axis=1, keepdims=True)
        self._fit = csr_array((arms.conj().ravel(), (rows, faces.ravel())), shape=forms.shape)
        super().__init__(mesh)

    def _prepare(self) -> None:
        """Factorize both systems; parts that are not bent are left out of them."""
        self._turned = np.zeros(len(self._rest), dtype=bool)
        self._shift = np.zeros((len(self._rest), len(self._pins)))
        for _, own, pins, together in self._parts():
            if together:
                self._shift[np.ix_(own, pins)] = 1 / len(pins)
            else:
                self._turned[own] = True
        still = diags_array((~self._turned).astype(np.float64))
        pinned = self._pull * (self._weights.T @ self._weights)
        self._first = _factorized(_interleaved(self._similar + pinned + still))
        self._second = _factorized(self._edges.T @ self._edges + pinned + still)

    def _moved(self, pose: Complexes, goals: Complexes) -> Complexes:
        # Displacements from rest are solved for: they keep their precision, and nothing moves by itself.
        pin_force = self._pull * (self._weights.T @ (goals - self._pins))
        similar = self._rest + to_complex(self._first.solve(to_points(pin_force).ravel()).reshape(-1, 2))
        turn = self._fit @ similar
        size = np.abs(turn)
        turn = np.divide(turn, size, out=np.ones_like(turn), where=size > 0)
        right = pin_force + self._edges.T @ (np.repeat(turn - 1, 3) * self._rest_edges)
        x, y = (self._second.solve(np.ascontiguousarray(part)) for part in (right.real, right.imag))
        shift = product(self._shift, goals - self._pins)
        return self._rest + np.where(self._turned, x + 1j * y, shift)


def _interleaved(matrix: csr_array) -> coo_array:
    """A Hermitian matrix (n, n) as the real one (2n, 2n) that does the same to x0 y0 x1 y1 ..."""
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


def _factorized(matrix: csr_array | coo_array) -> SparseCholesky:
    """The factorization of a real symmetric matrix."""
    entries = matrix.tocoo()
    lower = entries.row >= entries.col
    pattern = SummedPattern(entries.row[lower], entries.col[lower], matrix.shape[0])
    cholesky = SparseCholesky(pattern, supernodal=False)
    values: Floats = entries.data[lower]
    cholesky.factorize(pattern.summed(values))
    return cholesky
