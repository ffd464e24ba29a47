"""One recording bent by one method, and all that is measured on the way."""

import time
from dataclasses import dataclass

import numpy as np

from ..deform.deformer import Deformer
from ..deform.methods import make_deformer, parse_method
from ..editor.document.document import Document, EditState
from ..editor.document.drawing import Drawing
from ..editor.document.settings import Settings
from ..editor.session.edits import SetTargets
from ..editor.session.recording import Recording
from ..editor.session.replay import replay
from ..editor.session.session import Session
from ..errors import InputError
from ..geometry.distortion import Distortion, distortion
from ..geometry.mesh import MeshPoints
from ..geometry.validation import Floats, freeze

WAY_BACK = 60  # steps of the way back
JUMP = 30  # steps towards targets that were set at once
REPEATS = 3  # of what is timed and takes but a moment


@dataclass(frozen=True, eq=False)
class Trace:
    """Measures after each step: (s,) arrays. area, angle: E_area and E_angle; pin_error: pixels."""

    area: Floats
    angle: Floats
    flipped: Floats
    pin_error: Floats


@dataclass(frozen=True, eq=False)
class Run:
    """What one method made of one recording.

    spec: the method as it was typed; times (f,): seconds of the recording at each frame; trace: measures at
    each frame; step_seconds (f,): how long each took; setup_seconds: for the mesh; pins_seconds: for choosing
    pins. points, targets (k, 2), pose (n, 2), after: pins, where they should be, the pose at rest there, its
    measures. back: the farthest that a vertex is from its rest pose after the pins were led back the way they
    came, as a share of √area; back_after: the distortion there.
    jump: measures after each step from the rest pose with the last targets set at once.
    """

    spec: str
    drawing: Drawing
    times: Floats
    trace: Trace
    step_seconds: Floats
    setup_seconds: float
    pins_seconds: float
    points: MeshPoints
    targets: Floats
    pose: Floats
    after: Distortion
    back: float
    back_after: Distortion
    jump: Trace

    @property
    def pin_error(self) -> float:
        """Largest distance of a pin from its target in the last pose, pixels."""
        return _pin_error(self.drawing, self.points, self.targets, self.pose)


@dataclass(frozen=True, eq=False)
class ReplayedPoses:
    """Where a recording led: times and states of its steps, what each took, and the settled pose (n, 2)."""

    times: list[float]
    states: list[EditState]
    seconds: list[float]
    pose: Floats


def bend(recording: Recording, drawing: Drawing, spec: str) -> ReplayedPoses:
    """Bend a drawing as recorded by the method ``spec`` (see `parse_method`), and let it settle.

    Raises InputError where a recording has no pins in the end, or does not fit the drawing.
    """
    settings = _settings(spec)
    steps = []
    state: EditState | None = None
    for moment in replay(recording, drawing, lambda _: settings):
        state = moment.state
        if moment.step is not None:
            steps.append((moment.time, state, moment.step.report.seconds))
    if state is None or not state.pins or not steps:
        raise InputError("recording: expected one that bends a drawing and ends with pins on it, got another")
    times, states, seconds = (list(column) for column in zip(*steps, strict=True))
    return ReplayedPoses(times, states, seconds, _settled(drawing, state))


def run(recording: Recording, drawing: Drawing, spec: str) -> Run:
    """Bend a drawing as recorded by the method ``spec``, and measure. Raises InputError like `bend`."""
    bent = bend(recording, drawing, spec)
    points, targets = bent.states[-1].points, bent.states[-1].targets
    deformer, setup, pins = _timed(_settings(spec), drawing, points)
    returned = _led_back(deformer, drawing, points, [state.positions for state in bent.states], bent.pose)
    size = drawing.mesh.length
    return Run(
        spec=spec,
        drawing=drawing,
        times=freeze(np.array(bent.times)),
        trace=_traced(drawing, [(state.positions, state.points, state.targets) for state in bent.states]),
        step_seconds=freeze(np.array(bent.seconds)),
        setup_seconds=setup,
        pins_seconds=pins,
        points=points,
        targets=targets,
        pose=bent.pose,
        after=distortion(drawing.mesh, bent.pose),
        back=float(np.linalg.norm(returned - drawing.mesh.vertices, axis=1).max() / size),
        back_after=distortion(drawing.mesh, returned),
        jump=_jumped(deformer, drawing, points, targets),
    )


def _settings(spec: str) -> Settings:
    method, settings = parse_method(spec)
    return Settings(method, tuple(sorted(settings.items())))


def _settled(drawing: Drawing, state: EditState) -> Floats:
    """The pose (n, 2) once the drawing has come to rest under its pins."""
    session = Session(Document(drawing, state))
    session.begin("Settle")
    targets = {pin.id: (float(pin.target[0]), float(pin.target[1])) for pin in state.pins}
    session.apply(SetTargets(targets))
    session.settle()
    return session.state.positions


def _timed(settings: Settings, drawing: Drawing, points: MeshPoints) -> tuple[Deformer, float, float]:
    """A deformer with its pins, and the least seconds that making it and choosing pins took."""
    setup = pins = np.inf
    for _ in range(REPEATS):
        started = time.perf_counter()
        deformer = make_deformer(settings.method, drawing.mesh, **dict(settings.parameters))
        made = time.perf_counter()
        deformer.set_pins(points)
        setup, pins = min(setup, made - started), min(pins, time.perf_counter() - made)
    return deformer, setup, pins


def _led_back(
    deformer: Deformer, drawing: Drawing, points: MeshPoints, poses: list[Floats], last: Floats
) -> Floats:
    """The pose after the pins went back through all places where the drawing had them, to their rest."""
    mesh, pose = drawing.mesh, last
    chosen = np.unique(np.linspace(0, len(poses) - 1, WAY_BACK).astype(int))[::-1]
    way = [mesh.evaluate(points, poses[index]) for index in chosen]
    for targets in [*way, *[mesh.evaluate(points, mesh.vertices)] * (WAY_BACK // 5)]:
        pose = deformer.step(pose, targets).positions
    return pose


def _jumped(deformer: Deformer, drawing: Drawing, points: MeshPoints, targets: Floats) -> Trace:
    poses = [drawing.mesh.vertices]
    for _ in range(JUMP):
        poses.append(deformer.step(poses[-1], targets).positions)
    return _traced(drawing, [(pose, points, targets) for pose in poses])


def _traced(drawing: Drawing, moments: list[tuple[Floats, MeshPoints, Floats]]) -> Trace:
    found = [distortion(drawing.mesh, pose) for pose, _, _ in moments]
    errors = [_pin_error(drawing, points, targets, pose) for pose, points, targets in moments]
    columns = (
        [after.area for after in found],
        [after.angle for after in found],
        [float(after.flipped) for after in found],
        errors,
    )
    return Trace(*(freeze(np.array(column)) for column in columns))


def _pin_error(drawing: Drawing, points: MeshPoints, targets: Floats, pose: Floats) -> float:
    off = drawing.mesh.evaluate(points, pose) - targets
    return float(np.linalg.norm(off, axis=1).max(initial=0.0))
