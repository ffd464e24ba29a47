"""The paper's deformer: vector field, Dirichlet solve, log spirals; and memory of the rest shape."""

import math
import time
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import SolverError
from ...geometry.jit import compiled
from ...geometry.mesh import MeshPoints, TriMesh, signed_areas
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import (
    Complexes,
    Floats,
    Ints,
    as_choice,
    as_indices,
    as_number,
    as_numbers,
    as_points,
    as_switch,
)
from ..cholesky import SparseCholesky
from ..deformer import Deformer, StepReport, StepResult, as_targets
from .killing_field import KillingSystem
from .log_spiral import LogSpirals, linear_flow, spiral_factor
from .pin_rotation import PinRotationConstraints
from .preconditioned_cholesky import dot
from .rest_energy import SymmetricDirichlet, descend

Trajectory = Literal["spiral", "linear"]
Constraints = Literal["soft", "hard"]

_SHORTEST = 2.0**-10  # share of a substep below which a move that would flip a face is given up
_MAX_TURN = 0.1  # radians that a pin turns in one substep, at most
_ARRIVED = 1e-4  # share of √area: pins nearer than this to their targets are left to the rest memory alone
_RETRIES = 3  # of a substep that was blocked
_MAX_SUBSTEPS = 400  # of one step; farther targets are not reached
_MAX_BLOCKED = 10  # substeps in a row that end blocked, after their retries; the rest would be, too
_CORRECTIONS = 2  # most of them in one step
_LONGEST = 4.0  # times its field: as far as a correction may go
_LEVER = 10.0  # times the velocity of a pin: as far as others may go where that is more than √area
_THINNEST = 1e-2  # a face may not shrink below this share of its rest area in one move
# Longest way of a pin in one substep, how near a field comes to the exact one at every vertex, and how near
# the direction of a descent, as shares of √area. Without memory errors add up along the way.
_MAX_STEP, _MAX_STEP_WITH_MEMORY = 0.007, 0.05
_TOLERANCE, _TOLERANCE_WITH_MEMORY = 2e-8, 1e-6
_TOLERANCE_OF_DESCENT = 1e-5
_TURNED = 1e-3  # radians: a pin turned so nearly is left to the rest memory alone
_SOFTEST, _STIFFEST = 1e-3, 1e6
_SAFE = 0.9  # share of the way to the first flip that memory may go
_CUT = 0.05  # a step of memory shorter than this share of its length was in the wrong metric


@dataclass(frozen=True, eq=False)
class _PinGoals:
    """Where pins should be, (k,), and how far they should be turned, (k,) radians or NaN."""

    places: Complexes
    angles: Floats


@dataclass(frozen=True, eq=False)
class _Substep:
    """From ``start`` along ``field`` for ``share`` of its time; ``end`` is after memory and corrections.

    Arrays (n,).
    """

    start: Complexes
    field: Complexes
    share: float
    end: Complexes


