"""The multifrontal factorization against SuperLU."""

import numpy as np
import pytest
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

from akap_editor.deform.cholesky import CholeskyFactors, SymmetricPattern
from akap_editor.deform.dissection import dissect
from akap_editor.deform.fronts import SymbolicCholesky
from akap_editor.deform.multifrontal import Matrix, iterate, multiply
from akap_editor.errors import SolverError
from akap_editor.geometry.killing_matrix import KillingMatrix
from akap_editor.geometry.operators import to_complex
from tests.support import shapes

PRECISIONS = {np.float16: 2e-2, np.float64: 1e-11}


class Case:
    """The matrix K + I of a shape in elimination order, and its fronts."""

    def __init__(self, mesh, group=0):
        n = len(mesh.vertices)
        order, starts = dissect(mesh.vertices, mesh.edges)
        if group:  # any numbering, any groups of consecutive vertices
            order = np.random.default_rng(group).permutation(n)
            starts = np.append(np.arange(0, n, group), n)
        self.mesh = mesh.renumber(order, np.arange(len(mesh.faces)))
        self.killing = KillingMatrix(self.mesh)
        rows, columns = self.killing.blocks.rows, self.killing.blocks.columns
        self.is_diagonal = rows == columns
        self.symbolic = SymbolicCholesky(rows, columns, 2, starts)
        self.size = 2 * n
        self.neighbors = SymmetricPattern(rows, columns, self.size).neighbors()
        self.nonzeros = self.nonzeros_at(to_complex(self.mesh.vertices))

    def nonzeros_at(self, pose):
        return self.killing.nonzeros(pose) + self.is_diagonal

    def sparse(self, nonzeros):
        blocks = self.killing.blocks
        lower = coo_array((nonzeros, (blocks.rows, blocks.columns)), shape=(self.size, self.size)).tocsc()
        return csc_array(lower + lower.T - csc_array(np.diag(lower.diagonal())))

    def matrix(self, nonzeros):
        return Matrix(*self.neighbors, nonzeros)


def random_values(count, seed=0):
    return np.random.default_rng(seed).normal(size=(count, 2)).view(np.complex128)[:, 0]


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("group", [0, 1, 3, 50])
@pytest.mark.parametrize("name", shapes.SHAPES)
def test_solution_is_that_of_superlu(name, group, precision):
    case = Case(shapes.SHAPES[name], group)
    factors = CholeskyFactors(case.symbolic, precision)
    right = np.random.default_rng(1).normal(size=case.size)
    expected = splu(case.sparse(case.nonzeros)).solve(right)
    for scale in (1.0, 4.0):  # factorized again with other numbers
        factors.factorize(scale * case.nonzeros)
        found = factors.solve(right)
        assert np.abs(scale * found - expected).max() < PRECISIONS[precision] * np.abs(expected).max()


def test_components_may_be_eliminated_in_any_order():
    """Updates of one component then wait on the stack below those of another one."""
    mesh = shapes.SHAPES["islands"]
    n = len(mesh.vertices)
    for seed in range(20):
        case = Case(mesh, group=1 + seed % 4)
        factors = CholeskyFactors(case.symbolic)
        factors.factorize(case.nonzeros)
        right = np.random.default_rng(seed).normal(size=2 * n)
        assert np.abs(case.sparse(case.nonzeros) @ factors.solve(right) - right).max() < 1e-9


@pytest.mark.parametrize("precision", PRECISIONS)
def test_pivots_that_are_not_positive_are_refused(precision):
    case = Case(shapes.SHAPES["bar"])
    factors = CholeskyFactors(case.symbolic, precision)
    for bad in (case.nonzeros - 50 * case.is_diagonal, -case.nonzeros, 0 * case.nonzeros):
        with pytest.raises(SolverError, match="singular"):
            factors.factorize(bad)
    factors.factorize(case.nonzeros)
    assert np.isfinite(factors.solve(np.ones(case.size))).all()


def test_product_is_that_of_the_sparse_matrix():
    case = Case(shapes.SHAPES["ring"])
    values, result = random_values(case.size // 2), np.empty(case.size // 2, dtype=complex)
    multiply(case.matrix(case.nonzeros), values, result)
    expected = case.sparse(case.nonzeros) @ values.view(np.float64)
    assert np.abs(result.view(np.float64) - expected).max() < 1e-11


@pytest.mark.parametrize("known", [0, 1, 2, 3])
@pytest.mark.parametrize("precision", PRECISIONS)
def test_iterations_reach_double_precision(known, precision):
    """From factors at rest, in either precision, at a pose that is stretched by a fifth."""
    case = Case(shapes.SHAPES["bar"])
    factors = CholeskyFactors(case.symbolic, precision)
    factors.factorize(case.nonzeros)
    n = case.size // 2
    rotation = np.exp(0.4j)
    pose = rotation * (1.2 * case.mesh.vertices[:, 0] + 1j * case.mesh.vertices[:, 1])
    nonzeros, frame = case.nonzeros_at(pose), np.full(n, rotation)
    right, earlier = random_values(n), np.stack([random_values(n, seed) for seed in (1, 2, 3)])
    before = earlier.copy()
    solution = np.empty(n, dtype=complex)
    count, first, last = iterate(
        factors.preconditioner(frame), case.matrix(nonzeros), right, frame, earlier, known, 1e-12, 1.0, 1,
        60, solution,
    )  # fmt: skip
    expected = splu(case.sparse(nonzeros)).solve(right.view(np.float64)).view(complex)
    assert 1 < count < 60
    assert last <= 1e-12 < first
    assert np.abs(solution - expected).max() < 1e-11
    assert np.abs(earlier[0] - frame.conj() * solution).max() < 1e-15
    assert (earlier[1:] == before[:-1]).all()


def test_iterations_start_from_the_solution_that_earlier_ones_combine_to():
    """Also where an earlier one is twice the one before it, and adds nothing."""
    case = Case(shapes.SHAPES["bar"])
    factors = CholeskyFactors(case.symbolic, np.float64)
    factors.factorize(case.nonzeros)
    n = case.size // 2
    matrix, frame = case.matrix(case.nonzeros), np.exp(1j * np.linspace(0, 1, n))
    first, other = random_values(n, 1), random_values(n, 2)
    expected, right, solution = 3.0 * first - 0.5 * other, np.empty_like(first), np.empty_like(first)
    multiply(matrix, expected, right)
    earlier = frame.conj() * np.stack([first, 2.0 * first, other])
    count, largest, _ = iterate(
        factors.preconditioner(frame), matrix, right, frame, earlier, 3, 1e-9, 1.0, 1, 60, solution
    )
    assert count == 1
    assert largest < 1e-9
    assert np.abs(solution - expected).max() < 1e-9
