"""One factorization for many poses: conjugate gradients, preconditioned by the factors of an earlier pose.

A deformation is nearly isometric, so the matrix at the current pose is nearly the earlier one turned at each
vertex by the rotation R since then: R A₀⁻¹ Rᵀ is an excellent preconditioner.
"""

import numpy as np
from scipy.sparse import csc_array

from ..geometry.checks import Complexes, Floats
from .cholesky import SparseCholesky, SymmetricPattern

# What things cost, in units of one solve; the ratio of a numeric factorization to a solve is about the same
# at all mesh sizes.
_FACTORIZATION = 6.0
_ITERATION = 1.2
_MOST_ITERATIONS = 12
_SIMPLICIAL_BELOW = 10_000  # unknowns: solves are what counts there, factorizations are few and fast enough


class ReusedCholesky:
    """Solves A x = b for a matrix that changes a little from pose to pose.

    Unknowns are complex, one for each vertex; the matrix is real, with interleaved x and y. With ``exact``
    every matrix is factorized. Otherwise a factorization is kept as long as that is cheaper on average than
    making a new one, and solutions are as near as ``tolerance`` in the energy norm.
    """

    def __init__(self, pattern: SymmetricPattern, exact: bool, tolerance: float) -> None:
        size = pattern.size
        self._cholesky = SparseCholesky(pattern, supernodal=exact or size > _SIMPLICIAL_BELOW)
        starts = np.searchsorted(pattern.columns, np.arange(size + 1))
        self._lower = csc_array((np.zeros(pattern.count), pattern.rows, starts), shape=(size, size))
        self._upper = self._lower.T
        self._diagonal_slots = np.flatnonzero(pattern.rows == pattern.columns)
        self._exact, self._tolerance = exact, tolerance
        self._frame: Complexes = np.ones(size // 2, dtype=np.complex128)
        self._turn = self._now = self._frame
        self._last = np.zeros_like(self._frame)
        self._cost, self._solves = 0.0, 0
        self._stale, self._fresh = True, False
        self.iterations = self.factorizations = 0

    def forget(self) -> None:
        """The matrix is about to change by more than the pose does: factorize the next one."""
        self._stale = True

    def prepare(self, nonzeros: Floats, frame: Complexes) -> None:
        """Set the matrix; ``frame`` (n,) of unit size says how each vertex is turned. Raises SolverError."""
        self._lower.data = self._upper.data = nonzeros
        self._diagonal = nonzeros[self._diagonal_slots]
        self._now = frame
        if self._exact or self._stale:
            self._factorize()
        else:
            self._fresh = False
            self._turn = frame * self._frame.conj()

    def precondition(self, right: Complexes) -> Complexes:
        """An approximation of A⁻¹ b by one solve; exact where the matrix was just factorized."""
        turned = np.ascontiguousarray(self._turn.conj() * right)
        return self._turn * self._cholesky.solve(turned.view(np.float64)).view(np.complex128)

    def solve(self, right: Complexes) -> Complexes:
        """A⁻¹ b; where the factors are of an earlier pose, by conjugate gradients from the last solution."""
        if not self._fresh:
            solution = self._iterate(right)
            if solution is None:  # too far from the earlier pose
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
        self._stale = True  # until it has succeeded
        self._cholesky.factorize(self._lower.data)
        self._frame, self._turn = self._now, np.ones_like(self._now)
        self._stale, self._fresh = False, True
        self._cost, self._solves = _FACTORIZATION, 0
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
                self._judge(count)
                return solution + step
            direction = step + (square / previous) * direction
            image = self.multiply(direction)
            length = square / _dot(direction, image)
            solution = solution + length * direction
            residual = residual - length * image
            previous = square
        return None

    def _judge(self, count: int) -> None:
        """Factorize again once a solve costs more than the average since the last factorization."""
        self.iterations += count
        cost = _ITERATION * count
        self._cost, self._solves = self._cost + cost, self._solves + 1
        self._stale = cost > self._cost / self._solves

    def multiply(self, values: Complexes) -> Complexes:
        """A x with the matrix last set."""
        flat = values.view(np.float64)
        product = self._lower @ flat
        product += self._upper @ flat
        product -= self._diagonal * flat
        return product.view(np.complex128)


def _dot(a: Complexes, b: Complexes) -> float:
    return float(np.vdot(a, b).real)
