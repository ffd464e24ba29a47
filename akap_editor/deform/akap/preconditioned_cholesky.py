"""Conjugate gradients preconditioned by the Cholesky factors of an earlier pose.

A deformation is nearly isometric: the matrix at a pose is close to that of an earlier pose, rotated at each
vertex by the rotation R since then. So R A₀⁻¹ Rᵀ is an excellent preconditioner, and one factorization serves
many poses. Which earlier pose was factorized changes the cost of a solution, and the solution within its
tolerance.
"""

import numpy as np

from ...geometry.jit import compiled
from ...geometry.validation import Complexes, Floats, Ints
from ..cholesky import SparseCholesky, SymmetricPattern

# A factorization costs as much as five to eight iterations. With fresh factors, each iteration gains a digit;
# refactorize once the iterations beyond that cost as much as a factorization.
MAX_WASTED_ITERATIONS = 8
_MAX_ITERATIONS = 12  # of one solution; without convergence the current matrix is factorized
# Unknowns below which factors are simplicial: they take twice as long to compute, but solves, which are more
# frequent, take half the time. Larger factors do not fit into the caches.
_SIMPLICIAL_BELOW = 8_000
_WARM_STARTS = 2  # earlier solutions from which the next one starts
_DEPENDENT = 1e-11  # share of its energy below which what a further solution adds is rounding


