"""One factorization for many poses: conjugate gradients, preconditioned by the factors of an earlier pose.

A deformation is nearly isometric, so the matrix at the current pose is nearly the earlier one turned at each
vertex by the rotation R since then: R A₀⁻¹ Rᵀ is an excellent preconditioner.
"""

from typing import Any

import numpy as np
from scipy.sparse import csc_array

from ..geometry.checks import Complexes, Floats
from .cholesky import SparseCholesky, SymmetricPattern

# What things cost, in units of one solve; the ratio of a numeric factorization to a solve is about the same at
# all mesh sizes.
_FACTORIZATION = 6.0
_ITERATION = 1.2
_MOST_ITERATIONS = 12


class ReusedCholesky:
    """Solves A x = b for a matrix that changes a little from pose to pose.

    Unknowns are complex, one for each vertex; the matrix is real, with interleaved x and y. With ``exact`` every
    matrix is factorized. Otherwise a factorization is kept as long as that is cheaper on average than making a
    new one.
    """

    def __init__(self, pattern: SymmetricPattern, exact: bool) -> None:
        self._cholesky = SparseCholesky(pattern)
        size = pattern.size
        starts = np.searchsorted(pattern.columns, np.arange(size + 1))
        self._lower = csc_array((np.zeros(pattern.count), pattern.rows, starts), shape=(size, size))
        self._diagonal = np.flatnonzero(pattern.rows == pattern.columns)
        self._always = exact
        self._stale = True
        self._fresh = False
        self._turn: Complexes = np.ones(size // 2, dtype=np.complex128)
        self._frame = self._turn
        self._cost, self._uses = 0.0, 0
        self.iterations = 0

    def forget(self) -> None:
        """The matrix is about to change by more than the pose does: factorize the next one."""
        self._stale = True

    def prepare(self, nonzeros: Floats, frame: Complexes, exact: bool = False) -> None:
        """Set the matrix; ``frame`` (n,) of unit size says how each vertex is turned. Raises SolverError."""
        self._lower.data = nonzeros
        self._fresh = self._always or self._stale or exact
        if self._fresh:
            self._cholesky.factorize(nonzeros)
            self._frame, self._stale = frame, False
            self._cost, self._uses = _FACTORIZATION, 0
        self._turn = frame * self._frame.conj()

    def precondition(self, right: Complexes) -> Complexes:
        """An approximation of A⁻¹ b by one solve; exact where the matrix was just factorized."""
        turned = (self._turn.conj() * right).view(np.float64)
        return self._turn * self._cholesky.solve(turned).view(np.complex128)

    def solve(self, right: Complexes, tolerance: float) -> Complexes:
        """A⁻¹ b, by conjugate gradients until the energy norm of the error is about ``tolerance``."""
        solution = self.precondition(right)
        self.iterations = 0
        if self._fresh:
            return solution
        residual = right - self._multiply(solution)
        direction: Complexes | None = None
        previous = 1.0
        while self.iterations < _MOST_ITERATIONS:
            self.iterations += 1
            step = self.precondition(residual)
            square = _dot(residual, step)
            if square <= tolerance**2:
                solution = solution + step
                break
            direction = step if direction is None else step + (square / previous) * direction
            image = self._multiply(direction)
            length = square / _dot(direction, image)
            solution = solution + length * direction
            residual = residual - length * image
            previous = square
        self._judge()
        return solution

    def _judge(self) -> None:
        """Factorize again once a step costs more than the average since the last factorization."""
        cost = _ITERATION * self.iterations
        self._cost, self._uses = self._cost + cost, self._uses + 1
        self._stale = cost > self._cost / self._uses or self.iterations >= _MOST_ITERATIONS

    def _multiply(self, values: Complexes) -> Complexes:
        flat = values.view(np.float64)
        lower: Any = self._lower
        product = lower @ flat + lower.T @ flat - lower.data[self._diagonal] * flat
        return product.view(np.complex128)


def _dot(a: Complexes, b: Complexes) -> float:
    return float(np.vdot(a, b).real)
