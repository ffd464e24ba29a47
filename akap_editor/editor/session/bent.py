"""A drawing on its way: its state, what bends it, and how it comes to rest; without edits and history."""

from concurrent.futures import Executor, Future, wait
from dataclasses import dataclass, replace

import numpy as np

from ...deform.deformer import StepResult
from ...errors import SolverError
from ...geometry.validation import Floats
from ..document.document import Document, EditState
from ..document.drawing import Drawing
from ..document.pin_angles import pin_angles, pins_fixed_at_pose
from .stepper import Bending
from .worker import INLINE

PIN_TOLERANCE = 0.25  # pixels: a pin nearer than this to its target has arrived
STILL = 0.02  # pixels: a step that moves no vertex farther has come to rest
MOST_SETTLING = 400  # steps after the last change of a target, should a pose never come to rest
ANGLE_TOLERANCE = 0.002  # radians: a pin turned more nearly than this has arrived


@dataclass(frozen=True, eq=False)
class _UnderWay:
    """A step that is being computed, from the state ``before``, with pins ``off``, (k, 2), their targets."""

    before: EditState
    off: Floats
    result: Future[StepResult]


class Bent:
    """A document whose drawing follows its pins, `step` by step.

    A step may be computed in another thread (`start_step`). Until `step` takes it over, the pose is the one
    before it, and of the state nothing but targets and angles may change.
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self.last_step: StepResult | None = None
        self.jumps = 0  # how often the pose has changed in another way than by steps
        self._settling = 0
        self._under_way: _UnderWay | None = None
        self._opened = document.drawing
        self._bending = Bending(document.drawing.mesh, document.state)

    # -- what is there -------------------------------------------------------------------------------------

    @property
    def state(self) -> EditState:
        """The current state."""
        return self.document.state

    @property
    def drawing(self) -> Drawing:
        """The picture and its mesh."""
        return self.document.drawing

    @property
    def posed(self) -> bool:
        """Whether the drawing is anywhere but in its rest pose."""
        return not np.array_equal(self.state.positions, self.drawing.mesh.vertices)

    @property
    def moving(self) -> bool:
        """Whether pins are still on their way, or the drawing around them is."""
        return self._settling > 0

    def pin_positions(self) -> Floats:
        """(k, 2): where the pins are now, as opposed to where they should be."""
        return self.drawing.mesh.evaluate(self.state.points, self.state.positions)

    @property
    def near(self) -> bool:
        """Whether pins are where they should be, as far as an eye can see it in motion."""
        return self.pin_error() < 1.0 and self._bending.turn_error(self.state) < 0.05

    def pin_error(self) -> float:
        """Largest distance of a pin from where it should be, pixels."""
        return float(np.linalg.norm(self._bending.off(self.state), axis=1).max(initial=0.0))

    @property
    def turns(self) -> bool:
        """Whether the method lets pins hold angles."""
        return self._bending.holds_angles

    def pin_angle(self, pin_id: int) -> float:
        """By how many radians the drawing around a pin is turned from rest now, in (−π, π]."""
        pins = self.state.pins
        angles = pin_angles(self.drawing.mesh, pins, self.state.positions, {pin_id})
        return float(angles[[pin.id for pin in pins].index(pin_id)])

    # -- motion --------------------------------------------------------------------------------------------

    @property
    def stepping(self) -> bool:
        """Whether a step is under way, or waits to be taken over."""
        return self._under_way is not None

    def start_step(self, worker: Executor) -> None:
        """Let a worker compute the next step towards the current targets, unless one is under way."""
        if self._under_way is None:
            off, way = self._bending.off(self.state), self._bending.way(self.state)
            self._under_way = _UnderWay(self.state, off, worker.submit(way))

    def step_is_ready(self, seconds: float = 0.0) -> bool:
        """Whether `step` will not wait for a worker; look for so long."""
        way = self._under_way
        return way is not None and bool(wait([way.result], max(seconds, 0.0)).done)

    def step(self) -> StepResult:
        """The step under way, or else a new one; waits for it. On SolverError the pose is as it was."""
        self.start_step(INLINE)
        way, self._under_way = self._under_way, None
        assert way is not None
        try:
            result = way.result.result()
        except SolverError:
            self._settling = 0
            raise
        before = way.before.positions
        if result.field is not None and np.linalg.norm(way.off, axis=1).max(initial=0.0) > PIN_TOLERANCE:
            self._bending.last_way = before, way.off
        asked_since = self.state.pins is not way.before.pins
        self._set_state(replace(self.state, positions=result.positions))
        moved = float(np.abs(result.positions - before).max())
        arrived = self.pin_error() < PIN_TOLERANCE and self._bending.turn_error(self.state) < ANGLE_TOLERANCE
        still = moved < (STILL if arrived else 0.1 * STILL) and not asked_since
        self._settling = 0 if still else max(self._settling - 1, 0)
        self.last_step = result
        return result

    def fields(self) -> tuple[Floats, Floats] | None:
        """U_opt and U°, (n, 2) each, of the last step that moved pins; None for a method without fields."""
        return self._bending.fields()

    @property
    def last_way(self) -> tuple[Floats, Floats] | None:
        """Of the last step that moved pins: the pose before, (n, 2), and velocities of the pins, (k, 2)."""
        return self._bending.last_way

    def settle(self) -> None:
        """Step until the pose has come to rest."""
        while self.moving:
            self.step()

    def halt(self) -> None:
        """Leave the pose as it is, though pins may be on their way."""
        if self.stepping:
            self.step()
        self._settling = 0

    # -- inside --------------------------------------------------------------------------------------------

    def _bend_by(self, state: EditState) -> None:
        """Take over a state that bends differently; nothing has changed where that is not possible."""
        self._bending = Bending(self.drawing.mesh, state)
        self._set_state(state)
        self._settling = 0

    def _begin_settling(self) -> None:
        self._settling = MOST_SETTLING + int(self._bending.steps_left(self.state))

    def _put(self, pose: Floats) -> None:
        self.jumps += 1
        pins = pins_fixed_at_pose(self.drawing.mesh, self.state.pins, pose)
        self._set_state(replace(self.state, pins=pins, positions=pose))
        self._settling = 0

    def _set_state(self, state: EditState) -> None:
        self.document = replace(self.document.with_state(state), drawing=state.drawing or self._opened)

    def _restore(self, state: EditState) -> None:
        self.jumps += 1
        self._set_state(state)
        if self._bending.fits(self.drawing.mesh, state):
            self._bending.last_way = None
            self._bending.turns.forget()
            self._bending.set_pins(state)
        else:
            self._bending = Bending(self.drawing.mesh, state)
        self._settling = 0
