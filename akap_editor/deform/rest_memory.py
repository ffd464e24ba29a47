"""Descent towards the rest shape, so that stretching does not accumulate and no face inverts.

The energy is the symmetric Dirichlet energy of Smith and Schaefer 2015; its Hessian comes from what is known
of its eigenvectors (Smith, De Goes and Kim 2019, section 4).
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse import vstack

from ..geometry.checks import Complexes, Floats
from ..geometry.mesh import TriMesh
from ..geometry.operators import element_entries, gradient_matrices, hat_gradients

_SUFFICIENT = 1e-4  # Armijo's share of the decrease that the slope promises
_TRIES = 12
_LEAST_STRETCH = 0.03  # singular values below are taken to be this: Hessians beyond cannot be factorized
_NEAR = 0.8  # a try within this share of the parabola's minimum is near enough


class SymmetricDirichlet:
    """Σ A_f (‖J‖² + ‖J⁻¹‖²) over the faces, J the Jacobian of the map from rest; infinite at flips.

    stiffness: (m,) factors of the faces' energies.
    """

    def __init__(self, mesh: TriMesh, stiffness: Floats | None = None) -> None:
        # Of complex numbers, as the points are: a mixed product would convert them every time.
        self._gradient = vstack(gradient_matrices(mesh), format="csr").astype(np.complex128)
        self._divergence = self._gradient.T.tocsr()
        dx, dy, areas = hat_gradients(mesh.vertices, mesh.faces)
        self._areas = areas if stiffness is None else areas * stiffness
        self._true_areas = areas
        self._hats: Complexes = np.asarray(dx.T + 1j * dy.T, dtype=np.complex128, order="C")

    def columns(self, positions: Complexes) -> Complexes:
        """The columns of J, those of x before those of y, (2m,); linear in the positions (n,)."""
        return np.asarray(self._gradient @ positions, dtype=np.complex128)

    def _terms(self, columns: Complexes) -> tuple[Complexes, Complexes, Floats, Floats]:
        """The columns of J apart, det J = Im(conj(jx) jy) and ‖J‖², (m,) each."""
        jx, jy = columns[: len(self._areas)], columns[len(self._areas) :]
        return jx, jy, _cross(jx, jy), jx.real**2 + jx.imag**2 + jy.real**2 + jy.imag**2

    def value(self, columns: Complexes) -> float:
        """The energy, in square pixels, of a pose whose J has these columns (2m,); 4 Σ A_f at rest."""
        _, _, determinant, squares = self._terms(columns)
        if determinant.min() <= 0:
            return np.inf
        return float(self._areas @ (squares + squares / determinant**2))

    def gradient(self, columns: Complexes) -> Complexes:
        """The derivative of the energy with respect to the vertices, (n,)."""
        jx, jy, determinant, squares = self._terms(columns)
        inverse = 1.0 / determinant
        along = 2 * self._areas * (1 + inverse**2)
        across = 2j * self._areas * squares * inverse**3
        derivatives = np.concatenate([along * jx + across * jy, along * jy - across * jx])
        return np.asarray(self._divergence @ derivatives, dtype=np.complex128)

    def longest(self, columns: Complexes, change: Complexes) -> float:
        """How many times a change of the columns (2m,) fits before a face flips (Smith, Schaefer 2015).

        det(J + t D) is a quadratic polynomial in t; this is the least of its positive roots.
        """
        jx, jy, start, _ = self._terms(columns)
        dx, dy, square, _ = self._terms(change)
        slope = _cross(dx, jy) + _cross(jx, dy)
        # The root nearest to zero as 2 c / (−b ± √(b² − 4ac)), which needs no division by a small a.
        inside = slope**2 - 4 * square * start
        below = np.sqrt(np.maximum(inside, 0.0)) - slope
        flips = (inside > 0) & (below > 0)
        return float((2 * start[flips] / below[flips]).min(initial=np.inf))

    def half_hessian(self, columns: Complexes, convex: bool, spin: Floats | None = None) -> Floats:
        """Entries (21 m,) of half the Hessian, in the order of `element_pattern`; near an isometry that is K.

        With σ₁ ≥ σ₂ the singular values of J, a change of J has four eigenvectors: two scalings, with
        2 + 6 / σᵢ⁴, a flip, and a twist, whose eigenvalue is negative in compressed faces. With ``convex`` it
        is then taken to be zero. spin: (m,) c of further energies c A |z − e^{iθ}|², see `Turning`.
        """
        jx, jy, _, _ = self._terms(columns)
        turning, mirroring = 0.5 * (jx - 1j * jy), 0.5 * (jx + 1j * jy)
        size, other = np.abs(turning), np.abs(mirroring)
        first, second = (np.maximum(values, _LEAST_STRETCH) for values in (size + other, size - other))
        forth = turning.conj() / size
        back = np.where(other > 0, mirroring.conj(), 1.0) / np.where(other > 0, other, 1.0)
        a_b = 0.5 * self._hats.conj() * forth  # the change of a corner times this: scaling + i twist
        c_d = 0.5 * self._hats * back  # anisotropic scaling + i flip
        scale, twist = _rows(a_b)
        stretch, flip = _rows(c_d)
        product = first * second
        twisting = 2.0 - 2.0 * (first**2 - product + second**2) / product**3
        flipping = 2.0 + 2.0 * (first**2 + product + second**2) / product**3
        weights = (
            2 + 6 / first**4,
            2 + 6 / second**4,
            2 * (np.maximum(twisting, 0.0) if convex else twisting),
            2 * flipping,
        )
        rows = [scale + stretch, scale - stretch, twist, flip]
        factors = [0.5 * self._areas * weight for weight in weights]
        if spin is not None:
            rows += [scale, twist]
            factors += [self._true_areas * spin] * 2
        return element_entries(np.array(rows), np.array(factors))


def _cross(a: Complexes, b: Complexes) -> Floats:
    return np.asarray(a.real * b.imag - a.imag * b.real, dtype=np.float64)


def _rows(factors: Complexes) -> tuple[Floats, Floats]:
    """Real and imaginary part of Σ factor · (x + iy) over three corners, as rows (6, m) over x0 y0 x1 ..."""
    real, imaginary = np.empty((2, 6, factors.shape[1]))
    real[::2], real[1::2] = factors.real, -factors.imag
    imaginary[::2], imaginary[1::2] = factors.imag, factors.real
    return real, imaginary


def descend(value: Callable[[float], float], before: float, slope: float, length: float) -> float:
    """How far to go along a descent direction, at most ``length`` times its size.

    value: by the distance; before, slope: at the start. A try that goes past the minimum is followed by one
    at the minimum of the parabola through what is known, since a pose near its minimum would otherwise swing
    about it; the best one counts. 0 where no try lowers the value enough, so that it never rises.
    """
    if slope >= 0:
        return 0.0
    best, least = 0.0, before
    for _ in range(_TRIES):
        after = value(length)
        if after <= before + _SUFFICIENT * length * slope and after < least:
            best, least = length, after
        elif best:
            break
        curvature = after - before - length * slope
        shorter = (
            -0.5 * slope * length**2 / curvature if np.isfinite(after) and curvature > 0 else 0.5 * length
        )
        if best == length and shorter > _NEAR * length:
            break
        length = max(min(shorter, 0.5 * length if not np.isfinite(after) else length), 0.1 * length)
    return best
