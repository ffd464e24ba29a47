"""Steps a document's pose towards its pin targets until it settles."""

from collections.abc import Callable, Collection
from concurrent.futures import Executor, Future, wait
from dataclasses import dataclass, replace
from threading import Lock
from typing import Any

import numpy as np

from ...deform.deformer import Deformer, StepResult
from ...deform.methods import get_method, make_deformer
from ...errors import SolverError
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats
from ...overlap.overlaps import no_overlaps
from ..document.crossings import following_overlaps, overlaps_of, remember_overlaps
from ..document.document import EditState
from ..document.pin_angles import FullTurnCounter, pin_angles
from ..document.rig.joint import mesh_joints
from ..document.rig.pin_scales import face_scales

MAX_PIN_TRAVEL = 0.035  # of a pin in one step, as a share of √area; longer steps cost as much per pixel
MAX_PIN_ROTATION = 0.2  # radians of a pin in one step
PIN_TOLERANCE = 0.25  # pixels: a pin nearer than this to its target has arrived
ANGLE_TOLERANCE = 0.002  # radians: a pin nearer than this to its angle has arrived
VISIBLE_OFFSET, VISIBLE_ROTATION = 1.0, 0.05  # pixels, radians: less is not seen while the drawing moves
SETTLED_MOTION = 0.02  # pixels: a step that moves no vertex farther has settled
_DRAGGED_SHARE = 0.2  # of the largest distance from a target: a pin nearer to its own is not dragged itself
MAX_SETTLING_STEPS = 400  # after the last change of a target, in case a pose never settles


