"""Multifrontal Cholesky factorization A = Uᵀ U, and conjugate gradients that it preconditions.

The matrix is symmetric and positive definite, with one or two unknowns for each vertex of a mesh. Vertices
are numbered in their order of elimination and eliminated in groups, see `dissection`. Each group has a
*front*, a dense symmetric matrix of its own vertices and those later ones that they affect (Duff and Reid
1983, "The Multifrontal Solution of Indefinite Sparse Symmetric Linear Equations"; Liu 1992, "The Multifrontal
Method for Sparse Matrix Solution"). One front after another:

1. assemble: add the nonzeros of the own columns, and the update matrices of the fronts that end here;
2. eliminate the own unknowns, which gives rows of U and, in the rest of the front, an update matrix;
3. keep the rows of U, and put the update on a stack for the front of the next vertex that it affects.

Fronts are dense, so the inner loops run over contiguous rows. They are vectorized only where a slice starts
at 0.

Factors may be computed in single precision and kept in half of it: they take a quarter of the memory, which
a solve has to stream through the caches twice, and serve as a preconditioner of conjugate gradients in double
precision. All functions release Python's lock. Those that call one another are in this file, because numba's
cache on disk does not see changes elsewhere.
"""

from typing import Any, NamedTuple

import numpy as np

from ..geometry.jit import compiled, compiled_with_fast_sums, packed, unpacked
from ..geometry.validation import Complexes, Floats, Indices, Ints
from .fronts import Fronts

_PANEL = 8  # rows eliminated together
_ROUNDING = 1e-13  # share of the first correction below which a further one is rounding
_DEPENDENT = 1e-11  # share of its energy below which what a further basis vector adds is rounding


@compiled
def factorize(
    fronts: Fronts, nonzeros: Floats, factor: Any, front: Any, stack: Any, min_pivot: float
) -> bool:
    """The numeric phase; whether all pivots were above ``min_pivot``, so that the factors can be used.

    nonzeros: (z,) float64; factor: (factor_size,) receives the rows of U, with the inverse of each diagonal
    entry in its place; front: (largest_front²,) and stack: (stack_size,) are room for the work. The last
    three have one type, float32 or float64; or the factor is uint16 and keeps float32 as halves.
    """
    for s in range(len(fronts.starts) - 1):
        own = fronts.starts[s + 1] - fronts.starts[s]
        size = own + fronts.row_starts[s + 1] - fronts.row_starts[s]
        front[: size * size] = 0
        for k in range(fronts.entry_starts[s], fronts.entry_starts[s + 1]):
            front[fronts.entries[k]] += nonzeros[k]
        for k in range(fronts.child_starts[s], fronts.child_starts[s + 1]):
            child = fronts.children[k]
            runs = fronts.runs[fronts.run_starts[child] : fronts.run_starts[child + 1]]
            _add_update(front, size, stack[fronts.update_starts[child] :], runs)
        if not _eliminate(front, size, own, min_pivot):
            return False
        to = fronts.factor_starts[s]
        for k in range(own):
            row, kept = front[k * size + k : (k + 1) * size], factor[to : to + size - k]
            for j in range(size - k):
                kept[j] = packed(row[j], kept)
            to += size - k
        to = fronts.update_starts[s]
        for k in range(own, size):
            row, kept = front[k * size + k : (k + 1) * size], stack[to : to + size - k]
            for j in range(size - k):
                kept[j] = row[j]
            to += size - k
    return True


@compiled
def _add_update(front: Any, size: int, update: Any, runs: Ints) -> None:
    """Add a child's packed update to a front with ``size`` rows; runs: (q, 3) of the child."""
    start = 0
    length = runs[-1, 1]
    for first in range(len(runs)):
        for i in range(runs[first, 0], runs[first, 1]):
            target = front[(i + runs[first, 2]) * size :]
            low = i
            for q in range(first, len(runs)):
                high = runs[q, 1]
                low = max(low, runs[q, 0])
                part = target[low + runs[q, 2] : high + runs[q, 2]]
                added = update[start + low - i : start + high - i]
                for j in range(high - low):
                    part[j] += added[j]
            start += length - i


