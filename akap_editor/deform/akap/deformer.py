"""The deformer of the paper: vector field, Dirichlet solve, log spirals; and memory of the rest pose."""

import math
import time
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import SolverError
from ...geometry.joints import JointRows, MeshJoints, joined_groups
from ...geometry.mesh import NO_POINTS, MeshPoints, TriMesh
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import (
    Complexes,
    Floats,
    as_choice,
    as_indices,
    as_number,
    as_numbers,
    as_points,
    as_switch,
)
from ..deformer import Deformer, StepReport, StepResult, as_targets
from .elimination_order import EliminationOrder
from .flips import count_flipped, is_acceptable
from .killing_field import KillingSystem
from .log_spiral import LogSpirals, linear_flow, spiral_factor
from .pin_rotation import PinRotationConstraints
from .rest_memory import PinGoals, RestMemory

Trajectory = Literal["spiral", "linear"]
Constraints = Literal["soft", "hard"]

# Lengths are shares of √area.
_MAX_STEP, _MAX_STEP_WITH_MEMORY = 0.007, 0.05  # of a pin in one substep; without memory errors accumulate
_TOLERANCE, _TOLERANCE_WITH_MEMORY = 1e-8, 1e-6  # of a field at every vertex
_PIN_TOLERANCE = 1e-4  # offset of a pin within which it has arrived
_ANGLE_TOLERANCE = 1e-3  # radians within which the rotation of a pin has arrived
_MAX_ROTATION = 0.1  # radians that a pin rotates in one substep
_MAX_RETRIES = 3  # of a substep that was blocked
_MAX_SUBSTEPS = 400  # of one step, retries not counted; targets that are farther are not reached
_MAX_BLOCKED = 10  # successive substeps that are blocked after their retries; then the step ends
MAX_CORRECTIONS = 2  # of the pins after a step
_MAX_CORRECTION_FACTOR = 4.0  # of the field of a correction
_MAX_LEVER = 10.0  # displacement of a vertex as a multiple of the largest pin offset, if that exceeds √area
_MIN_SHARE = 2.0**-10  # of a substep; a shorter move is not made
_MIN_AREA_SHARE = 1e-2  # of its rest area that a face keeps in a move
_MIN_STIFFNESS, _MAX_STIFFNESS = 1e-3, 1e6


@dataclass(frozen=True, eq=False)
class Substep:
    """One field, followed from the pose ``start`` for the time ``share``, and then memory and corrections.

    start, field, end: (n,); end: the pose after memory and corrections; share: below 1 if a face blocked.
    """

    start: Complexes
    field: Complexes
    share: float
    end: Complexes


