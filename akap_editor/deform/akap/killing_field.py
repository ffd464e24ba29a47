"""As-Killing-as-possible vector fields (paper, sections 2.1 and 2.2)."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...geometry.jit import compiled
from ...geometry.joints import JointRows
from ...geometry.killing_matrix import KillingMatrix
from ...geometry.mesh import NO_POINTS, MeshPoints, TriMesh
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, Indices, Ints
from ..cholesky import SymmetricPattern
from ..deformer import SAME_PLACE
from .joint_frames import JointFrames
from .pin_rotation import PinRotationConstraints
from .preconditioned_cholesky import PreconditionedCholesky

_DEFAULT_GROUP = 8  # vertices eliminated together in a mesh that is not in elimination order


class KillingSystem:
    """The two linear systems of the paper on one mesh: (7) with the pins, (8) with the boundary fixed.

    pin_weight: λ as in eq. 5, the factor of a row; energies are weighted by area, so that its effect depends
    neither on the size nor on the density of the mesh.
    exact: factorize both matrices at every pose; otherwise only if necessary, see `PreconditionedCholesky`.
    hard: U° has exactly the velocities of the pins. (7) is then factorized at every pose, since a field takes
    many solves.
    tolerance: error of fields that were not factorized for, in pixels.
    stiffness: (m,) factors of the faces' energies.
    elimination: (f + 1,) the groups of vertices of a mesh in elimination order, see `Dissection.starts`; by
    default a few vertices each, which is right for any mesh, but slow for a large one.
    confirm: see `PreconditionedCholesky`.
    joints: rows that hold components together. They count as material: both systems contain K + JᵀJ, so that
    rigid motions stay exact (Lemma 1), and fields close the gaps that strong rows have at the pose.

    Both sparsity patterns depend on the mesh alone, because a pin couples only the vertices of one face. So
    the symbolic factorizations are computed once.

    A component without pins, or with all its pins at one place, could rotate freely and make (7) singular. It
    gets an anchor: the vertices of one of its faces follow the mean velocity of its pins, or stay, so that it
    translates without rotating. Pins may come to one place in a pose even if they are apart at rest.
    """

    def __init__(
        self,
        mesh: TriMesh,
        pin_weight: float,
        exact: bool = True,
        hard: bool = False,
        tolerance: float = 0.0,
        stiffness: Floats | None = None,
        elimination: Ints | None = None,
        confirm: bool = True,
        joints: JointRows | None = None,
        groups: Ints | None = None,
    ) -> None:
        self._mesh = mesh
        self.joints, self.groups = joints, mesh.component if groups is None else groups
        n = len(mesh.vertices)
        if elimination is None:
            elimination = np.append(np.arange(0, n, _DEFAULT_GROUP), n)
        self._hard = hard
        self._weight = pin_weight**2
        size = 2 * len(mesh.vertices)
        self._tolerance, self._stiffness = tolerance, stiffness
        self._rotation: PinRotationConstraints | None = None
        self._killing = KillingMatrix(mesh, None if joints is None else joints.links)
        self.blocks = self._killing.blocks
        self.pattern = SymmetricPattern(self.blocks.rows, self.blocks.columns, size)
        self._pinned_system = PreconditionedCholesky(self.pattern, exact or hard, elimination, confirm)
        on_boundary = np.zeros(len(mesh.vertices), dtype=bool)
        on_boundary[mesh.boundary_vertices] = True
        self._interior = np.flatnonzero(~on_boundary)
        self._interior_system: PreconditionedCholesky | None = None
        if len(self._interior):
            unknowns = (2 * self._interior[:, None] + np.arange(2)).ravel()
            inner, chosen = self.pattern.restrict(unknowns)
            self._inner_nonzeros = chosen.astype(np.intp)
            groups = np.unique(np.searchsorted(self._interior, elimination))
            self._interior_system = PreconditionedCholesky(inner, exact, groups, confirm)
        self._first_faces = np.unique(self.groups[mesh.faces[:, 0]], return_index=True)[1]
        if joints is not None:
            entries, rows, columns = joints.entries()
            self._joint_entries, self._joint_slots = entries, self._slots(rows, columns)
            self._joint_gaps = np.zeros(len(joints.strengths), dtype=np.complex128)
            self._joint_frames = JointFrames(mesh, joints)
        self._same_place = SAME_PLACE * mesh.length
        self._frames = VertexFrames(mesh)
        self.set_pins(NO_POINTS)

    def set_pins(self, points: MeshPoints, rotation: PinRotationConstraints | None = None) -> None:
        """Choose the constraints C of eq. 3, k points, and the faces that rotate with pins."""
        self._points, self._rotation = points, rotation
        self._pin_components = self.groups[self._mesh.faces[points.faces, 0]]
        _, first, group = np.unique(self._pin_components, return_index=True, return_inverse=True)
        self._first_pins = first[group]  # of each pin's component
        self._constrain(self._free_components(self._mesh.vertices))

    def _free_components(self, positions: Floats) -> NDArray[np.bool_]:
        """Which components (c,) need an anchor: those without two pins apart in the pose (n, 2)."""
        pins = self._mesh.evaluate(self._points, positions)
        apart = ((pins - pins[self._first_pins]) ** 2).sum(axis=1) > self._same_place**2
        free = np.ones(len(self._first_faces), dtype=bool)
        free[self._pin_components[apart]] = False
        if self._rotation is not None:
            free[self._pin_components[self._rotation.pins]] = False
        return free

    def _constrain(self, free: NDArray[np.bool_]) -> None:
        """Set the constraints: the pins, and an anchor in each component that is ``free`` (c,)."""
        mesh, points = self._mesh, self._points
        self._free = free
        is_own = self._pin_components == np.flatnonzero(free)[:, None]
        count = is_own.sum(axis=1)
        self._means = is_own / np.maximum(count, 1)[:, None]
        anchors = self._first_faces[free]
        for component in np.flatnonzero(count):
            anchors[component] = points.faces[is_own[component].argmax()]
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
        # With all pins on boundary vertices, the solution of (7) solves (8).
        is_interior = np.zeros(len(mesh.vertices), dtype=bool)
        is_interior[self._interior] = True
        is_inside = is_interior[self._corners] & (weights != 0)
        self._needs_interior = bool(is_inside.any()) or self._rotation is not None
        self._pinned_system.invalidate()

    def prepare(self, positions: Floats) -> None:
        """Set the pose (n, 2) of both systems. Raises SolverError if one is singular."""
        for system, nonzeros, frames in self._matrices(positions):
            system.prepare(nonzeros, frames)

    def factorize_ahead(self, positions: Floats) -> None:
        """Begin to factorize beside what `prepare` will factorize at the pose (n, 2)."""
        for system, nonzeros, frames in self._matrices(positions):
            system.factorize_ahead(nonzeros, frames)

    def _matrices(self, positions: Floats) -> Iterator[tuple[PreconditionedCholesky, Floats, Complexes]]:
        """The systems that fields need at a pose (n, 2), each with its nonzeros and rotations from rest."""
        self._set_anchors(positions)
        rotation_weights = None
        if self._rotation is not None:
            self._rotation.set_pose(positions)
            rotation_weights = self._rotation.rotation_weights
        pose = to_complex(positions)
        nonzeros = self._killing.nonzeros(pose, self._stiffness, rotation_weights)
        self.measure_gaps(pose)
        if self.joints is not None:
            np.add.at(nonzeros, self._joint_slots, self._joint_entries)
        frames = self._frames(pose)
        if self.joints is not None:
            frames = self._joint_frames.blend(frames)
        if self._interior_system is not None and self._needs_interior:
            yield self._interior_system, nonzeros.take(self._inner_nonzeros), frames[self._interior]
        np.add.at(nonzeros, self._pin_slots, self._pin_entries)
        yield self._pinned_system, nonzeros, frames

    def measure_gaps(self, pose: Complexes) -> None:
        """Let the next fields close the gaps that the joints have at the pose (n,)."""
        if self.joints is not None:
            self._joint_gaps = np.where(self.joints.is_strong, self.joints.gaps(pose), 0.0)

    def add_constraints(self, nonzeros: Floats, positions: Floats) -> None:
        """Add λ² WᵀW, with the anchors that a pose (n, 2) needs, to ``nonzeros`` (z,) in place.

        The rows of joints are added, too.
        """
        self._set_anchors(positions)
        np.add.at(nonzeros, self._pin_slots, self._pin_entries)
        if self.joints is not None:
            np.add.at(nonzeros, self._joint_slots, self._joint_entries)

    def _set_anchors(self, positions: Floats) -> None:
        """Update the constraints if other components need an anchor in the pose (n, 2)."""
        free = self._free_components(positions)
        if (free != self._free).any():
            self._constrain(free)

    def solve(self, right: Complexes, tolerance: float, warm_start_key: str) -> Complexes:
        """(K + λ² WᵀW)⁻¹ b for a right-hand side b (n,), at the pose last prepared.

        tolerance and warm_start_key: as in `PreconditionedCholesky.solve`.
        """
        return self._pinned_system.solve(right, tolerance, warm_start_key)

    def solve_once(self, nonzeros: Floats, right: Complexes, is_definite: bool) -> Complexes:
        """B⁻¹ b for another matrix B with the pattern of (7), see `PreconditionedCholesky.solve_once`."""
        return self._pinned_system.solve_once(nonzeros, right, is_definite)

    def at_pins(self, values: Complexes) -> Complexes:
        """W p, (k,), for values p (n,) at the vertices: e.g. the positions of the pins in a pose."""
        count = len(self._points)
        return np.asarray((self._weights[:count] * values[self._corners[:count]]).sum(axis=1))

    def pin_energy(self, offsets: Complexes) -> float:
        """λ² ‖r‖² for offsets r (k,) of the pins."""
        return self._weight * float(np.vdot(offsets, offsets).real)

    def pin_force(self, offsets: Complexes) -> Complexes:
        """λ² Wᵀ r for offsets r (k,) of the pins: half the gradient of λ² ‖W p − targets‖², (n,)."""
        return self._scatter(np.append(self._weight * offsets, np.zeros(len(self._weights) - len(offsets))))

    def field(
        self,
        velocities: Complexes,
        dirichlet: bool = True,
        warm_start_key: str = "",
        rates: Floats | None = None,
    ) -> tuple[Complexes, Complexes]:
        """U_opt of (8) and U° of (7), (n,) each, for pin velocities (k,), at the pose last prepared.

        dirichlet: solve (8); otherwise U° is returned twice. rates: (q,) radians per unit of time at which
        the faces of the `PinRotationConstraints` rotate. warm_start_key: see `PreconditionedCholesky.solve`.

        Hard pins are the limit of (7) for λ → ∞: U° = A⁻¹ Wᵀ (W A⁻¹ Wᵀ)⁻¹ ũ, one solve for each pin.
        (8) is solved as U_opt = U° + K_II⁻¹ f_I on the interior vertices I, with f = −K U°. By (7), f equals
        λ² Wᵀ(W U° − ũ), but that would multiply the error of U° by λ.
        """
        prescribed = self._constraint_velocities(velocities)
        forces = self._reactions(prescribed) if self._hard else self._weight * prescribed
        further_force: Complexes | float = 0.0
        if self._rotation is not None and rates is not None:
            further_force = self._rotation.pin_force(rates)
        if self.joints is not None:
            further_force = further_force - self.joints.pull(self._joint_gaps)
        right = self._scatter(forces) + further_force
        smooth = self._pinned_system.solve(right, self._tolerance, warm_start_key)
        if not dirichlet or self._interior_system is None or not self._needs_interior:
            return smooth, smooth
        pin_force = self._scatter(self._weight * self._at_constraints(smooth))
        force = pin_force + further_force - self._pinned_system.multiply(smooth)
        optimal = smooth.copy()
        optimal[self._interior] += self._interior_system.solve(
            force[self._interior], self._tolerance, warm_start_key
        )
        return optimal, smooth

    def energy(self, field: Complexes) -> float:
        """The Killing energy of a field (n,), eq. 2, at the pose last prepared."""
        constraint_energy = self._weight * float((np.abs(self._at_constraints(field)) ** 2).sum())
        if self._rotation is not None:
            constraint_energy += self._rotation.energy(field)
        if self.joints is not None:
            constraint_energy += self.joints.energy(self.joints.gaps(field))
        return max(self._pinned_system.energy(field) - constraint_energy, 0.0)

    def _constraint_velocities(self, velocities: Complexes) -> Complexes:
        """Velocities of pins and anchors, (c,); an anchor has the mean velocity of its component's pins."""
        return np.concatenate([velocities, np.repeat(self._means @ velocities, 3)])

    def _at_constraints(self, field: Complexes) -> Complexes:
        """W U, (c,), for a field U (n,)."""
        return np.asarray((self._weights * field[self._corners]).sum(axis=1))

    def _reactions(self, velocities: Complexes) -> Complexes:
        """The forces at the constraints, (c,), whose field A⁻¹ Wᵀ f has the ``velocities`` (c,) there.

        By least squares, since constraints may contradict or repeat one another.
        """
        count = len(velocities)
        compliance = np.empty((2 * count, 2 * count))
        for column, unit in enumerate(np.eye(2 * count)):
            field = self._pinned_system.solve(self._scatter(to_complex(unit.reshape(-1, 2))), 0.0)
            compliance[:, column] = to_points(self._at_constraints(field)).ravel()
        reactions = np.linalg.lstsq(compliance, to_points(velocities).ravel(), rcond=1e-12)[0]
        return to_complex(np.asarray(reactions, dtype=np.float64).reshape(-1, 2))

    def _scatter(self, values: Complexes) -> Complexes:
        """Wᵀ f, (n,), for values f (c,) at the constraints."""
        shares = (self._weights * values[:, None]).ravel()
        result = np.zeros(len(self._mesh.vertices), dtype=np.complex128)
        np.add.at(result, self._corners.ravel(), shares)
        return result

    def _slots(self, rows: Ints, columns: Ints) -> Ints:
        """The indices of matrix entries in the nonzeros of `pattern`."""
        return self.pattern.find(rows, columns)


class VertexFrames:
    """The rotation of each vertex from rest: the one that fits its edges best."""

    def __init__(self, mesh: TriMesh) -> None:
        rest = to_complex(mesh.vertices)
        self._edges = mesh.edges.astype(np.uint32)
        self._rest = (rest[mesh.edges[:, 0]] - rest[mesh.edges[:, 1]]).conj()

    def __call__(self, positions: Complexes) -> Complexes:
        """Unit complex numbers, (n,), at a pose (n,)."""
        return _edge_rotations(self._edges, self._rest, positions)


@compiled
def _edge_rotations(edges: Indices, rest: Complexes, positions: Complexes) -> Complexes:
    """Σ (pᵢ − pⱼ) conj(rᵢ − rⱼ) over the edges of each vertex i, normalized; 1 if the sum vanishes."""
    result = np.zeros_like(positions)
    for e in range(len(edges)):
        i, j = edges[e, 0], edges[e, 1]
        product = (positions[i] - positions[j]) * rest[e]
        result[i] += product
        result[j] += product
    for i in range(len(result)):
        size = np.sqrt(result[i].real ** 2 + result[i].imag ** 2)
        result[i] = result[i] / size if size > 0 else 1.0 + 0.0j
    return result
