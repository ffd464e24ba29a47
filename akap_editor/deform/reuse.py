"""One factorization for all poses: conjugate gradients, preconditioned by the factors of the rest pose.

A deformation is nearly isometric, so the matrix at a pose is nearly that of the rest pose turned at each
vertex by its rotation R since then: R A₀⁻¹ Rᵀ is an excellent preconditioner. It depends on the pose alone,
and not on the way there, so that what is computed with it does not either.
"""

import numpy as np
from scipy.sparse import csc_array

from ..geometry.checks import Complexes, Floats
from .cholesky import SparseCholesky, SymmetricPattern

_MOST_ITERATIONS = 80
_SIMPLICIAL_BELOW = 10_000  # unknowns: solves are what counts there, factorizations are few and fast enough


class ReusedCholesky:
    """Solves A x = b for a matrix that changes a little from pose to pose.

    Unknowns are complex, one for each vertex; the matrix is real, with interleaved x and y. With ``exact``
    every matrix is factorized. Otherwise that of the rest pose is, and solutions are as near as ``tolerance``
    in the energy norm; where iterations do not come that near, the matrix at hand is factorized after all.
    """

    def __init__(self, pattern: SymmetricPattern, exact: bool, tolerance: float) -> None:
        size = pattern.size
        self._cholesky = SparseCholesky(pattern, supernodal=exact or size > _SIMPLICIAL_BELOW)
        starts = np.searchsorted(pattern.columns, np.arange(size + 1))
        self._lower = csc_array((np.zeros(pattern.count), pattern.rows, starts), shape=(size, size))
        self._upper = self._lower.T
        self._diagonal_slots = np.flatnonzero(pattern.rows == pattern.columns)
        self._exact, self._tolerance = exact, tolerance
        self._turn: Complexes = np.ones(size // 2, dtype=np.complex128)
        self._last = np.zeros_like(self._turn)
        self._at_rest = self._fresh = False
        self.iterations = self.factorizations = 0

    def forget(self) -> None:
        """The matrix of the rest pose has changed."""
        self._at_rest = False

    def prepare(self, nonzeros: Floats, frame: Complexes, rest: Floats) -> None:
        """Set the matrix by its nonzeros at the pose and at rest. Raises SolverError.

        frame: (n,) of unit size, how each vertex is turned from rest.
        """
        self._lower.data = self._upper.data = nonzeros
        self._diagonal = nonzeros[self._diagonal_slots]
        if self._exact:
            self._factorize()
            return
        if not self._at_rest:
            self._cholesky.factorize(rest)
            self.factorizations += 1
            self._at_rest = True
        self._fresh, self._turn = False, frame

    def precondition(self, right: Complexes) -> Complexes:
        """An approximation of A⁻¹ b by one solve; exact where the matrix was just factorized."""
        turned = np.ascontiguousarray(self._turn.conj() * right)
        return self._turn * self._cholesky.solve(turned.view(np.float64)).view(np.complex128)

    def solve(self, right: Complexes) -> Complexes:
        """A⁻¹ b; where the factors are those of the rest pose, iterated from the last solution."""
        if not self._fresh:
            solution = self._iterate(right)
            if solution is None:  # too far from an isometry
                self._factorize()
        if self._fresh:
            solution = self.precondition(right)
        assert solution is not None
        self._last = solution
        return solution

    def energy(self, values: Complexes) -> float:
        """xᵀ A x with the matrix last set."""
        return _dot(values, self.multiply(values))

    def _factorize(self) -> None:
        self._at_rest = False
        self._cholesky.factorize(self._lower.data)
        self._fresh, self._turn = True, np.ones_like(self._turn)
        self.factorizations += 1

    def _iterate(self, right: Complexes) -> Complexes | None:
        image = self.multiply(self._last)  # of which the best multiple is where to start
        size = _dot(self._last, image)
        share = _dot(self._last, right) / size if size > 0 else 0.0
        solution, residual = share * self._last, right - share * image
        direction = np.zeros_like(residual)
        previous, count = np.inf, 0
        while count < _MOST_ITERATIONS:
            count += 1
            step = self.precondition(residual)
            square = _dot(residual, step)
            if square <= self._tolerance**2:
                self.iterations += count
                return solution + step
            direction = step + (square / previous) * direction
            image = self.multiply(direction)
            length = square / _dot(direction, image)
            solution = solution + length * direction
            residual = residual - length * image
            previous = square
        return None

    def multiply(self, values: Complexes) -> Complexes:
        """A x with the matrix last set."""
        flat = values.view(np.float64)
        product = self._lower @ flat
        product += self._upper @ flat
        product -= self._diagonal * flat
        return product.view(np.complex128)


def _dot(a: Complexes, b: Complexes) -> float:
    return float(np.vdot(a, b).real)
