"""What was done in a session, as a list that can be done again."""

import hashlib
import json
import reprlib
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

import numpy as np

from ...errors import InputError
from ...geometry.mesh import TriMesh
from ..document.document import Document
from ..document.drawing import Drawing
from ..document.keyframes import Animation
from .edits import (
    EDITS,
    AddPose,
    Edit,
    SetEasing,
    SetKeyframe,
    SetLoop,
    SetPins,
    SetPose,
    SetSettings,
    SetStiffness,
)
from .event_log import Event, EventLog

VERSION = 1
MAX_TIME = 1e9  # seconds

# Events that are not edits, with the values that each must have besides its time.
SESSION_EVENTS: dict[str, tuple[str, ...]] = {
    "begin": ("label",),
    "label": ("label",),
    "commit": (),
    "abort": (),
    "undo": (),
    "redo": (),
    "step": (),
    "return": ("line",),
}
_FIELDS = {**SESSION_EVENTS, **{name: edit.fields for name, edit in EDITS.items()}}


@dataclass(eq=False)
class Recording:
    """A session's pin edits, targets and settings with times.

    header: the drawing that it was made on (see `drawing_header`), in a file also the drawing itself; events:
    dictionaries with "t" (seconds since the start), "do" (what was done) and that event's values.
    docs/file-format.md describes them.
    """

    header: dict[str, Any]
    events: list[Event] | EventLog = field(default_factory=list)

    @property
    def duration(self) -> float:
        """Seconds from the start to the last event."""
        return float(self.events[-1]["t"]) if self.events else 0.0

    def to_text(self) -> str:
        """One JSON object a line, the header first."""
        head = {"format": "akap-recording", "version": VERSION, "drawing": self.header}
        lines = chain([head], self.events)
        return "".join(json.dumps(line, separators=(",", ":")) + "\n" for line in lines)


def mesh_digest(mesh: TriMesh) -> str:
    """A short name for exactly this mesh, to tell whether face numbers of a recording fit."""
    digest = hashlib.sha256(mesh.vertices.astype("<f8").tobytes())
    digest.update(mesh.faces.astype("<i4").tobytes())
    return digest.hexdigest()[:32]


def drawing_header(drawing: Drawing) -> dict[str, Any]:
    """What a recording says about its drawing."""
    header = {
        "name": drawing.name,
        "size": list(drawing.size),
        "vertices": len(drawing.mesh.vertices),
        "mesh": mesh_digest(drawing.mesh),
    }
    return header if drawing.meshing is None else {**header, "wanted": drawing.meshing.vertices}


def opening_edits(document: Document) -> list[Edit]:
    """The edits that lead from a drawing at rest to a document that was opened."""
    state, mesh = document.state, document.drawing.mesh
    edits: list[Edit] = [SetSettings(state.settings)]
    if state.stiffness is not None:
        edits.append(SetStiffness(state.stiffness))
    if not np.array_equal(state.positions, mesh.vertices):
        edits.append(SetPose(state.positions))
    if state.pins:
        edits.append(SetPins(state.pins))
    edits += [AddPose(pose.name, pose.positions) for pose in state.poses]
    edits += [SetKeyframe(key.time, key.positions, key.ease) for key in state.animation.keyframes]
    if state.animation.ease != Animation.ease:
        edits.append(SetEasing(None, state.animation.ease))
    if not state.animation.loop:
        edits.append(SetLoop(False))
    return edits


def parse_recording(text: str) -> Recording:
    """Read what `to_text` wrote. A last line that was cut off is left out.

    Raises InputError with the line's number.
    """
    lines = text.removesuffix("\n").split("\n")
    parsed: list[dict[str, Any]] = []
    for number, line in enumerate(lines, start=1):
        try:
            value = json.loads(line)
        except (ValueError, RecursionError) as error:
            if number == 1:
                came = repr(line[:40]) if line else "nothing"
                raise InputError(
                    f"recording line 1: expected the header of a recording, got {came}"
                ) from error
            if number == len(lines) and not text.endswith("\n"):
                break  # the writer was stopped in the middle of a line
            raise InputError(f"recording line {number}: expected a JSON object, got {line[:40]!r}") from error
        if not isinstance(value, dict):
            raise InputError(f"recording line {number}: expected a JSON object, got {line[:40]!r}")
        if parsed:
            _check_event(value, number, parsed[-1]["t"] if len(parsed) > 1 else 0.0)
        else:
            _check_head(value)
        parsed.append(value)
    return Recording(parsed[0]["drawing"], parsed[1:])


def _check_head(head: dict[str, Any]) -> None:
    if head.get("format") != "akap-recording" or not isinstance(head.get("drawing"), dict):
        raise InputError("recording line 1: expected the header of a recording, got something else")
    version = head.get("version")
    if version != VERSION:
        raise InputError(f"recording line 1: expected version {VERSION}, got {reprlib.repr(version)}")


def _check_event(event: dict[str, Any], number: int, previous: float) -> None:
    do, when = event.get("do"), event.get("t")
    if not isinstance(do, str) or do not in _FIELDS:
        came = reprlib.repr(do)
        raise InputError(f"recording line {number}: expected one of {', '.join(_FIELDS)}, got {came}")
    if isinstance(when, bool) or not isinstance(when, int | float) or not previous <= when <= MAX_TIME:
        came = reprlib.repr(when)
        raise InputError(f"recording line {number}: expected a time of {previous:g} s or later, got {came}")
    for name in _FIELDS[do]:
        if name not in event:
            raise InputError(f"recording line {number}: expected a value {name!r} in {do!r}, got none")
    if do == "return" and not (type(event["line"]) is int and 2 <= event["line"] < number):
        came = reprlib.repr(event["line"])
        raise InputError(f"recording line {number}: expected an earlier line to return to, got {came}")
