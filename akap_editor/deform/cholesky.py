"""Sparse Cholesky factorization, symbolic and numeric phase apart (paper, section 3.1)."""

from functools import cached_property

import numpy as np

from ..errors import SolverError
from ..geometry.validation import Complexes, Floats, Indices, Ints
from . import multifrontal
from .dissection import Dissection
from .fronts import SymbolicCholesky, column_starts


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
    def column_starts(self) -> Ints:
        """(size + 1,) int32, where the nonzeros of each column start, and their number."""
        return column_starts(self.columns, self.size)

    def neighbors(self) -> tuple[Indices, Indices]:
        """The later neighbors of each of n vertices with two unknowns, as in `multifrontal.Matrix`."""
        is_block = ((self.rows | self.columns) & 1 == 0) & (self.rows > self.columns)
        columns, rows = self.columns[is_block] // 2, self.rows[is_block] // 2
        return column_starts(columns, self.size // 2).astype(np.uint32), rows.astype(np.uint32)

    def find(self, rows: Ints, columns: Ints) -> Ints:
        """The indices (q,) among the nonzeros of those in ``rows`` and ``columns`` (q,), which must exist."""
        begin, end = self.column_starts[columns], self.column_starts[columns + 1]
        places = begin[:, None] + np.arange((end - begin).max(initial=1))
        return begin + (self.rows.take(places, mode="clip") == rows[:, None]).argmax(axis=1)

    def restrict(self, indices: Ints) -> tuple["SymmetricPattern", Ints]:
        """The pattern of the submatrix of some rows and columns, ascending ``indices``.

        Also returns which nonzeros of this pattern are those of the submatrix, int32.
        """
        number = np.full(self.size, -1, dtype=np.int32)
        number[indices] = np.arange(len(indices))
        rows, columns = number[self.rows], number[self.columns]
        chosen = np.flatnonzero((rows | columns) >= 0).astype(np.int32)
        return SymmetricPattern(rows[chosen], columns[chosen], len(indices)), chosen


class SummedPattern(SymmetricPattern):
    """The pattern of entries (q,) in any order and either triangle; entries at one place are summed."""

    def __init__(self, rows: Ints, columns: Ints, size: int) -> None:
        low, high = np.maximum(rows, columns).astype(np.int64), np.minimum(rows, columns).astype(np.int64)
        keys, self._slots = np.unique(high * size + low, return_inverse=True)
        super().__init__(keys % size, keys // size, size)

    def sum_entries(self, entries: Floats) -> Floats:
        """The nonzeros (count,) from the entries (q,)."""
        return np.bincount(self._slots, weights=entries, minlength=self.count).astype(np.float64, copy=False)


Precision = type[np.float16] | type[np.float64]
_MAX_HALF = 65504.0


class CholeskyFactors:
    """The factors of matrices with one symbolic factorization: factorize often, solve more often.

    precision: in which factors are kept. Those in float16 are computed in float32.
    """

    def __init__(self, symbolic: SymbolicCholesky, precision: Precision = np.float64) -> None:
        self.precision = precision
        self._is_half = precision is np.float16
        self._type = np.float32 if self._is_half else np.float64
        self.fronts = symbolic.fronts
        self.values = np.empty(symbolic.factor_size, dtype=np.uint16 if self._is_half else np.float64)
        self._front = np.empty(symbolic.largest_front**2, dtype=self._type)
        self._stack = np.empty(symbolic.stack_size, dtype=self._type)
        self._x = np.empty(int(self.fronts.starts[-1]), dtype=self._type)

    def factorize(self, nonzeros: Floats) -> None:
        """Compute the factors of the matrix with these nonzeros (count,).

        Raises SolverError if the matrix is not finite or, in the precision of the factors, not positive
        definite.
        """
        if not np.isfinite(nonzeros).all():
            raise SolverError("the linear system has entries that are not finite")
        min_pivot = 0.0
        if self._is_half:  # no entry of U exceeds the root of A's largest, nor the inverse root of a pivot
            if nonzeros.max() > _MAX_HALF**2:
                raise SolverError("the linear system has entries that are too large for half precision")
            min_pivot = _MAX_HALF**-2
        if not multifrontal.factorize(
            self.fronts, nonzeros, self.values, self._front, self._stack, min_pivot
        ):
            raise SolverError("the linear system is singular: a face has collapsed or a part is free")

    def solve(self, right: Floats) -> Floats:
        """The solution (size,) for a right-hand side (size,), as exact as the precision allows.

        Raises SolverError if it is not finite.
        """
        solution = right.astype(self._type)
        multifrontal.solve(self.fronts, self.values, solution, self._front)
        if not np.isfinite(solution).all():
            raise SolverError("the linear system has no finite solution")
        return solution.astype(np.float64, copy=False)

    def preconditioner(self, rotation: Complexes) -> multifrontal.Preconditioner:
        """R A⁻¹ Rᵀ for unit complex numbers R, (n,), in place of the two unknowns of each vertex."""
        return multifrontal.Preconditioner(self.fronts, self.values, rotation, self._x, self._front)


class SparseCholesky:
    """Factorizes symmetric positive definite matrices of one pattern, and solves with the last factors.

    dissection: of the n vertices; a vertex has size / n consecutive unknowns.
    """

    def __init__(self, pattern: SymmetricPattern, dissection: Dissection) -> None:
        order, starts = dissection
        width = pattern.size // len(order)
        self._order = (width * order[:, None].astype(np.int64) + np.arange(width)).ravel()
        number = np.empty(pattern.size, dtype=np.int64)
        number[self._order] = np.arange(pattern.size)
        ends = number[np.stack([pattern.rows, pattern.columns])]
        rows, columns = ends.max(axis=0), ends.min(axis=0)
        self._nonzeros = np.lexsort((rows, columns))
        symbolic = SymbolicCholesky(
            rows[self._nonzeros].astype(np.int32), columns[self._nonzeros].astype(np.int32), width, starts
        )
        self._factors = CholeskyFactors(symbolic)

    def factorize(self, nonzeros: Floats) -> None:
        """Compute the factors of the matrix with these nonzeros (count,).

        Raises SolverError if the matrix is not finite or not positive definite.
        """
        self._factors.factorize(nonzeros[self._nonzeros])

    def solve(self, right: Floats) -> Floats:
        """The solution (size,) for a right-hand side (size,). Raises SolverError if it is not finite."""
        result = np.empty(len(right))
        result[self._order] = self._factors.solve(right[self._order])
        return result