@compiled_with_fast_sums
def _eliminate(front: Any, size: int, own: int, min_pivot: float) -> bool:
    """Eliminate the first ``own`` rows of the upper triangle of a front with ``size`` rows, in place.

    They become rows of U, with inverse diagonal entries, and the rest becomes the update. Whether all pivots
    were above ``min_pivot``.
    """
    for k0 in range(0, own, _PANEL):
        k1 = min(k0 + _PANEL, own)
        for k in range(k0, k1):
            row = front[k * size + k : (k + 1) * size]
            if not row[0] > min_pivot:
                return False
            inverse = 1 / np.sqrt(row[0])
            for j in range(size - k):
                row[j] *= inverse
            row[0] = inverse
            for i in range(1, k1 - k):
                other, tail = front[(k + i) * size + k + i : (k + i + 1) * size], row[i:]
                factor = row[i]
                for j in range(size - k - i):
                    other[j] -= factor * tail[j]
        if k1 - k0 == _PANEL:
            _subtract_panel(front, size, k0)
        else:
            for k in range(k0, k1):
                for i in range(k1, size):
                    other, tail = front[i * size + i : (i + 1) * size], front[k * size + i : (k + 1) * size]
                    factor = tail[0]
                    for j in range(size - i):
                        other[j] -= factor * tail[j]
    return True


@compiled_with_fast_sums
def _subtract_panel(front: Any, size: int, k: int) -> None:
    """Subtract from the rows below a panel of eight rows, which starts at row ``k``, its outer products."""
    for i in range(k + _PANEL, size):
        other = front[i * size + i : (i + 1) * size]
        r0, r1 = front[k * size + i : (k + 1) * size], front[(k + 1) * size + i : (k + 2) * size]
        r2, r3 = front[(k + 2) * size + i : (k + 3) * size], front[(k + 3) * size + i : (k + 4) * size]
        r4, r5 = front[(k + 4) * size + i : (k + 5) * size], front[(k + 5) * size + i : (k + 6) * size]
        r6, r7 = front[(k + 6) * size + i : (k + 7) * size], front[(k + 7) * size + i : (k + 8) * size]
        f0, f1, f2, f3, f4, f5, f6, f7 = r0[0], r1[0], r2[0], r3[0], r4[0], r5[0], r6[0], r7[0]
        for j in range(size - i):
            other[j] -= (f0 * r0[j] + f1 * r1[j] + f2 * r2[j] + f3 * r3[j]) + (
                f4 * r4[j] + f5 * r5[j] + f6 * r6[j] + f7 * r7[j]
            )


@compiled_with_fast_sums
def solve(fronts: Fronts, factor: Any, x: Any, front: Any) -> None:
    """Solve Uᵀ U x = b. x: (unknowns,) holds b first; front: room for a vector of the largest front."""
    for s in range(len(fronts.starts) - 1):
        rows = fronts.rows[fronts.row_starts[s] : fronts.row_starts[s + 1]]
        begin, own = fronts.starts[s], fronts.starts[s + 1] - fronts.starts[s]
        below = front[own : own + len(rows)]
        for k in range(own):
            front[k] = x[begin + k]
        for k in range(len(rows)):
            below[k] = 0
        _forward(factor[fronts.factor_starts[s] :], own, own + len(rows), front)
        for k in range(own):
            x[begin + k] = front[k]
        for k in range(len(rows)):
            x[rows[k]] += below[k]
    for s in range(len(fronts.starts) - 2, -1, -1):
        rows = fronts.rows[fronts.row_starts[s] : fronts.row_starts[s + 1]]
        begin, own = fronts.starts[s], fronts.starts[s + 1] - fronts.starts[s]
        below = front[own : own + len(rows)]
        for k in range(own):
            front[k] = x[begin + k]
        for k in range(len(rows)):
            below[k] = x[rows[k]]
        _backward(factor[: fronts.factor_starts[s + 1]], own, own + len(rows), front)
        for k in range(own):
            x[begin + k] = front[k]


