"""Replays a recording on a drawing, with or without a window."""

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from ...deform.deformer import StepResult
from ...display_text import shortened
from ...errors import InputError, SolverError
from ...meshing.meshers import TRIANGLE
from ...words import tr
from ..document.document import EditState, new_document
from ..document.drawing import Drawing
from ..document.settings import Settings
from .edits import EDITS, Remesh, ReplayTarget, SetPins, SetSettings
from .recording import Event, Recording, mesh_digest
from .session import Session

# Exceptions raised by malformed values of an event.
_BAD_EVENT = (AssertionError, AttributeError, KeyError, OverflowError, TypeError, ValueError)
_MAX_REASON = 300  # characters of why an event cannot be replayed
_MAX_ASPECT_ERROR = 0.01  # aspect ratios that differ by less, as a share, are equal

# Events of gestures and the history; the others are edits, steps, and returns to an earlier state.
_GESTURES: dict[str, Callable[[Session, Event], None]] = {
    "begin": lambda session, event: session.begin(str(event["label"])),
    "label": lambda session, event: session.rename(str(event["label"])),
    "commit": lambda session, event: session.commit(event.get("join") is True),
    "abort": lambda session, event: session.abort(),
    "undo": lambda session, event: session.undo(),
    "redo": lambda session, event: session.redo(),
}


class ReplayedEvent(NamedTuple):
    """An event of a recording that was replayed.

    time: seconds since the start; state: after the event; step: its result if the event was a step; is_jump:
    whether the pose changed by anything but a step.
    """

    time: float
    state: EditState
    step: StepResult | None = None
    is_jump: bool = False


class Replay:
    """Replays a recording on a drawing, see `replay`, and leaves a session to go on with.

    session: the session in which it is replayed, None before the first event; its own recording holds the
    same events with the same times.
    """

    def __init__(
        self,
        recording: Recording,
        drawing: Drawing,
        change: Callable[[Settings], Settings] | None = None,
    ) -> None:
        self.session: Session | None = None
        self._recording, self._drawing, self._change = recording, drawing, change
        self._target: ReplayTarget
        self._now = 0.0  # seconds of the recording
        self._end: float | None = None  # when the replay ended, by the system's clock
        # States to which later events return, by line, with their lines in the session's own recording.
        self._earlier: dict[int, tuple[EditState, int]] = {}

    def events(self) -> Iterator[ReplayedEvent]:
        """Replay event by event.

        Raises InputError with the number of the event's line, and SolverError.
        """
        self._target = replay_target(self._recording, self._drawing)
        returned_to = {event["line"] for event in self._recording.events if event["do"] == "return"}
        for line, event in enumerate(self._recording.events, start=2):
            self._now = float(event["t"])
            before = None if self.session is None else self.session.state.positions
            try:
                step = self._replay_event(event)
            except (*_BAD_EVENT, InputError) as error:
                raise InputError(
                    tr(
                        "recording line {line}: cannot be replayed, {error}",
                        line=line,
                        error=shortened(str(error), _MAX_REASON),
                    )
                ) from error
            except SolverError as error:
                raise SolverError(tr("recording line {line}: {error}", line=line, error=error)) from error
            assert self.session is not None
            if line in returned_to:
                self._earlier[line] = self.session.state, len(self.session.recording.events) + 1
            is_jump = step is None and before is not None and self.session.state.positions is not before
            yield ReplayedEvent(self._now, self.session.state, step, is_jump)

    def _replay_event(self, event: Event) -> StepResult | None:
        """Replay one event; returns the result of a step, None for other events."""
        do = event["do"]
        if do == SetSettings.name and self._change is not None:
            event = {**event, **self._change(Settings.from_json(event)).to_json()}
        if self.session is None:
            opens = do == SetSettings.name  # every session's recording begins with its settings
            settings = Settings.from_json(event) if opens else None
            self.session = Session(new_document(self._drawing, settings), self.clock, 0.0)
            if opens:
                return None
        session = self.session
        if do == "step":
            return session.step()
        if do == "return":
            session.return_to(*self._earlier[event["line"]])
        elif do in _GESTURES:
            _GESTURES[do](session, event)
        else:
            edit = EDITS[do].from_json(event, self._target, session.drawing)
            if isinstance(edit, SetPins):
                session.stop_motion()  # the recorded targets are those that the pins were fixed at
            session.apply(edit)
            if isinstance(edit, Remesh) and edit.meshing.mesher != event.get("mesher", TRIANGLE):
                self._target = replace(self._target, same_mesh=False)  # the recorded one is not installed
        return None

    def clock(self) -> float:
        """Seconds of the recording; after `end` the system's clock continues from its last time."""
        return self._now if self._end is None else self._now + time.monotonic() - self._end

    def end(self) -> Session:
        """Commit a gesture that is still open, and stop the motion; returns the session to go on with."""
        assert self.session is not None, "expected a recording with at least one event"
        if self.session.history.is_open:
            self.session.commit()
        self.session.stop_motion()
        self._end = time.monotonic()
        return self.session


def replay(
    recording: Recording, drawing: Drawing, change: Callable[[Settings], Settings] | None = None
) -> Iterator[ReplayedEvent]:
    """Replay a recording on a drawing, event by event.

    On an equal mesh the poses are those of the recorded session to the last bit. On another mesh of the same
    picture, in any size, pins are located by their rest positions. change: replaces the recorded settings.
    Raises InputError on events that do not fit the drawing, SolverError if a step fails; both name the line.
    """
    yield from Replay(recording, drawing, change).events()


def replay_target(recording: Recording, drawing: Drawing) -> ReplayTarget:
    """How a recording fits a drawing. Raises InputError if its picture has another aspect ratio."""
    header = recording.header
    same_mesh = header.get("mesh") == mesh_digest(drawing.mesh)
    if same_mesh or "size" not in header:
        return ReplayTarget(drawing.mesh, same_mesh, 1.0)
    width, height = drawing.size
    try:
        recorded_width, recorded_height = map(float, header["size"])
        scale = width / recorded_width
        fits = abs(height / (scale * recorded_height) - 1) < _MAX_ASPECT_ERROR
    except (TypeError, ValueError, ZeroDivisionError) as error:
        raise InputError(
            tr("recording line 1: expected a size in pixels, got {value!r}", value=header["size"])
        ) from error
    if not fits:
        raise InputError(
            tr(
                "recording line 1: it was made on {value!r}, {recorded_width:g} x "
                "{recorded_height:g} pixels, and fits drawings of these proportions only, but {name!r} "
                "has {width} x {height}",
                value=header.get("name"),
                recorded_width=recorded_width,
                recorded_height=recorded_height,
                name=drawing.name,
                width=width,
                height=height,
            )
        )
    return ReplayTarget(drawing.mesh, same_mesh, scale)
