"""Does a recorded session again, with or without a window."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...deform.deformer import StepResult
from ...errors import InputError, SolverError
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.validation import Floats, as_number, as_points
from ..document.document import EditState, new_document
from ..document.drawing import Drawing, Meshing
from ..document.pin import Pin
from ..document.pin_angles import MOST_ANGLE
from ..document.remesh import remeshed
from ..document.settings import Settings
from .recording import Event, Recording, mesh_digest, settings_to_json
from .session import Session

# What a malformed value of an event raises where it is used.
_BAD_EVENT = (AssertionError, AttributeError, KeyError, OverflowError, TypeError, ValueError)
# What changes one of the lists that a state has.
_LISTS = {
    **dict.fromkeys(("keep", "forget", "rename", "order"), "poses"),
    **dict.fromkeys(("key", "unkey", "rekey", "ease", "loop"), "keyframes"),
}
_SAME_PLACE = 1e-6  # pixels
_SAME_SHAPE = 0.01  # pictures whose proportions differ by less show the same


class ReplayedEvent(NamedTuple):
    """What one event of a recording led to.

    time: in seconds since the start; state: after the event; step: its result where the event was a step;
    jumped: whether the pose changed in another way than by a step.
    """

    time: float
    state: EditState
    step: StepResult | None = None
    jumped: bool = False


@dataclass(frozen=True)
class _ReplayTarget:
    """Where a recording is done again: whether on its own mesh, and how much larger than it was."""

    mesh: TriMesh
    same_mesh: bool
    scale: float

    def places(self, values: Any, name: str, count: int) -> Floats:
        """Recorded places (count, 2) in pixels of this drawing."""
        return self.scale * as_points(values, name, count)


class Replay:
    """A recording that is done again on a drawing, see `replay`.

    session: what it is done to, once it has begun; its own recording says the same with the same times.
    """

    def __init__(
        self,
        recording: Recording,
        drawing: Drawing,
        change: Callable[[Settings], Settings] | None = None,
    ) -> None:
        self.session: Session | None = None
        self._recording, self._drawing, self._change = recording, drawing, change
        self._now = 0.0
        self._ended: float | None = None  # by the clock

    def moments(self) -> Iterator[ReplayedEvent]:
        """Do it, event by event. Raises InputError with the number of the event's line, SolverError."""
        stage = _stage(self._recording, self._drawing)
        returns = {event["line"] for event in self._recording.events if event["do"] == "return"}
        kept: dict[int, tuple[EditState, int]] = {}  # states to return to, with their lines in the session's
        for line, event in enumerate(self._recording.events, start=2):
            self._now = float(event["t"])
            before = None if self.session is None else self.session.state.positions
            try:
                step = self._do(event, stage, kept)
            except (*_BAD_EVENT, InputError) as error:
                raise InputError(f"recording line {line}: cannot be replayed, {error}") from error
            except SolverError as error:
                raise SolverError(f"recording line {line}: {error}") from error
            assert self.session is not None
            if line in returns:
                kept[line] = self.session.state, len(self.session.recording.events) + 1
            jumped = step is None and before is not None and self.session.state.positions is not before
            yield ReplayedEvent(self._now, self.session.state, step, jumped)

    def _do(
        self, event: Event, stage: _ReplayTarget, kept: dict[int, tuple[EditState, int]]
    ) -> StepResult | None:
        opens = event["do"] == "settings"
        if opens and self._change is not None:
            event = {**event, **settings_to_json(self._change(_settings(event)))}
        if self.session is None:
            settings = _settings(event) if opens else None
            self.session = Session(new_document(self._drawing, settings), self.clock, 0.0)
            if opens:  # so a session begins
                return None
        return _apply(self.session, event, stage, kept)

    def clock(self) -> float:
        """The time of what is being done, and after `end` that which has passed since."""
        return self._now if self._ended is None else self._now + time.monotonic() - self._ended

    def end(self) -> Session:
        """The session as it came out, to go on with; a gesture that was not ended is."""
        assert self.session is not None, "expected something that was done"
        if self.session.history.is_open:
            self.session.commit()
        self.session.halt()
        self._ended = time.monotonic()
        return self.session


def replay(
    recording: Recording, drawing: Drawing, change: Callable[[Settings], Settings] | None = None
) -> Iterator[ReplayedEvent]:
    """Do a recording again on a drawing: what each event led to.

    On the mesh that it was made on, poses are those of the session. On another mesh of the same picture, also
    in another size, pins are found by their place at rest. change: makes other settings of those recorded.
    Raises InputError with the number of the event's line, SolverError where a step fails.
    """
    yield from Replay(recording, drawing, change).moments()


