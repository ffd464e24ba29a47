"""The hand, which pans the canvas; the middle button does so with every tool."""

from ...words import mark
from ..events import PointerEvent
from .base import IdleTool, Markers, Tool, ToolContext
from .pins import OpeningMenu


class HandIdle(IdleTool):
    """The hand waits for a press: the left button pans, the right one opens a menu."""

    press_hint = mark("Drag to move the canvas, scroll to zoom")
    cursor = "pan"

    @property
    def markers(self) -> Markers:
        """The pin under the pointer."""
        return Markers(hovered_pin=self.hovered_pin)

    def press(self, event: PointerEvent) -> None:
        if event.button == "left":
            self.context.set_tool(Panning(self.context, event))
        elif event.button == "right" and self.context.session is not None:
            pin = self.context.pin_at(event.position)
            self.context.set_tool(OpeningMenu(self.context, event, pin))


class Panning(Tool):
    """The canvas follows the pointer. This edits nothing, so the history gets no entry."""

    hint = mark("Release to stop moving the canvas, Esc to cancel")
    cursor = "panning"

    def __init__(self, context: ToolContext, event: PointerEvent) -> None:
        super().__init__(context)
        self._button, self._camera_before, self._last = event.button, context.camera, event.position
        self._tool_before = context.tool

    def move(self, event: PointerEvent) -> None:
        dx, dy = event.position[0] - self._last[0], event.position[1] - self._last[1]
        self.context.camera = self.context.camera.panned(dx, dy)
        self._last = event.position

    def release(self, event: PointerEvent) -> None:
        if event.button == self._button:
            self._leave()

    def cancel(self) -> None:
        self.context.camera = self._camera_before
        self._leave()

    def _leave(self) -> None:
        """Return to suggested pins, which a pan must not lose, or else to the idle tool."""
        self.context.return_to_idle()
        if self._tool_before.can_finish:
            self.context.set_tool(self._tool_before)
