"""The symmetric Dirichlet energy of a pose, and a line search: memory descends on it to the rest pose.

The energy is that of Smith and Schaefer 2015, "Bijective Parameterization with Free Boundaries"; it is
infinite if a face flips. The Hessian uses the analytic eigenvectors of Smith, De Goes and Kim 2019, "Analytic
Eigensystems for Isotropic Distortion Energies", section 4.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...geometry.jit import compiled
from ...geometry.killing_matrix import Slots, Triangles, VertexBlocks, add_face
from ...geometry.mesh import TriMesh
from ...geometry.operators import hat_gradients
from ...geometry.validation import Complexes, Floats, Indices

_SUFFICIENT_DECREASE = 1e-4  # share of the decrease that the slope predicts (Armijo's condition)
_MAX_TRIES = 12  # of a line search
_MIN_STRETCH = 0.03  # lower bound of singular values in Hessians, which otherwise cannot be factorized
MAX_LOCAL_CHANGE = 0.03  # of a face's Jacobian in one step; beyond that, its corners are relaxed
_MAX_RELAXED = 100  # vertices; where more faces change that much, they do so together
_SWEEPS, _LOCAL_TRIES = 6, 8  # over the relaxed vertices; step lengths tried for each of them
_MIN_CONVEXITY = 1e-6  # of the Hessian of a vertex: its determinant as a share of the diagonal's
_CLOSE_TO_MINIMUM = 0.8  # a step that is at least this share of the parabola's minimum is not refined


class SymmetricDirichlet:
    """Σ A_f (‖J_f‖² + ‖J_f⁻¹‖²), with J_f the Jacobian of the map from rest on each face.

    stiffness: (m,) factors of the faces' energies. Jacobians are passed as their columns, (m, 2) complex: the
    derivative by x, then the one by y.
    """

    def __init__(self, mesh: TriMesh | Triangles, stiffness: Floats | None = None) -> None:
        dx, dy, areas = hat_gradients(mesh.vertices, mesh.faces)
        self._faces = mesh.faces.astype(np.uint32)
        self._hats = dx + 1j * dy  # gradients of the hat functions, (m, 3)
        self._weights = areas if stiffness is None else areas * stiffness
        self._areas = areas
        self._unscaled = self._hats, self._weights, self._areas

    def set_scales(self, scales: Floats | None) -> None:
        """Measure J_f / s_f with the areas s_f² A_f from now on; scales: (m,) s of the faces, None for 1."""
        self._hats, self._weights, self._areas = self._unscaled
        if scales is not None:
            squares = scales * scales
            self._hats = self._hats / scales[:, None]
            self._weights, self._areas = self._weights * squares, self._areas * squares

    def evaluate(self, positions: Complexes) -> tuple[float, Complexes, Complexes]:
        """The energy of a pose (n,), its derivative by the vertices, (n,), and the columns (m, 2).

        The energy is in square pixels, 4 Σ A_f at rest. If it is infinite, the derivative means nothing.
        """
        return _evaluate(positions, self._faces, self._hats, self._weights)

    def direction(self, columns: Complexes, direction: Complexes) -> tuple[Complexes, float]:
        """The columns of a direction (n,), (m, 2), and the step length at which the first face flips.

        columns: (m, 2) of the pose. The step length is infinity if no face flips (Smith and Schaefer 2015).
        """
        return _direction(columns, direction, self._faces, self._hats)

    def value(self, columns: Complexes, change: Complexes, step_length: float) -> float:
        """The energy of the pose with the columns J + t D: ``columns`` J and ``change`` D are (m, 2)."""
        return _value(columns, change, step_length, self._weights)

    def relax(
        self, positions: Complexes, change: Complexes, step_length: float, is_held: NDArray[np.bool_]
    ) -> None:
        """Move the corners of faces that a step has changed much towards the least energy around them.

        A step along a direction for the whole mesh is too long where a few faces are compressed, hence stiff.
        Without this, they would leap from one side of their minimum to the other in each step.

        positions: the pose (n,) after the step, modified in place; change, step_length: as in `value`;
        is_held: (n,) vertices that do not move.
        """
        shares = _relaxed_shares(len(positions), change, step_length, self._faces)
        shares[is_held] = 0.0
        corners = np.flatnonzero(shares)
        if 0 < len(corners) <= _MAX_RELAXED:
            around = np.flatnonzero((shares[self._faces] > 0).any(axis=1))
            relaxed = positions.copy()
            _relax(
                relaxed,
                corners.astype(np.uint32),
                self._faces[around],
                self._hats[around],
                self._weights[around],
            )
            positions += shares * (relaxed - positions)

    def half_hessian(
        self,
        columns: Complexes,
        convex: bool,
        blocks: VertexBlocks,
        rotation_weights: Floats | None = None,
    ) -> Floats:
        """The nonzeros (z,) of half the Hessian at a pose with these columns (m, 2); K near an isometry.

        With σ₁ ≥ σ₂ the singular values of J, the energy of a face has four eigenvectors: two scalings, with
        the eigenvalues 2 + 6 / σᵢ⁴, a flip, and a twist, whose eigenvalue is negative in compressed faces.
        convex: replace negative eigenvalues by zero; blocks: the sparsity pattern; rotation_weights: (m,)
        the weights c of `PinRotationConstraints`.
        """
        rotations = np.zeros(len(self._areas)) if rotation_weights is None else self._areas * rotation_weights
        result = np.zeros(len(blocks.rows))
        slots = blocks.slots
        _add_half_hessians(columns, self._weights, rotations, convex, self._faces, self._hats, slots, result)
        return result


@compiled
def _cross(a: complex, b: complex) -> float:
    return a.real * b.imag - a.imag * b.real


@compiled
def _square(a: complex) -> float:
    return a.real * a.real + a.imag * a.imag


@compiled
def _evaluate(
    positions: Complexes, faces: Indices, hats: Complexes, weights: Floats
) -> tuple[float, Complexes, Complexes]:
    """As `SymmetricDirichlet.evaluate`, by ∂det/∂jx = −i jy and ∂det/∂jy = i jx.

    The three hat gradients of a face add up to zero, so that two of them and two edges do.
    """
    gradient, columns = np.zeros_like(positions), np.empty((len(faces), 2), dtype=np.complex128)
    total = 0.0
    for f in range(len(faces)):
        i, j, k, a, b = faces[f, 0], faces[f, 1], faces[f, 2], hats[f, 0], hats[f, 1]
        p, q = positions[i] - positions[k], positions[j] - positions[k]
        jx, jy = a.real * p + b.real * q, a.imag * p + b.imag * q
        columns[f, 0], columns[f, 1] = jx, jy
        determinant, square = _cross(jx, jy), _square(jx) + _square(jy)
        inverse = 1 / determinant
        total += weights[f] * square * (1 + inverse * inverse) if determinant > 0 else np.inf
        along = 2 * weights[f] * (1 + inverse * inverse)
        across = 2 * weights[f] * square * inverse * inverse * inverse
        of_jx = complex(along * jx.real - across * jy.imag, along * jx.imag + across * jy.real)
        of_jy = complex(along * jy.real + across * jx.imag, along * jy.imag - across * jx.real)
        of_p, of_q = a.real * of_jx + a.imag * of_jy, b.real * of_jx + b.imag * of_jy
        gradient[i] += of_p
        gradient[j] += of_q
        gradient[k] -= of_p + of_q
    return total, gradient, columns


@compiled
def _relaxed_shares(n: int, change: Complexes, step_length: float, faces: Indices) -> Floats:
    """The share of its relaxation that each vertex takes, (n,): it grows from 0 to 1 with the change of its
    faces, so that the pose depends on the step continuously.
    """
    shares = np.zeros(n)
    for f in range(len(faces)):
        square = step_length * step_length * (_square(change[f, 0]) + _square(change[f, 1]))
        if square > MAX_LOCAL_CHANGE * MAX_LOCAL_CHANGE:
            share = min(np.sqrt(square) / MAX_LOCAL_CHANGE - 1, 1.0)
            for corner in range(3):
                v = faces[f, corner]
                shares[v] = max(shares[v], share)
    return shares


@compiled
def _relax(positions: Complexes, corners: Indices, faces: Indices, hats: Complexes, weights: Floats) -> None:
    """Move vertices to the least energy, by Newton's method for one after the other.

    corners: (c,) the vertices; faces, hats, weights: of all faces around them.
    """
    for _ in range(_SWEEPS):
        for v in corners:
            for is_whole in (True, False):
                before, slope, xx, xy, yy = _expand(v, positions, faces, hats, weights, is_whole)
                discriminant = xx * yy - xy * xy
                if xx > 0 and discriminant > _MIN_CONVEXITY * xx * yy:
                    break
            x, y = slope.real, slope.imag
            step, start = complex(xy * y - yy * x, xy * x - xx * y) / discriminant, positions[v]
            for _ in range(_LOCAL_TRIES):
                positions[v] = start + step
                if _expand(v, positions, faces, hats, weights, is_whole)[0] < before:
                    break
                positions[v] = start
                step *= 0.5


@compiled
def _expand(
    v: int, positions: Complexes, faces: Indices, hats: Complexes, weights: Floats, is_whole: bool
) -> tuple[float, complex, float, float, float]:
    """The energy of the faces around a vertex, its gradient and the entries xx, xy, yy of its Hessian.

    is_whole: otherwise without the part of the Hessian that may have negative eigenvalues.
    """
    energy, slope, xx, xy, yy = 0.0, 0j, 0.0, 0.0, 0.0
    for f in range(len(faces)):
        for corner in range(3):
            if faces[f, corner] != v:
                continue
            last, hat, weight = positions[faces[f, 2]], hats[f, corner], weights[f]
            p, q = positions[faces[f, 0]] - last, positions[faces[f, 1]] - last
            a, b = hats[f, 0], hats[f, 1]
            jx, jy = a.real * p + b.real * q, a.imag * p + b.imag * q
            determinant, square = _cross(jx, jy), _square(jx) + _square(jy)
            if not determinant > 0:
                return np.inf, slope, xx, xy, yy
            inverse = 1 / determinant
            along, across = 1 + inverse * inverse, 2 * inverse * inverse * inverse
            energy += weight * square * along
            # derivatives of the square and of the determinant, which is linear in the vertex
            s = 2 * (hat.real * jx + hat.imag * jy)
            d = complex(hat.real * jy.imag - hat.imag * jx.imag, hat.imag * jx.real - hat.real * jy.real)
            slope += weight * (along * s - across * square * d)
            straight, bent = 2 * along * _square(hat), 3 * across * square * inverse
            mixed = across if is_whole else 0.0
            xx += weight * (straight + bent * d.real * d.real - 2 * mixed * s.real * d.real)
            yy += weight * (straight + bent * d.imag * d.imag - 2 * mixed * s.imag * d.imag)
            xy += weight * (bent * d.real * d.imag - mixed * (s.real * d.imag + s.imag * d.real))
    return energy, slope, xx, xy, yy


@compiled
def _direction(
    columns: Complexes, direction: Complexes, faces: Indices, hats: Complexes
) -> tuple[Complexes, float]:
    """The step length is the least positive root t, over the faces, of the polynomials det(J + t D)."""
    change, shortest = np.empty_like(columns), np.inf
    for f in range(len(faces)):
        a, b, last = hats[f, 0], hats[f, 1], direction[faces[f, 2]]
        p, q = direction[faces[f, 0]] - last, direction[faces[f, 1]] - last
        dx, dy = a.real * p + b.real * q, a.imag * p + b.imag * q
        change[f, 0], change[f, 1] = dx, dy
        jx, jy = columns[f, 0], columns[f, 1]
        start, slope, square = _cross(jx, jy), _cross(dx, jy) + _cross(jx, dy), _cross(dx, dy)
        # The root nearest to zero as 2 c / (−b ± √(b² − 4ac)), which needs no division by a small a.
        discriminant = slope * slope - 4 * square * start
        if discriminant > 0:
            denominator = np.sqrt(discriminant) - slope
            if denominator > 0:
                shortest = min(shortest, 2 * start / denominator)
    return change, shortest


@compiled
def _value(columns: Complexes, change: Complexes, step_length: float, weights: Floats) -> float:
    total = 0.0
    for f in range(len(columns)):
        jx, jy = columns[f, 0] + step_length * change[f, 0], columns[f, 1] + step_length * change[f, 1]
        determinant = _cross(jx, jy)
        if not determinant > 0:
            return np.inf
        total += weights[f] * (_square(jx) + _square(jy)) * (1 + 1 / (determinant * determinant))
    return total


@compiled
def _add_half_hessians(
    columns: Complexes,
    weights: Floats,
    rotations: Floats,
    convex: bool,
    faces: Indices,
    hats: Complexes,
    slots: Slots,
    result: Floats,
) -> None:
    """Add half the Hessian of each face to the nonzeros (z,).

    weights: (m,) areas times stiffness; rotations: (m,) areas times c; slots: where the nonzeros are.
    """
    rows, matrix = np.empty((4, 6)), np.empty((6, 6))  # rows: eigenvectors over x0 y0 x1 y1 x2 y2
    for f in range(len(faces)):
        jx, jy = columns[f, 0], columns[f, 1]
        # J as a complex number z times rotation and scaling, plus one times a reflection
        direct, mirrored = 0.5 * (jx - 1j * jy), 0.5 * (jx + 1j * jy)
        direct_size, mirrored_size = abs(direct), abs(mirrored)
        first = max(direct_size + mirrored_size, _MIN_STRETCH)
        second = max(direct_size - mirrored_size, _MIN_STRETCH)
        direct_unit = direct.conjugate() / direct_size
        mirrored_unit = mirrored.conjugate() / mirrored_size if mirrored_size > 0 else 1.0 + 0.0j
        for k in range(3):
            # factors of a corner's displacement that give: scaling + i twist, and stretching + i flip
            scale_twist = 0.5 * hats[f, k].conjugate() * direct_unit
            stretch_flip = 0.5 * hats[f, k] * mirrored_unit
            x, y = 2 * k, 2 * k + 1
            rows[0, x] = scale_twist.real + stretch_flip.real
            rows[0, y] = -scale_twist.imag - stretch_flip.imag
            rows[1, x] = scale_twist.real - stretch_flip.real
            rows[1, y] = -scale_twist.imag + stretch_flip.imag
            rows[2, x], rows[2, y] = scale_twist.imag, scale_twist.real
            rows[3, x], rows[3, y] = stretch_flip.imag, stretch_flip.real
        product, squares = first * second, first * first + second * second
        twist = 2.0 - 2.0 * (squares - product) / product**3
        flip = 2.0 + 2.0 * (squares + product) / product**3
        if convex:
            twist = max(twist, 0.0)
        weight, rotation = weights[f], rotations[f]
        halves = (weight * (1 + 3 / first**4), weight * (1 + 3 / second**4), weight * twist, weight * flip)
        for row in range(6):
            for column in range(6):
                entry = 0.0
                for q in range(4):
                    entry += halves[q] * rows[q, row] * rows[q, column]
                scaling = 0.25 * (rows[0, row] + rows[1, row]) * (rows[0, column] + rows[1, column])
                matrix[row, column] = entry + rotation * (scaling + rows[2, row] * rows[2, column])
        add_face(result, f, faces[f], matrix, slots)


def line_search(value: Callable[[float], float], start: float, slope: float, max_step: float) -> float:
    """The step length, at most ``max_step``, along a descent direction; 0 if no try decreases the value.

    value: the function of the step length; start: its value at 0; slope: its derivative at 0.
    A step beyond the minimum is followed by one to the minimum of the parabola through the known values, and
    the best step is returned: otherwise a pose near its minimum would oscillate about it.
    """
    if slope >= 0:
        return 0.0
    best, least, step = 0.0, start, max_step
    for _ in range(_MAX_TRIES):
        after = value(step)
        if after <= start + _SUFFICIENT_DECREASE * step * slope and after < least:
            best, least = step, after
        elif best:
            break
        curvature = after - start - step * slope
        shorter = 0.5 * step
        if np.isfinite(after) and curvature > 0:
            shorter = -0.5 * slope * step**2 / curvature
        if best == step and shorter > _CLOSE_TO_MINIMUM * step:
            break
        step = max(min(shorter, step if np.isfinite(after) else 0.5 * step), 0.1 * step)
    return best