class InlineExecutor(Executor):
    """Runs each job inside `submit`: in scripts and tests no window waits for the result."""

    def submit(self, job: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run ``job(*args, **kwargs)``; returns its finished future."""
        future: Future[Any] = Future()
        try:
            future.set_result(job(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


INLINE = InlineExecutor()


@dataclass(frozen=True, eq=False)
class PendingStep:
    """A step that is being computed.

    start: the state it started from; pin_offsets: (k, 2) from the pins to their targets at the start, pixels.
    """

    start: EditState
    pin_offsets: Floats
    step: "Step"
    result: Future[StepResult]


class Step:
    """One step from a state, to be called once, in any thread.

    overlaps: after the call, those of the new pose; they depend on the state at the start and the new pose
    only.
    """

    def __init__(
        self,
        mesh: TriMesh,
        start: EditState,
        deform: Callable[[], StepResult],
        dragged_ids: Collection[int],
    ) -> None:
        self._mesh, self._start, self._deform, self._dragged_ids = mesh, start, deform, dragged_ids
        self.overlaps = no_overlaps(mesh)

    def __call__(self) -> StepResult:
        """The result of the step. Raises SolverError."""
        result, mesh, start = self._deform(), self._mesh, self._start
        before = overlaps_of(mesh, start.pins, start.positions, start.crossings)
        self.overlaps = following_overlaps(mesh, start.pins, before, result.positions, self._dragged_ids)
        return result


class Stepper:
    """Moves the pose of a state towards its pin targets and angles, one step at a time.

    It owns the deformer of the state's method, the pending step, and the number of steps until the pose must
    have settled. A step may run in another thread; meanwhile targets and angles may change, nothing else.
    Raises InputError for settings that no method accepts.

    last_step: result of the last step; last_motion: of the last step that moved pins, the pose before it
    (n, 2) and the velocities of its pins (k, 2), for `vector_fields`.
    """

    def __init__(self, mesh: TriMesh, state: EditState) -> None:
        self._lock = Lock()  # a thread computes steps or vector fields, one at a time
        self._pending: PendingStep | None = None
        self.last_step: StepResult | None = None
        self.set_method(mesh, state)

    # -- the state to step ---------------------------------------------------------------------------------

    def set_method(self, mesh: TriMesh, state: EditState) -> None:
        """Deform ``mesh`` by the method and stiffness of a state. On InputError nothing has changed."""
        method, parameters = state.settings.method, dict(state.settings.parameters)
        if state.stiffness is not None and get_method(method).deformer.takes_stiffness:
            parameters["stiffness"] = state.stiffness
        deformer = make_deformer(method, mesh, mesh_joints(state.joints), **parameters)
        deformer.set_pins(state.points)
        _prepare(deformer, state)
        with self._lock:
            # Any: a method may have more than the contract asks for, e.g. angles of pins and vector fields
            self._deformer: Any = deformer
            self._pin_count = len(state.pins)
            self.last_motion: tuple[Floats, Floats] | None = None
        self._mesh, self._settings, self._stiffness = mesh, state.settings, state.stiffness
        self._joints = state.joints
        self._max_travel = MAX_PIN_TRAVEL * mesh.length
        self._full_turns = FullTurnCounter()
        self.steps_left = 0

    def set_pins(self, state: EditState) -> None:
        """Take over the pins of a state and stop; no vertex moves."""
        with self._lock:
            self._deformer.set_pins(state.points)
            _prepare(self._deformer, state)
            self._pin_count = len(state.pins)
        self.steps_left = 0

    def restore(self, mesh: TriMesh, state: EditState) -> None:
        """Take over another state of the document, for example an earlier one, and stop.

        Raises InputError as `set_method` does.
        """
        same_method = state.settings == self._settings and state.stiffness is self._stiffness
        if mesh is not self._mesh or not same_method or state.joints is not self._joints:
            self.set_method(mesh, state)
            return
        self.last_motion = None
        self.reset_full_turns()
        self.set_pins(state)

    def aim(self, state: EditState) -> None:
        """Start to move: the targets or angles of the pins have changed."""
        self.steps_left = MAX_SETTLING_STEPS + int(self._least_steps(state))

    def stop(self) -> None:
        """Stop the motion, even if pins have not arrived."""
        self.steps_left = 0

    def reset_full_turns(self) -> None:
        """Forget full turns: from now on pins rotate the short way to their angles."""
        self._full_turns.reset()

    # -- distance from the goal ----------------------------------------------------------------------------

    @property
    def is_moving(self) -> bool:
        """Whether pins have not arrived, or the drawing around them has not settled."""
        return self.steps_left > 0

    def angle_errors(self, state: EditState) -> Floats:
        """Radians that each pin still has to rotate, with full turns, (k,); NaN for pins without an angle."""
        goals = state.angles
        if not self._deformer.holds_angles or not np.isfinite(goals).any():
            return np.full(len(goals), np.nan)
        angles = pin_angles(self._mesh, state.pins, state.positions)
        return goals - self._full_turns.unwrap(state.pins, angles)

    def angle_error(self, state: EditState) -> float:
        """The largest angle that a pin still has to rotate, radians."""
        return float(np.nan_to_num(np.abs(self.angle_errors(state))).max(initial=0.0))

    def has_visually_arrived(self, state: EditState) -> bool:
        """Whether the pins are so near to their targets and angles that no difference is visible."""
        return state.pin_error(self._mesh) < VISIBLE_OFFSET and self.angle_error(state) < VISIBLE_ROTATION

    def _least_steps(self, state: EditState) -> float:
        """The number of steps in which the pins can arrive if nothing holds them back."""
        travel = state.pin_error(self._mesh) / self._max_travel
        return max(travel, self.angle_error(state) / MAX_PIN_ROTATION)

    # -- steps ---------------------------------------------------------------------------------------------

    @property
    def has_pending_step(self) -> bool:
        """Whether a step has started and `finish` has not taken it over."""
        return self._pending is not None

    def start(self, state: EditState, executor: Executor) -> Future[StepResult]:
        """Start a step from ``state``; returns its future, whose exception may be a SolverError.

        No step may be pending. The step goes as far towards the targets as one step may.
        """
        assert self._pending is None, "a step is already pending"
        step = self._make_step(state)
        offsets = state.pin_offsets(self._mesh)
        self._pending = PendingStep(state, offsets, step, executor.submit(step))
        return self._pending.result

    def is_ready(self, seconds: float = 0.0) -> bool:
        """Whether `finish` will not block; waits up to ``seconds`` for that."""
        pending = self._pending
        return pending is not None and bool(wait([pending.result], max(seconds, 0.0)).done)

    def finish(self, state: EditState) -> EditState:
        """Wait for the pending step; returns ``state``, the current one, with the new pose.

        Raises SolverError if the step failed; the pose then stays and the motion stops.
        """
        pending, self._pending = self._pending, None
        assert pending is not None, "no step is pending"
        try:
            result = pending.result.result()
        except SolverError:
            self.stop()
            raise
        before = pending.start.positions
        moved_pins = np.linalg.norm(pending.pin_offsets, axis=1).max(initial=0.0) > PIN_TOLERANCE
        if result.field is not None and moved_pins:
            self.last_motion = before, pending.pin_offsets
        aimed_meanwhile = state.pins is not pending.start.pins
        state = replace(state, positions=result.positions, crossings=pending.step.overlaps.crossings)
        remember_overlaps(self._mesh, state.positions, pending.step.overlaps)
        arrived = state.pin_error(self._mesh) < PIN_TOLERANCE and self.angle_error(state) < ANGLE_TOLERANCE
        moved = float(np.abs(result.positions - before).max())
        # Pins that something holds back approach in ever smaller steps, so only a tenth counts as settled.
        settled = moved < (SETTLED_MOTION if arrived else 0.1 * SETTLED_MOTION) and not aimed_meanwhile
        self.steps_left = 0 if settled else max(self.steps_left - 1, 0)
        self.last_step = result
        return state

    def _make_step(self, state: EditState) -> "Step":
        """One step from a state towards its targets and angles, to be called in any thread."""
        pin_positions, errors = state.pin_positions(self._mesh), self.angle_errors(state)
        share = 1.0 / max(1.0, self._least_steps(state))
        targets = state.targets if share == 1.0 else pin_positions + share * (state.targets - pin_positions)
        angles = (state.angles - (1.0 - share) * errors,) if np.isfinite(errors).any() else ()

        # What a drag pulls along is also off its target, but less so
        offsets, turns = np.linalg.norm(state.pin_offsets(self._mesh), axis=1), np.nan_to_num(np.abs(errors))
        is_dragged = offsets > max(PIN_TOLERANCE, _DRAGGED_SHARE * offsets.max(initial=0.0))
        is_dragged |= turns > max(ANGLE_TOLERANCE, _DRAGGED_SHARE * turns.max(initial=0.0))
        dragged_ids = {pin.id for pin, dragged in zip(state.pins, is_dragged, strict=True) if dragged}

        scales = face_scales(self._mesh, state.pins) if self._deformer.takes_scales else None

        def step() -> StepResult:
            with self._lock:
                if self._deformer.takes_scales:
                    self._deformer.set_scales(scales)
                result: StepResult = self._deformer.step(state.positions, targets, *angles)
            return result

        return Step(self._mesh, state, step, dragged_ids)

    def vector_fields(self) -> tuple[Floats, Floats] | None:
        """U_opt and U°, (n, 2) each, of the last motion of the current pins; None if there was none.

        May be called in any thread.
        """
        with self._lock:
            motion = self.last_motion
            if motion is None or len(motion[1]) != self._pin_count:
                return None
            optimal, smooth = self._deformer.vector_fields(*motion)
        return optimal, smooth


def _prepare(deformer: Deformer, state: EditState) -> None:
    """Let a deformer prepare the next step beside; a pin with an angle changes in that step what it needs."""
    if not np.isfinite(state.angles).any():
        deformer.prepare(state.positions)
