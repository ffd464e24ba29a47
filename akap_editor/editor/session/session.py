"""One open document and everything that changes it: steps, edits, undo and the recording of all three."""

import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...deform.deformer import StepResult
from ...deform.methods import get_method
from ...errors import SolverError
from ...geometry.validation import Floats
from ...words import mark
from ..document.crossings import crossings_in_pose
from ..document.document import ArtworkFile, Document, EditState
from ..document.drawing import Drawing
from ..document.pin_angles import pin_angles
from .edits import Edit, Effect, SetPins
from .event_log import EventLog
from .history import History
from .preview import Preview
from .recording import Recording, drawing_header, opening_edits
from .stepper import INLINE, PIN_TOLERANCE, Stepper


class Session:
    """A document with its stepper, history and recording; pointer and view are the editor's.

    `apply` is the one door for edits. Edits happen inside a gesture: `begin`, any number of edits and steps,
    then `commit` or `abort`. While a step is pending, targets and angles may change and gestures may end; all
    other edits finish the step first. A step is a function of the state at its start, so it is recorded when
    it starts, and a replay on the same mesh gives the same poses to the last bit.

    clock: gives seconds; recorded times count from ``started``, by default now.
    discontinuities: how many times the pose has changed by anything but a step.
    """

    def __init__(
        self,
        document: Document,
        clock: Callable[[], float] = time.monotonic,
        started: float | None = None,
    ) -> None:
        self.document = document
        self.history = History()
        self.discontinuities = 0
        self._opened_drawing = document.drawing
        self._stepper = Stepper(document.drawing.mesh, document.state)
        self._saved_state: EditState | None = document.state
        self._preview: Preview | None = None
        self._has_gone_back = False  # whether the open gesture began with a return to an earlier state
        self._taken_pose: EditState | None = None  # the state after the open gesture took a previewed pose
        self._pending_line = 0  # index of the pending step in the recording
        self._clock, self._started = clock, clock() if started is None else started
        self._log = EventLog()
        self.recording = Recording(drawing_header(document.drawing), self._log)
        for edit in opening_edits(document):
            self._record(edit.name, **edit.to_json(document.drawing))

    # -- state ---------------------------------------------------------------------------------------------

    @property
    def state(self) -> EditState:
        """The current state; during a preview the previewed one."""
        return self.document.state

    @property
    def drawing(self) -> Drawing:
        """The picture and its mesh."""
        return self.document.drawing

    @property
    def present(self) -> EditState:
        """The current state, also during a preview."""
        return self.state if self._preview is None else self._preview.present

    @property
    def present_document(self) -> Document:
        """The document with the present state, which is what a save writes."""
        if self._preview is None:
            return self.document
        drawing = self.present.drawing or self._opened_drawing
        return replace(self.document, state=self.present, drawing=drawing)

    @property
    def is_modified(self) -> bool:
        """Whether the present state differs from the one in the file."""
        return self.present is not self._saved_state

    @property
    def is_posed(self) -> bool:
        """Whether the pose differs from the rest pose."""
        return not np.array_equal(self.state.positions, self.drawing.mesh.vertices)

    def pin_positions(self) -> Floats:
        """Where the pins are in the current pose, (k, 2) pixels."""
        return self.state.pin_positions(self.drawing.mesh)

    def pin_error(self) -> float:
        """The largest distance of a pin from its target, pixels."""
        return self.state.pin_error(self.drawing.mesh)

    def pin_angle(self, pin_id: int) -> float:
        """Rotation of the drawing around a pin since the rest pose, radians in (−π, π].

        Raises ValueError on an unknown id.
        """
        pins = self.state.pins
        angles = pin_angles(self.drawing.mesh, pins, self.state.positions, {pin_id})
        return float(angles[[pin.id for pin in pins].index(pin_id)])

    # -- steps ---------------------------------------------------------------------------------------------

    @property
    def is_moving(self) -> bool:
        """Whether pins have not arrived, or the drawing around them has not settled."""
        return self._stepper.is_moving

    @property
    def has_visually_arrived(self) -> bool:
        """Whether the pins are so near to their targets and angles that no difference is visible."""
        return self._stepper.has_visually_arrived(self.state)

    @property
    def supports_rotation(self) -> bool:
        """Whether pins can hold angles with the current method."""
        return get_method(self.state.settings.method).deformer.holds_angles

    @property
    def supports_scales(self) -> bool:
        """Whether pins can scale the drawing: with methods that remember the rest shape, if they do."""
        settings = self.state.settings
        return get_method(settings.method).deformer.takes_scales and bool(settings.get("memory", 0.0))

    @property
    def has_pending_step(self) -> bool:
        """Whether a step is being computed, or is computed and `step` has not taken it over."""
        return self._stepper.has_pending_step

    @property
    def last_step(self) -> StepResult | None:
        """The result of the last step."""
        return self._stepper.last_step

    @property
    def last_motion(self) -> tuple[Floats, Floats] | None:
        """The pose before the last step that moved pins, (n, 2), and the velocities of its pins, (k, 2)."""
        return self._stepper.last_motion

    def vector_fields(self) -> tuple[Floats, Floats] | None:
        """U_opt and U°, (n, 2) each, of `last_motion`; None for a method without fields. In any thread."""
        return self._stepper.vector_fields()

    def start_step(self, executor: Executor) -> Future[StepResult] | None:
        """Start the next step towards the current targets; returns its future, None if a step is pending."""
        if self._stepper.has_pending_step:
            return None
        self._record("step")
        self._pending_line = len(self._log) - 1
        return self._stepper.start(self.state, executor)

    def step_is_ready(self, seconds: float = 0.0) -> bool:
        """Whether `step` will not block; waits up to ``seconds`` for that."""
        return self._stepper.is_ready(seconds)

    def step(self) -> StepResult:
        """Take over the pending step, or a new one; waits for it.

        Raises SolverError if the step failed; then the pose stays, and the motion stops.
        """
        self.start_step(INLINE)
        try:
            self._set_state(self._stepper.finish(self.state))
        except Exception:
            # A replay must not fail where the session went on: an edit without effect replaces the step.
            event = self._log[self._pending_line]
            self._log.replace(self._pending_line, {"t": event["t"], "do": "targets", "targets": {}})
            raise
        result = self._stepper.last_step
        assert result is not None
        return result

    def finish_step(self) -> None:
        """Take over the pending step, if there is one. Raises SolverError if it failed."""
        if self.has_pending_step:
            self.step()

    def settle(self) -> None:
        """Step until the pose has settled. Raises SolverError."""
        while self.is_moving:
            self.step()

    def stop_motion(self) -> None:
        """Stop the motion, even if pins have not arrived. Raises SolverError if a pending step failed."""
        self.finish_step()
        self._stepper.stop()

    # -- edits ---------------------------------------------------------------------------------------------

    def apply(self, edit: Edit) -> None:
        """Change the state by an edit and record it; an edit that changes nothing is not recorded.

        Raises InputError on values that do not fit the document, and then nothing has changed; SolverError if
        a pending step failed.
        """
        if not edit.may_overlap_step:
            self.finish_step()
        if isinstance(edit, SetPins) and self.is_moving:
            edit = edit.fixed_at_pose(self.state, self.drawing)
        state = edit.apply(self.state, self.drawing)
        if state is self.state:
            return
        self._take_over(state, edit.effect)
        self._record(edit.name, **edit.to_json(self.drawing))

    def _take_over(self, state: EditState, effect: Effect) -> None:
        stepper = self._stepper
        # Pins that undo or Escape stopped on the way stay there until the next drag.
        keeps_targets = self.is_moving or self.pin_error() <= PIN_TOLERANCE
        if effect in (Effect.METHOD, Effect.JOINTS):
            stepper.set_method(self.drawing.mesh, state)
        elif effect in (Effect.MESH, Effect.DOCUMENT):
            self._restore(state)
        elif effect is Effect.PINS:
            stepper.set_pins(state)
        elif effect is Effect.POSE:
            self.discontinuities += 1
            stepper.stop()
        self._set_state(state)
        settles = effect is Effect.MESH and keeps_targets and self.pin_error() > PIN_TOLERANCE
        closes = effect is Effect.JOINTS and keeps_targets and len(state.pins) > 0
        if settles or closes or effect is Effect.TARGETS:
            stepper.aim(state)

    def return_to(self, state: EditState, line: int) -> None:
        """Restore the state after an earlier ``line`` of the recording; later lines stay in it."""
        self.finish_step()
        self._restore(state)
        self._record("return", line=line)

    # -- gestures ------------------------------------------------------------------------------------------

    def begin(self, label: str) -> None:
        """Start a gesture; during a preview, from the previewed state as `preview` says."""
        self.finish_step()
        preview = self._preview
        self.end_preview()
        if preview is not None and preview.line is not None and preview.shown is not self.state:
            self.history.begin(mark("Go Back in Time"), preview.present)
            self._record("begin", label="Go Back in Time")
            self.return_to(preview.shown, preview.line)
            self.history.commit()
            self._record("commit")
            self._has_gone_back = True
        self.history.begin(label, self.state)
        self._stepper.reset_full_turns()
        self._record("begin", label=label)
        if preview is not None and preview.takes_pose:
            for edit in preview.taking_edits(self._opened_drawing):
                self.apply(edit)
            self._taken_pose = self.state

    def rename(self, label: str) -> None:
        """Replace the label of the open gesture."""
        self.history.rename(label)
        self._record("label", label=label)

    def commit(self, join: bool = False) -> None:
        """End the gesture as one undo entry, or none if nothing changed; the pose goes on settling.

        join: merge it into the entry before.
        """
        if self._is_unchanged():
            self.finish_step()  # a pending step may be the only change
        if self.state is self._taken_pose or (self._has_gone_back and self._is_unchanged()):
            self.abort()  # nothing was edited in the previewed state
            return
        self._taken_pose, self._has_gone_back = None, False
        if self.history.is_unchanged(self.state):
            self.history.abort()
        else:
            self.history.commit(join)
        self._record("commit", **({"join": True} if join else {}))

    def _is_unchanged(self) -> bool:
        return self.state is self._taken_pose or self.history.is_unchanged(self.state)

    def abort(self) -> None:
        """End the gesture and restore the state from before it, bit for bit."""
        with suppress(SolverError):
            self.finish_step()
        # A gesture that changed nothing does not stop the motion of the one before.
        steps_left = self._stepper.steps_left if self.history.is_unchanged(self.state) else 0
        self._taken_pose = None
        self._restore(self.history.abort())
        self._stepper.steps_left = steps_left
        self._record("abort")
        if self._has_gone_back:
            self._has_gone_back = False
            self.undo()

    def undo(self) -> None:
        """Restore the state before the last gesture, if there is one. Raises SolverError if a step failed."""
        self.finish_step()
        self.end_preview()
        if self.history.undo_label is not None and not self.history.is_open:
            self._restore(self.history.undo(self.state))
            self._record("undo")

    def redo(self) -> None:
        """Restore the state after the gesture last undone, if there is one. Raises SolverError."""
        self.finish_step()
        self.end_preview()
        if self.history.redo_label is not None and not self.history.is_open:
            self._restore(self.history.redo(self.state))
            self._record("redo")

    # -- previews ------------------------------------------------------------------------------------------

    @property
    def is_previewing(self) -> bool:
        """Whether another state is shown in place of the present one."""
        return self._preview is not None

    def preview(
        self,
        state: EditState,
        line: int | None = None,
        positions: Floats | None = None,
        takes_pose: bool = False,
    ) -> None:
        """Show a state without editing or recording anything, until `end_preview`, undo or redo.

        line: of the recording, if the state was the present one after it; the next gesture then continues
        from the previewed state. Without a line it continues from the present; with takes_pose it first takes
        over the previewed pose. positions: a pose (n, 2) to show in place of the state's.
        """
        self.finish_step()
        previous = self._preview
        present = self.state if previous is None else previous.present
        steps_left = self._stepper.steps_left if previous is None else previous.steps_left
        self._preview = Preview(present, steps_left, state, line, takes_pose)
        if positions is not None and positions is not state.positions:
            drawing = state.drawing or self._opened_drawing
            crossings = crossings_in_pose(
                drawing.mesh, state.pins, state.positions, state.crossings, positions
            )
            state = replace(state, positions=positions, crossings=crossings)
        self._set_state(state)
        # The stepper keeps the present state, because its caches decide on the last bits of later steps.
        self._stepper.stop()

    def end_preview(self) -> None:
        """Show the present state again."""
        if self._preview is not None:
            preview, self._preview = self._preview, None
            self._set_state(preview.present)
            self._stepper.steps_left = preview.steps_left

    # -- files ---------------------------------------------------------------------------------------------

    def mark_saved(self, path: Path | None, digest: str = "") -> None:
        """Note that the file at ``path`` holds the present state; None for a file that is no document.

        digest: of the file, see `Document`.
        """
        self.document = replace(self.document, path=path, digest=digest)
        self._saved_state = self.present

    def set_artwork(self, artwork: ArtworkFile) -> None:
        """Note the picture file that the drawing shows now."""
        self.document = replace(self.document, artwork=artwork)

    def mark_unsaved(self) -> None:
        """Note that no file holds the present state, although nothing was edited since it was opened."""
        self._saved_state = None

    # -- inside --------------------------------------------------------------------------------------------

    def _set_state(self, state: EditState) -> None:
        drawing = state.drawing or self._opened_drawing
        self.document = replace(self.document.with_state(state), drawing=drawing)

    def _restore(self, state: EditState) -> None:
        self._stepper.restore((state.drawing or self._opened_drawing).mesh, state)
        self.discontinuities += 1
        self._set_state(state)

    def _record(self, do: str, **values: object) -> None:
        event = {"t": round(self._clock() - self._started, 4), "do": do, **values}
        self._log.append(event)
