"""Deforms the same pins by a second method, for a comparison side by side."""

from concurrent.futures import Executor
from dataclasses import replace

from ..geometry.distortion import Distortion, distortion
from ..geometry.validation import Floats
from .document.document import Document
from .document.pin import Pin
from .document.settings import Settings
from .session.edits import SetAngles, SetPins, SetScales, SetTargets
from .session.pin_edits import hold_angles
from .session.session import Session
from .session.stepper import INLINE

DEFAULT_METHOD = "arap"


class MethodComparison:
    """A second pose of a session's drawing, which follows the pins and targets of that session.

    spec: its method, in the notation of `parse_method`; session: the second pose, None while it is closed.
    """

    def __init__(self, spec: str = DEFAULT_METHOD) -> None:
        self.spec = spec
        self.session: Session | None = None
        self._session_spec = ""
        self._measured: tuple[Floats, Distortion] | None = None

    @property
    def is_moving(self) -> bool:
        """Whether the second pose has not settled."""
        return self.session is not None and self.session.is_moving

    def follow(self, main: Session, worker: Executor = INLINE, budget: float = 0.0) -> bool:
        """Copy the pins of ``main`` and step once; whether the second pose changed.

        worker: computes the step; budget: seconds to wait for it. A step that takes longer is taken over in a
        later call. With a new drawing or method the second pose starts at the pose of ``main``; whenever
        ``main`` is at rest, so is the second pose. Raises InputError if the method cannot deform the drawing,
        SolverError.
        """
        before = self._pose
        if self.session is not None and self.session.has_pending_step:
            if not self.session.step_is_ready(budget):
                return False
            self.session.step()
        session = self._session_for(main)
        self._copy_pins(session, main.state.pins)
        if session.is_moving:
            session.start_step(worker)
            if session.step_is_ready(budget):
                session.step()
        return self._pose is not before

    def close(self) -> None:
        """Drop the second pose."""
        self.session = None

    def measure(self) -> Distortion | None:
        """The distortion of the second pose, computed once for each pose."""
        if self.session is None:
            return None
        pose = self.session.state.positions
        if self._measured is None or self._measured[0] is not pose:
            self._measured = pose, distortion(self.session.drawing.mesh, pose)
        return self._measured[1]

    @property
    def _pose(self) -> Floats | None:
        return self.session.state.positions if self.session is not None else None

    def _session_for(self, main: Session) -> Session:
        """The session of the second pose; a new one after a reset or another drawing, method or stiffness."""
        session, is_at_rest = self.session, not (main.is_posed or main.is_moving)
        if (
            session is not None
            and session.drawing is main.drawing
            and session.state.stiffness is main.state.stiffness
            and self._session_spec == self.spec
            and not (is_at_rest and session.is_posed)
        ):
            return session
        self.session, self._session_spec = None, self.spec
        state = replace(main.state, settings=Settings.parse(self.spec))
        session = self.session = Session(Document(main.drawing, state))
        if not is_at_rest:
            _copy_goals(session, main.state.pins)
        return session

    @staticmethod
    def _copy_pins(session: Session, pins: tuple[Pin, ...]) -> None:
        if [_anchor(pin) for pin in session.state.pins] != [_anchor(pin) for pin in pins]:
            session.apply(SetPins(pins))
        if any(
            (copy.target != pin.target).any() or (copy.angle, copy.scale) != (pin.angle, pin.scale)
            for copy, pin in zip(session.state.pins, pins, strict=True)
        ):
            _copy_goals(session, pins)


def _copy_goals(session: Session, pins: tuple[Pin, ...]) -> None:
    """Set the targets, angles and scales of a session's pins to those of ``pins``."""
    angles = {pin.id: pin.angle for pin in pins if pin.angle is not None}
    if freed := {pin.id for pin in session.state.pins if pin.angle is not None} - set(angles):
        hold_angles(session, freed, False)
    session.apply(SetTargets({pin.id: (float(pin.target[0]), float(pin.target[1])) for pin in pins}))
    session.apply(SetAngles(angles))
    session.apply(SetScales({pin.id: pin.scale for pin in pins if pin.scale is not None}))


def _anchor(pin: Pin) -> tuple[object, ...]:
    """The identity of a pin and its point of the mesh, comparable."""
    return pin.id, pin.face, *pin.weights.tolist()
