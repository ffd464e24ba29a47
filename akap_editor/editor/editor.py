"""The editor: a session with a selection, tools, a pointer and a camera, driven by events."""

import time
from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from pathlib import Path
from typing import Literal

from ..errors import SolverError
from ..geometry.validation import Floats
from .camera import ZOOM_STEP, Camera, Point, fit, shift_into
from .document.document import Document
from .document.drawing import Drawing, visible_point
from .events import ARROWS, Event, KeyEvent, PinRequest, PointerEvent, ScrollEvent
from .gestures import T
from .pin_arrangement import NudgeSeries
from .pin_trails import Trails
from .session.edits import Edit
from .session.session import Session
from .session.stepper import INLINE
from .tools.base import IdleTool, Tool, distance
from .tools.joints import JointsIdle
from .tools.keyboard_pointer import MARGIN, KeyboardPointer
from .tools.knife import KnifeIdle
from .tools.pan import HandIdle, Panning
from .tools.pins import PinsIdle
from .tools.stiffness_brush import BrushIdle
from .tools.zoom import ZoomIdle

PICK_RADIUS = 12.0  # points of the screen around a pin's center
FRAME_BUDGET = 0.02  # seconds in which a frame starts steps
STEP_WAIT = 0.04  # seconds that a frame waits for a step if the last one did not take longer
WHEEL_STEP = 60.0  # points of the design that a notch of the wheel pans by
HELD_KEYS = ("space", "zoom", "alt", "shift", "h")  # keys that have a meaning while they are held