@compiled_with_fast_sums
def _forward(rows: Any, own: int, size: int, x: Any) -> None:
    """Solve with the transposed rows of a front, four at a time; x: (size,) the front's values."""
    at = k = 0
    while k < own:
        length = size - k
        if k + 4 <= own:
            b, c, d = at + length, at + 2 * length - 1, at + 3 * length - 3
            r0, r1, r2, r3 = rows[at:b], rows[b:c], rows[c:d], rows[d : d + length - 3]
            x0 = x[k] * unpacked(r0[0])
            x1 = (x[k + 1] - unpacked(r0[1]) * x0) * unpacked(r1[0])
            x2 = (x[k + 2] - unpacked(r0[2]) * x0 - unpacked(r1[1]) * x1) * unpacked(r2[0])
            x3 = x[k + 3] - unpacked(r0[3]) * x0 - unpacked(r1[2]) * x1 - unpacked(r2[1]) * x2
            x3 *= unpacked(r3[0])
            x[k], x[k + 1], x[k + 2], x[k + 3] = x0, x1, x2, x3
            tail, t0, t1, t2, t3 = x[k + 4 : size], r0[4:], r1[3:], r2[2:], r3[1:]
            for j in range(length - 4):
                tail[j] -= (unpacked(t0[j]) * x0 + unpacked(t1[j]) * x1) + (
                    unpacked(t2[j]) * x2 + unpacked(t3[j]) * x3
                )
            at, k = d + length - 3, k + 4
        else:
            x0 = x[k] * unpacked(rows[at])
            x[k] = x0
            tail, t0 = x[k + 1 : size], rows[at + 1 : at + length]
            for j in range(length - 1):
                tail[j] -= unpacked(t0[j]) * x0
            at, k = at + length, k + 1


@compiled_with_fast_sums
def _backward(rows: Any, own: int, size: int, x: Any) -> None:
    """Solve with the rows of a front, which end with ``rows``, the last ones first; x: (size,) its values."""
    at, k = len(rows), own
    while k > 0:
        if k % 4 == 0:
            k -= 4
            length = size - k
            at -= 4 * length - 6
            b, c, d = at + length, at + 2 * length - 1, at + 3 * length - 3
            r0, r1, r2, r3 = rows[at:b], rows[b:c], rows[c:d], rows[d : d + length - 3]
            tail, t0, t1, t2, t3 = x[k + 4 : size], r0[4:], r1[3:], r2[2:], r3[1:]
            s0 = s1 = s2 = s3 = 0 * x[k]
            for j in range(length - 4):
                s0 += unpacked(t0[j]) * tail[j]
                s1 += unpacked(t1[j]) * tail[j]
                s2 += unpacked(t2[j]) * tail[j]
                s3 += unpacked(t3[j]) * tail[j]
            x3 = (x[k + 3] - s3) * unpacked(r3[0])
            x2 = (x[k + 2] - s2 - unpacked(r2[1]) * x3) * unpacked(r2[0])
            x1 = (x[k + 1] - s1 - unpacked(r1[1]) * x2 - unpacked(r1[2]) * x3) * unpacked(r1[0])
            x0 = x[k] - s0 - unpacked(r0[1]) * x1 - unpacked(r0[2]) * x2 - unpacked(r0[3]) * x3
            x0 *= unpacked(r0[0])
            x[k], x[k + 1], x[k + 2], x[k + 3] = x0, x1, x2, x3
        else:
            k -= 1
            length = size - k
            at -= length
            tail, t0 = x[k + 1 : size], rows[at + 1 : at + length]
            s0 = 0 * x[k]
            for j in range(length - 1):
                s0 += unpacked(t0[j]) * tail[j]
            x[k] = (x[k] - s0) * unpacked(rows[at])


class Matrix(NamedTuple):  # numba's caches on disk refer to this name
    """A symmetric matrix with two unknowns for each vertex, by the columns of its lower triangle.

    starts: (n + 1,) uint32, where the later neighbors of each vertex begin in vertices: (b,) uint32;
    nonzeros: (3n + 4b,) float64, sorted by column. Vertex j has 3 of its own and 4 for each later neighbor:
    first the column of x, with two entries of its own and two for each neighbor, then that of y, with one.
    """

    starts: Indices
    vertices: Indices
    nonzeros: Floats