def _stage(recording: Recording, drawing: Drawing) -> _ReplayTarget:
    """Raises InputError where a recording was made on a picture of other proportions."""
    header = recording.header
    same_mesh = header.get("mesh") == mesh_digest(drawing.mesh)
    if same_mesh or "size" not in header:
        return _ReplayTarget(drawing.mesh, same_mesh, 1.0)
    width, height = drawing.size
    try:
        recorded_width, recorded_height = map(float, header["size"])
        scale = width / recorded_width
        fits = abs(height / (scale * recorded_height) - 1) < _SAME_SHAPE
    except (TypeError, ValueError, ZeroDivisionError) as error:
        raise InputError(f"recording line 1: expected a size in pixels, got {header['size']!r}") from error
    if not fits:
        raise InputError(
            f"recording line 1: it was made on {header.get('name')!r}, {recorded_width:g} x "
            f"{recorded_height:g} pixels, and fits drawings of these proportions only, but {drawing.name!r} "
            f"has {width} x {height}"
        )
    return _ReplayTarget(drawing.mesh, same_mesh, scale)


def _settings(event: Event) -> Settings:
    return Settings(str(event["method"]), tuple(sorted(dict(event["parameters"]).items())))


def _meshing(event: Event, stage: _ReplayTarget) -> Meshing:
    tolerance = event["background"]
    return Meshing(
        int(event["vertices"]),
        stage.scale * float(event["expand"]),
        float(event["threshold"]),
        None if tolerance is None else float(tolerance),
    )


def _pins(event: Event, stage: _ReplayTarget, mesh: TriMesh) -> tuple[Pin, ...]:
    pins = event["pins"]
    if len({int(pin["id"]) for pin in pins}) < len(pins):
        raise InputError("expected pins with ids of their own, got one id twice")
    if stage.same_mesh and (mesh is stage.mesh or _fit(pins, mesh)):
        points = [(int(pin["face"]), pin["weights"]) for pin in pins]
    else:
        located = mesh.locate(stage.places([pin["rest"] for pin in pins], "rest", len(pins)))
        points = list(zip(located.faces.tolist(), located.weights, strict=True))
    targets = stage.places([pin["target"] for pin in pins], "target", len(pins))
    return tuple(
        Pin(int(pin["id"]), face, weights, target, int(pin.get("depth", 0)), _angle(pin.get("angle")))
        for pin, (face, weights), target in zip(pins, points, targets, strict=True)
    )


def _angle(value: Any) -> float | None:
    return None if value is None else as_number(value, "angle", -MOST_ANGLE, MOST_ANGLE)


def _fit(pins: list[Any], mesh: TriMesh) -> bool:
    """Whether faces and weights of recorded pins hold on a mesh that was made anew."""
    if any(not 0 <= int(pin["face"]) < len(mesh.faces) for pin in pins):
        return False
    weights = as_points([pin["weights"] for pin in pins], "weights", len(pins), columns=3)
    points = MeshPoints(np.array([int(pin["face"]) for pin in pins], dtype=np.int32), weights)
    away = mesh.evaluate(points, mesh.vertices) - as_points([pin["rest"] for pin in pins], "rest", len(pins))
    return bool(np.abs(away).max(initial=0.0) < _SAME_PLACE)


def _stiffen(session: Session, event: Event, stage: _ReplayTarget) -> None:
    if event["do"] == "paint":
        dabs = stage.places(event["dabs"], "dabs", len(event["dabs"]))
        session.paint_stiffness(dabs, stage.scale * float(event["radius"]), event["factor"])
    elif stage.same_mesh or event["factors"] is None:
        session.set_stiffness(event["factors"])
    else:
        raise ValueError("stiffness fits only the mesh that it was made on")


def _apply(
    session: Session, event: Event, stage: _ReplayTarget, kept: dict[int, tuple[EditState, int]]
) -> StepResult | None:
    """Do one event; the result where it is a step."""
    do = event["do"]
    if do == "step":
        return session.step()
    if do == "begin":
        session.begin(str(event["label"]))
    elif do == "label":
        session.rename(str(event["label"]))
    elif do == "pins":
        session.halt()  # what was still moving then is in their targets
        session.set_pins(_pins(event, stage, session.drawing.mesh))
    elif do == "settings":
        session.set_settings(_settings(event))
    elif do == "targets":
        places = stage.places(list(event["targets"].values()), "targets", len(event["targets"]))
        session.set_targets(dict(zip(map(int, event["targets"]), map(tuple, places), strict=True)))
    elif do == "angles":
        session.turn_pins({int(pin): angle for pin, angle in event["angles"].items()})
    elif do in ("stiffness", "paint"):
        _stiffen(session, event, stage)
    elif do == "pose":
        if not stage.same_mesh:
            raise ValueError("a pose fits only the mesh that it was made on")
        session.set_pose(as_points(event["positions"], "positions", len(session.drawing.mesh.vertices)))
    elif do == "mesh":
        session.set_drawing(remeshed(session.drawing, _meshing(event, stage)))
    elif do in _LISTS:
        if "positions" in event and not stage.same_mesh:
            raise ValueError("a pose fits only the mesh that it was made on")
        change = session.change_poses if _LISTS[do] == "poses" else session.animate
        change(do, **{name: value for name, value in event.items() if name not in ("t", "do")})
    elif do == "return":
        session.go_back(*kept[event["line"]])
    else:
        {
            "commit": lambda: session.commit(event.get("join") is True),
            "abort": session.abort,
            "undo": session.undo,
            "redo": session.redo,
            "reset": session.reset_pose,
            "bake": session.bake_pose,
        }[do]()
    return None
