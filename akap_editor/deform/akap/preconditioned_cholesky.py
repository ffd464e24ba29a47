"""Conjugate gradients preconditioned by the Cholesky factors of an earlier pose.

A deformation is nearly isometric: the matrix at a pose is close to that of an earlier pose, rotated at each
vertex by the rotation R since then. So R A₀⁻¹ Rᵀ is an excellent preconditioner, and one factorization serves
many poses. Which earlier pose was factorized changes the cost of a solution, and the solution within its
tolerance.

Factors are kept in half precision, which quarters the memory that a solve reads. Residuals and solutions
have double precision.
"""

from threading import Thread

import numpy as np

from ...errors import SolverError
from ...geometry.validation import Complexes, Floats, Ints
from ..cholesky import CholeskyFactors, Precision, SymmetricPattern
from ..fronts import SymbolicCholesky
from ..multifrontal import Matrix, dot, iterate, multiply

# A factorization costs as much as ten iterations. With fresh factors, each iteration gains a digit or more;
# refactorize once the iterations beyond that cost as much as a factorization.
MAX_WASTED_ITERATIONS = 2
MAX_WASTED_ITERATIONS_OF_SMALL = 8  # small meshes factorize at once
_FACTORIZATION_DELAY = 1  # poses for which the old factors serve while new ones are made beside
_LONG_DELAY = 2  # the same for many vertices, whose factors take longer than a pose
MIN_LARGE_VERTICES = 50_000  # of a mesh whose factors take longer to make than a pose
_MAX_ITERATIONS = 12  # of one solution; without convergence the current matrix is factorized
_MIN_REUSE_VERTICES = 100  # of a mesh whose factors serve for several poses: other ones cost nothing
MIN_THREAD_VERTICES = 1500  # of a mesh that is factorized beside: on smaller ones, a thread costs more
_EXACT_ITERATIONS = 5  # that reach double precision from the factors of the very matrix
# Earlier solutions from which the next one starts; if they are not confirmed, errors hide what a third adds.
_WARM_STARTS, _WARM_STARTS_IF_CONFIRMED = 2, 3
# The contraction is 1 to 2 % after a factorization, and then grows from pose to pose.
_CONTRACTION_GROWTH, _CONTRACTION_SAFETY = 1.3, 3.0


