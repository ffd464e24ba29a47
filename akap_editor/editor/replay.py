"""Does a recorded session again, with or without a window."""

from collections.abc import Iterator

from ..errors import InputError
from ..geometry.checks import as_points
from ..geometry.mesh import TriMesh
from .document import Document, Drawing, EditState, Pin, Settings, new_document
from .recording import Event, Recording, mesh_digest, settings_to_json
from .session import Session

# What a malformed value of an event raises where it is used.
_BAD_EVENT = (AssertionError, AttributeError, KeyError, OverflowError, TypeError, ValueError)


def replay(
    recording: Recording, drawing: Drawing, settings: Settings | None = None
) -> Iterator[tuple[float, EditState]]:
    """Do a recording again on a drawing: the time and the state after each event.

    On the mesh that it was made on, poses are those of the session; on another mesh of the same picture pins
    are found by their place at rest. settings: bend in this way throughout, whatever was recorded.
    Raises InputError with the number of the event's line.
    """
    session: Session | None = None
    same_mesh = recording.header.get("mesh") == mesh_digest(drawing.mesh)
    for number, event in enumerate(recording.events, start=2):
        if event["do"] == "settings" and settings is not None:
            event = {**event, **settings_to_json(settings)}
        try:
            if session is None:
                session = Session(_start(event, drawing))
            _apply(session, event, same_mesh)
        except _BAD_EVENT as error:
            raise InputError(f"recording line {number}: cannot be replayed, {error}") from error
        yield float(event["t"]), session.state


def _start(event: Event, drawing: Drawing) -> Document:
    return new_document(drawing, _settings(event) if event["do"] == "settings" else None)


def _settings(event: Event) -> Settings:
    return Settings(str(event["method"]), tuple(sorted(dict(event["parameters"]).items())))


def _pins(event: Event, mesh: TriMesh, same_mesh: bool) -> tuple[Pin, ...]:
    pins = event["pins"]
    if len({int(pin["id"]) for pin in pins}) < len(pins):
        raise InputError("expected pins with ids of their own, got one id twice")
    if same_mesh:
        points = [(int(pin["face"]), pin["weights"]) for pin in pins]
    else:
        located = mesh.locate([pin["rest"] for pin in pins])
        points = list(zip(located.faces.tolist(), located.weights, strict=True))
    targets = as_points([pin["target"] for pin in pins], "target", len(pins))
    return tuple(
        Pin(int(pin["id"]), face, weights, target)
        for pin, (face, weights), target in zip(pins, points, targets, strict=True)
    )


def _apply(session: Session, event: Event, same_mesh: bool) -> None:
    do = event["do"]
    if do == "begin":
        session.begin(str(event["label"]))
    elif do == "pins":
        session.set_pins(_pins(event, session.drawing.mesh, same_mesh))
    elif do == "settings":
        session.set_settings(_settings(event))
    elif do == "targets":
        session.set_targets({int(pin_id): (x, y) for pin_id, (x, y) in event["targets"].items()})
    elif do == "pose":
        session.set_pose(as_points(event["positions"], "positions", len(session.drawing.mesh.vertices)))
    else:
        {
            "commit": session.commit,
            "abort": session.abort,
            "undo": session.undo,
            "redo": session.redo,
            "reset": session.reset_pose,
            "step": session.step,
        }[do]()
