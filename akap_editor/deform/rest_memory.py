"""Descent towards the rest shape, so that stretching does not accumulate and no face inverts.

The energy is the symmetric Dirichlet energy of Smith and Schaefer 2015; the search direction comes from the
Killing operator as preconditioner (Claici, Bessmeltsev, Schaefer and Solomon 2017).
"""

from collections.abc import Callable

import numpy as np

from ..geometry.checks import Complexes
from ..geometry.mesh import TriMesh
from ..geometry.operators import gradient_matrices, to_complex, to_points

_SUFFICIENT = 1e-4  # Armijo's share of the decrease that the slope promises
_TRIES = 12
_NEAR = 0.8  # a try within this share of the parabola's minimum is near enough


class SymmetricDirichlet:
    """Σ A_f (‖J‖² + ‖J⁻¹‖²) over the faces, J the Jacobian of the map from rest; infinite at flips."""

    def __init__(self, mesh: TriMesh) -> None:
        self._gx, self._gy = gradient_matrices(mesh)
        self._gx_t, self._gy_t = self._gx.T.tocsr(), self._gy.T.tocsr()
        self._areas = mesh.rest_areas

    def _columns(self, positions: Complexes) -> tuple[Complexes, Complexes]:
        """The columns of J, (m,) each, as complex numbers."""
        points = to_points(positions)
        return to_complex(self._gx @ points), to_complex(self._gy @ points)

    def value(self, positions: Complexes) -> float:
        """The energy of a pose (n,), in square pixels; 4 Σ A_f at rest."""
        jx, jy = self._columns(positions)
        determinant = (jx.conj() * jy).imag
        if determinant.min() <= 0:
            return np.inf
        squares = _squares(jx, jy)
        return float(self._areas @ (squares + squares / determinant**2))

    def gradient(self, positions: Complexes) -> Complexes:
        """Derivative with respect to the vertices, (n,); det J = Im(conj(jx) jy)."""
        jx, jy = self._columns(positions)
        determinant = (jx.conj() * jy).imag
        squares = _squares(jx, jy)
        along = 2 * self._areas * (1 + determinant**-2)
        across = -2 * self._areas * squares * determinant**-3
        dx = along * jx - 1j * across * jy
        dy = along * jy + 1j * across * jx
        return to_complex(self._gx_t @ to_points(dx) + self._gy_t @ to_points(dy))


def _squares(jx: Complexes, jy: Complexes) -> np.ndarray:
    return jx.real**2 + jx.imag**2 + jy.real**2 + jy.imag**2


def descend(
    positions: Complexes,
    value: Callable[[Complexes], float],
    gradient: Complexes,
    direction: Complexes,
    length: float,
) -> Complexes:
    """One step from ``positions`` along a descent direction, at most ``length`` times its size.

    A try that goes past the minimum is followed by one at the minimum of the parabola through what is known,
    since a pose near its minimum would otherwise swing about it. Returns ``positions`` where no try lowers
    the energy enough, so that it never rises.
    """
    slope = float((gradient.conj() * direction).real.sum())
    if slope >= 0:
        return positions
    before = value(positions)
    for _ in range(_TRIES):
        candidate = positions + length * direction
        after = value(candidate)
        curvature = after - before - length * slope
        shorter = (
            -0.5 * slope * length**2 / curvature if np.isfinite(after) and curvature > 0 else 0.5 * length
        )
        if after <= before + _SUFFICIENT * length * slope and shorter > _NEAR * length:
            return candidate
        length = max(min(shorter, 0.5 * length if not np.isfinite(after) else length), 0.1 * length)
    return positions
