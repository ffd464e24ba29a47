"""Memory of the rest pose: descent on the rest energy, so that stretching does not accumulate."""

from dataclasses import dataclass

import numpy as np

from ...errors import SolverError
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.operators import to_points
from ...geometry.validation import Complexes, Floats
from .killing_field import KillingSystem
from .pin_rotation import PinRotationConstraints
from .preconditioned_cholesky import dot
from .rest_energy import SymmetricDirichlet, line_search

_TOLERANCE = 3e-6  # of a descent direction at every vertex, as a share of √area
_FLIP_MARGIN = 0.9  # share of the step to the first flip that the line search may take
_MIN_RELAXED_VERTICES = 2500  # of a mesh whose faces are relaxed; coarser ones hardly take longer without
_MIN_SHARE = 0.05  # if the line search accepts less than this share, retry with Newton's direction


@dataclass(frozen=True, eq=False)
class PinGoals:
    """The goals of the pins in a substep: positions (k,), and angles (k,) in radians, NaN if free."""

    positions: Complexes
    angles: Floats


class RestMemory:
    """Moves poses towards the rest pose by descent on `SymmetricDirichlet`, with soft pins at their goals.

    mesh: the rest pose; system: with the same pins, prepared at the pose while pins move; stiffness: (m,)
    factors of the faces' energies.
    """

    def __init__(self, mesh: TriMesh, system: KillingSystem, stiffness: Floats | None) -> None:
        self._mesh, self._system = mesh, system
        self._energy = SymmetricDirichlet(mesh, stiffness)

    def set_scales(self, scales: Floats | None) -> None:
        """Remember the rest shape enlarged by scales (m,) of the faces, None for 1."""
        self._energy.set_scales(scales)

    def set_pins(self, points: MeshPoints, rotation: PinRotationConstraints | None) -> None:
        """Choose the pins, k points of the mesh, and the faces that rotate with them."""
        groups = self._system.groups
        pinned = np.unique(groups[self._mesh.faces[points.faces, :1]])
        self._is_unpinned = ~np.isin(groups, pinned)
        self._has_unpinned = bool(self._is_unpinned.any())
        self._rotation = rotation
        self._is_held = np.zeros(len(self._mesh.vertices), dtype=bool)
        self._is_held[self._mesh.faces[points.faces]] = True
        if rotation is not None:
            self._is_held[self._mesh.faces[rotation.faces]] = True
        if self._system.joints is not None:
            self._is_held[self._system.joints.corners] = True

    def descend(self, pose: Complexes, goals: PinGoals, max_step: float, is_moving: bool) -> Complexes:
        """One descent step from the pose (n,); returns the new pose (n,). Raises SolverError.

        max_step: of the line search; 1 is the whole direction. is_moving: whether the system is prepared at
        the pose. Near an isometry, the Hessian of the energy is 2 (K + λ² WᵀW), and the system has its
        factors. If that is no good model, or if the drawing only settles, Newton's direction is taken.
        """
        energy, rotation = self._energy, self._rotation
        offsets = self._system.at_pins(pose) - goals.positions
        start, gradient, columns = energy.evaluate(pose)
        if start == np.inf:  # another method has flipped faces
            return pose
        start += self._system.pin_energy(offsets)
        gradient += 2 * self._system.pin_force(offsets)
        if rotation is not None:
            residuals = rotation.face_rotations(pose) - np.exp(1j * goals.angles[rotation.pins])
            start += rotation.residual_energy(residuals)
            gradient += 2 * rotation.residual_gradient(residuals)
        joints = self._system.joints
        if joints is not None:
            gaps = joints.gaps(pose)
            start += joints.energy(gaps)
            gradient += 2 * joints.pull(gaps)
        if self._has_unpinned:
            gradient[self._is_unpinned] = 0.0

        def search(direction: Complexes) -> tuple[Complexes, float, Complexes]:
            """The pose (n,) after a line search along a direction (n,), the step length, and the columns of
            the whole direction.
            """
            change, first_flip = energy.direction(columns, direction)
            pin_change = self._system.at_pins(direction)
            gap_change = joints.gaps(direction) if joints is not None else 0.0
            rotation_change = rotation.face_rotations(direction) if rotation is not None else 0.0

            def value(step_length: float) -> float:
                total = energy.value(columns, change, step_length)
                total += self._system.pin_energy(offsets + step_length * pin_change)
                if rotation is not None:
                    total += rotation.residual_energy(residuals + step_length * rotation_change)
                if joints is not None:
                    total += joints.energy(gaps + step_length * gap_change)
                return total

            slope = dot(gradient, direction)
            step_length = line_search(value, start, slope, min(max_step, _FLIP_MARGIN * first_flip))
            return pose + step_length * direction, step_length, change

        if is_moving:
            tolerance = _TOLERANCE * self._mesh.length
            direction = -0.5 * self._system.solve(gradient, tolerance, "memory")
            moved, step_length, change = search(direction)
            if step_length >= _MIN_SHARE * max_step:
                if len(pose) >= _MIN_RELAXED_VERTICES:
                    energy.relax(moved, change, step_length, self._is_held)
                return moved
        return search(self._newton_direction(pose, columns, gradient))[0]

    def _newton_direction(self, pose: Complexes, columns: Complexes, gradient: Complexes) -> Complexes:
        """Newton's direction (n,) for the gradient (n,) of rest energy and pin energies at a pose (n,)."""
        if not gradient.any():
            return gradient
        rotation_weights = None if self._rotation is None else self._rotation.rotation_weights

        def solve(convex: bool) -> Complexes:
            nonzeros = self._energy.half_hessian(columns, convex, self._system.blocks, rotation_weights)
            self._system.add_constraints(nonzeros, to_points(pose))
            return -0.5 * self._system.solve_once(nonzeros, gradient, is_definite=convex)

        try:
            return solve(convex=False)
        except SolverError:  # far from a minimum the Hessian has negative eigenvalues
            return solve(convex=True)