class AkapDeformer(Deformer):
    """As-Killing-as-possible deformation (Solomon, Ben-Chen, Butscher and Guibas 2011).

    mesh: the rest pose.
    memory: 0 is the paper's method, whose result depends on the path of the pins; with more, up to 1, each
    substep also descends on the rest energy.
    dirichlet: solve (4), too. trajectory: "spiral" (16) or "linear". The four combinations of both are the
    variants of Fig. 8.
    pin_weight: λ of eq. 5, the factor of a row; with area-weighted energies, 10 to 1000 behave alike.
    max_step: largest step of a pin in one substep, as a share of √area; longer ones are divided, because
    following one field too far distorts (Fig. 2). By default 0.007 without memory and 0.05 with it; with
    memory, the pose does not depend on it.
    constraints: "soft" pins attract the field with λ as in eq. 3; "hard" ones give U° exactly their
    velocities (Fig. 3).
    exact: factorize both systems in every substep, as the paper does. Otherwise factors are reused, and poses
    differ by less than a hundredth of a pixel at 1000 × 1000 pixels.
    stiffness: (m,) factors of the faces' energies, from 1e-3 to 1e6.
    joints: hold components together, in the same linear solve.
    Raises InputError for arguments out of range.
    """

    holds_angles = True
    takes_stiffness = True
    has_memory = True
    has_vector_fields = True
    takes_joints = True
    takes_scales = True

    def __init__(
        self,
        mesh: TriMesh,
        memory: float = 0.0,
        dirichlet: bool = True,
        trajectory: Trajectory = "spiral",
        pin_weight: float = 100.0,
        max_step: float | None = None,
        constraints: Constraints = "soft",
        exact: bool = False,
        stiffness: ArrayLike | None = None,
        joints: MeshJoints | None = None,
    ) -> None:
        self._memory_strength = as_number(memory, "memory", 0, 1)
        as_choice(trajectory, "trajectory", ("spiral", "linear"))
        as_choice(constraints, "constraints", ("soft", "hard"))
        as_switch(exact, "exact")
        as_number(pin_weight, "pin_weight", 1e-3, 1e6)
        if max_step is None:
            max_step = _MAX_STEP_WITH_MEMORY if memory else _MAX_STEP
        as_number(max_step, "max_step", 1e-4, math.inf)
        self._stiffness: Floats | None = None
        if stiffness is not None:
            count = len(mesh.faces)
            self._stiffness = as_numbers(stiffness, "stiffness", count, _MIN_STIFFNESS, _MAX_STIFFNESS)
        joints = joints if joints is not None and len(joints) else None
        rows = None if joints is None else JointRows(mesh, joints)
        self._order = EliminationOrder(mesh, None if rows is None else rows.links)
        if self._stiffness is not None:
            self._stiffness = self._order.face_values(self._stiffness)
        mesh = self._mesh = self._order.mesh
        self._joints: JointRows | None = None
        self._groups = mesh.component  # of components that are joined
        if rows is not None:
            self._joints, self._groups = self._order.joint_rows(rows), joined_groups(mesh, rows.components)
        self._dirichlet = as_switch(dirichlet, "dirichlet")
        self._max_step = max_step * mesh.length
        # Soft pins give way a little to the rest memory. With memory, they are not moved back from within the
        # tolerance: the pose would never settle.
        self._pin_tolerance = _PIN_TOLERANCE * mesh.length
        self._min_offset = self._pin_tolerance if memory else 0.0
        self._pin_weight = pin_weight
        self._hard = constraints == "hard"
        tolerance = mesh.length * (_TOLERANCE_WITH_MEMORY if memory else _TOLERANCE)
        confirm = not memory  # without memory errors accumulate along the path
        self._system = KillingSystem(
            *(mesh, pin_weight, exact, self._hard, tolerance, self._stiffness, self._order.starts, confirm),
            *(self._joints, self._groups),
        )
        self._exact_system: KillingSystem | None = None
        self._has_spirals = trajectory == "spiral"
        self._flow = LogSpirals(mesh).flow if self._has_spirals else linear_flow
        self._memory = RestMemory(mesh, self._system, self._stiffness)
        self._faces, self._min_areas = mesh.faces.astype(np.uint32), _MIN_AREA_SHARE * mesh.rest_areas
        self._scales: Floats | None = None
        self._given_scales: ArrayLike | None = None
        self.set_pins(NO_POINTS)

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins, k points of the mesh; moves nothing.

        Raises InputError for points with faces that the mesh does not have.
        """
        as_indices(points.faces, "points.faces", None, len(self._mesh.faces))
        self._points = self._order.points(points)
        self._set_angle_pins(np.zeros(len(points), dtype=bool))

    def prepare(self, positions: ArrayLike) -> None:
        """Make the factors for a step from the pose (n, 2) beside, see `Deformer.prepare`.

        Those of pins that hold angles are made in the step.
        """
        pose = self._order.pose(as_points(positions, "positions", len(self._mesh.vertices)))
        if len(self._points):
            self._system.factorize_ahead(to_points(pose))

    def set_scales(self, scales: ArrayLike | None) -> None:
        """Remember the rest shape enlarged, see `Deformer`; without memory this has no effect."""
        if scales is self._given_scales or not self._memory_strength:
            return
        self._given_scales, self._scales = scales, None
        min_areas = _MIN_AREA_SHARE * self._mesh.rest_areas
        if scales is not None:
            count = len(self._mesh.faces)
            self._scales = self._order.face_values(as_numbers(scales, "scales", count, 1e-3, 1e3))
            min_areas = min_areas * self._scales**2
        self._min_areas = min_areas
        self._memory.set_scales(self._scales)
        if self._pin_rotation is not None:
            self._pin_rotation.set_scales(self._scales)

    def _set_angle_pins(self, has_angle: NDArray[np.bool_]) -> None:
        """Choose which pins (k,) hold an angle."""
        self._has_angle = has_angle
        self._pin_rotation: PinRotationConstraints | None = None
        if has_angle.any():
            self._pin_rotation = PinRotationConstraints(self._mesh, self._points, has_angle)
            self._pin_rotation.set_scales(self._scales)
        self._system.set_pins(self._points, self._pin_rotation)
        self._memory.set_pins(self._points, self._pin_rotation)
        self._exact_system = None

    def angles(self, positions: ArrayLike) -> Floats:
        """The rotation from rest around each pin, (k,) radians in (−π, π], at a pose (n, 2)."""
        pose = self._order.pose(as_points(positions, "positions", len(self._mesh.vertices)))
        all_pins = np.ones(len(self._points), dtype=bool)
        return PinRotationConstraints(self._mesh, self._points, all_pins).angles(pose)

    def vector_field(self, positions: ArrayLike, velocities: ArrayLike) -> Floats:
        """U_opt of eq. 4, (n, 2), at a pose (n, 2) for pin velocities (k, 2), pixels per unit of time.

        Factorizes anew, and has no effect on later steps. Raises InputError and SolverError.
        """
        return self.vector_fields(positions, velocities)[0]

    def vector_fields(self, positions: ArrayLike, velocities: ArrayLike) -> tuple[Floats, Floats]:
        """U_opt of eq. 4 and U° of eq. 3, (n, 2) each, as in Fig. 4; otherwise like `vector_field`."""
        pose = self._order.pose(as_points(positions, "positions", len(self._mesh.vertices)))
        pin_velocities = to_complex(as_points(velocities, "velocities", len(self._points)))
        if self._exact_system is None:
            self._exact_system = KillingSystem(
                *(self._mesh, self._pin_weight, True, self._hard, 0.0, self._stiffness, self._order.starts),
                *(True, self._joints, self._groups),
            )
            self._exact_system.set_pins(self._points)
        self._exact_system.prepare(to_points(pose))
        optimal, smooth = self._exact_system.field(pin_velocities, self._dirichlet)
        return self._order.positions(optimal), self._order.positions(smooth)

    # -- steps ---------------------------------------------------------------------------------------------

    def step(self, positions: ArrayLike, targets: ArrayLike, angles: ArrayLike | None = None) -> StepResult:
        """Move the pose (n, 2) so that its pins reach ``targets`` (k, 2), see `Deformer.step`.

        angles: (k,) radians by which the surroundings of pins are to be rotated from rest, the short way
        round; NaN for pins that let them rotate freely. Raises InputError and SolverError.
        """
        started = time.perf_counter()
        pose = self._order.pose(as_points(positions, "positions", len(self._mesh.vertices)))
        goal_positions = as_targets(targets, len(self._points), self._mesh, pose)
        goal_angles = np.full(len(self._points), np.nan)
        if angles is not None:
            goal_angles = as_numbers(angles, "angles", len(self._points), allow_nan=True)
        goals = PinGoals(goal_positions, goal_angles)
        has_angle = np.isfinite(goals.angles)
        if (has_angle != self._has_angle).any():
            self._set_angle_pins(has_angle)
        substeps, unfinished = [Substep(pose, np.zeros_like(pose), 1.0, pose)], False
        if len(self._points):
            substeps, unfinished = self._substeps(pose, goals)
        last = replace(substeps[-1], end=self._correct_pins(substeps[-1], pose, goals.positions))
        substeps[-1] = last
        result = self._order.positions(last.end)
        pin_offsets = goals.positions - self._system.at_pins(last.end)
        return StepResult(
            result,
            self._order.positions(last.field),
            StepReport(
                seconds=time.perf_counter() - started,
                substeps=len(substeps) if len(self._points) else 0,
                energy=self._system.energy(last.field) if last.field.any() else 0.0,
                flipped=count_flipped(last.end, self._faces),
                pin_error=float(np.abs(pin_offsets).max(initial=0.0)),
                blocked=last.share < 1,
                unfinished=unfinished,
            ),
            flow=lambda t: self._order.positions(self._pose_at(substeps, t)),
        )

    def _substeps(self, pose: Complexes, goals: PinGoals) -> tuple[list[Substep], bool]:
        """The substeps from a pose (n,) to the goals, and whether they stop early, being too many."""
        substeps: list[Substep] = []
        if self._count_substeps(pose, goals) > _MAX_SUBSTEPS:
            substeps = self._rigid_motion(pose, goals.positions)
        end = substeps[-1].end if substeps else pose
        starts, rotations = self._system.at_pins(end), self._remaining_rotations(end, goals.angles)
        count, blocked = self._count_substeps(end, goals), 0
        for number in range(1, min(count, _MAX_SUBSTEPS) + 1):
            share = number / count
            positions = goals.positions if number == count else starts + share * (goals.positions - starts)
            part = PinGoals(positions, goals.angles - (1 - share) * rotations)
            for _ in range(1 + _MAX_RETRIES):  # a substep opens the faces that block it
                substeps.append(self._substep(end, part))
                end = substeps[-1].end
                if substeps[-1].share == 1:
                    break
            blocked = blocked + 1 if substeps[-1].share < 1 else 0
            if blocked == _MAX_BLOCKED:
                return substeps, number < count
        return substeps, count > _MAX_SUBSTEPS

    def _count_substeps(self, pose: Complexes, goals: PinGoals) -> int:
        """The number of substeps from a pose (n,) to the goals, each short enough for one field."""
        distance = float(np.abs(goals.positions - self._system.at_pins(pose)).max())
        rotation = 0.0
        if self._pin_rotation is not None:
            rotation = float(np.nan_to_num(np.abs(self._remaining_rotations(pose, goals.angles))).max())
        return max(1, math.ceil(distance / self._max_step), math.ceil(rotation / _MAX_ROTATION))

    def _rigid_motion(self, pose: Complexes, goals: Complexes) -> list[Substep]:
        """One exact substep that moves the drawing rigidly with all pins, if that brings them much closer.

        The motion fits pins and goals (k,) by least squares. With linear trajectories it is a translation,
        because straight steps cannot rotate without growing.
        """
        pins = self._system.at_pins(pose)
        center, translation = pins.mean(), goals.mean() - pins.mean()
        fit = np.vdot(pins - center, goals - goals.mean())
        angle = float(np.angle(fit)) if self._has_spirals and fit != 0 else 0.0
        field = 1j * angle * (pose - center) + translation / complex(spiral_factor(np.array([1j * angle]))[0])
        pinned = np.unique(self._groups[self._mesh.faces[self._points.faces, 0]])
        field[~np.isin(self._groups, pinned)] = 0.0
        end = self._flow(pose, field, 1.0)
        before, after = (np.abs(goals - self._system.at_pins(each)).max() for each in (pose, end))
        return [Substep(pose, field, 1.0, end)] if after < 0.5 * before else []

    def _pose_at(self, substeps: list[Substep], t: float) -> Complexes:
        """The pose (n,) at time ``t`` of a step; memory and corrections come in gradually."""
        number, local = divmod(t * len(substeps), 1.0)
        if number == len(substeps):
            return substeps[-1].end.copy()
        substep = substeps[int(number)]
        followed = self._flow(substep.start, substep.field, substep.share)
        pose = self._flow(substep.start, substep.field, local * substep.share)
        return pose + local * (substep.end - followed)

    def _remaining_rotations(self, pose: Complexes, angles: Floats) -> Floats:
        """The rotation of each pin from the pose (n,) to ``angles`` (k,), in (−π, π]; NaN if it is free."""
        if self._pin_rotation is None:
            return angles
        differences = angles - self._pin_rotation.angles(pose)
        return np.asarray(np.angle(np.exp(1j * differences)), dtype=np.float64)

    def _substep(self, pose: Complexes, goals: PinGoals) -> Substep:
        """Follow one field from the pose (n,), section 2.4, with velocities from the pins to their goals."""
        velocities = goals.positions - self._system.at_pins(pose)
        rates = None
        moved, field, share = pose, np.zeros_like(pose), 1.0
        is_moving = bool(np.abs(velocities).max() > self._min_offset)
        if self._pin_rotation is not None:
            rates = self._remaining_rotations(pose, goals.angles)[self._pin_rotation.pins]
            is_moving = is_moving or bool(np.abs(rates).max() > _ANGLE_TOLERANCE)
        if is_moving:
            self._system.prepare(to_points(pose))
            field, _ = self._system.field(velocities, self._dirichlet, "motion", rates)
            moved, share = self._follow_field(pose, field, velocities)
        if share < 1:  # open the faces that block, or else the pins could not even move back
            angles = goals.angles - self._remaining_rotations(moved, goals.angles)
            current = PinGoals(self._system.at_pins(moved), angles)
            moved = self._memory.descend(moved, current, 1.0, False)
        if self._memory_strength:
            moved = self._memory.descend(moved, goals, self._memory_strength, is_moving)
        if not np.isfinite(moved).all():
            raise SolverError("the step has no finite result")
        return Substep(pose, field, share, moved)

    def _correct_pins(self, last: Substep, before: Complexes, goals: Complexes) -> Complexes:
        """Move the pins back to ``goals`` (k,) after a step from the pose ``before`` (n,); the new pose (n,).

        The second solve ignores pins in the interior: without a correction, one that is to stay would drift
        while another is dragged fast. Offsets are reduced to the tolerance, not to zero, so that the pose
        does not jump when an offset exceeds it. If the step was blocked, only pins that were at their goals
        before are corrected.
        """
        pose, share = last.end, 1.0
        was_away = np.abs(goals - self._system.at_pins(before)) > 2 * self._pin_tolerance
        for number in range(MAX_CORRECTIONS):
            offsets = goals - self._system.at_pins(pose)
            if last.share < 1:
                offsets[was_away] = 0.0
            largest = float(np.abs(offsets).max(initial=0.0))
            if largest <= self._pin_tolerance or share < 1:
                break
            if not last.field.any():
                self._system.prepare(to_points(pose))
            self._system.measure_gaps(pose)  # not those of the pose that was prepared
            offsets *= 1 - self._pin_tolerance / largest
            # Recordings with memory replay to the same bits only if both corrections are one series.
            key = "correction" if self._memory_strength else f"correction {number}"
            field, _ = self._system.field(offsets, self._dirichlet, key)
            reached = self._system.at_pins(field)
            square = float(np.vdot(reached, reached).real)
            if square == 0:
                break
            factor = float(np.vdot(reached, offsets).real) / square
            factor = min(max(factor, 0.0), _MAX_CORRECTION_FACTOR)
            pose, share = self._follow_field(pose, factor * field, offsets)
        return pose

    def _follow_field(
        self, pose: Complexes, field: Complexes, velocities: Complexes
    ) -> tuple[Complexes, float]:
        """Follow a field (n,) until a face would flip; the new pose (n,) and the share of time followed.

        Faces that another method has flipped are ignored. A part that hangs on the pins by a collapsed face
        can get a huge velocity from a small one: displacements are limited by √area and the largest of the
        pin ``velocities`` (k,).
        """
        max_displacement = max(self._mesh.length, _MAX_LEVER * float(np.abs(velocities).max()))
        t = 1.0
        while t >= _MIN_SHARE:
            with np.errstate(over="ignore", invalid="ignore"):  # not finite, and so not bounded
                moved = self._flow(pose, field, t)
            if is_acceptable(pose, moved, max_displacement, self._faces, self._min_areas):
                return moved, t
            t /= 2
        return pose, 0.0
