"""The one door through which a window, a script or a test changes anything."""

import time
from collections.abc import Callable, Iterable
from pathlib import Path

from ..errors import SolverError
from .camera import Camera, Point, fit
from .document import Document, Settings
from .events import Event, KeyEvent, PointerEvent, ScrollEvent
from .session import Session
from .tools import ZOOM_STEP, Idle, Tool, distance

PICK_RADIUS = 12.0  # points of the screen around a pin's center
FRAME_BUDGET = 0.02  # seconds of stepping in one frame


class Editor:
    """A session with a pointer, a selection and a camera."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.session: Session | None = None
        self.camera = Camera()
        self._canvas = (0.0, 0.0, 1280.0, 800.0)
        self._fitted: Camera | None = None
        self.selection: frozenset[int] = frozenset()
        self.pointer: Point | None = None
        self.ui_scale = 1.0  # points of the window per point of the design
        self.hand_tool = False
        self._space = False
        self.tool: Tool = Idle(self)
        self._clock = clock

    # -- document ------------------------------------------------------------------------------------------

    def open(self, document: Document) -> None:
        """Show a drawing; the one before it is gone."""
        session = Session(document, self._clock)
        self.cancel()
        self.session = session
        self.select(())
        self.fit()

    def mark_saved(self, path: Path) -> None:
        """The file at ``path`` now holds the current state."""
        if self.session is not None:
            self.session.mark_saved(path)

    @property
    def modified(self) -> bool:
        """Whether closing would lose something."""
        return self.session is not None and self.session.modified

    # -- events --------------------------------------------------------------------------------------------

    def handle_event(self, event: Event) -> None:
        """Let the active tool act on what the user did."""
        if isinstance(event, KeyEvent):
            self._key(event)
            return
        self.pointer = event.position
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
        if event.key == "space":
            self._space = event.pressed
        elif event.key == "escape" and event.pressed:
            self.cancel()

    def pointer_left(self) -> None:
        """The pointer is no longer over the canvas."""
        self.pointer = None

    def enter(self, tool: Tool) -> None:
        """Make a tool state the active one."""
        self.tool = tool

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

    # -- motion --------------------------------------------------------------------------------------------

    @property
    def moving(self) -> bool:
        """Whether `advance` has something to do."""
        return self.session is not None and self.session.moving

    def advance(self, budget: float = FRAME_BUDGET) -> bool:
        """Take the drawing closer to its pins' targets, for about ``budget`` seconds; whether it moved.

        On SolverError the gesture is cancelled, the pose is the one from before it, and the error is raised.
        """
        if self.session is None or not self.session.moving:
            return False
        started = time.perf_counter()
        try:
            while True:
                self.session.step()
                if not self.session.moving or self.session.pin_error() < 1.0:
                    return True
                if time.perf_counter() - started > budget:
                    return True
        except SolverError:
            self.cancel()
            raise

    # -- edits, one gesture each ---------------------------------------------------------------------------

    def add_pin(self, at: Point) -> int | None:
        """A pin at a place in the drawing (pixels); its id, or None beside the drawing."""
        if self.session is None or self.busy:
            return None
        self.session.begin("Add pin")
        try:
            added = self.session.add_pin(at)
        except Exception:
            self.session.abort()
            raise
        self.session.commit()
        if added is not None:
            self.select({added})
        return added

    def remove_pins(self, ids: Iterable[int]) -> None:
        """Take pins off the drawing; it keeps its pose."""
        if self.session is None:
            return
        gone = frozenset(ids) & {pin.id for pin in self.session.state.pins}
        if gone:
            label = "Remove pin" if len(gone) == 1 else f"Remove {len(gone)} pins"
            self._edit(label, lambda session: session.remove_pins(gone))

    def remove_selected(self) -> None:
        """Take the selected pins off the drawing."""
        self.remove_pins(self.selection)

    def reset_pose(self) -> None:
        """The rest pose, with the pins where they then are."""
        self._edit("Reset pose", lambda session: session.reset_pose())

    def set_settings(self, settings: Settings) -> None:
        """Bend differently from now on. Raises InputError on unknown methods or parameters."""
        if self.session is not None and settings != self.session.state.settings:
            self._edit("Change settings", lambda session: session.set_settings(settings))

    def undo(self) -> None:
        """Take back the last gesture; in the middle of one, that one."""
        if self.busy:
            self.cancel()
        elif self.session is not None:
            self.session.undo()
            self._prune_selection()

    def redo(self) -> None:
        """Do again what was undone."""
        if self.session is not None and not self.busy:
            self.session.redo()
            self._prune_selection()

    def _edit(self, label: str, change: Callable[[Session], None]) -> None:
        if self.session is None or self.busy:
            return
        self.session.begin(label)
        try:
            change(self.session)
        except Exception:
            self.session.abort()
            raise
        self.session.commit()
        self._prune_selection()

    @property
    def busy(self) -> bool:
        """Whether a gesture is under way."""
        is_open = self.session is not None and self.session.history.is_open
        return is_open or not isinstance(self.tool, Idle)

    # -- selection and view --------------------------------------------------------------------------------

    def select(self, ids: Iterable[int]) -> None:
        """Select exactly these pins."""
        self.selection = frozenset(ids)
        self._prune_selection()

    def select_all(self) -> None:
        """Select every pin."""
        if self.session is not None:
            self.select(pin.id for pin in self.session.state.pins)

    def _prune_selection(self) -> None:
        there = {pin.id for pin in self.session.state.pins} if self.session is not None else set()
        self.selection &= there

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

    @property
    def hovered_pin(self) -> int | None:
        """The pin under the pointer."""
        return self.pin_at(self.pointer) if self.pointer is not None else None

    @property
    def would_add_pin(self) -> bool:
        """Whether a click where the pointer is would add a pin."""
        if self.session is None or self.pointer is None or self.hand or not isinstance(self.tool, Idle):
            return False
        if self.hovered_pin is not None:
            return False
        state, mesh = self.session.state, self.session.drawing.mesh
        return mesh.find(self.camera.to_drawing(self.pointer), state.positions) is not None

    @property
    def hand(self) -> bool:
        """Whether a left drag moves the canvas."""
        return self.hand_tool or self._space

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

    def zoom(self, factor: float) -> None:
        """Magnify about the middle of the canvas."""
        left, top, right, bottom = self.canvas
        self.camera = self.camera.zoomed(factor, ((left + right) / 2, (top + bottom) / 2))

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
