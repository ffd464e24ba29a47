"""One drawing being bent, with all edits of it, their history and recording; without pointer or view."""

import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import wraps
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ...deform.deformer import StepResult
from ...errors import InputError, SolverError
from ...geometry.validation import Floats, as_number, as_points
from ..document import keyframes
from ..document import named_poses as poses
from ..document.depth import check_depths, depth_at
from ..document.document import Document, EditState
from ..document.drawing import Drawing
from ..document.pin import Pin
from ..document.pin_angles import MOST_ANGLE, with_held_angles
from ..document.remesh import carried_over
from ..document.rest_pose import baked_state
from ..document.settings import Settings
from ..document.stiffness import apply_stroke, as_stiffness, stroke_coverage
from .bent import PIN_TOLERANCE, Bent
from .event_log import EventLog
from .history import History
from .recording import Recording, drawing_header, opening_events, pins_to_json, settings_to_json
from .stepper import Bending

Target = tuple[float, float]
P = ParamSpec("P")
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class _Preview:
    """What is shown in place of the ``present``, with what goes on once it is left; see `Session.visit`."""

    present: EditState
    bending: Bending
    settling: int
    there: EditState
    line: int | None
    taken: bool


def _after_step(
    edit: Callable[Concatenate["Session", P], T],
) -> Callable[Concatenate["Session", P], T]:
    """An edit that begins where the step under way ends, and raises what that raises."""

    @wraps(edit)
    def after_step(self: "Session", *args: P.args, **kwargs: P.kwargs) -> T:
        if self.stepping:
            self.step()
        return edit(self, *args, **kwargs)

    return after_step