class PreconditionedCholesky:
    """Solves A x = b for a matrix that changes a little from pose to pose.

    Unknowns are complex, one for each vertex; the matrix is real, with interleaved x and y, and its pattern
    has all four entries of two coupled vertices.
    exact: factorize every matrix. Otherwise solutions are iterated to the tolerance asked for, and the matrix
    is factorized when iterations become too expensive or do not converge.

    iterations, factorizations: numbers so far.
    """

    def __init__(self, pattern: SymmetricPattern, exact: bool) -> None:
        size = pattern.size
        self._cholesky = SparseCholesky(pattern, supernodal=exact or pattern.size > _SIMPLICIAL_BELOW)
        self._starts = np.searchsorted(pattern.columns, np.arange(size + 1)).astype(np.int32)
        self._vertices = (pattern.rows // 2).astype(np.int32)
        self._exact = exact
        self._frame = self._rotation = np.ones(size // 2, dtype=np.complex128)
        self._factorized_frame = self._frame
        self._solutions: dict[str, list[Complexes]] = {}  # rotated back to rest, the last one first
        self._has_factors = self._is_exact = False  # of some pose; of the current one
        self._wasted_iterations = 0.0
        self.iterations = self.factorizations = 0

    def invalidate(self) -> None:
        """Discard the factors: the next matrix is not close to the one that was factorized."""
        self._has_factors = False

    def prepare(self, nonzeros: Floats, frame: Complexes) -> None:
        """Set the matrix by its nonzeros (z,).

        frame: (n,) unit complex numbers, the rotation of each vertex from rest. Raises SolverError if the
        matrix is factorized and singular.
        """
        self._nonzeros, self._frame, self._is_exact = nonzeros, frame, False
        if self._exact or not self._has_factors or self._wasted_iterations >= MAX_WASTED_ITERATIONS:
            self.factorize()
        else:
            self._rotation = frame * self._factorized_frame.conj()

    def solve(self, right: Complexes, tolerance: float, warm_start_key: str = "") -> Complexes:
        """A⁻¹ b for a right-hand side b (n,), exact if the current matrix is factorized.

        tolerance: largest error of a value otherwise. The error is estimated as the preconditioned residual,
        which is also subtracted from the result.
        warm_start_key: names a series of solutions that are similar from pose to pose; each starts from the
        last ones. Raises SolverError.
        """
        earlier = self._solutions.get(warm_start_key, [])
        solution = None if self._is_exact else self._iterate(right, tolerance, earlier)
        if solution is None:
            if not self._is_exact:  # no convergence: too far from an isometry
                self.factorize()
            solution = self._precondition(right)
        if warm_start_key and not self._exact:
            at_rest = self._frame.conj() * solution
            self._solutions[warm_start_key] = [at_rest, *earlier][:_WARM_STARTS]
        return solution

    def energy(self, values: Complexes) -> float:
        """xᵀ A x for values x (n,) and the matrix last set."""
        return dot(values, self.multiply(values))

    def multiply(self, values: Complexes) -> Complexes:
        """A x, (n,), for values x (n,) and the matrix last set."""
        return _product(self._starts, self._vertices, self._nonzeros, values)

    def factorize(self) -> None:
        """Factorize the current matrix. Raises SolverError."""
        self._has_factors = False
        self._cholesky.factorize(self._nonzeros)
        self._has_factors = self._is_exact = True
        self._factorized_frame, self._rotation = self._frame, np.ones_like(self._frame)
        self._wasted_iterations = 0.0
        self.factorizations += 1

    def _precondition(self, right: Complexes) -> Complexes:
        """R A₀⁻¹ Rᵀ b, (n,)."""
        rotated = self._rotation.conj() * right
        return self._rotation * self._cholesky.solve(rotated.view(np.float64)).view(np.complex128)

    def _iterate(self, right: Complexes, tolerance: float, earlier: list[Complexes]) -> Complexes | None:
        """The solution (n,) by preconditioned conjugate gradients; None if they do not converge soon."""
        solution, residual = self._project_on_earlier(right, earlier)
        direction = np.zeros_like(residual)
        previous, first_error = np.inf, 0.0
        for count in range(_MAX_ITERATIONS):
            correction = self._precondition(residual)
            square = dot(residual, correction)
            error = float(np.abs(correction).max())
            first_error = first_error or error
            if error <= tolerance:
                self.iterations += count + 1
                digits = float(np.log10(max(first_error / tolerance, 1.0)))
                self._wasted_iterations += max(count - digits, 0.0)
                return solution + correction
            direction = correction + (square / previous) * direction
            image = self.multiply(direction)
            step_length = square / dot(direction, image)
            solution = solution + step_length * direction
            residual = residual - step_length * image
            previous = square
        return None

    def _project_on_earlier(self, right: Complexes, earlier: list[Complexes]) -> tuple[Complexes, Complexes]:
        """The combination of earlier solutions with the least error in the energy norm, and its residual.

        earlier: (n,) each, rotated back to rest; they are rotated with the vertices first. Method: Fischer
        1998, "Projection techniques for iterative solution of Ax = b with successive right-hand sides".
        """
        solution, residual = np.zeros_like(right), right
        previous: tuple[Complexes, Complexes, float] | None = None
        for at_rest in earlier:
            basis = self._frame * at_rest
            image = self.multiply(basis)
            energy_before = dot(basis, image)
            if previous is not None:  # make the second one orthogonal to the first
                first, first_image, energy = previous
                share = dot(first_image, basis) / energy
                basis = basis - share * first
                image = image - share * first_image
            energy = dot(basis, image)
            if energy <= _DEPENDENT * energy_before:
                continue
            share = dot(basis, residual) / energy
            solution = solution + share * basis
            residual = residual - share * image
            previous = basis, image, energy
        return solution, residual


@compiled
def _product(starts: Ints, vertices: Ints, nonzeros: Floats, values: Complexes) -> Complexes:
    """A x, (n,), for a symmetric matrix A given by the columns of its lower triangle.

    starts: (2n,) index of each column's first nonzero; vertices: (z,) vertex of each nonzero's row.
    """
    result = np.zeros_like(values)
    for j in range(len(values)):
        first, second, x = starts[2 * j], starts[2 * j + 1], values[j]  # columns of x and y
        real = nonzeros[first] * x.real + nonzeros[first + 1] * x.imag
        imaginary = nonzeros[first + 1] * x.real + nonzeros[second] * x.imag
        shift = second - first - 1  # from an entry to the entry of the same row in the second column
        for k in range(first + 2, second, 2):
            i = vertices[k]
            a, b, c, d = nonzeros[k], nonzeros[k + 1], nonzeros[k + shift], nonzeros[k + shift + 1]
            y = values[i]
            real += a * y.real + b * y.imag
            imaginary += c * y.real + d * y.imag
            result[i] += complex(a * x.real + c * x.imag, b * x.real + d * x.imag)
        result[j] += complex(real, imaginary)
    return result


@compiled
def dot(a: Complexes, b: Complexes) -> float:
    """Re aᴴ b of two vectors (n,). BLAS would use threads, which wait for one another on a busy machine."""
    total = 0.0
    for k in range(len(a)):
        total += a[k].real * b[k].real + a[k].imag * b[k].imag
    return total
