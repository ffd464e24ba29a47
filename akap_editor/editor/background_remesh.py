"""Remeshes the open drawing in a thread while the user moves the sliders."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from threading import Event

from ..progress import Cancelled, listening, part
from ..words import mark
from .document.document import EditState
from .document.drawing import Drawing, Meshing
from .document.remesh import remesh_drawing, transfer_state
from .editor import Editor
from .session.edits import Remesh
from .session.history import HistoryEntry
from .session.session import Session
from .session.stepper import INLINE

HISTORY_LABEL = mark("Change Mesh")


@dataclass(eq=False)
class SliderGesture:
    """One drag of a slider: all its values are applied to the state before it, as one entry of the history.

    start_drawing, start_state: from before the gesture; entry: in the history, None before the first mesh;
    label: of this entry.
    """

    session: Session
    start_drawing: Drawing
    start_state: EditState
    entry: HistoryEntry | None = None
    label: str = HISTORY_LABEL


@dataclass(frozen=True, eq=False)
class _Job:
    """A mesh that is being made, and the state carried over to it; ``cancelled`` ends it early."""

    gesture: SliderGesture
    meshing: Meshing
    result: Future[tuple[Drawing, EditState]]
    cancelled: Event


class BackgroundRemesh:
    """Makes meshes one at a time; of the requests that come meanwhile only the last one is made.

    The mesh is computed by ``worker``, by default inside `advance`. `advance` takes it over and is to be
    called after each frame.

    notify: called by the worker when `progress` has changed.
    """

    def __init__(
        self, editor: Editor, worker: Executor = INLINE, notify: Callable[[], None] = lambda: None
    ) -> None:
        self._editor = editor
        self._worker = worker
        self._notify = notify
        self.progress = 0.0, ""
        self._gesture: SliderGesture | None = None
        self._requested: Meshing | None = None
        self._job: _Job | None = None
        self._is_dragging = False

    @property
    def meshing(self) -> Meshing | None:
        """The requested options, otherwise those of the current mesh; None if nothing is open."""
        session = self._editor.session
        if session is None:
            return None
        current = session.drawing.meshing or Meshing(vertices=len(session.drawing.mesh.vertices))
        return self._requested or current

    @property
    def is_dragging(self) -> bool:
        """Whether a slider is dragged."""
        return self._is_dragging

    @property
    def is_active(self) -> bool:
        """Whether a slider is dragged or a mesh is being made; the window shows the mesh meanwhile."""
        return self._is_dragging or self.is_busy

    @property
    def is_busy(self) -> bool:
        """Whether a mesh is being made, or requested."""
        return self._requested is not None or self._job is not None

    def request(self, meshing: Meshing, dragging: bool = False, label: str = HISTORY_LABEL) -> None:
        """Ask for another mesh. dragging: more requests of the same gesture may follow, until `end_drag`.

        label: of the entry in the history.
        """
        session = self._editor.session
        if session is None:
            return
        if self._gesture is None or not self._is_dragging or self._gesture.session is not session:
            self._gesture = SliderGesture(session, session.drawing, session.state, label=label)
        self._requested, self._is_dragging = meshing, dragging

    def cancel(self) -> None:
        """Give up the mesh that is being made, and undo the ones that the same gesture has made before."""
        gesture, job = self._gesture, self._job
        self._gesture = self._requested = self._job = None
        self._is_dragging = False
        if job is not None:
            job.cancelled.set()
        if gesture is None or gesture.entry is None or self._editor.is_busy:
            return
        if gesture.session is self._editor.session and gesture.entry is gesture.session.history.last:
            gesture.session.undo()

    def end_drag(self) -> None:
        """End the gesture; its last request is still made."""
        self._is_dragging = False

    def advance(self) -> bool:
        """Start the requested mesh, or take over a finished one; whether the drawing changed.

        A finished mesh waits while a gesture of the editor is under way. Raises InputError if there is no
        such mesh; then nothing has changed.
        """
        if self._gesture is not None and self._gesture.session is not self._editor.session:
            self._gesture = self._requested = self._job = None
        self._take_cuts()
        has_changed = False
        job = self._job
        if job is not None and job.result.done() and not self._editor.is_busy:
            self._job = None
            if job.meshing == self._requested:
                self._requested = None
            has_changed = self._take_over(job.gesture, *job.result.result())
        if self._job is None and self._requested is not None and self._gesture is not None:
            self._start(self._gesture, self._requested)
        return has_changed

    def _take_cuts(self) -> None:
        """Request the mesh with the cuts that the knife or the list of cuts asks for."""
        knife, meshing = self._editor.knife_tool, self.meshing
        cuts, knife.request = knife.request, None
        if cuts is not None and meshing is not None:
            self.request(replace(meshing, cuts=cuts.cuts), label=cuts.label)

    def finish(self) -> None:
        """Wait for the requested mesh. Raises InputError as `advance` does."""
        while self.is_busy:
            if self._job is not None:
                self._job.result.exception()
            self.advance()

    def _start(self, gesture: SliderGesture, meshing: Meshing) -> None:
        cancelled = Event()

        def hear(share: float, text: str) -> None:
            if cancelled.is_set():
                raise Cancelled("cancelled")
            self.progress = share, text
            self._notify()

        def make() -> tuple[Drawing, EditState]:
            with listening(hear):
                with part(0.0, 0.7):
                    drawing = remesh_drawing(gesture.start_drawing, meshing)
                with part(0.7, 1.0):
                    state = transfer_state(gesture.start_state, gesture.start_drawing.mesh, drawing)
            return drawing, state

        self._job = _Job(gesture, meshing, self._worker.submit(make), cancelled)

    def _take_over(self, gesture: SliderGesture, drawing: Drawing, state: EditState) -> bool:
        """Replace the gesture's entry in the history, so that the whole gesture is one entry."""
        session = gesture.session
        if gesture is not self._gesture:  # a later gesture started before this mesh and contains its options
            return False
        if gesture.entry is not None and gesture.entry is session.history.last:
            session.undo()
        is_at_start = session.state is gesture.start_state
        session.begin(gesture.label)
        try:
            session.apply(Remesh.from_drawing(drawing, state if is_at_start else None))
        except Exception:
            session.abort()
            raise
        session.commit()
        gesture.entry = session.history.last
        return True
