"""Follow-through: loose parts lag behind the pose, overshoot and settle.

The pose q stays what it is; shown is x. On the loose faces, from step to step of h seconds,

    x' = argmin Σ A (‖J‖² + ‖J⁻¹‖²) + Σ m |x − (x_n + h v_n e^(−c h))|² / h²,

with J the Jacobian from q to x, so that at rest x = q. That is implicit Euler as a minimization
(Martin et al. 2011, "Example-Based Elastic Materials"), here one step of Newton's method with a line search,
which flips no face. The masses m follow from the speed at which each part is to swing.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import eigsh

from ..errors import SolverError
from ..geometry.killing_matrix import KillingMatrix, Triangles
from ..geometry.mesh import TriMesh
from ..geometry.operators import hat_gradients, to_complex, to_points
from ..geometry.validation import Complexes, Floats, Ints
from .akap.preconditioned_cholesky import dot
from .akap.rest_energy import SymmetricDirichlet, line_search
from .cholesky import SparseCholesky, SymmetricPattern
from .dissection import dissect

STEP_SECONDS = 1 / 60
MIN_SPEED, MAX_SPEED, DEFAULT_SPEED = 0.5, 8.0, 3.0  # swings a second
MAX_BOUNCE, DEFAULT_BOUNCE = 0.8, 0.5  # what is left of a swing after half a period
_LONGEST_JUMP = 0.25  # share of √area: a pose that jumps farther in a step was undone or cut, nothing swings
_SETTLED = 0.02  # pixels: a part nearer than this to its pose, and slower in a step, has settled
_FLIP_MARGIN = 0.9  # share of the step to the first flip that the line search may take
_MOST_SUBSTEPS = 4  # implicit Euler damps by ω h / 2, which leaves less than much bounce
_LEAST_BOUNCE = 1e-3


@dataclass(frozen=True, eq=False)
class SwingState:
    """Where loose parts are, (v,) complex, their velocities in pixels a second, and the pose there.

    is_settled: whether they are where the pose has them, at rest.
    """

    positions: Complexes
    velocities: Complexes
    pose: Complexes
    is_settled: bool


class FollowThrough:
    """Lets loose faces of a mesh swing about the poses that they are given.

    loose: (m,) bool; anchors: faces whose vertices stay where the pose has them, for example those of pins;
    speed: swings a second; bounce: from 0 to `MAX_BOUNCE`, what is left of a swing after half a period. Of a
    part some vertex must be held, by an anchor or by faces that are not loose; else it does not swing.
    """

    def __init__(
        self, mesh: TriMesh, loose: NDArray[np.bool_], anchors: Ints, speed: float, bounce: float
    ) -> None:
        self._count = len(mesh.vertices)
        self._longest_jump = _LONGEST_JUMP * mesh.length
        is_held = np.zeros(self._count, dtype=bool)
        is_held[mesh.faces[~loose]] = True
        is_held[mesh.faces[anchors]] = True
        self._vertices = np.unique(mesh.faces[loose])
        number = np.full(self._count, -1)
        number[self._vertices] = np.arange(len(self._vertices))
        self._faces = number[mesh.faces[loose]].astype(np.int32)
        part = Triangles(mesh.vertices[self._vertices], self._faces)
        self._free = self._swinging(part, is_held[self._vertices])
        self._masses = np.zeros(0)
        if self.is_empty:
            return
        self._killing = KillingMatrix(part)
        blocks = self._killing.blocks
        pattern = SymmetricPattern(blocks.rows, blocks.columns, 2 * len(self._vertices))
        unknowns = (2 * self._free[:, None] + np.arange(2)).ravel()
        inner, self._chosen = pattern.restrict(unknowns)
        free_number = np.full(len(self._vertices), -1)
        free_number[self._free] = np.arange(len(self._free))
        free_edges = free_number[part.edges]
        free_edges = free_edges[(free_edges >= 0).all(axis=1)]
        self._cholesky = SparseCholesky(inner, dissect(part.vertices[self._free], free_edges))
        self._masses = self._swing_masses(part, inner, free_edges, speed)
        self._diagonal = blocks.slots.vertices[self._free].astype(np.int64)
        self._substeps, self._drag = _damping(speed, bounce)

    @property
    def is_empty(self) -> bool:
        """Whether nothing swings."""
        return not len(self._free)

    @property
    def free_count(self) -> int:
        """The number of vertices that swing."""
        return len(self._free)

    def start(self, pose: Floats) -> SwingState:
        """The state in which loose parts are at rest in a pose (n, 2)."""
        goal = self._part_of(pose)
        return SwingState(goal, np.zeros_like(goal), goal, True)

    def step(self, state: SwingState, pose: Floats, seconds: float = STEP_SECONDS) -> SwingState:
        """The state some seconds later, in which the pose is ``pose`` (n, 2)."""
        goal = self._part_of(pose)
        moved = np.abs(goal - state.pose).max(initial=0.0)
        if self.is_empty or (state.is_settled and moved == 0) or seconds <= 0:
            return state if moved == 0 else self.start(pose)
        if moved > self._longest_jump:
            return self.start(pose)
        substeps = self._substeps
        begin = state.pose
        for k in range(1, substeps + 1):
            between = goal if k == substeps else begin + k / substeps * (goal - begin)
            state = self._substep(state, between, seconds / substeps)
        return state

    def shown(self, state: SwingState, pose: Floats) -> Floats:
        """The pose (n, 2) that is shown: ``pose`` itself when the state has settled."""
        if state.is_settled or self.is_empty:
            return pose
        result = pose.copy()
        result[self._vertices[self._free]] = to_points(state.positions[self._free])
        return result

    def energy(self, state: SwingState) -> float:
        """Energy of deformation and of motion beyond that of the pose, square pixels."""
        energy = self._energy(state.pose)
        value = energy.evaluate(state.positions)[0] - energy.evaluate(state.pose)[0]
        return value + float(self._masses @ np.abs(state.velocities[self._free]) ** 2)

    def _part_of(self, pose: Floats) -> Complexes:
        return to_complex(np.ascontiguousarray(pose[self._vertices]))

    def _energy(self, goal: Complexes) -> SymmetricDirichlet:
        return SymmetricDirichlet(Triangles(to_points(goal), self._faces))

    def _substep(self, state: SwingState, goal: Complexes, h: float) -> SwingState:
        """One step of h seconds to a pose (v,)."""
        if hat_gradients(to_points(goal), self._faces)[2].min() <= 0:  # another method has flipped faces
            return SwingState(goal, np.zeros_like(goal), goal, True)
        energy, free = self._energy(goal), self._free
        masses = self._masses / h**2
        predicted = state.positions[free] + h * np.exp(-self._drag * h) * state.velocities[free]
        x = goal.copy()
        x[free] = state.positions[free] + (goal - state.pose)[free]  # carried along with its root
        value, gradient, columns = energy.evaluate(x)
        if not np.isfinite(value):
            x = goal.copy()
            value, gradient, columns = energy.evaluate(x)
        offsets = x[free] - predicted
        slopes = gradient[free] + 2 * masses * offsets
        direction = np.zeros_like(x)
        direction[free] = self._newton_direction(energy, columns, masses, slopes)
        change, first_flip = energy.direction(columns, direction)

        def total(share: float) -> float:
            away = offsets + share * direction[free]
            return energy.value(columns, change, share) + float(masses @ (away.real**2 + away.imag**2))

        slope = dot(slopes, direction[free])
        x = x + line_search(total, total(0.0), slope, min(1.0, _FLIP_MARGIN * first_flip)) * direction
        velocities = np.zeros_like(x)
        velocities[free] = (x - state.positions)[free] / h
        is_settled = bool(
            np.abs(x - goal).max() < _SETTLED and np.abs(velocities).max() * STEP_SECONDS < _SETTLED
        )
        if is_settled:
            return SwingState(goal, np.zeros_like(goal), goal, True)
        return SwingState(x, velocities, goal, False)

    def _newton_direction(
        self, energy: SymmetricDirichlet, columns: Complexes, masses: Floats, slopes: Complexes
    ) -> Complexes:
        for convex in (False, True):  # far from a minimum the Hessian has negative eigenvalues
            nonzeros = energy.half_hessian(columns, convex, self._killing.blocks)
            nonzeros[self._diagonal[:, 0]] += masses
            nonzeros[self._diagonal[:, 1]] += masses
            try:
                self._cholesky.factorize(nonzeros[self._chosen])
                break
            except SolverError:
                if convex:
                    raise
        return -0.5 * to_complex(self._cholesky.solve(slopes.view(np.float64)).reshape(-1, 2))

    @staticmethod
    def _swinging(part: Triangles, is_held: Ints) -> Ints:
        """The free vertices of connected parts of which something is held, int32."""
        count = len(part.vertices)
        graph = coo_array((np.ones(len(part.edges)), part.edges.T), shape=(count, count))
        labels = connected_components(graph, directed=False)[1]
        has_root = np.zeros(count, dtype=bool)
        has_root[labels[is_held]] = True
        free: Ints = np.flatnonzero(~is_held & has_root[labels]).astype(np.int32)
        return free

    def _swing_masses(
        self, part: Triangles, inner: SymmetricPattern, free_edges: Ints, speed: float
    ) -> Floats:
        """The masses (f,) with which the slowest swing of each connected free part has the speed.

        Near the pose the energy is wᵀ K w, so that ω² is the lowest eigenvalue of K x = λ M x.
        """
        thirds = np.repeat(hat_gradients(part.vertices, self._faces)[2] / 3, 3)
        areas: Floats = np.bincount(self._faces.ravel(), thirds, len(part.vertices))[self._free].astype(float)
        nonzeros = self._killing.nonzeros(to_complex(part.vertices))[self._chosen]
        size, count = inner.size, len(self._free)
        lower = coo_array((nonzeros, (inner.rows, inner.columns)), shape=(size, size)).tocsc()
        diagonal = coo_array((lower.diagonal(), (np.arange(size), np.arange(size))), shape=(size, size))
        matrix = (lower + lower.T - diagonal).tocsc()
        graph = coo_array((np.ones(len(free_edges)), free_edges.T), shape=(count, count))
        labels = connected_components(graph, directed=False)[1]
        masses = np.empty(count, dtype=np.float64)
        for label in range(labels.max() + 1):
            members = np.flatnonzero(labels == label)
            unknowns = (2 * members[:, None] + np.arange(2)).ravel()
            stiffness, weights = matrix[unknowns][:, unknowns], np.repeat(areas[members], 2)
            if len(unknowns) <= 8:
                scaled = stiffness.toarray() / np.sqrt(weights[:, None] * weights)
                lowest = float(np.linalg.eigvalsh(scaled)[0])
            else:
                mass = coo_array((weights, (np.arange(len(weights)),) * 2)).tocsc()
                start = np.ones(len(unknowns))  # else it would be random
                found = eigsh(stiffness, k=1, M=mass, sigma=0.0, v0=start, return_eigenvectors=False)
                lowest = float(found[0])
            masses[members] = areas[members] * lowest / (2 * np.pi * speed) ** 2
        return masses


def _damping(speed: float, bounce: float) -> tuple[int, float]:
    """Substeps of a step, and the drag c in 1/s, for a swing of which ``bounce`` is left after half a period.

    Implicit Euler alone damps with the ratio ω h / 2; shorter substeps damp less.
    """
    omega, decrement = 2 * np.pi * speed, -np.log(max(bounce, _LEAST_BOUNCE))
    ratio = decrement / np.hypot(np.pi, decrement)  # of the damping to the critical one
    for substeps in range(1, _MOST_SUBSTEPS + 1):
        drag = 2 * omega * (ratio - omega * STEP_SECONDS / substeps / 2)
        if drag >= 0:
            break
    return substeps, max(drag, 0.0)
