"""As-rigid-as-possible deformation: Liu, Zhang, Xu, Gotsman and Gortler 2008, "A Local/Global Approach to
Mesh Parameterization".

The energy over faces f and their edges i, with v at rest and p in the pose, is

    ½ Σ_f Σ_i cot θ_i |(p_i − p_i+1) − R_f (v_i − v_i+1)|²  =  Σ_f A_f ‖J_f − R_f‖²

with the Jacobian J_f of the map from rest. The local step finds the rotations R_f that fit best, the global
step the positions, from a Poisson equation with the Laplacian of cotangents. Neither can raise the energy.

With "spokes-and-rims" there is one rotation for each vertex v instead, which fits all edges of the faces
around it (Chao, Pinkall, Sanan and Schröder 2010, "A Simple Geometric Model for Elastic Deformations"):

    Σ_f A_f ⅓ Σ_v∈f ‖J_f − R_v‖²

so that the rotations of neighbors share faces, which makes bends smoother.
"""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, diags_array, vstack

from ...geometry.mesh import TriMesh
from ...geometry.operators import gradient_matrices, to_complex, to_points
from ...geometry.validation import Complexes, as_choice, as_number, as_points, as_switch
from ..cholesky import SparseCholesky, SummedPattern
from .rest_based import RestBasedDeformer, product

Rotations = Literal["faces", "spokes-and-rims"]

_MOST = 100_000  # iterations that can be asked for
_MOST_TO_CONVERGE = 10_000  # pins that are crowded into a point shrink the rest ever more slowly
_SAME_PIN = 1e-9  # share of the largest compliance below which pins say the same thing twice


class ArapDeformer(RestBasedDeformer):
    """As-rigid-as-possible deformation (Liu, Zhang, Xu, Gotsman and Gortler 2008).

    mesh: the rest pose.
    iterations: most pairs of a local and a global step in one step; the pose is the first guess.
    tolerance: share of the square root of the mesh's area; once no vertex moves farther, the step ends.
    converge: iterate until then, but at most 10,000 times, whatever ``iterations`` says.
    rotations: "faces", as in the paper, or "spokes-and-rims".
    Pins are exactly at their targets where these do not contradict one another; the energy may flip faces.
    Raises InputError on settings out of range.
    """

    def __init__(
        self,
        mesh: TriMesh,
        iterations: int = 10,
        tolerance: float = 1e-7,
        converge: bool = False,
        rotations: Rotations = "faces",
    ) -> None:
        wanted = int(as_number(iterations, "iterations", 1, _MOST))
        self._iterations = _MOST_TO_CONVERGE if as_switch(converge, "converge") else wanted
        as_choice(rotations, "rotations", ("faces", "spokes-and-rims"))
        self._tolerance = as_number(tolerance, "tolerance", 0, 1) * mesh.length
        self._gradient = vstack(gradient_matrices(mesh), format="csr")
        self._areas = mesh.rest_areas
        self._divergence = csr_array(self._gradient.T * np.tile(self._areas, 2))
        self._laplacian = self._divergence @ self._gradient
        self._around: csr_array | None = None
        if rotations == "spokes-and-rims":
            corners = np.repeat(np.arange(len(mesh.faces)), 3), mesh.faces.ravel()
            shape = len(mesh.faces), len(mesh.vertices)
            self._around = csr_array((np.full(mesh.faces.size, 1 / 3), corners), shape=shape)
        super().__init__(mesh)

    def energy(self, positions: ArrayLike) -> float:
        """Σ A ‖J − R‖² of a pose (n, 2) with the rotations that fit it best, in square pixels.

        With spokes and rims and R the mean of a face's rotations, ⅓ Σ ‖J − R_v‖² is ‖J − R‖² + 2 − ‖R‖².
        """
        columns = self._columns(to_complex(as_points(positions, "positions", len(self._rest))))
        rotations = self._rotations(columns)
        off = np.abs(columns - rotations) ** 2
        if self._around is not None:
            off += 1 - np.abs(rotations) ** 2
        return float(np.tile(self._areas, 2) @ off)

    def _prepare(self) -> None:
        """Factorize the global step; it has pins as hard constraints, by their compliance W A⁻¹ Wᵀ.

        A = L + WᵀW gives the same answer as the Laplacian L, since W p is prescribed, and is not singular.
        """
        pinned = self._weights.T @ self._weights
        matrix = (self._laplacian + pinned + diags_array(self._held.astype(np.float64))).tocoo()
        lower = matrix.row >= matrix.col
        pattern = SummedPattern(matrix.row[lower], matrix.col[lower], matrix.shape[0])
        self._cholesky = SparseCholesky(pattern, supernodal=False)
        self._cholesky.factorize(pattern.summed(matrix.data[lower]))
        rows = self._weights.toarray()
        answers = np.array([self._cholesky.solve(row) for row in rows]).reshape(rows.shape).T
        stiffness = np.linalg.pinv(self._weights @ answers, rcond=_SAME_PIN, hermitian=True)
        self._corrections = answers @ stiffness

    def _moved(self, pose: Complexes, goals: Complexes) -> Complexes:
        for _ in range(self._iterations):
            previous, pose = pose, self._global_step(self._rotations(self._columns(pose)), goals)
            if np.abs(pose - previous)[~self._held].max() <= self._tolerance:
                break
        return pose

    def _columns(self, pose: Complexes) -> Complexes:
        """The two columns of all Jacobians as complex numbers, ∂x of each face, then ∂y, (2m,)."""
        return to_complex(self._gradient @ to_points(pose))

    def _rotations(self, columns: Complexes) -> Complexes:
        """The rotations R and iR of each face, (2m,), nearest to its Jacobian: the unit of ∂x − i ∂y.

        With spokes and rims, the mean of those of its corners.
        """
        m = len(self._areas)
        turn = columns[:m] - 1j * columns[m:]
        if self._around is None:
            turn = _units(turn)
        else:
            turn = self._around @ _units(self._around.T @ (self._areas * turn))
        return np.concatenate([turn, 1j * turn])

    def _global_step(self, rotations: Complexes, goals: Complexes) -> Complexes:
        """The least energy with these rotations and the pins at ``goals``: L p = ∇ᵀ A R, W p = goals."""
        right = self._divergence @ to_points(rotations) + self._weights.T @ to_points(goals)
        x, y = (self._cholesky.solve(np.ascontiguousarray(column)) for column in right.T)
        free = x + 1j * y
        return free + product(self._corrections, goals - self._weights @ free)


def _units(values: Complexes) -> Complexes:
    """Numbers of size 1 in the direction of ``values``, and 1 for 0."""
    size = np.abs(values)
    return np.divide(values, size, out=np.ones_like(values), where=size > 0)
