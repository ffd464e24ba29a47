"""The same pins bent by a second method at the same time, to be seen beside the first."""

from concurrent.futures import Executor
from dataclasses import replace

from ..geometry.distortion import Distortion, distortion
from ..geometry.validation import Floats
from .document.document import Document
from .document.pin import Pin
from .document.settings import Settings
from .session.edits import SetAngles, SetPins, SetTargets
from .session.pin_edits import hold_angles
from .session.session import Session
from .session.stepper import INLINE

FIRST = "arap"


class MethodComparison:
    """A second pose of a session's drawing. It follows the session's pins and targets and changes neither.

    spec: its method, as `parse_method` reads it.
    """

    def __init__(self, spec: str = FIRST) -> None:
        self.spec = spec
        self.session: Session | None = None
        self._made = ""
        self._measured: tuple[Floats, Distortion] | None = None

    @property
    def moving(self) -> bool:
        """Whether it has not come to rest under its pins."""
        return self.session is not None and self.session.is_moving

    @property
    def waiting(self) -> bool:
        """Whether nothing moves until a worker is done with a step."""
        return self.session is not None and self.session.has_pending_step and not self.session.step_is_ready()

    def follow(self, main: Session, worker: Executor = INLINE, budget: float = 0.0) -> None:
        """Once a frame: take over what was done to the pins of ``main``, and go one step.

        worker: computes it; budget: seconds to wait for that; a longer step is left to a later call.

        A new drawing or method starts from the pose of ``main``, and where that is at rest, so is this one.
        Raises InputError where the drawing is none for the method, SolverError.
        """
        if self.session is not None and self.session.has_pending_step:
            if not self.session.step_is_ready(budget):
                return
            self.session.step()
        own, at_rest = self.session, not (main.is_posed or main.is_moving)
        known = own is not None and own.drawing is main.drawing and self._made == self.spec
        known = known and own is not None and own.state.stiffness is main.state.stiffness
        if own is None or not known or (at_rest and own.is_posed):
            self.session, self._made = None, self.spec
            state = replace(main.state, settings=Settings.parse(self.spec))
            own = self.session = Session(Document(main.drawing, state))
            if not at_rest:
                self._aim(own, main.state.pins)
        if [_place(pin) for pin in own.state.pins] != [_place(pin) for pin in main.state.pins]:
            own.apply(SetPins(main.state.pins))
        if any(
            (mine.target != its.target).any() or mine.angle != its.angle
            for mine, its in zip(own.state.pins, main.state.pins, strict=True)
        ):
            self._aim(own, main.state.pins)
        if own.is_moving:
            own.start_step(worker)
            if own.step_is_ready(budget):
                own.step()

    def close(self) -> None:
        """Forget the pose."""
        self.session = None

    def measure(self) -> Distortion | None:
        """The distortion of its pose, computed once for each pose."""
        if self.session is None:
            return None
        pose = self.session.state.positions
        if self._measured is None or self._measured[0] is not pose:
            self._measured = pose, distortion(self.session.drawing.mesh, pose)
        return self._measured[1]

    @staticmethod
    def _aim(own: Session, pins: tuple[Pin, ...]) -> None:
        held = {pin.id: pin.angle for pin in pins if pin.angle is not None}
        if freed := {pin.id for pin in own.state.pins if pin.angle is not None} - set(held):
            hold_angles(own, freed, False)
        targets = {pin.id: (float(pin.target[0]), float(pin.target[1])) for pin in pins}
        own.apply(SetTargets(targets))
        own.apply(SetAngles(held))


def _place(pin: Pin) -> tuple[object, ...]:
    """What tells whether two pins are the same one."""
    return pin.id, pin.face, *pin.weights.tolist()
