"""Replays a recording with one deformation method and measures it."""

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

RETURN_STEPS = 60  # on the way back to the rest positions of the pins
JUMP_STEPS = 30  # towards targets that are all set at once
TIMING_REPEATS = 3  # of measurements that are short


@dataclass(frozen=True, eq=False)
class Trace:
    """E_area, E_angle, number of flipped faces and largest pin error (pixels) after each step, (s,) each."""

    area: Floats
    angle: Floats
    flipped: Floats
    pin_error: Floats


@dataclass(frozen=True, eq=False)
class Run:
    """The measures of one method on one recording.

    spec: the method as it was typed; times (f,): seconds of the recording at each step; trace: measures at
    each step; step_seconds (f,): duration of each step; setup_seconds: construction of the deformer;
    pins_seconds: `Deformer.set_pins`.
    points, targets (k, 2): the pins and their targets in the end; pose (n, 2), final_distortion: the settled
    pose and its distortion.
    return_error: largest distance of a vertex from its rest position after the pins went back along their
    path, as a share of √area; return_distortion: the distortion there.
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
    final_distortion: Distortion
    return_error: float
    return_distortion: Distortion
    jump: Trace

    @property
    def pin_error(self) -> float:
        """Largest distance of a pin from its target in the settled pose, pixels."""
        return _pin_error(self.drawing, self.points, self.targets, self.pose)


@dataclass(frozen=True, eq=False)
class ReplayedPoses:
    """The steps of a replay: times and durations in seconds, and states; then the settled pose (n, 2)."""

    times: list[float]
    states: list[EditState]
    step_seconds: list[float]
    pose: Floats


def replay_method(recording: Recording, drawing: Drawing, spec: str) -> ReplayedPoses:
    """Replay a recording with the method ``spec`` (see `parse_method`), and let the drawing settle.

    Raises InputError if the recording has no pins in the end, or does not fit the drawing.
    """
    settings = _settings(spec)
    steps = []
    state: EditState | None = None
    for event in replay(recording, drawing, lambda _: settings):
        state = event.state
        if event.step is not None:
            steps.append((event.time, state, event.step.report.seconds))
    if state is None or not state.pins or not steps:
        raise InputError("recording: expected one that bends a drawing and ends with pins on it, got another")
    times, states, step_seconds = (list(column) for column in zip(*steps, strict=True))
    return ReplayedPoses(times, states, step_seconds, _settled_pose(drawing, state))


def run(recording: Recording, drawing: Drawing, spec: str) -> Run:
    """Replay a recording with the method ``spec``, and measure it. Raises InputError like `replay_method`."""
    replayed = replay_method(recording, drawing, spec)
    points, targets = replayed.states[-1].points, replayed.states[-1].targets
    deformer, setup_seconds, pins_seconds = _time_setup(_settings(spec), drawing, points)
    poses = [state.positions for state in replayed.states]
    returned = _return_to_rest(deformer, drawing, points, poses, replayed.pose)
    return_error = np.linalg.norm(returned - drawing.mesh.vertices, axis=1).max() / drawing.mesh.length
    return Run(
        spec=spec,
        drawing=drawing,
        times=freeze(np.array(replayed.times)),
        trace=_trace(drawing, [(state.positions, state.points, state.targets) for state in replayed.states]),
        step_seconds=freeze(np.array(replayed.step_seconds)),
        setup_seconds=setup_seconds,
        pins_seconds=pins_seconds,
        points=points,
        targets=targets,
        pose=replayed.pose,
        final_distortion=distortion(drawing.mesh, replayed.pose),
        return_error=float(return_error),
        return_distortion=distortion(drawing.mesh, returned),
        jump=_jump_trace(deformer, drawing, points, targets),
    )


def _settings(spec: str) -> Settings:
    method, parameters = parse_method(spec)
    return Settings(method, tuple(sorted(parameters.items())))


def _settled_pose(drawing: Drawing, state: EditState) -> Floats:
    """The pose (n, 2) in which the drawing settles."""
    session = Session(Document(drawing, state))
    session.begin("Settle")
    targets = {pin.id: (float(pin.target[0]), float(pin.target[1])) for pin in state.pins}
    session.apply(SetTargets(targets))
    session.settle()
    return session.state.positions


def _time_setup(settings: Settings, drawing: Drawing, points: MeshPoints) -> tuple[Deformer, float, float]:
    """A deformer with its pins, and the shortest times of its construction and of `set_pins`, in seconds."""
    setup_seconds = pins_seconds = np.inf
    for _ in range(TIMING_REPEATS):
        started = time.perf_counter()
        deformer = make_deformer(settings.method, drawing.mesh, **dict(settings.parameters))
        constructed = time.perf_counter()
        deformer.set_pins(points)
        setup_seconds = min(setup_seconds, constructed - started)
        pins_seconds = min(pins_seconds, time.perf_counter() - constructed)
    return deformer, setup_seconds, pins_seconds


def _return_to_rest(
    deformer: Deformer, drawing: Drawing, points: MeshPoints, poses: list[Floats], pose: Floats
) -> Floats:
    """The pose after the pins went back from ``pose`` through their positions in ``poses`` to rest."""
    mesh = drawing.mesh
    chosen = np.unique(np.linspace(0, len(poses) - 1, RETURN_STEPS).astype(int))[::-1]
    path = [mesh.evaluate(points, poses[index]) for index in chosen]
    path += [mesh.evaluate(points, mesh.vertices)] * (RETURN_STEPS // 5)
    for targets in path:
        pose = deformer.step(pose, targets).positions
    return pose


def _jump_trace(deformer: Deformer, drawing: Drawing, points: MeshPoints, targets: Floats) -> Trace:
    """The measures of steps from the rest pose to targets that are set at once."""
    poses = [drawing.mesh.vertices]
    for _ in range(JUMP_STEPS):
        poses.append(deformer.step(poses[-1], targets).positions)
    return _trace(drawing, [(pose, points, targets) for pose in poses])


def _trace(drawing: Drawing, steps: list[tuple[Floats, MeshPoints, Floats]]) -> Trace:
    """The measures of poses, each with pins and targets."""
    distortions = [distortion(drawing.mesh, pose) for pose, _, _ in steps]
    pin_errors = [_pin_error(drawing, points, targets, pose) for pose, points, targets in steps]
    columns = (
        [each.area for each in distortions],
        [each.angle for each in distortions],
        [float(each.flipped) for each in distortions],
        pin_errors,
    )
    return Trace(*(freeze(np.array(column)) for column in columns))


def _pin_error(drawing: Drawing, points: MeshPoints, targets: Floats, pose: Floats) -> float:
    """Largest distance of a pin from its target, pixels."""
    offsets = drawing.mesh.evaluate(points, pose) - targets
    return float(np.linalg.norm(offsets, axis=1).max(initial=0.0))
