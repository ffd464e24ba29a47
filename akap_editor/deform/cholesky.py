"""Sparse Cholesky factorization by CHOLMOD, symbolic and numeric phase apart (paper, section 3.1)."""

from functools import cached_property
from threading import Lock
from typing import Any

import numpy as np
from cvxopt import cholmod, matrix, spmatrix

from ..errors import SolverError
from ..geometry.validation import Floats, Ints

_SIMPLICIAL, _SUPERNODAL = 0, 2  # values of CHOLMOD's option "supernodal"
_options_lock = Lock()  # CHOLMOD's options are global


class SymmetricPattern:
    """The sparsity pattern of a symmetric matrix.

    rows, columns: (count,) int32 indices of the nonzeros in the lower triangle, sorted by column, then by
    row; size: number of rows of the matrix.
    """

    def __init__(self, rows: Ints, columns: Ints, size: int) -> None:
        self.rows, self.columns, self.size = rows.astype(np.int32), columns.astype(np.int32), size

    @property
    def count(self) -> int:
        """The number of nonzeros."""
        return len(self.rows)

    @cached_property
    def matrix(self) -> Any:
        """A CHOLMOD matrix of this pattern; each factorization overwrites its values."""
        indices = (matrix(index.astype(np.int64)) for index in (self.rows, self.columns))
        return spmatrix(1.0, *indices, (self.size, self.size))

    def restrict(self, indices: Ints) -> tuple["SymmetricPattern", Ints]:
        """The pattern of the submatrix of some rows and columns, ascending ``indices``.

        Also returns which nonzeros of this pattern are those of the submatrix, int32.
        """
        number = np.full(self.size, -1, dtype=np.int32)
        number[indices] = np.arange(len(indices))
        chosen = np.flatnonzero((number[self.rows] >= 0) & (number[self.columns] >= 0)).astype(np.int32)
        return SymmetricPattern(number[self.rows[chosen]], number[self.columns[chosen]], len(indices)), chosen


class SummedPattern(SymmetricPattern):
    """The pattern of entries (q,) in any order and either triangle; entries at one place are summed."""

    def __init__(self, rows: Ints, columns: Ints, size: int) -> None:
        low, high = np.maximum(rows, columns).astype(np.int64), np.minimum(rows, columns).astype(np.int64)
        keys, self._slots = np.unique(high * size + low, return_inverse=True)
        super().__init__(keys % size, keys // size, size)

    def sum_entries(self, entries: Floats) -> Floats:
        """The nonzeros (count,) from the entries (q,)."""
        return np.bincount(self._slots, weights=entries, minlength=self.count).astype(np.float64, copy=False)


class SparseCholesky:
    """Factorizes symmetric positive definite matrices of one pattern, and solves with the last factors.

    Supernodal factors are smaller, and several times faster to compute on large meshes; simplicial ones
    (``supernodal`` off) solve up to twice as fast while they fit into the caches.
    """

    def __init__(self, pattern: SymmetricPattern, supernodal: bool = True) -> None:
        self._pattern = pattern
        with _options_lock:
            cholmod.options["supernodal"] = _SUPERNODAL if supernodal else _SIMPLICIAL
            self._factor: Any = cholmod.symbolic(pattern.matrix, uplo="L")

    def factorize(self, nonzeros: Floats) -> None:
        """Compute the factors of the matrix with these nonzeros (count,).

        Raises SolverError if the matrix is not finite or not positive definite.
        """
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
        """The solution (size,) for a right-hand side (size,). Raises SolverError if it is not finite."""
        solution = matrix(right)
        cholmod.solve(self._factor, solution)
        result = np.asarray(memoryview(solution))[:, 0]
        if not np.isfinite(result).all():
            raise SolverError("the linear system has no finite solution")
        return result
