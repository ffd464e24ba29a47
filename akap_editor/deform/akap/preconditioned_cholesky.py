"""Few factorizations for many poses: conjugate gradients, preconditioned by factors of an earlier pose.

A deformation is nearly isometric, so the matrix at a pose is nearly that of an earlier pose turned at each
vertex by its rotation R since then: R A₀⁻¹ Rᵀ is an excellent preconditioner. Which pose that was changes the
cost of a solution, and the solution by no more than its tolerance.
"""

import numpy as np

from ...geometry.jit import compiled
from ...geometry.validation import Complexes, Floats, Ints
from ..cholesky import SparseCholesky, SymmetricPattern

# A factorization costs as much as five to eight iterations. When so many were spent beyond those that gained
# a digit each, which new factors do, it is time for another.
_AFFORDED = 8
_MOST_ITERATIONS = 12  # of one solution; then the matrix at hand is factorized
# Unknowns below which factors are simplicial: twice as slow to make, but solves, of which there are more,
# take half the time. Larger ones no longer fit into the caches.
_SIMPLICIAL_BELOW = 8_000
_KEPT = 2  # earlier solutions from which the next one begins
_SAME = 1e-11  # of two that differ by less than this share of their energies one is enough


class PreconditionedCholesky:
    """Solves A x = b for a matrix that changes a little from pose to pose.

    Unknowns are complex, one for each vertex; the matrix is real, with interleaved x and y, and where two
    vertices are coupled, all four entries are in the pattern. With ``exact`` every matrix is factorized.
    Otherwise one is now and then, and solutions are as near as asked for; where iterations do not come that
    near soon, the matrix at hand is factorized after all.
    """

    def __init__(self, pattern: SymmetricPattern, exact: bool) -> None:
        size = pattern.size
        self._cholesky = SparseCholesky(pattern, supernodal=exact or pattern.size > _SIMPLICIAL_BELOW)
        self._starts = np.searchsorted(pattern.columns, np.arange(size + 1)).astype(np.int32)
        self._vertices = (pattern.rows // 2).astype(np.int32)
        self._exact = exact
        self._frame = self._turn = np.ones(size // 2, dtype=np.complex128)
        self._then = self._frame  # the frame of the factorized pose
        self._earlier: dict[str, list[Complexes]] = {}
        self._usable = self._fresh = False
        self._spent = 0.0
        self.iterations = self.factorizations = 0

    def forget(self) -> None:
        """What was factorized is no longer near the matrices to come."""
        self._usable = False

    def prepare(self, nonzeros: Floats, frame: Complexes) -> None:
        """Set the matrix by its nonzeros. Raises SolverError.

        frame: (n,) of unit size, how each vertex is turned from rest.
        """
        self._nonzeros, self._frame, self._fresh = nonzeros, frame, False
        if self._exact or not self._usable or self._spent >= _AFFORDED:
            self._factorize()
        else:
            self._turn = frame * self._then.conj()

    def solve(self, right: Complexes, tolerance: float, like: str = "") -> Complexes:
        """A⁻¹ b, each value as near as ``tolerance``, or exact where the matrix was just factorized.

        The error of an iterate is estimated as what the preconditioner makes of its residual, and that is
        then taken off.

        like: a name for solutions that are alike from pose to pose: each begins with the last ones.
        """
        solution = None if self._fresh else self._iterate(right, tolerance, self._earlier.get(like, []))
        if solution is None:
            if not self._fresh:  # too far from an isometry
                self._factorize()
            solution = self._precondition(right)
        if like and not self._exact:
            unturned = self._frame.conj() * solution
            self._earlier[like] = [unturned, *self._earlier.get(like, [])][:_KEPT]
        return solution

    def energy(self, values: Complexes) -> float:
        """xᵀ A x with the matrix last set."""
        return dot(values, self.multiply(values))

    def multiply(self, values: Complexes) -> Complexes:
        """A x with the matrix last set."""
        return _product(self._starts, self._vertices, self._nonzeros, values)

    def _factorize(self) -> None:
        self._usable = False
        self._cholesky.factorize(self._nonzeros)
        self._usable = self._fresh = True
        self._then, self._turn = self._frame, np.ones_like(self._frame)
        self._spent = 0.0
        self.factorizations += 1

    def _precondition(self, right: Complexes) -> Complexes:
        turned = self._turn.conj() * right
        return self._turn * self._cholesky.solve(turned.view(np.float64)).view(np.complex128)

    def _iterate(self, right: Complexes, tolerance: float, earlier: list[Complexes]) -> Complexes | None:
        solution, residual = self._best_of(right, earlier)
        direction = np.zeros_like(residual)
        previous, first = np.inf, 0.0
        for count in range(_MOST_ITERATIONS):
            step = self._precondition(residual)
            square = dot(residual, step)
            size = _largest(step)
            first = first or size
            if size <= tolerance:
                self.iterations += count + 1
                self._spent += max(count - float(np.log10(max(first / tolerance, 1.0))), 0.0)
                return solution + step
            direction = step + (square / previous) * direction
            image = self.multiply(direction)
            length = square / dot(direction, image)
            solution = solution + length * direction
            residual = residual - length * image
            previous = square
        return None

    def _best_of(self, right: Complexes, earlier: list[Complexes]) -> tuple[Complexes, Complexes]:
        """The combination of earlier solutions, turned with the drawing, with the least error; its residual.

        (Fischer 1998, "Projection techniques for iterative solution of Ax = b with successive right-hand
        sides".)
        """
        solution, residual = np.zeros_like(right), right
        previous: tuple[Complexes, Complexes, float] | None = None
        for values in earlier:
            turned = self._frame * values
            image = self.multiply(turned)
            before = dot(turned, image)
            if previous is not None:  # the second one is made orthogonal to the first
                first, first_image, size = previous
                share = dot(first_image, turned) / size
                turned = turned - share * first
                image = image - share * first_image
            size = dot(turned, image)
            if size <= _SAME * before:
                continue
            share = dot(turned, residual) / size
            solution = solution + share * turned
            residual = residual - share * image
            previous = turned, image, size
        return solution, residual


@compiled
def _product(starts: Ints, vertices: Ints, nonzeros: Floats, values: Complexes) -> Complexes:
    """Of a symmetric matrix, given by its lower triangle in columns, and one value for each pair of them."""
    result = np.zeros_like(values)
    for j in range(len(values)):
        own, other, x = starts[2 * j], starts[2 * j + 1], values[j]
        real = nonzeros[own] * x.real + nonzeros[own + 1] * x.imag
        imaginary = nonzeros[own + 1] * x.real + nonzeros[other] * x.imag
        shift = other - own - 1  # from an entry to the one beside it in the next column
        for k in range(own + 2, other, 2):
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
    """Re aᴴ b of two vectors; BLAS would call in threads, which on a busy machine wait for one another."""
    total = 0.0
    for k in range(len(a)):
        total += a[k].real * b[k].real + a[k].imag * b[k].imag
    return total


def _largest(values: Complexes) -> float:
    return float(np.abs(values).max())