class Session(Bent):
    """The state of one open drawing and everything that may change it.

    Edits happen inside a gesture: `begin`, any number of edits and steps, then `commit` or `abort`. Adding or
    removing pins moves no vertex; only `step` does. All edits are written to `recording`, with times from
    ``clock`` (seconds) since it was ``started``, by default now. While a step is under way, targets and
    angles may change and gestures end, and are recorded after it; all other edits wait for it.
    """

    def __init__(
        self,
        document: Document,
        clock: Callable[[], float] = time.monotonic,
        started: float | None = None,
    ) -> None:
        super().__init__(document)
        self.history = History()
        self._saved: EditState | None = document.state
        self._visit: _Preview | None = None
        self._taken: EditState | None = None  # as the open gesture began, where it took over a visited pose
        self._clock, self._started = clock, clock() if started is None else started
        self._asked: list[tuple[str, dict[str, object]]] = []  # edits to be recorded after the step under way
        self.recording = Recording(drawing_header(document.drawing), EventLog())
        for event in opening_events(document):
            self._record(**event)

    # -- what is there -------------------------------------------------------------------------------------

    @property
    def present(self) -> EditState:
        """The current state, also while another moment is visited."""
        return self.state if self._visit is None else self._visit.present

    @property
    def kept(self) -> Document:
        """The document with the present state: what is saved, whatever is looked at."""
        drawing = self.present.drawing or self._opened
        return (
            self.document
            if self._visit is None
            else replace(self.document, state=self.present, drawing=drawing)
        )

    @property
    def modified(self) -> bool:
        """Whether there is something that the file does not hold."""
        return self.present is not self._saved

    # -- visits --------------------------------------------------------------------------------------------

    @property
    def visiting(self) -> bool:
        """Whether another moment is shown in place of the present one."""
        return self._visit is not None

    @_after_step
    def visit(
        self, state: EditState, line: int | None = None, seen: Floats | None = None, take: bool = False
    ) -> None:
        """Show a state; nothing is edited, and nothing recorded.

        line: of the recording, after which the state was there: the next gesture goes on from it. Without,
        that goes on from the present; take: but takes over the pose, as a part of it. seen: a pose (n, 2)
        that is shown in place of the state's. `leave` returns to the present, and so do undo and redo.
        """
        before = self._visit or _Preview(self.state, self._bending, self._settling, state, line, take)
        self._visit = replace(before, there=state, line=line, taken=take)
        self._set_state(state if seen is None else replace(state, positions=seen))
        self._settling = 0
        if not self._bending.fits(self.drawing.mesh, self.state):
            # the present's own is not touched: what it has cached would change the last bits of later steps
            fits = before.bending.fits(self.drawing.mesh, self.state)
            self._bending = before.bending if fits else Bending(self.drawing.mesh, self.state)

    def leave(self) -> None:
        """Show the present again, if another moment is visited."""
        if self._visit is not None:
            visit, self._visit = self._visit, None
            self._set_state(visit.present)
            self._bending, self._settling = visit.bending, visit.settling

    # -- gestures ------------------------------------------------------------------------------------------

    @_after_step
    def begin(self, label: str) -> None:
        """Start a gesture; while another moment is visited, from there, see `visit`."""
        visit = self._visit
        self.leave()
        if visit is not None and visit.line is not None and visit.there is not self.state:
            self.history.begin("Go back in time", visit.present)
            self._record("begin", label="Go back in time")
            self.go_back(visit.there, visit.line)
            self.history.commit()
            self._record("commit")
        self.history.begin(label, self.state)
        self._bending.turns.forget()
        self._record("begin", label=label)
        if visit is not None and visit.taken:
            self.set_pose(visit.there.positions)
            self._taken = self.state

    def rename(self, label: str) -> None:
        """Say better what the open gesture turned out to be."""
        self.history.rename(label)
        self._record("label", label=label)

    def commit(self, join: bool = False) -> None:
        """End the gesture: one undo entry, or none where nothing changed. The pose may go on to settle.

        join: as a part of the entry before it.
        """
        if self.stepping and (self.state is self._taken or self.history.unchanged(self.state)):
            self.step()  # which may be all that has changed
        if self.state is self._taken:  # nothing was done but to look
            self.abort()
            return
        self._taken = None
        if self.history.unchanged(self.state):
            self.history.abort()
        else:
            self.history.commit(join)
        self._record("commit", **({"join": True} if join else {}))

    def abort(self) -> None:
        """End the gesture and restore the state from before it, bit for bit."""
        with suppress(SolverError):
            if self.stepping:
                self.step()
        settling = self._settling if self.history.unchanged(self.state) else 0
        self._taken = None
        self._restore(self.history.abort())
        self._settling = settling
        self._record("abort")

    @_after_step
    def undo(self) -> None:
        """Back to the state before the last gesture, if there is one."""
        self.leave()
        if self.history.undo_label is not None and not self.history.is_open:
            self._restore(self.history.undo(self.state))
            self._record("undo")

    @_after_step
    def redo(self) -> None:
        """Forward again, if something was undone."""
        self.leave()
        if self.history.redo_label is not None and not self.history.is_open:
            self._restore(self.history.redo(self.state))
            self._record("redo")

    # -- edits, inside a gesture ---------------------------------------------------------------------------

    @_after_step
    def add_pin(self, at: Target) -> int | None:
        """A pin exactly on what is seen at ``at`` in the current pose; its id, or None beside the drawing."""
        mesh, pins = self.drawing.mesh, self.state.pins
        found = mesh.find(at, self.state.positions, self.document.order)
        if found is None:
            return None
        depth = depth_at(mesh, pins, found)
        pin_id = 1 + max((pin.id for pin in pins), default=0)
        pin = Pin(pin_id, int(found.faces[0]), found.weights[0], np.array(at, dtype=np.float64), depth)
        self.set_pins((*pins, pin))
        return pin_id

    def remove_pins(self, ids: Iterable[int]) -> None:
        """Remove pins; ids that are not there are ignored."""
        gone = set(ids)
        self.set_pins(tuple(pin for pin in self.state.pins if pin.id not in gone))

    def set_depths(self, depths: Mapping[int, int]) -> None:
        """Bring pins to the front or back, by id; moves nothing. Raises InputError on depths out of range."""
        check_depths(depths)
        self.set_pins(tuple(replace(pin, depth=depths.get(pin.id, pin.depth)) for pin in self.state.pins))

    @_after_step
    def set_pins(self, pins: tuple[Pin, ...]) -> None:
        """Replace all pins; moves nothing. The pins that stay are told to stay where they are."""
        if self._settling:
            here = dict(zip((pin.id for pin in self.state.pins), self.pin_positions(), strict=True))
            pins = tuple(replace(pin, target=here[pin.id]) if pin.id in here else pin for pin in pins)
        state = replace(self.state, pins=pins)
        self._bending.set_pins(state)
        self._set_state(state)
        self._settling = 0
        self._record("pins", pins=pins_to_json(self.drawing.mesh, pins))

    def set_targets(self, targets: Mapping[int, Target]) -> None:
        """Say where pins should be, by id; `step` moves them. Raises InputError on unknown ids or NaN."""
        self._check_ids("targets", targets)
        places = dict(zip(targets, as_points(list(targets.values()), "targets", len(targets)), strict=True))
        pins = tuple(replace(pin, target=places.get(pin.id, pin.target)) for pin in self.state.pins)
        self._set_state(replace(self.state, pins=pins))
        self._begin_settling()
        self._record("targets", targets={str(pin_id): at.tolist() for pin_id, at in places.items()})

    def turn_pins(self, angles: Mapping[int, float]) -> None:
        """Let pins hold angles, by id, in radians from rest; `step` turns the drawing around them.

        In one gesture full turns count. Raises InputError on unknown ids and angles out of range.
        """
        self._check_ids("angles", angles)
        limits = -MOST_ANGLE, MOST_ANGLE
        held = {pin: as_number(angle, f"angle of pin {pin}", *limits) for pin, angle in angles.items()}
        pins = tuple(replace(pin, angle=held.get(pin.id, pin.angle)) for pin in self.state.pins)
        self._set_state(replace(self.state, pins=pins))
        self._begin_settling()
        self._record("angles", angles={str(pin_id): angle for pin_id, angle in held.items()})

    @_after_step
    def hold_angles(self, ids: Iterable[int], hold: bool = True) -> None:
        """Let pins hold the angles that they have, or turn as they will again; moves nothing."""
        self.set_pins(
            with_held_angles(self.drawing.mesh, self.state.pins, self.state.positions, set(ids), hold)
        )

    @_after_step
    def hold_pins(self) -> None:
        """Before a new drag: pins that were stopped on their way, by undo or Escape, stay where they are."""
        if not self.moving and self.pin_error() > PIN_TOLERANCE:
            here = self.pin_positions().tolist()
            self.set_targets({pin.id: (x, y) for pin, (x, y) in zip(self.state.pins, here, strict=True)})

    @_after_step
    def set_settings(self, settings: Settings) -> None:
        """Bend differently from now on; moves nothing. Raises InputError, and then nothing has changed."""
        self._bend_by(replace(self.state, settings=settings))
        self._record("settings", **settings_to_json(settings))

    @_after_step
    def set_stiffness(self, factors: ArrayLike | None) -> None:
        """Let faces bend less by factors (m,), None for 1 everywhere; moves nothing. Raises InputError."""
        stiffness = None if factors is None else as_stiffness(factors, len(self.drawing.mesh.faces))
        self._bend_by(replace(self.state, stiffness=stiffness))
        self._record("stiffness", factors=None if stiffness is None else stiffness.tolist())

    @_after_step
    def paint_stiffness(self, dabs: ArrayLike, radius: float, factor: float) -> None:
        """Let bend less what a brush covers, at places ``dabs`` (d, 2) of the rest pose; moves nothing.

        radius: in pixels; factor: from 1, as without, to 1000. Raises InputError.
        """
        places = as_points(dabs, "dabs")
        stiffness = apply_stroke(
            self.state.stiffness, stroke_coverage(self.drawing.mesh, places, radius), factor
        )
        self._bend_by(replace(self.state, stiffness=stiffness))
        self._record("paint", dabs=places.tolist(), radius=radius, factor=factor)

    @_after_step
    def set_drawing(self, drawing: Drawing, carried: EditState | None = None) -> None:
        """Bend another mesh of the same picture, made by `remeshed`, from now on; pins and pose stay.

        carried: the current state `carried_over` to it, where that is known. Raises InputError as that does.
        """
        assert drawing.meshing is not None, "expected a drawing whose mesh can be made again"
        self._restore(carried or carried_over(self.state, self.drawing.mesh, drawing))
        self._record("mesh", **asdict(drawing.meshing))

    @_after_step
    def set_pose(self, positions: Floats) -> None:
        """Take over a pose (n, 2); the pins stay on the drawing and go there with it. Raises InputError."""
        pose = poses.as_pose(positions, "positions", len(self.drawing.mesh.vertices))
        self._put(pose)
        self._record("pose", positions=pose.tolist())

    @_after_step
    def reset_pose(self) -> None:
        """Back to the rest pose; the pins stay on the drawing and go there with it."""
        if self.posed:
            self._put(self.drawing.mesh.vertices)
            self._record("reset")

    @_after_step
    def bake_pose(self) -> None:
        """Make the pose the rest pose; nothing moves. Raises InputError, and then nothing has changed."""
        if self.posed:
            self._restore(baked_state(self.state, self.drawing))
            self._record("bake")

    @_after_step
    def change_poses(self, do: str, **values: Any) -> None:
        """Change the poses with names, see `poses.changed`; nothing moves. Raises InputError, KeyError."""
        kept = poses.changed(self.state.poses, do, values, self.state.positions)
        self._set_state(replace(self.state, poses=kept))
        self._record(do, **values)

    @_after_step
    def animate(self, do: str, **values: Any) -> None:
        """Change the keyframes, see `keyframes.changed`; nothing moves. Raises InputError, KeyError."""
        animation = keyframes.changed(self.state.animation, do, values, self.state.positions)
        self._set_state(replace(self.state, animation=animation))
        self._record(do, **values)

    @_after_step
    def go_back(self, state: EditState, line: int) -> None:
        """Take over the state after an earlier ``line`` of the recording, where what came after it stays."""
        self._restore(state)
        self._record("return", line=line)

    def step(self) -> StepResult:
        """The step under way, or else a new one; waits for it. On SolverError the pose is as it was."""
        try:
            result = super().step()
            self._record("step")
        finally:
            asked, self._asked = self._asked, []
            for do, values in asked:
                self._record(do, **values)
        return result

    @property
    def recorded(self) -> bool:
        """Whether the recording says all that led to the current state."""
        return not self._asked

    # -- saving --------------------------------------------------------------------------------------------

    def mark_saved(self, path: Path | None) -> None:
        """The current state is what the file at ``path`` holds; None: or one that is no .akap file."""
        self.document = replace(self.document, path=path)
        self._saved = self.present

    def mark_unsaved(self) -> None:
        """No file holds the current state, though it was there from the start."""
        self._saved = None

    # -- inside --------------------------------------------------------------------------------------------

    def _check_ids(self, name: str, ids: Iterable[int]) -> None:
        known = [pin.id for pin in self.state.pins]
        for pin_id in ids:
            if pin_id not in known:
                raise InputError(f"{name}: expected ids of pins {sorted(known)}, got {pin_id}")

    def _record(self, do: str, **values: object) -> None:
        if self.stepping:
            self._asked.append((do, values))
            return
        self.recording.events.append({"t": round(self._clock() - self._started, 4), "do": do, **values})