class Preconditioner(NamedTuple):  # numba's caches on disk refer to this name
    """R A₀⁻¹ Rᵀ with the factors of A₀, and room for one solve.

    rotation: (n,) unit complex numbers R; factor: of `factorize`; x: (2n,) and front: (largest_front,), of
    the type in which the factor was computed.
    """

    fronts: Fronts
    factor: Any
    rotation: Complexes
    x: Any
    front: Any


@compiled_with_fast_sums
def dot(a: Complexes, b: Complexes) -> float:
    """Re aᴴ b of two vectors (n,). BLAS would use threads, which wait for one another on a busy machine."""
    total = 0.0
    for k in range(len(a)):
        total += a[k].real * b[k].real + a[k].imag * b[k].imag
    return total


@compiled_with_fast_sums
def multiply(matrix: Matrix, values: Complexes, result: Complexes) -> None:
    """Set ``result`` (n,) to A x for x = ``values`` (n,)."""
    starts, vertices, nonzeros = matrix
    result[:] = 0
    for j in range(len(values)):
        begin, end, x = starts[j], starts[j + 1], values[j]
        p = 3 * j + 4 * begin  # the first entry of the column of x; the neighbors' follow in both columns
        q = p + 2 + 2 * (end - begin)  # of the column of y
        real = nonzeros[p] * x.real + nonzeros[p + 1] * x.imag
        imaginary = nonzeros[p + 1] * x.real + nonzeros[q] * x.imag
        p, q = p + 2, q + 1
        for k in range(begin, end):
            i = vertices[k]
            a, b, c, d = nonzeros[p], nonzeros[p + 1], nonzeros[q], nonzeros[q + 1]
            p, q = p + 2, q + 2
            y = values[i]
            real += a * y.real + b * y.imag
            imaginary += c * y.real + d * y.imag
            result[i] += complex(a * x.real + c * x.imag, b * x.real + d * x.imag)
        result[j] += complex(real, imaginary)


@compiled_with_fast_sums
def precondition(preconditioner: Preconditioner, right: Complexes, result: Complexes) -> float:
    """Set ``result`` (n,) to R A₀⁻¹ Rᵀ b for b = ``right`` (n,); returns its largest absolute value."""
    rotation, x = preconditioner.rotation, preconditioner.x
    for k in range(len(right)):
        rotated = right[k] * rotation[k].conjugate()
        x[2 * k], x[2 * k + 1] = rotated.real, rotated.imag
    solve(preconditioner.fronts, preconditioner.factor, x, preconditioner.front)
    largest = 0.0
    for k in range(len(right)):
        value = complex(np.float64(x[2 * k]), np.float64(x[2 * k + 1]))
        square = value.real * value.real + value.imag * value.imag
        if not square <= largest:  # NaN, too
            largest = square
        result[k] = rotation[k] * value
    return np.sqrt(largest)


@compiled
def iterate(
    preconditioner: Preconditioner,
    matrix: Matrix,
    right: Complexes,
    frame: Complexes,
    earlier: Complexes,
    known: int,
    tolerance: float,
    trusted_contraction: float,
    min_solves: int,
    max_solves: int,
    solution: Complexes,
) -> tuple[int, float, float]:
    """Solve A x = b by preconditioned conjugate gradients, in one call without Python's lock.

    right: b (n,); solution: (n,) receives x.
    frame: (n,) unit complex numbers; earlier: (w, n), of which the first ``known`` are earlier solutions
    times conj(frame) of their pose, the last one first. Iterations start from the best combination of these;
    the solution is put before them.
    trusted_contraction: the share of an error that a solve is trusted to leave, at most 1. Iterations end
    with the first correction that leaves an error within the ``tolerance`` at every vertex, after at least
    ``min_solves`` of them or as soon as corrections are rounding.

    Returns the number of solves, 0 if there were ``max_solves`` without convergence, and the largest value of
    the first and of the last correction.
    """
    n = len(right)
    residual, correction, image = right.copy(), np.empty_like(right), np.empty_like(right)
    direction = np.zeros_like(right)
    solution[:] = 0
    _project_on_earlier(matrix, frame, earlier, known, residual, solution)
    previous, first, last = np.inf, 0.0, 0.0
    for count in range(1, max_solves + 1):
        last = precondition(preconditioner, residual, correction)
        if count == 1:
            first = last
        is_enough = count >= min_solves or last <= _ROUNDING * first
        if is_enough and last * trusted_contraction <= tolerance:
            for i in range(len(earlier) - 1, 0, -1):
                earlier[i] = earlier[i - 1]
            for k in range(n):
                solution[k] += correction[k]
                earlier[0, k] = frame[k].conjugate() * solution[k]
            return count, first, last
        square = dot(residual, correction)
        share = square / previous
        for k in range(n):
            direction[k] = correction[k] + share * direction[k]
        multiply(matrix, direction, image)
        step = square / dot(direction, image)
        for k in range(n):
            solution[k] += step * direction[k]
            residual[k] -= step * image[k]
        previous = square
    return 0, first, last


