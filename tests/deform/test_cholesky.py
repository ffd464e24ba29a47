"""Sparse factorization against dense matrices."""

import numpy as np
import pytest

from akap_editor.deform.cholesky import SparseCholesky, SummedPattern, SymmetricPattern
from akap_editor.deform.dissection import Dissection
from akap_editor.errors import SolverError


@pytest.fixture(params=range(4))
def entries(request):
    """Rows, columns and values of a positive definite matrix, entries repeated and in both triangles."""
    rng = np.random.default_rng(request.param)
    size = 12
    i, j = rng.integers(0, size, (2, 60))
    values = rng.normal(size=60)
    diagonal = np.arange(size)
    return (
        np.concatenate([i, diagonal]),
        np.concatenate([j, diagonal]),
        np.concatenate([values, np.full(size, 40.0)]),
        size,
    )


def any_order(count):
    """Groups of vertices in an order that has nothing to do with the matrix, which costs only time."""
    return Dissection(np.random.default_rng(9).permutation(count), np.append(np.arange(0, count, 3), count))


def dense(rows, columns, values, size):
    """The dense symmetric matrix of entries in either triangle, summed."""
    lower = np.zeros((size, size))
    np.add.at(lower, (np.maximum(rows, columns), np.minimum(rows, columns)), values)
    return lower + np.tril(lower, -1).T


def test_pattern_sums_entries(entries):
    rows, columns, values, size = entries
    pattern = SummedPattern(rows, columns, size)
    nonzeros = pattern.sum_entries(values)
    assert len(nonzeros) == pattern.count == len(set(zip(pattern.rows, pattern.columns, strict=True)))
    assert np.abs(dense(pattern.rows, pattern.columns, nonzeros, size) - dense(*entries)).max() < 1e-13


def test_restricted_pattern_is_the_submatrix(entries):
    rows, columns, values, size = entries
    kept = np.array([1, 2, 5, 7, 11])
    pattern = SummedPattern(rows, columns, size)
    part, chosen = pattern.restrict(kept)
    nonzeros = pattern.sum_entries(values)[chosen]
    expected = dense(*entries)[np.ix_(kept, kept)]
    assert np.abs(dense(part.rows, part.columns, nonzeros, part.size) - expected).max() < 1e-13


def test_solution_is_that_of_the_dense_system(entries):
    rows, columns, values, size = entries
    pattern = SummedPattern(rows, columns, size)
    solver = SparseCholesky(pattern, any_order(size))
    right = np.random.default_rng(1).normal(size=size)
    for scale in (1.0, 3.0):  # factorized again with other numbers
        solver.factorize(scale * pattern.sum_entries(values))
        expected = np.linalg.solve(scale * dense(*entries), right)
        before = right.copy()
        assert np.abs(solver.solve(right) - expected).max() < 1e-13
        assert right.tolist() == before.tolist()


def test_two_factorizations_of_one_pattern_do_not_mix(entries):
    rows, columns, values, size = entries
    pattern = SummedPattern(rows, columns, size)
    solvers = SparseCholesky(pattern, any_order(size)), SparseCholesky(pattern, any_order(size))
    for scale, solver in zip((1.0, 3.0), solvers, strict=True):
        solver.factorize(scale * pattern.sum_entries(values))
    right = np.ones(size)
    once, thrice = (solver.solve(right) for solver in solvers)
    assert np.abs(once - 3 * thrice).max() < 1e-13


PATTERN = SymmetricPattern(np.array([0, 1, 1]), np.array([0, 0, 1]), 2)


@pytest.mark.parametrize("nonzeros", [[1.0, 1.0, 1.0], [1.0, 2.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 1.0]])
def test_matrix_that_is_not_positive_definite_is_refused(nonzeros):
    with pytest.raises(SolverError, match="singular"):
        SparseCholesky(PATTERN, any_order(2)).factorize(np.array(nonzeros))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused(bad):
    solver = SparseCholesky(PATTERN, any_order(2))
    with pytest.raises(SolverError, match="not finite"):
        solver.factorize(np.array([1.0, 0.0, bad]))
    solver.factorize(np.array([1.0, 0.0, 1.0]))
    with pytest.raises(SolverError, match="no finite solution"):
        solver.solve(np.array([bad, 1.0]))
    assert solver.solve(np.array([2.0, 3.0])).tolist() == [2.0, 3.0]
