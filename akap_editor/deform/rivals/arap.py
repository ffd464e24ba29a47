"""As-rigid-as-possible deformation: Liu, Zhang, Xu, Gotsman and Gortler 2008, "A Local/Global Approach to
Mesh Parameterization".

The energy over faces f and their edges i, with v at rest and p in the pose, is

    ½ Σ_f Σ_i cot θ_i |(p_i − p_i+1) − R_f (v_i − v_i+1)|²  =  Σ_f A_f ‖J_f − R_f‖²

with the Jacobian J_f of the map from rest. The local step finds the best rotations R_f, the global step the
best positions, from a Poisson equation with the cotangent Laplacian. Neither can increase the energy.

With "spokes-and-rims", each vertex v has one rotation instead, fitted to all edges of the faces around it
(Chao, Pinkall, Sanan and Schröder 2010, "A Simple Geometric Model for Elastic Deformations"):

    Σ_f A_f ⅓ Σ_v∈f ‖J_f − R_v‖²

The rotations of neighbors share faces, which makes bends smoother.
"""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, diags_array, vstack

from ...geometry.mesh import TriMesh
from ...geometry.operators import gradient_matrices, to_complex, to_points
from ...geometry.validation import Complexes, as_choice, as_number, as_points, as_switch
from ..cholesky import SparseCholesky, SummedPattern
from ..dissection import dissect
from .rest_based import RestBasedDeformer, product

Rotations = Literal["faces", "spokes-and-rims"]

_MAX_ITERATIONS = 100_000  # that can be asked for in one step
_MAX_ITERATIONS_TO_CONVERGE = 10_000  # pins crowded into a point shrink the rest ever more slowly
_REPEATED = 1e-9  # share of the largest compliance below which a pin repeats another one


class ArapDeformer(RestBasedDeformer):
    """As-rigid-as-possible deformation (Liu, Zhang, Xu, Gotsman and Gortler 2008).

    mesh: the rest pose.
    iterations: maximum number of pairs of a local and a global step in one step, which starts from the pose.
    tolerance: share of √area; the step ends once no vertex moves farther in an iteration.
    converge: iterate until then, regardless of ``iterations``, but at most 10,000 times.
    rotations: "faces", as in the paper, or "spokes-and-rims".
    Pins reach their targets exactly unless these contradict one another; the energy may flip faces.
    Raises InputError for arguments out of range.
    """

    def __init__(
        self,
        mesh: TriMesh,
        iterations: int = 10,
        tolerance: float = 1e-7,
        converge: bool = False,
        rotations: Rotations = "faces",
    ) -> None:
        self._dissection = dissect(mesh.vertices, mesh.edges)
        limit = int(as_number(iterations, "iterations", 1, _MAX_ITERATIONS))
        self._iterations = _MAX_ITERATIONS_TO_CONVERGE if as_switch(converge, "converge") else limit
        as_choice(rotations, "rotations", ("faces", "spokes-and-rims"))
        self._tolerance = as_number(tolerance, "tolerance", 0, 1) * mesh.length
        self._gradient = vstack(gradient_matrices(mesh), format="csr")
        self._areas = mesh.rest_areas
        self._divergence = csr_array(self._gradient.T * np.tile(self._areas, 2))
        self._laplacian = self._divergence @ self._gradient
        self._corner_mean: csr_array | None = None  # (m, n), for rotations of vertices
        if rotations == "spokes-and-rims":
            corners = np.repeat(np.arange(len(mesh.faces)), 3), mesh.faces.ravel()
            shape = len(mesh.faces), len(mesh.vertices)
            self._corner_mean = csr_array((np.full(mesh.faces.size, 1 / 3), corners), shape=shape)
        super().__init__(mesh)

    def energy(self, positions: ArrayLike) -> float:
        """Σ A ‖J − R‖² of a pose (n, 2) with its best rotations, in square pixels.

        With spokes and rims, ⅓ Σ ‖J − R_v‖² is ‖J − R‖² + 2 − ‖R‖², with R the mean of a face's rotations.
        Raises InputError.
        """
        columns = self._columns(to_complex(as_points(positions, "positions", len(self._rest))))
        rotations = self._rotations(columns)
        squares = np.abs(columns - rotations) ** 2
        if self._corner_mean is not None:
            squares += 1 - np.abs(rotations) ** 2
        return float(np.tile(self._areas, 2) @ squares)

    def _prepare(self) -> None:
        """Factorize the global step, and the compliance W A⁻¹ Wᵀ by which it has pins as hard constraints.

        A = L + WᵀW has the same solution as the Laplacian L, because W p is prescribed, and is not singular.
        """
        pinned = self._weights.T @ self._weights
        matrix = (self._laplacian + pinned + diags_array(self._is_unpinned.astype(np.float64))).tocoo()
        lower = matrix.row >= matrix.col
        pattern = SummedPattern(matrix.row[lower], matrix.col[lower], matrix.shape[0])
        self._cholesky = SparseCholesky(pattern, self._dissection)
        self._cholesky.factorize(pattern.sum_entries(matrix.data[lower]))
        rows = self._weights.toarray()
        responses = np.array([self._cholesky.solve(row) for row in rows]).reshape(rows.shape).T
        stiffness = np.linalg.pinv(self._weights @ responses, rcond=_REPEATED, hermitian=True)
        self._corrections = responses @ stiffness

    def _deform(self, pose: Complexes, goals: Complexes) -> Complexes:
        for _ in range(self._iterations):
            previous, pose = pose, self._global_step(self._rotations(self._columns(pose)), goals)
            if np.abs(pose - previous)[~self._is_unpinned].max() <= self._tolerance:
                break
        return pose

    def _columns(self, pose: Complexes) -> Complexes:
        """The columns of the Jacobians as complex numbers, (2m,): ∂x of each face, then ∂y."""
        return to_complex(self._gradient @ to_points(pose))

    def _rotations(self, columns: Complexes) -> Complexes:
        """The rotations R, then iR, of each face, (2m,): of ∂x − i ∂y, the unit complex number.

        With spokes and rims, R is the mean of the rotations of the face's corners.
        """
        m = len(self._areas)
        similarity = columns[:m] - 1j * columns[m:]
        if self._corner_mean is None:
            rotation = _normalize(similarity)
        else:
            rotation = self._corner_mean @ _normalize(self._corner_mean.T @ (self._areas * similarity))
        return np.concatenate([rotation, 1j * rotation])

    def _global_step(self, rotations: Complexes, goals: Complexes) -> Complexes:
        """The pose (n,) of least energy for rotations R (2m,): L p = ∇ᵀ A R, with W p = goals (k,)."""
        right = self._divergence @ to_points(rotations) + self._weights.T @ to_points(goals)
        x, y = (self._cholesky.solve(np.ascontiguousarray(column)) for column in right.T)
        free = x + 1j * y
        return free + product(self._corrections, goals - self._weights @ free)


def _normalize(values: Complexes) -> Complexes:
    """Unit complex numbers in the direction of ``values``; 1 for 0."""
    size = np.abs(values)
    return np.divide(values, size, out=np.ones_like(values), where=size > 0)
