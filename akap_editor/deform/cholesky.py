"""Sparse Cholesky factorization by CHOLMOD, symbolic and numeric phases apart (paper, section 3.1)."""

from functools import cached_property
from threading import Lock
from typing import Any

import numpy as np
from cvxopt import cholmod, matrix, spmatrix

from ..errors import SolverError
from ..geometry.validation import Floats, Ints

_SIMPLICIAL, _SUPERNODAL = 0, 2  # values of CHOLMOD's option
_options = Lock()  # which are those of the whole process


class SymmetricPattern:
    """Where the nonzeros of a symmetric sparse matrix are.

    rows, columns: (count,) int32, those of the lower triangle, by columns and within them by rows.
    """

    def __init__(self, rows: Ints, columns: Ints, size: int) -> None:
        self.rows, self.columns, self.size = rows.astype(np.int32), columns.astype(np.int32), size

    @property
    def count(self) -> int:
        """Number of nonzeros."""
        return len(self.rows)

    @cached_property
    def matrix(self) -> Any:
        """A sparse matrix for the values of whoever factorizes next."""
        indices = (matrix(index.astype(np.int64)) for index in (self.rows, self.columns))
        return spmatrix(1.0, *indices, (self.size, self.size))

    def restricted(self, kept: Ints) -> tuple["SymmetricPattern", Ints]:
        """The pattern of the rows and columns ``kept``, ascending, and which of the nonzeros are its own."""
        number = np.full(self.size, -1, dtype=np.int32)
        number[kept] = np.arange(len(kept))
        chosen = np.flatnonzero((number[self.rows] >= 0) & (number[self.columns] >= 0)).astype(np.int32)
        return SymmetricPattern(number[self.rows[chosen]], number[self.columns[chosen]], len(kept)), chosen


class SummedPattern(SymmetricPattern):
    """The pattern of entries (q,) in any order and either triangle, those at one place to be summed."""

    def __init__(self, rows: Ints, columns: Ints, size: int) -> None:
        low, high = np.maximum(rows, columns).astype(np.int64), np.minimum(rows, columns).astype(np.int64)
        keys, self._slots = np.unique(high * size + low, return_inverse=True)
        super().__init__(keys % size, keys // size, size)

    def summed(self, entries: Floats) -> Floats:
        """Nonzeros (count,) from the entries (q,)."""
        return np.bincount(self._slots, weights=entries, minlength=self.count).astype(np.float64, copy=False)


class SparseCholesky:
    """A symmetric positive definite matrix of fixed pattern: factorize often, solve more often.

    Supernodal factors are several times faster to make on large meshes, and smaller. With ``supernodal`` off,
    solves are up to twice as fast as long as the factors fit into the caches.
    """

    def __init__(self, pattern: SymmetricPattern, supernodal: bool = True) -> None:
        self._pattern = pattern
        with _options:
            cholmod.options["supernodal"] = _SUPERNODAL if supernodal else _SIMPLICIAL
            self._factor: Any = cholmod.symbolic(pattern.matrix, uplo="L")

    def factorize(self, nonzeros: Floats) -> None:
        """Numeric phase. Raises SolverError where the matrix is not positive definite or not finite."""
        if not np.isfinite(nonzeros).all():
            raise SolverError("the linear system has entries that are not finite")
        self._pattern.matrix.V = matrix(nonzeros)
        try:
            cholmod.numeric(self._pattern.matrix, self._factor)
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
