"""Draws the axis of the mirror by hand."""

import math

from ...words import mark, tr
from ..camera import Point
from ..events import KeyEvent, PointerEvent
from ..mirroring import set_axis
from .base import Cursor, IdleTool, Markers, Tool, ToolContext, distance

SNAP_ANGLE = math.radians(15.0)
_SHORTEST = 8.0  # points of the screen; a shorter line is a slip


def draw_axis(context: ToolContext) -> None:
    """Let the next drag be the axis of the mirror."""
    if context.session is not None and not context.is_busy:
        context.set_tool(AxisIdle(context))


class AxisIdle(IdleTool):
    """Waits for the drag that is the axis; Escape leaves it."""

    @property
    def press_hint(self) -> str:
        return tr("Drag along the middle of the drawing, Shift snaps to 15°, Esc cancels")

    cursor: Cursor = "cross"

    def press(self, event: PointerEvent) -> None:
        if event.button == "left":
            self.context.set_tool(DrawingAxis(self.context, event))
        else:
            self.context.return_to_idle()

    def key(self, event: KeyEvent) -> bool:
        if event.key == "escape":
            self.context.return_to_idle()
            return True
        return False


class DrawingAxis(Tool):
    """The axis goes from the press to the pointer."""

    hint = mark("Release to set the axis of the mirror, Shift snaps to 15°, Esc to cancel")

    def __init__(self, context: ToolContext, event: PointerEvent) -> None:
        super().__init__(context)
        self._start = self._end = event.position

    @property
    def markers(self) -> Markers:
        """The line so far."""
        return Markers(mirror_axis=(self._start, self._end))

    def move(self, event: PointerEvent) -> None:
        self._end = event.position
        if event.shift or "shift" in self.context.held:
            self._end = _snapped(self._start, event.position)

    def release(self, event: PointerEvent) -> None:
        if event.button != "left":
            return
        self.context.return_to_idle()
        if distance(self._start, self._end) >= _SHORTEST * self.context.ui_scale:
            to_drawing = self.context.camera.to_drawing
            set_axis(self.context, to_drawing(self._start), to_drawing(self._end))


def _snapped(start: Point, end: Point) -> Point:
    """The point as far from ``start`` as ``end`` in the nearest direction that is a multiple of 15°."""
    length = distance(start, end)
    angle = math.atan2(end[1] - start[1], end[0] - start[0])
    angle = SNAP_ANGLE * round(angle / SNAP_ANGLE)
    return start[0] + length * math.cos(angle), start[1] + length * math.sin(angle)
