"""Descent towards the rest shape, so that stretching does not accumulate and no face inverts.

The energy is the symmetric Dirichlet energy of Smith and Schaefer 2015; its Hessian comes from what is known
of its eigenvectors (Smith, De Goes and Kim 2019, section 4).
"""

from collections.abc import Callable

import numpy as np

from ...geometry.jit import compiled
from ...geometry.killing_matrix import Slots, VertexBlocks, add_face
from ...geometry.mesh import TriMesh
from ...geometry.operators import hat_gradients
from ...geometry.validation import Complexes, Floats, Ints

_SUFFICIENT = 1e-4  # Armijo's share of the decrease that the slope promises
_TRIES = 12
_LEAST_STRETCH = 0.03  # singular values below are taken to be this: Hessians beyond cannot be factorized
_NEAR = 0.8  # a try within this share of the parabola's minimum is near enough


class SymmetricDirichlet:
    """Σ A_f (‖J‖² + ‖J⁻¹‖²) over the faces, J the Jacobian of the map from rest; infinite at flips.

    stiffness: (m,) factors of the faces' energies.
    """

    def __init__(self, mesh: TriMesh, stiffness: Floats | None = None) -> None:
        dx, dy, areas = hat_gradients(mesh.vertices, mesh.faces)
        self._faces, self._count = mesh.faces.copy(), len(mesh.vertices)
        self._hats = dx + 1j * dy  # gradients of the hat functions, (m, 3)
        self._areas = areas if stiffness is None else areas * stiffness
        self._true_areas = areas

    def columns(self, positions: Complexes) -> Complexes:
        """The columns of J, (m, 2), the one of x before that of y; linear in the positions (n,)."""
        return _columns(positions, self._faces, self._hats)

    def value(self, columns: Complexes) -> float:
        """The energy, in square pixels, of a pose whose J has these columns (m, 2); 4 Σ A_f at rest."""
        return _value(columns, self._areas)

    def gradient(self, columns: Complexes) -> Complexes:
        """The derivative of the energy with respect to the vertices, (n,)."""
        return _gradient(columns, self._areas, self._faces, self._hats, self._count)

    def longest(self, columns: Complexes, change: Complexes) -> float:
        """How many times a change of the columns (m, 2) fits before a face flips (Smith, Schaefer 2015)."""
        return _longest(columns, change)

    def half_hessian(
        self, columns: Complexes, convex: bool, blocks: VertexBlocks, spin: Floats | None = None
    ) -> Floats:
        """The nonzeros (z,), at ``blocks``, of half the Hessian; near an isometry that is K.

        With σ₁ ≥ σ₂ the singular values of J, a change of J has four eigenvectors: two scalings, with
        2 + 6 / σᵢ⁴, a flip, and a twist, whose eigenvalue is negative in compressed faces. With ``convex`` it
        is then taken to be zero. spin: (m,) the factors c of `PinRotationConstraints`.
        """
        spins = np.zeros(len(self._areas)) if spin is None else self._true_areas * spin
        result = np.zeros(len(blocks.rows))
        _add_half_hessians(columns, self._areas, spins, convex, self._faces, self._hats, blocks.slots, result)
        return result


@compiled
def _cross(a: complex, b: complex) -> float:
    return a.real * b.imag - a.imag * b.real


@compiled
def _square(a: complex) -> float:
    return a.real * a.real + a.imag * a.imag


@compiled
def _columns(positions: Complexes, faces: Ints, hats: Complexes) -> Complexes:
    result = np.empty((len(faces), 2), dtype=np.complex128)
    for f in range(len(faces)):
        jx = jy = 0.0j
        for k in range(3):
            point = positions[faces[f, k]]
            jx += hats[f, k].real * point
            jy += hats[f, k].imag * point
        result[f, 0], result[f, 1] = jx, jy
    return result


@compiled
def _value(columns: Complexes, areas: Floats) -> float:
    total = 0.0
    for f in range(len(columns)):
        jx, jy = columns[f, 0], columns[f, 1]
        determinant = _cross(jx, jy)
        if not determinant > 0:
            return np.inf
        total += areas[f] * (_square(jx) + _square(jy)) * (1 + 1 / (determinant * determinant))
    return total


