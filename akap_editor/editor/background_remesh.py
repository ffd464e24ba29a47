"""Gives the open drawing another mesh while the user goes on choosing what it should be like."""

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

from .document.document import EditState
from .document.drawing import Drawing, Meshing
from .document.remesh import remesh_drawing, transfer_state
from .editor import Editor
from .session.edits import Remesh
from .session.history import HistoryEntry
from .session.session import Session

Made = tuple[Drawing, EditState]
LABEL = "Change mesh"


@dataclass(eq=False)
class _SliderGesture:
    """Choices of one drag of a slider: each is made from the state before the first, and all are one entry.

    base, start: the drawing and the state then; entry: of the history, once there is one.
    """

    session: Session
    base: Drawing
    start: EditState
    entry: HistoryEntry | None = None


class BackgroundRemesh:
    """Meshes are made in another thread, one at a time; of choices that come meanwhile the last counts.

    `advance`, called now and then, takes them over.
    """

    def __init__(self, editor: Editor) -> None:
        self._editor = editor
        self._worker = ThreadPoolExecutor(1, "mesh")
        self._series: _SliderGesture | None = None
        self._wanted: Meshing | None = None
        self._job: tuple[_SliderGesture, Meshing, Future[Made]] | None = None
        self._held = False

    @property
    def meshing(self) -> Meshing | None:
        """What is wanted, or else how the mesh that is there was made; None where nothing is open."""
        session = self._editor.session
        if session is None:
            return None
        made = session.drawing.meshing or Meshing(vertices=len(session.drawing.mesh.vertices))
        return self._wanted or made

    @property
    def active(self) -> bool:
        """Whether a choice is being made, or a mesh."""
        return self._held or self.busy

    @property
    def busy(self) -> bool:
        """Whether a mesh is being made, or waits to be."""
        return self._wanted is not None or self._job is not None

    def want(self, meshing: Meshing, held: bool = False) -> None:
        """Choose how the mesh is to be made; held: more choices of the same gesture may follow."""
        session = self._editor.session
        if session is None:
            return
        if self._series is None or not self._held or self._series.session is not session:
            self._series = _SliderGesture(session, session.drawing, session.state)
        self._wanted, self._held = meshing, held

    def let_go(self) -> None:
        """The gesture is over; its last choice is still made."""
        self._held = False

    def advance(self) -> bool:
        """Begin, or take over, what is wanted; whether the drawing was changed.

        Raises InputError where there is no such mesh; all stays as it was.
        """
        if self._series is not None and self._series.session is not self._editor.session:
            self._series = self._wanted = self._job = None
        changed = False
        if self._job is not None and self._job[2].done() and not self._editor.busy:
            (series, meshing, made), self._job = self._job, None
            if meshing == self._wanted:
                self._wanted = None
            changed = self._take_over(series, *made.result())
        if self._job is None and self._wanted is not None and self._series is not None:
            self._begin(self._series, self._wanted)
        return changed

    def finish(self) -> None:
        """Wait for what is wanted. Raises InputError as `advance` does."""
        while self.busy:
            if self._job is not None:
                self._job[2].exception()
            self.advance()

    def _begin(self, series: _SliderGesture, meshing: Meshing) -> None:
        def make() -> Made:
            drawing = remesh_drawing(series.base, meshing)
            return drawing, transfer_state(series.start, series.base.mesh, drawing)

        self._job = series, meshing, self._worker.submit(make)

    def _take_over(self, series: _SliderGesture, drawing: Drawing, state: EditState) -> bool:
        """As one entry for the whole series: what it has made so far is taken back first."""
        session = series.session
        if series is not self._series:  # the next one began without it, and includes its choice
            return False
        if series.entry is not None and series.entry is session.history.last:
            session.undo()
        as_begun = session.state is series.start
        session.begin(LABEL)
        try:
            session.apply(Remesh.to(drawing, state if as_begun else None))
        except Exception:
            session.abort()
            raise
        session.commit()
        series.entry = session.history.last
        return True