class AkapDeformer(Deformer):
    """As-Killing-as-possible deformation (Solomon, Ben-Chen, Butscher and Guibas 2011).

    mesh: the rest pose.
    memory: 0 is the paper's method, path-dependent; up to 1, each substep also descends towards the rest.
    dirichlet: with the second solve (4); trajectory: "spiral" (16) or "linear"; the four combinations are
    the variants of Fig. 8.
    pin_weight: λ on the row as in eq. 5; with area-weighted energies 10 to 1000 behave alike.
    max_step: longest way of a pin in one substep, as a share of the square root of the mesh's area; a longer
    way is cut, because following one field too far distorts (Fig. 2). By default 0.007, and 0.05 with memory,
    under which the pose does not depend on the way.
    constraints: "soft" pins pull with λ as in eq. 3, "hard" ones give U° exactly their velocities (Fig. 3).
    exact: factorize both systems in every substep, as the paper does; otherwise a factorization serves for
    many poses, for poses that are the same within less than a hundredth of a pixel (at 1000 × 1000).
    stiffness: (m,) factors from 1e-3 to 1e6 of the faces' energies, by which parts bend less or more.
    Raises InputError on settings out of range.
    """

    holds_angles = True
    takes_stiffness = True
    has_memory = True
    has_vector_fields = True

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
    ) -> None:
        self._memory = as_number(memory, "memory", 0, 1)
        as_choice(trajectory, "trajectory", ("spiral", "linear"))
        as_choice(constraints, "constraints", ("soft", "hard"))
        as_number(pin_weight, "pin_weight", 1e-3, 1e6)
        if max_step is None:
            max_step = _MAX_STEP_WITH_MEMORY if memory else _MAX_STEP
        as_number(max_step, "max_step", 1e-4, math.inf)
        stiff = None
        if stiffness is not None:
            stiff = as_numbers(stiffness, "stiffness", len(mesh.faces), _SOFTEST, _STIFFEST)
        self._mesh = mesh
        self._dirichlet = as_switch(dirichlet, "dirichlet")
        length = mesh.length
        self._max_length = max_step * length
        # The soft pins give way a little to the rest memory; a field that took them back each time would
        # keep the pose from ever coming to rest.
        self._near = _ARRIVED * length
        self._arrived = self._near if memory else 0.0
        self._pin_weight = pin_weight
        self._hard = constraints == "hard"
        tolerance = length * (_TOLERANCE_WITH_MEMORY if memory else _TOLERANCE)
        self._system = KillingSystem(
            mesh, pin_weight, as_switch(exact, "exact"), self._hard, tolerance, stiff
        )
        self._newton: SparseCholesky | None = None
        self._stiffness = stiff
        self._exact_system: KillingSystem | None = None
        self._has_spirals = trajectory == "spiral"
        self._flow = LogSpirals(mesh).flow if self._has_spirals else linear_flow
        self._rest = SymmetricDirichlet(mesh, stiff)
        self._faces, self._least_areas = mesh.faces.copy(), _THINNEST * mesh.rest_areas
        self.set_pins(MeshPoints(np.zeros(0, dtype=np.int32), np.zeros((0, 3))))

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins; moves nothing. Raises InputError where a face is not one of the mesh."""
        as_indices(points.faces, "points.faces", None, len(self._mesh.faces))
        self._points = points
        self._corners = self._mesh.faces[points.faces]
        pinned = np.unique(self._mesh.component[self._corners[:, :1]])
        self._held = ~np.isin(self._mesh.component, pinned)
        self._hold(np.zeros(len(points), dtype=bool))

    def _hold(self, holding: NDArray[np.bool_]) -> None:
        """Choose which pins (k,) hold an angle."""
        self._holding = holding
        self._turning = PinRotationConstraints(self._mesh, self._points, holding) if holding.any() else None
        self._system.set_pins(self._points, self._turning)
        self._exact_system = None

    def angles(self, positions: ArrayLike) -> Floats:
        """How far the surroundings of each pin are turned from rest at a pose (n, 2), (k,), in (−π, π]."""
        pose = to_complex(as_points(positions, "positions", len(self._mesh.vertices)))
        every = PinRotationConstraints(self._mesh, self._points, np.ones(len(self._points), dtype=bool))
        return every.angles(pose)

    def vector_field(self, positions: ArrayLike, velocities: ArrayLike) -> Floats:
        """U_opt of eq. 4, (n, 2), at a pose (n, 2) for pin velocities (k, 2), pixels per unit of time.

        Always by fresh factorizations, and without any effect on later steps.
        """
        return self.vector_fields(positions, velocities)[0]

    def vector_fields(self, positions: ArrayLike, velocities: ArrayLike) -> tuple[Floats, Floats]:
        """U_opt of eq. 4 and U° of eq. 3, (n, 2) each, as in Fig. 4; otherwise like `vector_field`."""
        pose = as_points(positions, "positions", len(self._mesh.vertices))
        wanted = as_points(velocities, "velocities", len(self._points))
        if self._exact_system is None:
            self._exact_system = KillingSystem(
                self._mesh, self._pin_weight, True, self._hard, stiffness=self._stiffness
            )
            self._exact_system.set_pins(self._points)
        self._exact_system.prepare(pose)
        optimal, smooth = self._exact_system.field(to_complex(wanted), self._dirichlet)
        return to_points(optimal), to_points(smooth)

    def step(self, positions: ArrayLike, targets: ArrayLike, angles: ArrayLike | None = None) -> StepResult:
        """Move the pose (n, 2) so that its pins come to ``targets`` (k, 2); see `Deformer.step`.

        angles: (k,) radians by which the surroundings of pins are to be turned from rest; NaN where a pin
        lets them turn as they will. The shorter way round is taken.
        """
        started = time.perf_counter()
        pose = to_complex(as_points(positions, "positions", len(self._mesh.vertices)))
        goals = as_targets(targets, len(self._points), self._mesh, pose)
        wanted = np.full(len(goals), np.nan)
        if angles is not None:
            wanted = as_numbers(angles, "angles", len(goals), allow_nan=True)
        if (np.isfinite(wanted) != self._holding).any():
            self._hold(np.isfinite(wanted))
        way = [_Substep(pose, np.zeros_like(pose), 1.0, pose)]
        unfinished = False
        if len(goals):
            if self._count_substeps(pose, goals, wanted) > _MAX_SUBSTEPS:
                way += self._rigid_motion(pose, goals)
            unfinished = self._follow(way, goals, wanted)
            del way[0]
        way[-1] = replace(way[-1], end=self._corrected(way[-1], pose, goals))
        result, field = to_points(way[-1].end.copy()), way[-1].field
        return StepResult(
            result,
            to_points(field),
            StepReport(
                seconds=time.perf_counter() - started,
                substeps=len(way) if len(goals) else 0,
                energy=self._system.energy(field) if field.any() else 0.0,
                flipped=int((signed_areas(result, self._mesh.faces) <= 0).sum()),
                pin_error=float(np.abs(goals - self._pin_positions(way[-1].end)).max(initial=0.0)),
                blocked=way[-1].share < 1,
                unfinished=unfinished,
            ),
            flow=lambda t: to_points(self._along(way, t)),
        )

    def _count_substeps(self, pose: Complexes, goals: Complexes, angles: Floats) -> int:
        """The number of substeps from a pose (n,) to goals and angles (k,) of the pins."""
        travel = float(np.abs(goals - self._pin_positions(pose)).max())
        rotation = float(np.nan_to_num(np.abs(self._still_to_turn(pose, angles))).max())
        return max(1, math.ceil(travel / self._max_length), math.ceil(rotation / _MAX_TURN))

    def _rigid_motion(self, pose: Complexes, goals: Complexes) -> list[_Substep]:
        """One exact substep that carries the drawing along with all pins, if that brings them much nearer.

        The rotation fits pins (k,) and goals (k,) by least squares; straight steps have no rotation that does
        not also grow.
        """
        pins = self._pin_positions(pose)
        center, drift = pins.mean(), goals.mean() - pins.mean()
        fit = np.vdot(pins - center, goals - goals.mean())
        angle = float(np.angle(fit)) if self._has_spirals and fit != 0 else 0.0
        field = 1j * angle * (pose - center) + drift / complex(spiral_factor(np.array([1j * angle]))[0])
        field[self._held] = 0.0
        end = self._flow(pose, field, 1.0)
        before, after = (np.abs(goals - self._pin_positions(each)).max() for each in (pose, end))
        return [_Substep(pose, field, 1.0, end)] if after < 0.5 * before else []

    def _follow(self, way: list[_Substep], goals: Complexes, angles: Floats) -> bool:
        """Append substeps towards goals and angles (k,); whether there are more than one step may have."""
        pose = way[-1].end
        starts, turns = self._pin_positions(pose), self._still_to_turn(pose, angles)
        count, blocked = self._count_substeps(pose, goals, angles), 0
        for index in range(1, min(count, _MAX_SUBSTEPS) + 1):
            share = index / count
            places = goals if index == count else starts + share * (goals - starts)
            aims = _PinGoals(places, angles - (1 - share) * turns)
            for _ in range(1 + _RETRIES):  # where faces stood in the way, they were opened
                way.append(self._substep(way[-1].end, aims))
                if way[-1].share == 1:
                    break
            blocked = blocked + 1 if way[-1].share < 1 else 0
            if blocked == _MAX_BLOCKED:
                return index < count
        return count > _MAX_SUBSTEPS

    def _along(self, way: list[_Substep], t: float) -> Complexes:
        """The pose at time ``t`` of a step; what the rest memory added comes in gradually."""
        number, local = divmod(t * len(way), 1.0)
        if number == len(way):
            return way[-1].end.copy()
        part = way[int(number)]
        followed = self._flow(part.start, part.field, part.share)
        return self._flow(part.start, part.field, local * part.share) + local * (part.end - followed)

    def _pin_positions(self, pose: Complexes) -> Complexes:
        return (self._points.weights * pose[self._corners]).sum(axis=1)

    def _still_to_turn(self, pose: Complexes, angles: Floats) -> Floats:
        """By how much pins (k,) differ from ``angles``, in (−π, π]; NaN for those that hold none."""
        if self._turning is None:
            return angles
        off = angles - self._turning.angles(pose)
        return np.asarray(np.angle(np.exp(1j * off)), dtype=np.float64)

    def _substep(self, pose: Complexes, aims: _PinGoals) -> _Substep:
        """One field and one move: section 2.4, with velocities towards ``aims`` from where the pins are."""
        velocities = aims.places - self._pin_positions(pose)
        rates = None
        moved, field, share = pose, np.zeros_like(pose), 1.0
        moving = bool(np.abs(velocities).max() > self._arrived)
        if self._turning is not None:
            rates = self._still_to_turn(pose, aims.angles)[self._turning.pins]
            moving = moving or bool(np.abs(rates).max() > _TURNED)
        if moving:
            self._system.prepare(to_points(pose))
            field, _ = self._system.field(velocities, self._dirichlet, "motion", rates)
            moved, share = self._move(pose, field, velocities)
        if share < 1:  # faces at their limit open again, or the pins could not even go back
            here = _PinGoals(
                self._pin_positions(moved), aims.angles - self._still_to_turn(moved, aims.angles)
            )
            moved = self._remember(moved, here, 1.0, False)
        if self._memory:
            moved = self._remember(moved, aims, self._memory, moving)
        if not np.isfinite(moved).all():
            raise SolverError("the step has no finite result")
        return _Substep(pose, field, share, moved)

    def _corrected(self, last: _Substep, before: Complexes, goals: Complexes) -> Complexes:
        """The pose after a step once its pins were brought back to ``goals``.

        The second solve is blind to pins in the interior: without this, one that holds still would drift with
        whatever is dragged fast. What is below the tolerance stays, so that nothing jumps where it is passed.
        Where the way was blocked, only pins that were at their goals ``before`` the step are brought back.
        """
        pose, share = last.end, 1.0
        on_the_way = np.abs(goals - self._pin_positions(before)) > 2 * self._near
        for _ in range(_CORRECTIONS):
            off = goals - self._pin_positions(pose)
            if last.share < 1:
                off[on_the_way] = 0.0
            miss = float(np.abs(off).max(initial=0.0))
            if miss <= self._near or share < 1:
                break
            if not last.field.any():
                self._system.prepare(to_points(pose))
            off *= 1 - self._near / miss
            field, _ = self._system.field(off, self._dirichlet, "correction")
            reached = self._pin_positions(field)
            size = float(np.vdot(reached, reached).real)
            if size == 0:
                break
            best = float(np.vdot(reached, off).real) / size
            pose, share = self._move(pose, min(max(best, 0.0), _LONGEST) * field, off)
        return pose

    def _move(self, pose: Complexes, field: Complexes, velocities: Complexes) -> tuple[Complexes, float]:
        """Follow the field as far as no face flips; also for what share of the way that was.

        Faces that are flipped already, by another method, move freely. A part that hangs on the pins by a
        collapsed face is flung away by a small velocity: no vertex goes farther than the drawing is large.
        """
        farthest = max(self._mesh.length, _LEVER * float(np.abs(velocities).max()))
        t = 1.0
        while t >= _SHORTEST:
            with np.errstate(over="ignore", invalid="ignore"):  # then not finite, and so not near
                moved = self._flow(pose, field, t)
            near = np.abs(moved - pose).max() <= farthest
            if near and _keeps_faces(pose, moved, self._faces, self._least_areas):
                return moved, t
            t /= 2
        return pose, 0.0

    def _remember(self, pose: Complexes, aims: _PinGoals, length: float, moving: bool) -> Complexes:
        """One step towards the rest shape, pins held softly at ``aims``.

        Near an isometry the Hessian of the energy is 2 (K + λ² WᵀW), and while pins are moving that matrix is
        at hand. Where that is no good model, and where the drawing only settles, it is Newton's step.
        """

        rest, columns = self._rest, self._rest.columns(pose)
        off = self._pin_positions(pose) - aims.places
        if rest.value(columns) == np.inf:  # faces that are flipped already, by another method
            return pose
        gradient = rest.gradient(columns) + 2 * self._system.pull(off)
        turning = self._turning
        if turning is not None:
            twisted = turning.turns(pose) - np.exp(1j * aims.angles[turning.pins])
            gradient += 2 * turning.misfit_gradient(twisted)
        gradient[self._held] = 0.0

        def descended(direction: Complexes) -> tuple[Complexes, float]:
            change, pins = rest.columns(direction), self._pin_positions(direction)
            turns = turning.turns(direction) if turning is not None else 0.0

            def value(far: float) -> float:
                total = rest.value(columns + far * change) + self._misfit(off + far * pins)
                return total if turning is None else total + turning.misfit(twisted + far * turns)

            slope = dot(gradient, direction)
            far = descend(value, value(0.0), slope, min(length, _SAFE * rest.longest(columns, change)))
            return pose + far * direction, far

        if moving:
            tolerance = _TOLERANCE_OF_DESCENT * self._mesh.length
            near, far = descended(-0.5 * self._system.solve(gradient, tolerance, "memory"))
            if far >= _CUT * length:
                return near
        return descended(self._newton_direction(pose, columns, gradient))[0]

    def _misfit(self, off: Complexes) -> float:
        return self._pin_weight**2 * float(np.vdot(off, off).real)

    def _newton_direction(self, pose: Complexes, columns: Complexes, gradient: Complexes) -> Complexes:
        """The direction of Newton's method for a gradient (n,) of energy and misfit at a pose (n,)."""
        if not gradient.any():
            return gradient
        if self._newton is None:
            self._newton = SparseCholesky(self._system.pattern)
        spin = None if self._turning is None else self._turning.spin
        for convex in (False, True):  # far from a minimum the Hessian has negative eigenvalues
            nonzeros = self._rest.half_hessian(columns, convex, self._system.blocks, spin)
            self._system.add_pins(nonzeros, to_points(pose))
            try:
                self._newton.factorize(nonzeros)
                break
            except SolverError:
                if convex:
                    raise
        return -0.5 * to_complex(self._newton.solve(gradient.view(np.float64)).reshape(-1, 2))


@compiled
def _keeps_faces(before: Complexes, after: Complexes, faces: Ints, least: Floats) -> bool:
    """Whether no face comes below its least area (m,) or, where that is less, below 0.9 times what it has.

    Faces that are flipped before do not count.
    """
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        a, b = before[j] - before[i], before[k] - before[i]
        c, d = after[j] - after[i], after[k] - after[i]
        was, is_now = 0.5 * (a.real * b.imag - a.imag * b.real), 0.5 * (c.real * d.imag - c.imag * d.real)
        if was > 0 and not is_now > min(least[f], 0.9 * was):
            return False
    return True
