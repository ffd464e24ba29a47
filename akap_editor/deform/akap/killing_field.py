"""As-Killing-as-possible vector fields (paper, sections 2.1 and 2.2)."""

import numpy as np
from numpy.typing import NDArray

from ...geometry.jit import compiled
from ...geometry.killing_matrix import KillingMatrix
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, Ints
from ..cholesky import SymmetricPattern
from .pin_rotation import PinRotationConstraints
from .preconditioned_cholesky import PreconditionedCholesky

_SAME_PLACE = 1e-3  # share of √area: pins nearer than this are at one place


class KillingSystem:
    """The two linear systems of the paper on one mesh: (7) with the pins, (8) with the boundary fixed.

    Both patterns depend on the mesh alone, since a pin couples only vertices of one face: their symbolic
    factorizations are made once. ``pin_weight`` is the paper's λ as in eq. 5, on the row; energies are
    weighted by area, so that its meaning depends neither on the size nor on the density of the mesh.

    A component whose pins are all at one place, at rest or where a bent drawing brings them together, or that
    has none, could turn freely and make (7) singular: the vertices of one of its faces are then held to the
    mean velocity of its pins, or to zero, which moves it without turning.

    With ``exact`` both matrices are factorized at every pose; otherwise now and then (see
    `PreconditionedCholesky`), and fields are as near as ``tolerance``, in pixels.
    ``stiffness`` (m,) multiplies the energies of faces. With ``hard`` U° has exactly the
    pins' velocities, and (7) is always factorized, since many solves go into one field.
    """

    def __init__(
        self,
        mesh: TriMesh,
        pin_weight: float,
        exact: bool = True,
        hard: bool = False,
        tolerance: float = 0.0,
        stiffness: Floats | None = None,
    ) -> None:
        self._mesh = mesh
        self._hard = hard
        self._weight = pin_weight**2
        size = 2 * len(mesh.vertices)
        self._tolerance, self._stiffness = tolerance, stiffness
        self._turning: PinRotationConstraints | None = None
        self._killing = KillingMatrix(mesh)
        self.blocks = self._killing.blocks
        self.pattern = SymmetricPattern(self.blocks.rows, self.blocks.columns, size)
        self._pinned = PreconditionedCholesky(self.pattern, exact or hard)
        on_boundary = np.zeros(len(mesh.vertices), dtype=bool)
        on_boundary[mesh.boundary_vertices] = True
        self._interior = np.flatnonzero(~on_boundary).astype(np.int32)
        self._inner: PreconditionedCholesky | None = None
        if len(self._interior):
            kept = (2 * self._interior[:, None] + np.arange(2)).ravel()
            inner, self._inner_nonzeros = self.pattern.restricted(kept)
            self._inner = PreconditionedCholesky(inner, exact)
        self._first_faces = np.unique(mesh.component[mesh.faces[:, 0]], return_index=True)[1]
        self._same_place = _SAME_PLACE * mesh.length
        self._frames = _VertexFrames(mesh)
        self.set_pins(MeshPoints(np.zeros(0, dtype=np.int32), np.zeros((0, 3))))

    def set_pins(self, points: MeshPoints, turning: PinRotationConstraints | None = None) -> None:
        """Choose the constraints C of eq. 3, and faces whose turning is constrained."""
        self._points, self._turning = points, turning
        self._pin_components = self._mesh.component[self._mesh.faces[points.faces, 0]]
        self._constrain(self._free_components(self._mesh.vertices))

    def _free_components(self, positions: Floats) -> NDArray[np.bool_]:
        """Which components (c,) have no two pins at different places in the pose ``positions`` (n, 2)."""
        places = self._mesh.evaluate(self._points, positions)
        _, first, group = np.unique(self._pin_components, return_index=True, return_inverse=True)
        apart = ((places - places[first][group]) ** 2).sum(axis=1) > self._same_place**2
        free = np.ones(len(self._first_faces), dtype=bool)
        free[self._pin_components[apart]] = False
        if self._turning is not None:
            free[self._pin_components[self._turning.pins]] = False
        return free

    def _constrain(self, free: NDArray[np.bool_]) -> None:
        """Constraints from the pins, and from an anchor face in each of the components ``free``."""
        mesh, points = self._mesh, self._points
        self._free = free
        owners = self._pin_components == np.flatnonzero(free)[:, None]
        count = owners.sum(axis=1)
        self._means = owners / np.maximum(count, 1)[:, None]
        anchors = self._first_faces[free]
        for part in np.flatnonzero(count):
            anchors[part] = points.faces[owners[part].argmax()]
        faces = np.concatenate([points.faces, np.repeat(anchors, 3)])
        weights = np.concatenate([points.weights, np.tile(np.eye(3), (len(anchors), 1))])
        self._corners = mesh.faces[faces]
        self._weights = weights
        outer = self._weight * weights[:, :, None] * weights[:, None, :]
        rows = 2 * np.broadcast_to(self._corners[:, :, None], outer.shape)
        columns = 2 * np.broadcast_to(self._corners[:, None, :], outer.shape)
        lower = rows >= columns
        entries, rows, columns = outer[lower], rows[lower], columns[lower]
        self._pin_entries = np.tile(entries, 2)
        self._pin_slots = self._slots(
            np.concatenate([rows, rows + 1]), np.concatenate([columns, columns + 1])
        )
        # Where all pins sit on boundary vertices, (8) returns what (7) gave.
        interior_vertex = np.zeros(len(mesh.vertices), dtype=bool)
        interior_vertex[self._interior] = True
        inside = interior_vertex[self._corners] & (weights != 0)
        self._needs_interior = bool(inside.any()) or self._turning is not None
        self._pinned.forget()

    def prepare(self, positions: Floats) -> None:
        """Prepare both systems at the pose ``positions`` (n, 2). Raises SolverError."""
        self._anchor(positions)
        spin = None
        if self._turning is not None:
            self._turning.place(positions)
            spin = self._turning.spin
        pose = to_complex(positions)
        nonzeros = self._killing.nonzeros(pose, self._stiffness, spin)
        frames = self._frames(pose)
        if self._inner is not None and self._needs_interior:
            self._inner.prepare(nonzeros[self._inner_nonzeros], frames[self._interior])
        np.add.at(nonzeros, self._pin_slots, self._pin_entries)
        self._pinned.prepare(nonzeros, frames)

    def add_pins(self, nonzeros: Floats, positions: Floats) -> None:
        """Add λ² WᵀW, with the anchors that a pose (n, 2) needs, to the nonzeros of a matrix."""
        self._anchor(positions)
        np.add.at(nonzeros, self._pin_slots, self._pin_entries)

    def _anchor(self, positions: Floats) -> None:
        free = self._free_components(positions)
        if (free != self._free).any():
            self._constrain(free)

    def solve(self, right: Complexes, tolerance: float, like: str) -> Complexes:
        """(K + λ² WᵀW)⁻¹ applied to a vector (n,), at the pose last prepared."""
        return self._pinned.solve(right, tolerance, like)

    def pull(self, offsets: Complexes) -> Complexes:
        """λ² Wᵀ applied to offsets (k,) of the pins: half the gradient of λ² ‖W p − targets‖², (n,)."""
        return self._spread(np.append(self._weight * offsets, np.zeros(len(self._weights) - len(offsets))))

    def field(
        self, velocities: Complexes, dirichlet: bool = True, like: str = "", rates: Floats | None = None
    ) -> tuple[Complexes, Complexes]:
        """U_opt of (8) and U° of (7), (n,) each, for pin velocities (k,), at the pose last prepared.

        rates: (q,) radians per unit of time by which the faces of the `PinRotationConstraints` rotate.

        Hard pins are the limit of (7) for λ → ∞: U° = A⁻¹ Wᵀ (W A⁻¹ Wᵀ)⁻¹ ũ, one solve for each pin.
        (8) is solved as U_opt = U° + K_II⁻¹ f_I on interior vertices, f = −K U°: by (7) λ² Wᵀ(W U° − ũ),
        which would carry λ times the error of U°. Without ``dirichlet`` both are U°.
        """
        wanted = self._constraints(velocities)
        pull = self._reactions(wanted) if self._hard else self._weight * wanted
        turn: Complexes | float = 0.0
        if self._turning is not None and rates is not None:
            turn = self._turning.pull(rates)
        smooth = self._pinned.solve(self._spread(pull) + turn, self._tolerance, like)
        if not dirichlet or self._inner is None or not self._needs_interior:
            return smooth, smooth
        pins = self._spread(self._weight * self._at_constraints(smooth))
        force = pins + turn - self._pinned.multiply(smooth)
        optimal = smooth.copy()
        optimal[self._interior] += self._inner.solve(force[self._interior], self._tolerance, like)
        return optimal, smooth

    def energy(self, field: Complexes) -> float:
        """The Killing energy of a field (n,), eq. 2, at the pose last prepared."""
        other = self._weight * float((np.abs(self._at_constraints(field)) ** 2).sum())
        if self._turning is not None:
            other += self._turning.energy(field)
        return max(self._pinned.energy(field) - other, 0.0)

    def _constraints(self, velocities: Complexes) -> Complexes:
        """Velocities of pins and anchors; an anchor follows the pins of its component, or holds still."""
        return np.concatenate([velocities, np.repeat(self._means @ velocities, 3)])

    def _at_constraints(self, field: Complexes) -> Complexes:
        """W applied to a field (n,)."""
        return np.asarray((self._weights * field[self._corners]).sum(axis=1))

    def _reactions(self, wanted: Complexes) -> Complexes:
        """The pull at the constraints, (c,), under which A⁻¹ Wᵀ has exactly the velocities ``wanted`` there.

        Least squares, since constraints may contradict one another or say the same twice.
        """
        count = len(wanted)
        compliance = np.empty((2 * count, 2 * count))
        for column, unit in enumerate(np.eye(2 * count)):
            answer = self._at_constraints(
                self._pinned.solve(self._spread(to_complex(unit.reshape(-1, 2))), 0.0)
            )
            compliance[:, column] = to_points(answer).ravel()
        reactions = np.linalg.lstsq(compliance, to_points(wanted).ravel(), rcond=1e-12)[0]
        return to_complex(np.asarray(reactions, dtype=np.float64).reshape(-1, 2))

    def _spread(self, values: Complexes) -> Complexes:
        """Wᵀ applied to values (c,) at the constraints."""
        shares = (self._weights * values[:, None]).ravel()
        result = np.zeros(len(self._mesh.vertices), dtype=np.complex128)
        np.add.at(result, self._corners.ravel(), shares)
        return result

    def _slots(self, rows: Ints, columns: Ints) -> Ints:
        keys = self.pattern.columns.astype(np.int64) * self.pattern.size + self.pattern.rows
        return np.searchsorted(keys, columns.astype(np.int64) * self.pattern.size + rows)


class _VertexFrames:
    """How far each vertex is turned from rest: the rotation that fits its edges best."""

    def __init__(self, mesh: TriMesh) -> None:
        rest = to_complex(mesh.vertices)
        self._edges = mesh.edges.copy()
        self._rest = (rest[mesh.edges[:, 0]] - rest[mesh.edges[:, 1]]).conj()

    def __call__(self, positions: Complexes) -> Complexes:
        """Complex numbers of unit size, (n,), for a pose (n,)."""
        return _turns(self._edges, self._rest, positions)


@compiled
def _turns(edges: Ints, rest: Complexes, positions: Complexes) -> Complexes:
    """Σ over the edges of vertex i of (pᵢ − pⱼ) conj(rᵢ − rⱼ), made of unit size."""
    result = np.zeros_like(positions)
    for e in range(len(edges)):
        i, j = edges[e, 0], edges[e, 1]
        product = (positions[i] - positions[j]) * rest[e]
        result[i] += product
        result[j] += product
    for i in range(len(result)):
        size = abs(result[i])
        result[i] = result[i] / size if size > 0 else 1.0 + 0.0j
    return result
