"""Recordings: the events of a session, written and read as one JSON object a line."""

import hashlib
import json
import reprlib
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

import numpy as np

from ...errors import InputError
from ...geometry.json_numbers import bounded_integer, finite_float, refuse_constant
from ...geometry.mesh import TriMesh
from ...words import tr
from ..document.document import Document
from ..document.drawing import Drawing
from ..document.keyframes import Animation
from .edits import (
    EDITS,
    AddPose,
    Edit,
    SetCrossings,
    SetEasing,
    SetJoints,
    SetKeyframe,
    SetLoop,
    SetLoose,
    SetMirror,
    SetPins,
    SetPose,
    SetSettings,
    SetStiffness,
)
from .event_log import Event, EventLog

VERSION = 1
MAX_TIME = 1e7  # seconds, 115 days

# Events that are not edits, with the values that each must have besides its time.
_SESSION_EVENTS: dict[str, tuple[str, ...]] = {
    "begin": ("label",),
    "label": ("label",),
    "commit": (),
    "abort": (),
    "undo": (),
    "redo": (),
    "step": (),
    "return": ("line",),
}
_EVENT_FIELDS = {**_SESSION_EVENTS, **{name: edit.fields for name, edit in EDITS.items()}}


@dataclass(eq=False)
class Recording:
    """The events of a session, in order.

    header: describes the drawing (see `drawing_header`); in a file it also holds the drawing; events:
    dictionaries with "t" (seconds since the start), "do" (the name of the event) and the event's values;
    docs/file-format.md describes them.
    """

    header: dict[str, Any]
    events: list[Event] | EventLog = field(default_factory=list)

    @property
    def duration(self) -> float:
        """Seconds from the start to the last event."""
        return float(self.events[-1]["t"]) if self.events else 0.0

    def to_text(self) -> str:
        """The recording as text: one JSON object a line, the header first."""
        first_line = {"format": "akap-recording", "version": VERSION, "drawing": self.header}
        lines = chain([first_line], self.events)
        return "".join(json.dumps(line, separators=(",", ":")) + "\n" for line in lines)


def mesh_digest(mesh: TriMesh) -> str:
    """A hash of the vertices and faces: a recording's face indices are valid on an equal mesh only."""
    digest = hashlib.sha256(mesh.vertices.astype("<f8").tobytes())
    digest.update(mesh.faces.astype("<i4").tobytes())
    return digest.hexdigest()[:32]


def drawing_header(drawing: Drawing) -> dict[str, Any]:
    """The description of a drawing in the header of its recordings: name, size in pixels, and mesh."""
    header = {
        "name": drawing.name,
        "size": list(drawing.size),
        "vertices": len(drawing.mesh.vertices),
        "mesh": mesh_digest(drawing.mesh),
    }
    made = drawing.meshing
    return header if made is None else {**header, "wanted": made.vertices, "mesher": made.mesher}


def opening_edits(document: Document) -> list[Edit]:
    """The edits that lead from a document in its rest pose, without pins, to ``document``."""
    state, mesh = document.state, document.drawing.mesh
    edits: list[Edit] = [SetSettings(state.settings)]
    if state.stiffness is not None:
        edits.append(SetStiffness(state.stiffness))
    if state.loose is not None:
        loose = state.loose
        edits.append(SetLoose(np.flatnonzero(loose.faces), loose.speed, loose.bounce))
    if not np.array_equal(state.positions, mesh.vertices):
        edits.append(SetPose(state.positions))
    if state.joints:
        edits.append(SetJoints(state.joints))
    if state.pins:
        edits.append(SetPins(state.pins))
    if state.mirror is not None:
        edits.append(SetMirror(state.mirror))
    if len(state.crossings):
        edits.append(SetCrossings(state.crossings))
    edits += [AddPose(pose.name, pose.positions, pose.crossings) for pose in state.poses]
    edits += [
        SetKeyframe(key.time, key.positions, key.ease, key.crossings, key.layers, key.depths)
        for key in state.animation.keyframes
    ]
    if state.animation.ease != Animation.ease:
        edits.append(SetEasing(None, state.animation.ease))
    if not state.animation.loop:
        edits.append(SetLoop(False))
    return edits


def parse_recording(text: str) -> Recording:
    """Read the text of `Recording.to_text`; an incomplete last line is ignored.

    Raises InputError with the number of the bad line.
    """
    lines = text.removesuffix("\n").split("\n")
    parsed: list[dict[str, Any]] = []
    for number, line in enumerate(lines, start=1):
        try:
            value = _parse_line(line)
        except InputError as error:
            raise InputError(tr("recording line {number}: {error}", number=number, error=error)) from error
        except (ValueError, RecursionError) as error:
            if number == 1:
                actual = repr(line[:40]) if line else "nothing"
                raise InputError(
                    tr("recording line 1: expected the header of a recording, got {actual}", actual=actual)
                ) from error
            if number == len(lines) and not text.endswith("\n"):
                break  # the writer was stopped in the middle of a line
            raise InputError(
                tr(
                    "recording line {number}: expected a JSON object, got {line!r}",
                    number=number,
                    line=line[:40],
                )
            ) from error
        if not isinstance(value, dict):
            raise InputError(
                tr(
                    "recording line {number}: expected a JSON object, got {line!r}",
                    number=number,
                    line=line[:40],
                )
            )
        if parsed:
            _check_event(value, number, parsed[-1]["t"] if len(parsed) > 1 else 0.0)
        else:
            _check_first_line(value)
        parsed.append(value)
    return Recording(parsed[0]["drawing"], parsed[1:])


def _parse_line(line: str) -> Any:
    """Read JSON with strict numbers. Raises InputError, ValueError or RecursionError."""
    return json.loads(
        line, parse_int=bounded_integer, parse_float=finite_float, parse_constant=refuse_constant
    )


def _check_first_line(value: dict[str, Any]) -> None:
    if value.get("format") != "akap-recording" or not isinstance(value.get("drawing"), dict):
        raise InputError(tr("recording line 1: expected the header of a recording, got something else"))
    version = value.get("version")
    if version != VERSION:
        raise InputError(
            tr(
                "recording line 1: expected version {version}, got {value}",
                version=VERSION,
                value=reprlib.repr(version),
            )
        )


def _check_event(event: dict[str, Any], number: int, previous_time: float) -> None:
    """Raise InputError if line ``number`` is not an event, or earlier than the one before."""

    def bad(expected: str, actual: str) -> InputError:
        return InputError(
            tr(
                "recording line {number}: expected {expected}, got {actual}",
                number=number,
                expected=expected,
                actual=actual,
            )
        )

    name, time = event.get("do"), event.get("t")
    if not isinstance(name, str) or name not in _EVENT_FIELDS:
        raise bad(tr("one of {names}", names=", ".join(_EVENT_FIELDS)), reprlib.repr(name))
    if isinstance(time, bool) or not isinstance(time, int | float) or not previous_time <= time <= MAX_TIME:
        is_late = isinstance(time, int | float) and time > MAX_TIME
        expected = (
            tr("a time up to {most:g} s", most=MAX_TIME)
            if is_late
            else tr("a time of {time:g} s or later", time=previous_time)
        )
        raise bad(expected, reprlib.repr(time))
    for field_name in _EVENT_FIELDS[name]:
        if field_name not in event:
            raise bad(tr("a value {field_name!r} in {name!r}", field_name=field_name, name=name), "none")
    if name == "return" and not (type(event["line"]) is int and 2 <= event["line"] < number):
        raise bad(tr("an earlier line to return to"), reprlib.repr(event["line"]))