class PreconditionedCholesky:
    """Solves A x = b for a matrix that changes a little from pose to pose.

    Unknowns are complex, one for each vertex; the matrix is real, with interleaved x and y, and its pattern
    has all four entries of two coupled vertices.
    exact: factorize every matrix, in double precision. Otherwise solutions are iterated to the tolerance
    asked for, and the matrix is factorized when iterations become too expensive or do not converge.
    starts: (f + 1,) the groups of vertices that are eliminated together, see `Dissection`.
    confirm: end iterations only with a correction that is itself within the tolerance, so that the error is a
    small share of it, and start them from three earlier solutions. Otherwise they start from two, and the
    last, merely confirming one is left out where the contraction last seen leaves an error within the
    tolerance.

    While iterations converge, new factors of large meshes are made in a thread beside, and taken over a fixed
    number of poses later: so solutions do not depend on how fast that was.

    symbolic: the symbolic factorization; iterations, factorizations: numbers so far.
    """

    def __init__(self, pattern: SymmetricPattern, exact: bool, starts: Ints, confirm: bool = True) -> None:
        n = pattern.size // 2
        self.symbolic = SymbolicCholesky(pattern.rows, pattern.columns, 2, starts)
        self._matrix = Matrix(*pattern.neighbors(), np.empty(0))
        self._exact, self._confirm = exact, confirm
        self._warm_starts = _WARM_STARTS_IF_CONFIRMED if confirm else _WARM_STARTS
        self._is_tiny, self._is_small = n < _MIN_REUSE_VERTICES, n < MIN_THREAD_VERTICES
        self._delay = _LONG_DELAY if n >= MIN_LARGE_VERTICES else _FACTORIZATION_DELAY
        self._min_exact_iterations = _EXACT_ITERATIONS if confirm or self._is_small else 1
        self._precision: Precision = np.float64 if exact else np.float16
        self._factors = CholeskyFactors(self.symbolic, self._precision)
        self._spare: CholeskyFactors | None = None  # made beside, or used before
        self._other_factors: CholeskyFactors | None = None  # of `solve_once`
        self._job: _FactorizationThread | None = None
        self._frame = self._rotation = self._factorized_frame = np.ones(n, np.complex128)
        self._poses_to_wait = 0
        self._earlier_solutions: dict[
            str, tuple[Complexes, int]
        ] = {}  # and how many, as `iterate` takes them
        self._has_factors = self._is_exact = False  # of some pose; of the current one
        self._wasted_iterations, self._contraction = 0.0, 1.0
        self.iterations = self.factorizations = 0

    def invalidate(self) -> None:
        """Discard the factors: the next matrix is not close to the one that was factorized."""
        self._has_factors = False

    def prepare(self, nonzeros: Floats, frame: Complexes) -> None:
        """Set the matrix by its nonzeros (z,), which must not change later.

        frame: (n,) unit complex numbers, the rotation of each vertex from rest. Raises SolverError if the
        matrix is factorized and singular.
        """
        self._matrix = self._matrix._replace(nonzeros=nonzeros)
        self._frame, self._is_exact = frame, False
        if self._exact or self._is_tiny or not self._has_factors:
            job = self._finish_job()
            if job is not None and job.has_factors_of(nonzeros, frame):
                self._use_factors_made_beside(job)
                self._is_exact = True
            else:
                self.factorize()
            return
        if self._job is not None:
            self._poses_to_wait -= 1
            if self._poses_to_wait == 0:
                self._take_over()
        elif self._is_small and self._wasted_iterations >= MAX_WASTED_ITERATIONS_OF_SMALL:
            self.factorize()
            return
        elif not self._is_small and self._wasted_iterations >= MAX_WASTED_ITERATIONS:
            self._factorize_beside(nonzeros, frame)
        self._rotation = frame * self._factorized_frame.conj()
        self._contraction = min(_CONTRACTION_GROWTH * self._contraction, 1.0)

    def factorize_ahead(self, nonzeros: Floats, frame: Complexes) -> None:
        """Begin to factorize the matrix that `prepare` will probably be called with next, beside.

        If it is called with another one, that is factorized as ever; solutions are the same in any case.
        Nothing is done if `prepare` would not factorize, if the mesh is small, or as long as other factors
        are being made.
        """
        is_busy = self._job is not None and self._job.is_alive()
        if not (self._exact or self._is_small or self._has_factors or is_busy):
            self._factorize_beside(nonzeros, frame)

    def solve(self, right: Complexes, tolerance: float, warm_start_key: str = "") -> Complexes:
        """A⁻¹ b for a right-hand side b (n,), exact if every matrix is factorized.

        tolerance: largest error of a value otherwise. The error is estimated as the preconditioned residual,
        which is also added to the result.
        warm_start_key: names a series of solutions that are similar from pose to pose; each starts from the
        last ones. Raises SolverError.
        """
        if self._exact:
            return self._solve_directly(right)
        solution = self._iterate(right, tolerance, warm_start_key)
        if solution is None and not self._is_exact:  # too far from an isometry
            self.factorize()
            solution = self._iterate(right, tolerance, warm_start_key)
        if solution is None and self._precision is np.float16:  # too ill-conditioned for it
            self._use_double_precision()
            self.factorize()
            solution = self._iterate(right, tolerance, warm_start_key)
        if solution is None:
            solution = self._solve_directly(right)
        return solution

    def solve_once(self, nonzeros: Floats, right: Complexes, is_definite: bool) -> Complexes:
        """B⁻¹ b to double precision, for another matrix B with this pattern, given by its nonzeros (z,).

        is_definite: whether B is known to be positive definite, so that what is too much for half precision
        is factorized in double. Raises SolverError if B is not positive definite.
        """
        if self._other_factors is None:
            self._other_factors = CholeskyFactors(self.symbolic, self._precision)
        try:
            self._other_factors.factorize(nonzeros)
            return self._solve_exactly(self._other_factors, nonzeros, right)
        except SolverError:
            if self._other_factors.precision is np.float64 or not is_definite:
                raise
        self._other_factors = CholeskyFactors(self.symbolic, np.float64)  # from now on
        return self.solve_once(nonzeros, right, is_definite)

    def energy(self, values: Complexes) -> float:
        """xᵀ A x for values x (n,) and the matrix last set."""
        return dot(values, self.multiply(values))

    def multiply(self, values: Complexes) -> Complexes:
        """A x, (n,), for values x (n,) and the matrix last set."""
        result = np.empty_like(values)
        multiply(self._matrix, values, result)
        return result

    def factorize(self) -> None:
        """Factorize the current matrix. Raises SolverError."""
        self._finish_job()
        self._has_factors = False
        nonzeros = self._matrix.nonzeros
        try:
            self._factors.factorize(nonzeros)
        except SolverError:
            if self._precision is np.float64 or not np.isfinite(nonzeros).all():
                raise
            self._use_double_precision()
            self._factors.factorize(nonzeros)
        self._is_exact = True
        self._use_factors_of(self._frame)

    def _use_double_precision(self) -> None:
        """Make all further factors in double precision."""
        self._finish_job()
        self._precision = np.float64
        self._factors = CholeskyFactors(self.symbolic, self._precision)
        self._spare = self._other_factors = None

    def _use_factors_of(self, frame: Complexes) -> None:
        """Begin to use new factors of a matrix at a pose with the rotations ``frame`` (n,)."""
        self._has_factors = True
        self._factorized_frame, self._rotation = frame, self._frame * frame.conj()
        self._wasted_iterations, self._contraction = 0.0, 1.0
        self.factorizations += 1

    def _factorize_beside(self, nonzeros: Floats, frame: Complexes) -> None:
        """Begin to factorize a matrix in another thread, see `prepare`."""
        if self._spare is None:
            self._spare = CholeskyFactors(self.symbolic, self._precision)
        self._job = _FactorizationThread(self._spare, nonzeros, frame)
        self._job.start()
        self._poses_to_wait = self._delay

    def _finish_job(self) -> "_FactorizationThread | None":
        """Wait until nothing is factorized beside; returns the thread if there was one."""
        job, self._job = self._job, None
        if job is not None:
            job.join()
        return job

    def _take_over(self) -> None:
        """Use the factors that were made beside. If they could not be made, the old ones go on serving."""
        job = self._finish_job()
        if job is not None and job.has_factors:
            self._use_factors_made_beside(job)
        else:
            self._wasted_iterations = 0.0

    def _use_factors_made_beside(self, job: "_FactorizationThread") -> None:
        """Exchange the factors for those of a thread that has ended."""
        self._factors, self._spare = job.factors, self._factors
        self._use_factors_of(job.frame)

    def _solve_directly(self, right: Complexes) -> Complexes:
        """A⁻¹ b, (n,), with factors of the current matrix in double precision. Raises SolverError."""
        return self._factors.solve(right.view(np.float64)).view(np.complex128)

    def _solve_exactly(self, factors: CholeskyFactors, nonzeros: Floats, right: Complexes) -> Complexes:
        """B⁻¹ b, (n,), to double precision from factors of the very matrix B. Raises SolverError."""
        if factors.precision is np.float64:
            return factors.solve(right.view(np.float64)).view(np.complex128)
        unrotated, solution = np.ones_like(right), np.empty_like(right)
        count, _, _ = iterate(
            factors.preconditioner(unrotated), self._matrix._replace(nonzeros=nonzeros), right, unrotated,
            np.empty((_WARM_STARTS, len(right)), np.complex128), 0, np.inf, 1.0,
            _EXACT_ITERATIONS, _MAX_ITERATIONS, solution,
        )  # fmt: skip
        if not count:
            raise SolverError("the linear system is not positive definite")
        return solution

    def _iterate(self, right: Complexes, tolerance: float, warm_start_key: str) -> Complexes | None:
        """The solution (n,) by preconditioned conjugate gradients; None if they do not converge soon."""
        earlier, known = np.empty((self._warm_starts, len(right)), np.complex128), 0
        if warm_start_key:
            earlier, known = self._earlier_solutions.get(warm_start_key, (earlier, 0))
        solution, preconditioner = np.empty_like(right), self._factors.preconditioner(self._rotation)
        trusted = 1.0 if self._confirm else min(_CONTRACTION_SAFETY * self._contraction, 1.0)
        count, first, last = iterate(
            preconditioner, self._matrix, right, self._frame, earlier, known, tolerance, trusted,
            self._min_exact_iterations if self._is_exact else 1, _MAX_ITERATIONS, solution,
        )  # fmt: skip
        if not count:
            return None
        self._earlier_solutions[warm_start_key] = earlier, min(known + 1, self._warm_starts)
        if count > 1 and first > 0:
            seen = (last / first) ** (1 / (count - 1))
            self._contraction = max(seen, 0.5 * (seen + self._contraction))
        self.iterations += count
        if not self._is_exact:  # there more iterations are made than the tolerance asks for
            digits = float(np.log10(max(first / tolerance, 1.0))) if tolerance else np.inf
            self._wasted_iterations += max(count - 1 - digits, 0.0)
        return solution


class _FactorizationThread(Thread):
    """Factorizes one matrix beside a drag.

    frame: (n,) the rotations of the vertices at its pose; has_factors: whether it succeeded. A thread and not
    an executor: in a process that was forked meanwhile it counts as ended without success, and nothing waits.
    """

    def __init__(self, factors: CholeskyFactors, nonzeros: Floats, frame: Complexes) -> None:
        super().__init__(name="factorization")
        self.factors, self.frame, self.has_factors = factors, frame, False
        self._nonzeros = nonzeros

    def run(self) -> None:
        """Factorize; a matrix that cannot be factorized leaves no factors."""
        try:
            self.factors.factorize(self._nonzeros)
        except SolverError:
            return
        self.has_factors = True

    def has_factors_of(self, nonzeros: Floats, frame: Complexes) -> bool:
        """Whether it succeeded with this matrix at a pose with these rotations."""
        is_same = np.array_equal(nonzeros, self._nonzeros) and np.array_equal(frame, self.frame)
        return self.has_factors and is_same
