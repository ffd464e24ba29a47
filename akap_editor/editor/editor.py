"""The one door through which a window, a script or a test changes anything."""

import time
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from pathlib import Path
from typing import Literal

from ..errors import SolverError
from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats
from .camera import Camera, Point, fit
from .document.document import Document
from .events import ARROWS, Event, KeyEvent, PinRequest, PointerEvent, ScrollEvent
from .gestures import NudgeSeries, T
from .pin_trails import Trails
from .session.edits import Edit
from .session.session import Session
from .session.stepper import INLINE
from .tools.base import Tool, distance
from .tools.keyboard_pointer import KeyboardPointer
from .tools.pins import ZOOM_STEP, Idle
from .tools.stiffness_brush import Brush

PICK_RADIUS = 12.0  # points of the screen around a pin's center
FRAME_BUDGET = 0.02  # seconds in which a frame waits for steps
NUDGE, BIG_NUDGE = 1.0, 10.0  # pixels
HELD_KEYS = ("space", "alt", "shift", "h")  # what they mean lasts as long as they are held


class Editor:
    """A session with the selected pins, the active tool, the pointer and the camera.

    clock: returns seconds, for the recording and for nudges; worker: computes the steps of `advance`, one at
    a time; by default they are computed at once.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic, worker: Executor = INLINE) -> None:
        self.session: Session | None = None
        self.selection: frozenset[int] = frozenset()
        self.trails = Trails()
        self.worker = worker
        self.camera = Camera()
        self._canvas = (0.0, 0.0, 1280.0, 800.0)
        self._fitted: Camera | None = None
        self.pointer: Point | None = None
        self.last_pointer: Point | None = None  # where it was when it left the canvas
        self.ui_scale = 1.0  # points of the window per point of the design
        self.chosen_tool: Literal["pins", "hand", "brush"] = "pins"
        self.brush = Brush()
        self.held: frozenset[str] = frozenset()  # of HELD_KEYS
        self.request: PinRequest | None = None
        self.newest_pin: int | None = None  # added by the last click: a second one on it is no double click
        self.tool: Tool = Idle(self)
        self._clock = clock
        self._nudges = NudgeSeries(clock)
        self._last_hit_test: tuple[TriMesh, Floats, Point, bool] | None = None  # mesh, pose, place, result

    # -- document ------------------------------------------------------------------------------------------

    def open(self, document: Document) -> None:
        """Show a drawing; the one before it is gone."""
        self.take_over(Session(document, self._clock))

    def take_over(self, session: Session) -> None:
        """Go on with a session; the one before it is gone."""
        self.cancel()
        self.return_to_idle()
        self.session = session
        self.trails.clear()
        self.select(())
        self.fit()

    def close(self) -> None:
        """Nothing is open any more."""
        self.cancel()
        self.return_to_idle()
        self.session = None
        self.select(())

    def mark_saved(self, path: Path | None) -> None:
        """The file at ``path`` now holds the current state."""
        if self.session is not None:
            self.session.mark_saved(path)

    @property
    def modified(self) -> bool:
        """Whether closing would lose something."""
        return self.session is not None and self.session.is_modified

    # -- events --------------------------------------------------------------------------------------------

    def handle_event(self, event: Event) -> None:
        """Let the active tool act on what the user did."""
        if isinstance(event, KeyEvent):
            self._key(event)
            return
        self.pointer = self.last_pointer = event.position
        if isinstance(event, ScrollEvent):
            self.camera = self.camera.zoomed(ZOOM_STEP**event.amount, event.position)
        else:
            self._pointer(event)

    def _pointer(self, event: PointerEvent) -> None:
        act = {"press": self.tool.press, "move": self.tool.move, "release": self.tool.release}
        try:
            act[event.kind](event)
        except Exception:
            self.cancel()
            raise

    def _key(self, event: KeyEvent) -> None:
        if event.key in HELD_KEYS:
            self.held = self.held | {event.key} if event.pressed else self.held - {event.key}
        elif event.pressed and self.tool.key(event):
            return
        elif event.key == "escape" and event.pressed:
            self.cancel()
        elif event.key in ARROWS and event.pressed:
            size = BIG_NUDGE if event.shift else NUDGE
            x, y = ARROWS[event.key]
            self._nudges.nudge(self, size * x, size * y)

    def pointer_left(self) -> None:
        """The mouse is no longer over the canvas."""
        if not isinstance(self.tool, KeyboardPointer):
            self.pointer = None

    def set_tool(self, tool: Tool) -> None:
        """Make a tool state the active one."""
        self.tool = tool

    def return_to_idle(self) -> None:
        """No tool is at work any more."""
        self.set_tool(Idle(self))

    def cancel(self) -> None:
        """The one way out of a gesture: Escape, focus loss and errors all come here."""
        if not isinstance(self.tool, Idle):
            self.tool.cancel()
        if self.session is not None and self.session.history.is_open:
            self.session.abort()

    @property
    def hint(self) -> str:
        """What can be done now, in words."""
        return self.tool.hint

    # -- edits and selection -------------------------------------------------------------------------------

    def edit(self, label: str, change: Callable[[Session], T]) -> T | None:
        """Change the session in one gesture, and return what ``change`` does; on an error nothing changes.

        Does nothing and returns None without a session or during a gesture.
        """
        if self.session is None or self.busy:
            return None
        self.session.begin(label)
        try:
            result = change(self.session)
        except Exception:
            self.session.abort()
            raise
        self.session.commit()
        self._drop_missing_pins()
        return result

    def apply(self, label: str, *edits: Edit) -> None:
        """Apply edits in one gesture; on an error nothing changes. Does nothing during a gesture."""

        def apply_all(session: Session) -> None:
            for edit in edits:
                session.apply(edit)

        self.edit(label, apply_all)

    def undo(self) -> None:
        """Undo the last gesture; during a gesture, cancel it."""
        self.trails.clear()
        if self.busy:
            self.cancel()
        elif self.session is not None:
            self.session.undo()
            self._drop_missing_pins()

    def redo(self) -> None:
        """Redo the gesture that was undone last."""
        self.trails.clear()
        if self.session is not None and not self.busy:
            self.session.redo()
            self._drop_missing_pins()

    def undo_or_redo_to(self, depth: int) -> None:
        """Undo or redo until ``depth`` gestures can be undone, or as many as there are."""
        if self.session is None or self.busy:
            return
        history = self.session.history
        while history.depth > max(depth, 0):
            self.undo()
        while history.depth < depth and history.redo_label is not None:
            self.redo()

    def select(self, pins: Iterable[int]) -> None:
        """Select exactly these pins, by id."""
        self.selection = frozenset(pins)
        self._drop_missing_pins()

    def select_all(self) -> None:
        """Select every pin."""
        if self.session is not None:
            self.select(pin.id for pin in self.session.state.pins)

    def _drop_missing_pins(self) -> None:
        """Keep the selection and the popup request to pins that exist."""
        pins = set() if self.session is None else {pin.id for pin in self.session.state.pins}
        self.selection &= pins
        if self.request is not None and self.request.pin not in pins:
            self.request = None

    # -- motion --------------------------------------------------------------------------------------------

    @property
    def moving(self) -> bool:
        """Whether `advance` has something to do."""
        return self.session is not None and self.session.is_moving

    @property
    def waiting(self) -> bool:
        """Whether nothing moves until the worker is done with a step."""
        session = self.session
        return session is not None and session.has_pending_step and not session.step_is_ready()

    def advance(self, budget: float = FRAME_BUDGET) -> bool:
        """Take the drawing closer to its pins' targets, waiting about ``budget`` seconds; whether it moved.

        A step that takes longer goes on meanwhile, and a later call takes it over. On SolverError the gesture
        is cancelled, the pose is the one from before it, and the error is raised.
        """
        session = self.session
        if session is None or not session.is_moving:
            return False
        until, moved, enough = time.perf_counter() + budget, False, False
        self.trails.follow(session)
        try:
            while session.is_moving and not enough:
                session.start_step(self.worker)
                if not session.step_is_ready(until - time.perf_counter()):
                    break
                seconds = session.step().report.seconds
                moved = True
                enough = session.has_visually_arrived or seconds > budget or time.perf_counter() > until
                self.trails.follow(session)
        except SolverError:
            self.cancel()
            raise
        return moved

    def start_next_step(self) -> None:
        """Let the worker begin with the next step while a frame is drawn, if steps take longer than that."""
        session = self.session
        if session is None or session.last_step is None or not session.is_moving:
            return
        if session.last_step.report.seconds > FRAME_BUDGET:
            session.start_step(self.worker)

    @property
    def busy(self) -> bool:
        """Whether a gesture is under way."""
        is_open = self.session is not None and self.session.history.is_open
        return is_open or not isinstance(self.tool, Idle)

    # -- view ----------------------------------------------------------------------------------------------

    def request_pin_popup(self, kind: Literal["values", "menu"], pin: int) -> None:
        """Ask the window to open something for a pin, which becomes selected."""
        if pin not in self.selection or kind == "values":
            self.select({pin})
        self.request = PinRequest(kind, pin)

    def pins_on_screen(self) -> dict[int, Point]:
        """Where the pins are seen, by id."""
        if self.session is None:
            return {}
        places = zip(self.session.state.pins, self.session.pin_positions().tolist(), strict=True)
        return {pin.id: self.camera.to_screen((x, y)) for pin, (x, y) in places}

    def pin_at(self, position: Point) -> int | None:
        """The nearest pin within reach of a point of the screen, or None."""
        near = [(distance(place, position), pin) for pin, place in self.pins_on_screen().items()]
        best = min(near, default=None)
        return best[1] if best is not None and best[0] <= PICK_RADIUS * self.ui_scale else None

    def is_on_drawing(self, position: Point) -> bool:
        """Whether the drawing is under a point of the screen. Caches the last result."""
        if self.session is None:
            return False
        mesh, pose, place = (
            self.session.drawing.mesh,
            self.session.state.positions,
            self.camera.to_drawing(position),
        )
        last = self._last_hit_test
        if last is None or last[0] is not mesh or last[1] is not pose or last[2] != place:
            last = self._last_hit_test = mesh, pose, place, mesh.find(place, pose) is not None
        return last[3]

    @property
    def hovered_pin(self) -> int | None:
        """The pin under the pointer, if a press would take it."""
        if self.pointer is None or self.chosen_tool == "brush":
            return None
        return self.pin_at(self.pointer)

    @property
    def would_add_pin(self) -> bool:
        """Whether a click where the pointer is would add a pin."""
        if self.session is None or self.pointer is None or not isinstance(self.tool, Idle):
            return False
        if self.pans_on_drag or self.chosen_tool == "brush" or self.held & {"shift", "alt"}:
            return False
        if self.hovered_pin is not None:
            return False
        return self.is_on_drawing(self.pointer)

    @property
    def pans_on_drag(self) -> bool:
        """Whether a left drag moves the canvas."""
        return self.chosen_tool == "hand" or "space" in self.held

    @property
    def canvas(self) -> tuple[float, float, float, float]:
        """The part of the window where the drawing is seen, (left, top, right, bottom) in points."""
        return self._canvas

    @canvas.setter
    def canvas(self, canvas: tuple[float, float, float, float]) -> None:
        """A drawing that was fitted into the old canvas is fitted into the new one."""
        if canvas != self._canvas:
            self._canvas = canvas
            if self.camera == self._fitted:
                self.fit()
            self.tool.resized()

    def zoom(self, factor: float) -> None:
        """Magnify about the middle of the canvas, or about the crosshair."""
        left, top, right, bottom = self.canvas
        middle = (left + right) / 2, (top + bottom) / 2
        self.camera = self.camera.zoomed(
            factor, self.tool.place if isinstance(self.tool, KeyboardPointer) else middle
        )

    def fit(self) -> None:
        """Show the whole picture and all of the pose."""
        if self.session is None:
            return
        width, height = self.session.drawing.size
        pose = self.session.state.positions
        low, high = pose.min(axis=0), pose.max(axis=0)
        left, top, right, bottom = self.canvas
        self.camera = self._fitted = fit(
            (min(low[0], 0.0), min(low[1], 0.0)),
            (max(high[0], width), max(high[1], height)),
            (left, top),
            (right, bottom),
        )