@compiled
def _gradient(columns: Complexes, areas: Floats, faces: Ints, hats: Complexes, count: int) -> Complexes:
    """By ∂det/∂jx = −i jy and ∂det/∂jy = i jx."""
    result = np.zeros(count, dtype=np.complex128)
    for f in range(len(faces)):
        jx, jy = columns[f, 0], columns[f, 1]
        inverse = 1 / _cross(jx, jy)
        along = 2 * areas[f] * (1 + inverse * inverse)
        across = 2 * areas[f] * (_square(jx) + _square(jy)) * inverse * inverse * inverse
        of_jx = complex(along * jx.real - across * jy.imag, along * jx.imag + across * jy.real)
        of_jy = complex(along * jy.real + across * jx.imag, along * jy.imag - across * jx.real)
        for k in range(3):
            result[faces[f, k]] += hats[f, k].real * of_jx + hats[f, k].imag * of_jy
    return result


@compiled
def _longest(columns: Complexes, change: Complexes) -> float:
    """det(J + t D) is a quadratic polynomial in t; this is the least of its positive roots over the faces."""
    shortest = np.inf
    for f in range(len(columns)):
        jx, jy = columns[f, 0], columns[f, 1]
        dx, dy = change[f, 0], change[f, 1]
        start, slope, square = _cross(jx, jy), _cross(dx, jy) + _cross(jx, dy), _cross(dx, dy)
        # The root nearest to zero as 2 c / (−b ± √(b² − 4ac)), which needs no division by a small a.
        inside = slope * slope - 4 * square * start
        if inside > 0:
            below = np.sqrt(inside) - slope
            if below > 0:
                shortest = min(shortest, 2 * start / below)
    return shortest


@compiled
def _add_half_hessians(
    columns: Complexes,
    areas: Floats,
    spins: Floats,
    convex: bool,
    faces: Ints,
    hats: Complexes,
    slots: Slots,
    result: Floats,
) -> None:
    rows, matrix = np.empty((4, 6)), np.empty((6, 6))
    for f in range(len(faces)):
        jx, jy = columns[f, 0], columns[f, 1]
        turning, mirroring = 0.5 * (jx - 1j * jy), 0.5 * (jx + 1j * jy)
        size, other = abs(turning), abs(mirroring)
        first, second = max(size + other, _LEAST_STRETCH), max(size - other, _LEAST_STRETCH)
        forth = turning.conjugate() / size
        back = mirroring.conjugate() / other if other > 0 else 1.0 + 0.0j
        for k in range(3):
            a_b = 0.5 * hats[f, k].conjugate() * forth  # the change of a corner times this: scaling + i twist
            c_d = 0.5 * hats[f, k] * back  # anisotropic scaling + i flip
            x, y = 2 * k, 2 * k + 1
            rows[0, x], rows[0, y] = a_b.real + c_d.real, -a_b.imag - c_d.imag
            rows[1, x], rows[1, y] = a_b.real - c_d.real, -a_b.imag + c_d.imag
            rows[2, x], rows[2, y] = a_b.imag, a_b.real
            rows[3, x], rows[3, y] = c_d.imag, c_d.real
        product, squares = first * second, first * first + second * second
        twisting = 2.0 - 2.0 * (squares - product) / product**3
        flipping = 2.0 + 2.0 * (squares + product) / product**3
        if convex:
            twisting = max(twisting, 0.0)
        area, spin = areas[f], spins[f]
        weights = (area * (1 + 3 / first**4), area * (1 + 3 / second**4), area * twisting, area * flipping)
        for row in range(6):
            for column in range(6):
                entry = 0.0
                for q in range(4):
                    entry += weights[q] * rows[q, row] * rows[q, column]
                scales = 0.25 * (rows[0, row] + rows[1, row]) * (rows[0, column] + rows[1, column])
                matrix[row, column] = entry + spin * (scales + rows[2, row] * rows[2, column])
        add_face(result, f, faces[f], matrix, slots)


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