class Editor:
    """A session with the selected pins, the tools, the pointer and the camera.

    Windows, scripts and tests drive it: by events, by the functions in `gestures`, and by `advance` once a
    frame. It implements `ToolContext` and `EditContext`.

    clock: returns seconds, for the recording and for nudges; worker: computes the steps of `advance`, one at
    a time; by default they are computed at once.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic, worker: Executor = INLINE) -> None:
        self.session: Session | None = None
        self.selection: frozenset[int] = frozenset()
        self.worker = worker
        self.camera = Camera()
        self.pointer: Point | None = None  # None while the mouse is not over the canvas
        self.last_pointer: Point | None = None  # the last position of the pointer on the canvas
        self.ui_scale = 1.0  # points of the window per point of the design
        self.held: frozenset[str] = frozenset()  # of HELD_KEYS
        self.request: PinRequest | None = None
        self.menu_request: Point | None = None  # where the menu of the empty canvas is to open
        self.trails = Trails()
        self.pins_tool, self.hand_tool = PinsIdle(self), HandIdle(self)
        self.zoom_tool, self.brush_tool = ZoomIdle(self), BrushIdle(self)
        self.joint_tool, self.knife_tool = JointsIdle(self), KnifeIdle(self)
        self.chosen_tool: IdleTool = self.pins_tool
        self._active_tool: Tool | None = None  # None while the idle tool is active
        self._canvas = (0.0, 0.0, 1280.0, 800.0)
        self._fitted: Camera | None = None
        self._clock = clock
        self._nudges = NudgeSeries(clock)
        self._last_hit_test: tuple[Drawing, Floats, Point, bool] | None = None  # with its arguments

    # -- document ------------------------------------------------------------------------------------------

    def open(self, document: Document) -> None:
        """Show a document in place of the open one. Raises InputError if its settings are invalid."""
        self.take_over(Session(document, self._clock))

    def take_over(self, session: Session) -> None:
        """Continue a session in place of the open one."""
        self.close()
        self.session = session
        self.trails.clear()
        self.brush_tool.last_end = None
        self.fit()

    def close(self) -> None:
        """Close the session."""
        self.cancel()
        self.return_to_idle()
        self.session = None
        self.select(())

    def mark_saved(self, path: Path | None, digest: str = "") -> None:
        """Note that the file at ``path``, with this ``digest``, holds the current state; see `Document`."""
        if self.session is not None:
            self.session.mark_saved(path, digest)

    @property
    def is_modified(self) -> bool:
        """Whether closing would lose changes."""
        return self.session is not None and self.session.is_modified

    # -- tools ---------------------------------------------------------------------------------------------

    @property
    def tool(self) -> Tool:
        """The active tool, which gets the events: a gesture, the keyboard pointer, or the idle tool."""
        return self.idle_tool if self._active_tool is None else self._active_tool

    @property
    def idle_tool(self) -> IdleTool:
        """The tool whose gesture a press starts: the chosen one, or hand or zoom while their key is held."""
        if "zoom" in self.held:
            return self.zoom_tool
        return self.hand_tool if "space" in self.held else self.chosen_tool

    def set_tool(self, tool: Tool) -> None:
        """Make a state the active tool."""
        self._active_tool = tool

    def return_to_idle(self) -> None:
        """Make `idle_tool` the active tool."""
        self._active_tool = None

    def toggle_keyboard_pointer(self) -> None:
        """Let keys move the pointer, or end that. The hand has nothing to click, so the pins replace it."""
        if self.tool.is_keyboard_driven:
            self.return_to_idle()
        elif self.session is not None and not self.is_busy:
            if self.chosen_tool is self.hand_tool:
                self.chosen_tool = self.pins_tool
            self.set_tool(KeyboardPointer(self))

    def cancel(self) -> None:
        """Cancel the gesture under way: on Escape, on loss of focus and on errors."""
        self.tool.cancel()
        if self.session is not None and self.session.history.is_open:
            self.session.abort()

    def finish(self) -> None:
        """Keep what the gesture under way has done; on an error it is cancelled."""
        try:
            self.tool.finish()
        except Exception:
            self.cancel()
            raise

    @property
    def is_busy(self) -> bool:
        """Whether a gesture is under way."""
        return not self.tool.is_idle or (self.session is not None and self.session.history.is_open)

    # -- events --------------------------------------------------------------------------------------------

    def handle_event(self, event: Event) -> None:
        """Let the active tool react to an event; on an error the gesture is cancelled."""
        try:
            if isinstance(event, KeyEvent):
                self._handle_key(event)
                return
            self.pointer = self.last_pointer = event.position
            if isinstance(event, ScrollEvent):
                if self.tool.scroll(event):
                    return
                panned = self.camera.panned(WHEEL_STEP * self.ui_scale * event.sideways, 0.0)
                self.camera = panned.zoomed(ZOOM_STEP**event.amount, event.position)
            else:
                self._handle_pointer(event)
        except Exception:
            self.cancel()
            raise

    def _handle_pointer(self, event: PointerEvent) -> None:
        if event.kind == "move":
            self.tool.move(event)
        elif event.kind == "release":
            self.tool.release(event)
        elif event.button == "middle" and self.tool.is_idle:
            self.set_tool(Panning(self, event))
        else:
            self.tool.press(event)

    def _handle_key(self, event: KeyEvent) -> None:
        if event.key in HELD_KEYS:
            self.held = self.held | {event.key} if event.pressed else self.held - {event.key}
        elif event.pressed and self.tool.key(event):
            return
        elif event.key == "escape" and event.pressed and self.is_busy:
            self.cancel()
        elif event.key == "escape" and event.pressed:
            self.select(())
        elif event.key in ARROWS and event.pressed:
            self._nudges.nudge_towards(self, ARROWS[event.key], is_long=event.shift)

    def pointer_left(self) -> None:
        """Note that the mouse left the canvas."""
        if not self.tool.is_keyboard_driven:
            self.pointer = None

    # -- edits and selection -------------------------------------------------------------------------------

    def edit(self, label: str, change: Callable[[Session], T]) -> T | None:
        """Change the session in one gesture, and return what ``change`` does; on an error nothing changes.

        Does nothing and returns None without a session or during a gesture.
        """
        if self.session is None or self.is_busy:
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
        if self.is_busy:
            self.cancel()
        elif self.session is not None:
            self.session.undo()
            self._drop_missing_pins()

    def redo(self) -> None:
        """Redo the gesture that was undone last."""
        self.trails.clear()
        if self.session is not None and not self.is_busy:
            self.session.redo()
            self._drop_missing_pins()

    def undo_or_redo_to(self, depth: int) -> None:
        """Undo or redo until ``depth`` gestures can be undone, or as many as there are."""
        if self.session is None or self.is_busy:
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

    def select_next(self, forward: bool = True) -> None:
        """Select the pin after the selected ones, or before them; after the last comes the first."""
        if self.session is None or not self.session.state.pins:
            return
        ids = [pin.id for pin in self.session.state.pins]
        selected = [index for index, pin in enumerate(ids) if pin in self.selection]
        index = max(selected, default=-1) + 1 if forward else min(selected, default=0) - 1
        pin = ids[index % len(ids)]
        self.select({pin})
        self.tool.reveal_pin(pin)

    def _drop_missing_pins(self) -> None:
        """Keep the selection and the popup request to pins that exist."""
        pins = set() if self.session is None else {pin.id for pin in self.session.state.pins}
        self.selection &= pins
        if self.request is not None and self.request.pin not in pins:
            self.request = None

    def request_pin_popup(self, kind: Literal["values", "menu"], pin: int) -> None:
        """Ask the window to open the values or the menu of a pin, which is selected for it."""
        if pin not in self.selection or kind == "values":
            self.select({pin})
        self.request = PinRequest(kind, pin)

    # -- motion --------------------------------------------------------------------------------------------

    @property
    def is_moving(self) -> bool:
        """Whether `advance` has steps to make."""
        return self.session is not None and self.session.is_moving

    def advance(self, budget: float = FRAME_BUDGET) -> bool:
        """Step the pose towards the pins' targets for about ``budget`` seconds; return whether it moved.

        A step that takes longer stays pending, and a later call takes it over; but if steps take hardly
        longer, the call waits, because a frame without a new pose would only delay the next one. On a
        SolverError the gesture is cancelled, which restores the pose from before it, and the error is raised.
        """
        session = self.session
        if session is None or not session.is_moving:
            return False
        started, moved, done = time.perf_counter(), False, False
        is_worth_waiting = session.last_step is not None and session.last_step.report.seconds < STEP_WAIT
        patience = max(budget, STEP_WAIT) if budget and is_worth_waiting else budget
        self.trails.follow(session)
        try:
            while session.is_moving and not done:
                session.start_step(self.worker)
                if not session.step_is_ready(started + patience - time.perf_counter()):
                    break
                moved, seconds = True, session.step().report.seconds
                is_late = max(seconds, time.perf_counter() - started) > budget
                done = session.has_visually_arrived or is_late
                self.trails.follow(session)
        except SolverError:
            self.cancel()
            raise
        return moved

    def start_next_step(self) -> None:
        """Start the next step while a frame is drawn, if steps take longer than a frame waits for them."""
        session = self.session
        last_step = session.last_step if session is not None and session.is_moving else None
        if session is not None and last_step is not None and last_step.report.seconds > FRAME_BUDGET:
            session.start_step(self.worker)

    # -- view ----------------------------------------------------------------------------------------------

    @property
    def hint(self) -> str:
        """What the user can do now, in one sentence."""
        return self.tool.hint

    def pins_on_screen(self) -> dict[int, Point]:
        """Positions of the pins on the screen, by id."""
        if self.session is None:
            return {}
        positions = zip(self.session.state.pins, self.session.pin_positions().tolist(), strict=True)
        return {pin.id: self.camera.to_screen((x, y)) for pin, (x, y) in positions}

    def pin_at(self, position: Point) -> int | None:
        """The nearest pin within reach of a point of the screen, or None."""
        hidden = {pin.id for pin in self.session.state.pins if pin.is_hidden} if self.session else set()
        centers = self.pins_on_screen().items()
        distances = [(distance(center, position), pin) for pin, center in centers if pin not in hidden]
        nearest = min(distances, default=None)
        return nearest[1] if nearest is not None and nearest[0] <= PICK_RADIUS * self.ui_scale else None

    def is_on_drawing(self, position: Point) -> bool:
        """Whether the drawing is under a point of the screen. Caches the last result."""
        if self.session is None:
            return False
        drawing, pose = self.session.drawing, self.session.state.positions
        point, last = self.camera.to_drawing(position), self._last_hit_test
        if last is None or last[0] is not drawing or last[1] is not pose or last[2] != point:
            hit = visible_point(drawing, point, pose, self.session.document.face_order, unlocked=True)
            last = self._last_hit_test = drawing, pose, point, hit is not None
        return last[3]

    @property
    def canvas(self) -> tuple[float, float, float, float]:
        """The part of the window that shows the drawing, (left, top, right, bottom) in points."""
        return self._canvas

    @canvas.setter
    def canvas(self, canvas: tuple[float, float, float, float]) -> None:
        """Fit the drawing into the new canvas if the old one still showed it as `fit` does."""
        if canvas != self._canvas:
            self._canvas = canvas
            if self.camera == self._fitted:
                self.fit()
            self.tool.resize()

    def zoom(self, factor: float) -> None:
        """Zoom about the middle of the canvas, or about the keyboard pointer."""
        left, top, right, bottom = self.canvas
        center = (left + right) / 2, (top + bottom) / 2
        if self.tool.is_keyboard_driven and self.pointer is not None:
            center = self.pointer
        self.camera = self.camera.zoomed(factor, center)

    def reveal(self, position: Point) -> Point:
        """Pan until a point of the screen is inside the canvas, with a margin; return where it is then."""
        left, top, right, bottom = self.canvas
        dx = shift_into(position[0], left, right, MARGIN * self.ui_scale)
        dy = shift_into(position[1], top, bottom, MARGIN * self.ui_scale)
        self.camera = self.camera.panned(dx, dy)
        return position[0] + dx, position[1] + dy

    def fit(self) -> None:
        """Show the whole picture and the whole pose."""
        if self.session is None:
            return
        width, height = self.session.drawing.size
        pose = self.session.state.positions
        low, high = pose.min(axis=0), pose.max(axis=0)
        corners = (min(low[0], 0.0), min(low[1], 0.0)), (max(high[0], width), max(high[1], height))
        self.camera = self._fitted = fit(*corners, self.canvas[:2], self.canvas[2:])
