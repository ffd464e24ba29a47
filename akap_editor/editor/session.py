"""One drawing being bent: document, history, deformer and recording, without pointer or view."""

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..deform.deformer import Deformer, StepResult, make_deformer
from ..errors import InputError, SolverError
from ..geometry.checks import Floats, as_points
from .document import Document, Drawing, EditState, Pin, Settings
from .history import History
from .recording import Recording, drawing_header, pins_to_json, settings_to_json

PIN_TOLERANCE = 0.25  # pixels: a pin nearer than this to its target has arrived
STILL = 0.02  # pixels: a step that moves no vertex farther has come to rest
MOST_SETTLING = 400  # steps after the last change of a target, should a pose never come to rest
REACH = 0.02  # longest way of a pin in one step, as a share of √area: no step keeps the caller waiting

Target = tuple[float, float]


class Session:
    """The state of one open drawing and everything that may change it.

    Edits happen inside a gesture: `begin`, any number of edits and steps, then `commit` or `abort`. Adding or
    removing pins moves no vertex; only `step` does. All edits are written to `recording`, with times from
    ``clock`` (seconds).
    """

    def __init__(self, document: Document, clock: Callable[[], float] = time.monotonic) -> None:
        self.document = document
        self.history = History()
        self.last_step: StepResult | None = None
        self._saved: EditState | None = document.state
        self._settling = 0
        self._reach = REACH * float(np.sqrt(document.drawing.mesh.rest_areas.sum()))
        self._clock, self._started = clock, clock()
        self.recording = Recording(drawing_header(document.drawing))
        self._deformer = self._make_deformer(document.state.settings)
        self._deformer.set_pins(document.state.points)
        self._record("settings", **settings_to_json(document.state.settings))
        if self.posed:
            self._record("pose", positions=document.state.positions.tolist())
        if document.state.pins:
            self._record("pins", pins=pins_to_json(document.drawing.mesh, document.state.pins))

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
    def modified(self) -> bool:
        """Whether there is something that the file does not hold."""
        return self.document.state is not self._saved

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

    def pin_error(self) -> float:
        """Largest distance of a pin from where it should be, pixels."""
        return float(np.linalg.norm(self.state.targets - self.pin_positions(), axis=1).max(initial=0.0))

    # -- gestures ------------------------------------------------------------------------------------------

    def begin(self, label: str) -> None:
        """Start a gesture."""
        self.history.begin(label, self.state)
        self._record("begin", label=label)

    def commit(self) -> None:
        """End the gesture: one undo entry, or none where nothing changed. The pose may go on to settle."""
        if self.history.unchanged(self.state):
            self.history.abort()
        else:
            self.history.commit()
        self._record("commit")

    def abort(self) -> None:
        """End the gesture and restore the state from before it, bit for bit."""
        settling = self._settling if self.history.unchanged(self.state) else 0
        self._restore(self.history.abort())
        self._settling = settling
        self._record("abort")

    def undo(self) -> None:
        """Back to the state before the last gesture, if there is one."""
        if self.history.undo_label is not None and not self.history.is_open:
            self._restore(self.history.undo(self.state))
            self._record("undo")

    def redo(self) -> None:
        """Forward again, if something was undone."""
        if self.history.redo_label is not None and not self.history.is_open:
            self._restore(self.history.redo(self.state))
            self._record("redo")

    # -- edits, inside a gesture ---------------------------------------------------------------------------

    def add_pin(self, at: Target) -> int | None:
        """A pin exactly on what is seen at ``at`` in the current pose; its id, or None beside the drawing."""
        found = self.drawing.mesh.find(at, self.state.positions)
        if found is None:
            return None
        pin_id = 1 + max((pin.id for pin in self.state.pins), default=0)
        pin = Pin(pin_id, int(found.faces[0]), found.weights[0], np.array(at, dtype=np.float64))
        self.set_pins((*self.state.pins, pin))
        return pin_id

    def remove_pins(self, ids: Iterable[int]) -> None:
        """Remove pins; ids that are not there are ignored."""
        gone = set(ids)
        self.set_pins(tuple(pin for pin in self.state.pins if pin.id not in gone))

    def set_pins(self, pins: tuple[Pin, ...]) -> None:
        """Replace all pins; moves nothing. The pins that stay are told to stay where they are."""
        if self._settling:
            here = dict(zip((pin.id for pin in self.state.pins), self.pin_positions(), strict=True))
            pins = tuple(replace(pin, target=here[pin.id]) if pin.id in here else pin for pin in pins)
        state = replace(self.state, pins=pins)
        self._deformer.set_pins(state.points)
        self._set_state(state)
        self._settling = 0
        self._record("pins", pins=pins_to_json(self.drawing.mesh, pins))

    def set_targets(self, targets: Mapping[int, Target]) -> None:
        """Say where pins should be, by id; `step` moves them. Raises InputError on unknown ids or NaN."""
        known = {pin.id for pin in self.state.pins}
        for pin_id in targets:
            if pin_id not in known:
                raise InputError(f"targets: expected ids of pins {sorted(known)}, got {pin_id}")
        places = dict(zip(targets, as_points(list(targets.values()), "targets", len(targets)), strict=True))
        pins = tuple(
            replace(pin, target=places[pin.id]) if pin.id in places else pin for pin in self.state.pins
        )
        self._set_state(replace(self.state, pins=pins))
        self._settling = MOST_SETTLING + int(self.pin_error() / self._reach)
        self._record("targets", targets={str(pin_id): at.tolist() for pin_id, at in places.items()})

    def hold_pins(self) -> None:
        """Before a new drag: pins that were stopped on their way, by undo or Escape, stay where they are."""
        if not self.moving and self.pin_error() > PIN_TOLERANCE:
            places = zip(self.state.pins, self.pin_positions().tolist(), strict=True)
            self.set_targets({pin.id: (x, y) for pin, (x, y) in places})

    def set_settings(self, settings: Settings) -> None:
        """Bend differently from now on; moves nothing. Raises InputError, and then nothing has changed."""
        deformer = self._make_deformer(settings)
        deformer.set_pins(self.state.points)
        self._deformer = deformer
        self._set_state(replace(self.state, settings=settings))
        self._settling = 0
        self._record("settings", **settings_to_json(settings))

    def set_pose(self, positions: Floats) -> None:
        """Take over a pose (n, 2); the pins stay on the drawing and go there with it. Raises InputError."""
        pose = as_points(positions, "positions", len(self.drawing.mesh.vertices))
        self._put(pose)
        self._record("pose", positions=pose.tolist())

    def reset_pose(self) -> None:
        """Back to the rest pose; the pins stay on the drawing and go there with it."""
        if self.posed:
            self._put(self.drawing.mesh.vertices)
            self._record("reset")

    # -- motion --------------------------------------------------------------------------------------------

    def step(self) -> StepResult:
        """One step of the deformer towards the current targets. On SolverError the pose is as it was."""
        before, targets, here = self.state.positions, self.state.targets, self.pin_positions()
        way = float(np.linalg.norm(targets - here, axis=1).max(initial=0.0))
        share = min(1.0, self._reach / way) if way else 1.0
        try:
            result = self._deformer.step(before, here + share * (targets - here) if share < 1 else targets)
        except SolverError:
            self._settling = 0
            raise
        self._set_state(replace(self.state, positions=result.positions))
        self._record("step")
        moved = float(np.abs(result.positions - before).max())
        still = moved < STILL if self.pin_error() < PIN_TOLERANCE else moved < 0.1 * STILL
        self._settling = 0 if still else max(self._settling - 1, 0)
        self.last_step = result
        return result

    def settle(self) -> None:
        """Step until the pose has come to rest."""
        while self.moving:
            self.step()

    # -- saving --------------------------------------------------------------------------------------------

    def mark_saved(self, path: Path) -> None:
        """The current state is what the file at ``path`` holds."""
        self.document = replace(self.document, path=path)
        self._saved = self.state

    # -- inside --------------------------------------------------------------------------------------------

    def _make_deformer(self, settings: Settings) -> Deformer:
        return make_deformer(settings.method, self.drawing.mesh, **dict(settings.parameters))

    def _put(self, pose: Floats) -> None:
        places = self.drawing.mesh.evaluate(self.state.points, pose)
        pins = tuple(replace(pin, target=place) for pin, place in zip(self.state.pins, places, strict=True))
        self._set_state(replace(self.state, pins=pins, positions=pose))
        self._settling = 0

    def _set_state(self, state: EditState) -> None:
        self.document = self.document.with_state(state)

    def _restore(self, state: EditState) -> None:
        if state.settings != self.state.settings:
            self._deformer = self._make_deformer(state.settings)
        self._deformer.set_pins(state.points)
        self._set_state(state)
        self._settling = 0

    def _record(self, do: str, **values: object) -> None:
        self.recording.events.append({"t": round(self._clock() - self._started, 4), "do": do, **values})
