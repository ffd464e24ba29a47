"""The keyboard pointer: a crosshair that arrow keys move and that clicks with the chosen tool."""

from dataclasses import replace

from ..camera import Point
from ..events import ARROWS, KeyEvent, PointerEvent
from .base import Crosshair, Cursor, IdleTool, Markers, ToolContext

STEP, BIG_STEP = 4.0, 40.0  # points of the screen that an arrow key moves it by, alone and with Shift
MARGIN = 32.0  # points of the screen between it and the edge of the canvas, which is panned instead
_GAP = 13.0  # points of the screen between its center and its arms
_GAP_AROUND_BRUSH = 3.0  # between the circle of the brush and the arms


class KeyboardPointer(IdleTool):
    """Keys move the pointer. It starts where the mouse was last, or in the middle of the canvas."""

    is_keyboard_driven = True

    def __init__(self, context: ToolContext) -> None:
        super().__init__(context)
        left, top, right, bottom = context.canvas
        x, y = context.last_pointer or (left, top)
        is_inside = left < x < right and top < y < bottom
        self._move_to((x, y) if is_inside else ((left + right) / 2, (top + bottom) / 2))

    @property
    def press_hint(self) -> str:
        return self.context.idle_tool.keyboard_hint

    @property
    def cursor(self) -> Cursor:
        return self.context.idle_tool.cursor

    @property
    def markers(self) -> Markers:
        """The crosshair, and what the chosen tool shows at its position."""
        markers = self.context.idle_tool.markers
        scale, gap = self.context.ui_scale, _GAP * self.context.ui_scale
        if markers.brush is not None:
            gap = max(gap, markers.brush.radius + _GAP_AROUND_BRUSH * scale)
        return replace(markers, crosshair=Crosshair(self.position, gap))

    @property
    def position(self) -> Point:
        """Its position on the screen."""
        assert self.context.pointer is not None
        return self.context.pointer

    def press(self, event: PointerEvent) -> None:
        self.context.idle_tool.press(event)

    def key(self, event: KeyEvent) -> bool:
        if event.key in ARROWS:
            step = (BIG_STEP if event.shift else STEP) * self.context.ui_scale
            dx, dy = ARROWS[event.key]
            self._move_by(step * dx, step * dy)
        elif event.key == "enter":
            self._click()
        elif event.key == "escape":
            self.context.return_to_idle()
        else:
            return False
        return True

    def move(self, event: PointerEvent) -> None:
        """Give the pointer back to the mouse."""
        self.context.return_to_idle()

    def resize(self) -> None:
        left, top, right, bottom = self.context.canvas
        x, y = self.position
        self._move_to((min(max(x, left), right), min(max(y, top), bottom)))

    def reveal_pin(self, pin: int) -> None:
        """Bring a pin into view and move onto it."""
        self._move_to(self.context.reveal(self.context.pins_on_screen()[pin]))

    def _move_to(self, position: Point) -> None:
        self.context.pointer = self.context.last_pointer = position

    def _move_by(self, dx: float, dy: float) -> None:
        """Move over the drawing by points of the screen; near the edge of the canvas, pan it instead."""
        context, (x, y) = self.context, self.position
        left, top, right, bottom = context.canvas
        margin = MARGIN * context.ui_scale
        pans_x = x + dx < left + margin if dx < 0 else x + dx > right - margin and dx > 0
        pans_y = y + dy < top + margin if dy < 0 else y + dy > bottom - margin and dy > 0
        context.camera = context.camera.panned(-dx * pans_x, -dy * pans_y)
        self._move_to((x + dx * (not pans_x), y + dy * (not pans_y)))

    def _click(self) -> None:
        """Press and release the left button with the chosen tool."""
        context, position = self.context, self.position
        shift, alt = "shift" in context.held, "alt" in context.held
        context.idle_tool.press(PointerEvent("press", position, shift=shift, alt=alt))
        context.tool.release(PointerEvent("release", position, shift=shift, alt=alt))
        context.set_tool(self)