@compiled_with_fast_sums
def _project_on_earlier(
    matrix: Matrix, frame: Complexes, earlier: Complexes, known: int, residual: Complexes, solution: Complexes
) -> None:
    """Add to ``solution`` the combination of earlier ones with the least error in the energy norm.

    Updates the ``residual`` (n,); other arguments as in `iterate`. Method: Fischer 1998, "Projection
    techniques for iterative solution of Ax = b with successive right-hand sides".
    """
    n = len(residual)
    basis, images = np.empty((known, n), np.complex128), np.empty((known, n), np.complex128)
    energies = np.zeros(known)
    for i in range(known):
        for k in range(n):
            basis[i, k] = frame[k] * earlier[i, k]
    for i in range(0, known - 1, 2):
        _multiply_pair(matrix, basis[i], basis[i + 1], images[i], images[i + 1])
    if known % 2 == 1:
        multiply(matrix, basis[known - 1], images[known - 1])
    for i in range(known):
        vector, image = basis[i], images[i]
        before = dot(vector, image)
        for j in range(i):  # make it orthogonal to those before
            if energies[j] > 0:
                other, other_image = basis[j], images[j]
                share = dot(other_image, vector) / energies[j]
                for k in range(n):
                    vector[k] -= share * other[k]
                    image[k] -= share * other_image[k]
        energy = dot(vector, image)
        if not energy > _DEPENDENT * before:
            continue
        energies[i] = energy
        share = dot(vector, residual) / energy
        for k in range(n):
            solution[k] += share * vector[k]
            residual[k] -= share * image[k]


@compiled_with_fast_sums
def _multiply_pair(
    matrix: Matrix, values: Complexes, others: Complexes, result: Complexes, other_result: Complexes
) -> None:
    """As `multiply`, for two vectors in one pass over the matrix, which such a product waits for."""
    starts, vertices, nonzeros = matrix
    result[:], other_result[:] = 0, 0
    for j in range(len(values)):
        begin, end, x, u = starts[j], starts[j + 1], values[j], others[j]
        p = 3 * j + 4 * begin
        q = p + 2 + 2 * (end - begin)
        a, b, d = nonzeros[p], nonzeros[p + 1], nonzeros[q]
        x_real, x_imaginary = a * x.real + b * x.imag, b * x.real + d * x.imag
        u_real, u_imaginary = a * u.real + b * u.imag, b * u.real + d * u.imag
        p, q = p + 2, q + 1
        for k in range(begin, end):
            i = vertices[k]
            a, b, c, d = nonzeros[p], nonzeros[p + 1], nonzeros[q], nonzeros[q + 1]
            p, q = p + 2, q + 2
            y, v = values[i], others[i]
            x_real += a * y.real + b * y.imag
            x_imaginary += c * y.real + d * y.imag
            u_real += a * v.real + b * v.imag
            u_imaginary += c * v.real + d * v.imag
            result[i] += complex(a * x.real + c * x.imag, b * x.real + d * x.imag)
            other_result[i] += complex(a * u.real + c * u.imag, b * u.real + d * u.imag)
        result[j] += complex(x_real, x_imaginary)
        other_result[j] += complex(u_real, u_imaginary)
