"""The zoom tool: a click zooms in, with Alt out, and a drag to the right or left zooms continuously."""

from ...words import mark
from ..events import PointerEvent
from .base import IdleTool, Pointing, Tool, ToolContext

CLICK_FACTOR = 1.5
_DOUBLE_DISTANCE = 120.0  # points of the design: a drag that far doubles the zoom


class ZoomIdle(IdleTool):
    """The zoom tool waits for a press."""

    press_hint = mark("Click to zoom in, Alt-click to zoom out, or drag to the right or left")
    keyboard_hint = mark("Enter zooms in, Alt+Enter zooms out, arrows move, Esc ends")
    cursor = "zoom"

    def press(self, event: PointerEvent) -> None:
        if self.context.session is not None:
            self.context.set_tool(PointingZoom(self.context, event))


class PointingZoom(Pointing):
    """The canvas is pressed and not dragged yet; a click zooms at this place."""

    hint = mark("Release to zoom, or drag to the right or left")
    cursor = "zoom"

    def drag(self, event: PointerEvent) -> None:
        zooming = Zooming(self.context, event, self.start)
        self.context.set_tool(zooming)
        zooming.move(event)

    def click(self, event: PointerEvent) -> None:
        zooms_out = event.alt or "alt" in self.context.held or self.button == "right"
        factor = 1 / CLICK_FACTOR if zooms_out else CLICK_FACTOR
        self.context.camera = self.context.camera.zoomed(factor, self.start)
        self.context.return_to_idle()


class Zooming(Tool):
    """The zoom follows the pointer, about the place of the press. This edits nothing."""

    hint = mark("Release to keep this zoom, Esc to cancel")
    cursor = "zoom"

    def __init__(self, context: ToolContext, event: PointerEvent, start: tuple[float, float]) -> None:
        super().__init__(context)
        self._button, self._start, self._camera_before = event.button, start, context.camera

    def move(self, event: PointerEvent) -> None:
        distance = (event.position[0] - self._start[0]) / (_DOUBLE_DISTANCE * self.context.ui_scale)
        self.context.camera = self._camera_before.zoomed(2.0**distance, self._start)

    def release(self, event: PointerEvent) -> None:
        if event.button == self._button:
            self.context.return_to_idle()

    def cancel(self) -> None:
        self.context.camera = self._camera_before
        super().cancel()
