"""Descent towards the rest shape, so that stretching does not accumulate and no face inverts.

The energy is the symmetric Dirichlet energy of Smith and Schaefer 2015; the search direction comes from the
Killing operator as preconditioner (Claici, Bessmeltsev, Schaefer and Solomon 2017).
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse import vstack

from ..geometry.checks import Complexes, Floats
from ..geometry.mesh import TriMesh
from ..geometry.operators import gradient_matrices, to_complex, to_points

_SUFFICIENT = 1e-4  # Armijo's share of the decrease that the slope promises
_TRIES = 12
_ITERATIONS = 12
_SOLVED = 0.01  # share of the gradient that Newton's direction may leave
_NEAR = 0.8  # a try within this share of the parabola's minimum is near enough


class SymmetricDirichlet:
    """Σ A_f (‖J‖² + ‖J⁻¹‖²) over the faces, J the Jacobian of the map from rest; infinite at flips."""

    def __init__(self, mesh: TriMesh) -> None:
        self._gradient = vstack(gradient_matrices(mesh), format="csr")
        self._divergence = self._gradient.T.tocsr()
        self._areas = mesh.rest_areas

    def _terms(self, positions: Complexes) -> tuple[Complexes, Complexes, Floats, Floats]:
        """The columns of J as complex numbers, det J = Im(conj(jx) jy) and ‖J‖², (m,) each."""
        columns = to_complex(self._gradient @ to_points(positions))
        jx, jy = columns[: len(self._areas)], columns[len(self._areas) :]
        determinant = jx.real * jy.imag - jx.imag * jy.real
        return jx, jy, determinant, jx.real**2 + jx.imag**2 + jy.real**2 + jy.imag**2

    def value(self, positions: Complexes) -> float:
        """The energy of a pose (n,), in square pixels; 4 Σ A_f at rest."""
        _, _, determinant, squares = self._terms(positions)
        if determinant.min() <= 0:
            return np.inf
        return float(self._areas @ (squares + squares / determinant**2))

    def gradient(self, positions: Complexes) -> Complexes:
        """Derivative with respect to the vertices, (n,)."""
        jx, jy, determinant, squares = self._terms(positions)
        inverse = 1.0 / determinant
        along = 2 * self._areas * (1 + inverse**2)
        across = -2j * self._areas * squares * inverse**3
        derivatives = np.concatenate([along * jx - across * jy, along * jy + across * jx])
        return to_complex(self._divergence @ to_points(derivatives))

    def curvature(self, positions: Complexes) -> Callable[[Complexes], Complexes]:
        """The product of the Hessian at a pose (n,) with a change of the vertices (n,)."""
        jx, jy, determinant, squares = self._terms(positions)
        inverse = 1.0 / determinant
        along = 2 * self._areas * (1 + inverse**2)
        across = 2 * self._areas * squares * inverse**3

        def product(change: Complexes) -> Complexes:
            columns = to_complex(self._gradient @ to_points(change))
            hx, hy = columns[: len(jx)], columns[len(jx) :]
            d = (hx.conj() * jy + jx.conj() * hy).imag
            s = 2 * (jx.conj() * hx + jy.conj() * hy).real
            more_along = -4 * self._areas * inverse**3 * d
            more_across = 2 * self._areas * inverse**3 * (s - 3 * squares * inverse * d)
            derivatives = np.concatenate(
                [
                    more_along * jx + along * hx + 1j * (more_across * jy + across * hy),
                    more_along * jy + along * hy - 1j * (more_across * jx + across * hx),
                ]
            )
            return to_complex(self._divergence @ to_points(derivatives))

        return product


def newton_direction(
    gradient: Complexes,
    curvature: Callable[[Complexes], Complexes],
    precondition: Callable[[Complexes], Complexes],
) -> Complexes:
    """A descent direction: Newton's, by conjugate gradients that stop where the energy is not convex."""
    solution = np.zeros_like(gradient)
    residual = -gradient
    step = direction = precondition(residual)
    first = square = float(np.vdot(residual, step).real)
    for _ in range(_ITERATIONS):
        image = curvature(direction)
        bend = float(np.vdot(direction, image).real)
        if bend <= 0:
            return solution if solution.any() else direction
        length = square / bend
        solution = solution + length * direction
        residual = residual - length * image
        step = precondition(residual)
        previous, square = square, float(np.vdot(residual, step).real)
        if square <= _SOLVED**2 * first:
            break
        direction = step + (square / previous) * direction
    return solution


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
