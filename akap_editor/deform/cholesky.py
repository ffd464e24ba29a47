"""Sparse Cholesky factorization by CHOLMOD, symbolic and numeric phases apart (paper, section 3.1)."""

from typing import Any

import numpy as np
from cvxopt import cholmod, matrix, spmatrix

from ..errors import SolverError
from ..geometry.checks import Floats, Ints

_SIMPLICIAL, _SUPERNODAL = 0, 2  # values of CHOLMOD's option


class SymmetricPattern:
    """Where the entries of a symmetric sparse matrix are, given by entries that are to be summed.

    rows, columns: (q,) indices, either triangle; nonzeros are those of the lower triangle, by columns.
    """

    def __init__(self, rows: Ints, columns: Ints, size: int) -> None:
        low, high = np.maximum(rows, columns).astype(np.int64), np.minimum(rows, columns).astype(np.int64)
        keys, slots = np.unique(high * size + low, return_inverse=True)
        self.size = size
        self.rows, self.columns = keys % size, keys // size
        self.slots = slots.astype(np.int64)

    @property
    def count(self) -> int:
        """Number of nonzeros."""
        return len(self.rows)

    def summed(self, entries: Floats) -> Floats:
        """Nonzeros (count,) from entries (q,) in the order in which the pattern was given."""
        return np.bincount(self.slots, weights=entries, minlength=self.count).astype(np.float64, copy=False)

    def restricted(self, kept: Ints) -> tuple["SymmetricPattern", Ints]:
        """The pattern of the rows and columns ``kept`` alone, and which of the nonzeros are its own."""
        number = np.full(self.size, -1, dtype=np.int64)
        number[kept] = np.arange(len(kept))
        chosen = np.flatnonzero((number[self.rows] >= 0) & (number[self.columns] >= 0))
        part = SymmetricPattern(number[self.rows[chosen]], number[self.columns[chosen]], len(kept))
        nonzeros = np.empty(part.count, dtype=np.int64)
        nonzeros[part.slots] = chosen
        return part, nonzeros


class SparseCholesky:
    """A symmetric positive definite matrix of fixed pattern: factorize often, solve more often.

    Supernodal factorizations are several times faster to make on large meshes. With ``supernodal`` off,
    solves in a row are up to twice as fast.
    """

    def __init__(self, pattern: SymmetricPattern, supernodal: bool = True) -> None:
        self._matrix: Any = spmatrix(
            1.0, matrix(pattern.rows), matrix(pattern.columns), (pattern.size, pattern.size)
        )
        cholmod.options["supernodal"] = _SUPERNODAL if supernodal else _SIMPLICIAL
        self._factor: Any = cholmod.symbolic(self._matrix, uplo="L")

    def factorize(self, nonzeros: Floats) -> None:
        """Numeric phase. Raises SolverError where the matrix is not positive definite or not finite."""
        if not np.isfinite(nonzeros).all():
            raise SolverError("the linear system has entries that are not finite")
        self._matrix.V = matrix(nonzeros)
        try:
            cholmod.numeric(self._matrix, self._factor)
        except ArithmeticError as error:
            raise SolverError(
                "the linear system is singular: a face has collapsed or a part is free"
            ) from error

    def solve(self, right: Floats) -> Floats:
        """Solution of the last factorized system for one right-hand side (size,). Raises SolverError."""
        solution = matrix(right)
        cholmod.solve(self._factor, solution)
        result = np.asarray(memoryview(solution))[:, 0]
        if not np.isfinite(result).all():
            raise SolverError("the linear system has no finite solution")
        return result
