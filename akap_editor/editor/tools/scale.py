"""The handle on the ring around a pin that scales the drawing there; afterwards the pin keeps its scale."""

import math

from ...words import mark, tr
from ..camera import Point
from ..document.pin import MAX_PIN_SCALE, MIN_PIN_SCALE
from ..events import PointerEvent
from ..session.edits import SetScales
from ..session.pin_edits import hold_stopped_pins
from .base import Markers, PinGesture, Pointing, RotationRing, ToolContext, distance
from .rotate import RING_RADIUS, pin_with_ring, rotation_ring

HANDLE_REACH = 9.0  # points of the screen: a press this close to the handle takes it
_SNAP = 0.1
_DIRECTION = math.pi / 4  # of the handle from the pin, radians clockwise from the right: below it


def scale_handle(ring: RotationRing, ui_scale: float) -> Point:
    """Where the handle is on a ring; while it is dragged, it follows the pointer away from the pin."""
    radius = RING_RADIUS * ui_scale if ring.handle_radius is None else ring.handle_radius
    x, y = ring.center
    return x + radius * math.cos(_DIRECTION), y + radius * math.sin(_DIRECTION)


def scale_handle_at(context: ToolContext, position: Point) -> int | None:
    """The pin whose handle is at a point of the screen."""
    pin, session = pin_with_ring(context), context.session
    if pin is None or session is None or not session.supports_scales:
        return None
    handle = scale_handle(rotation_ring(context, pin), context.ui_scale)
    return pin if distance(handle, position) <= HANDLE_REACH * context.ui_scale else None


class PointingScaleHandle(Pointing):
    """The handle is pressed and not dragged yet; a double click sets the scale to 100 %."""

    hint = mark("Drag to scale the drawing around this pin, double-click for 100 %")
    cursor = "grab"

    def __init__(self, context: ToolContext, event: PointerEvent, pin: int) -> None:
        super().__init__(context, event)
        self.pin, self._is_double = pin, event.clicks == 2

    def drag(self, event: PointerEvent) -> None:
        scaling = ScalingPin(self.context, self.start, self.pin)
        self.context.set_tool(scaling)
        scaling.move(event)

    def click(self, event: PointerEvent) -> None:
        self.context.return_to_idle()
        if self._is_double and self.session.state.pin(self.pin).scale not in (None, 1.0):
            self.context.apply(mark("Scale Pin"), SetScales({self.pin: 1.0}))


class ScalingPin(PinGesture):
    """The drawing around a pin grows with the distance of the pointer; Shift snaps to steps of 10 %."""

    def __init__(self, context: ToolContext, start: Point, pin: int) -> None:
        super().__init__(context, context.selection)
        self.pin = pin
        self._scale = self.session.state.pin(pin).scale or 1.0
        self._distance = max(self._distance_to(start), 1.0)
        self._ratio = 1.0
        context.select({pin})
        self.session.begin(mark("Scale Pin"))
        hold_stopped_pins(self.session)

    @property
    def hint(self) -> str:
        """The scale, and how to end."""
        percent = 100 * (self.session.state.pin(self.pin).scale or 1.0)
        return tr(
            "{percent:.0f} %: release to keep this scale, Shift snaps to 10 %, Esc to cancel", percent=percent
        )

    @property
    def markers(self) -> Markers:
        """The ring, with the handle at the pointer's distance, and the scale."""
        ring = rotation_ring(self.context, self.pin)
        radius = RING_RADIUS * self.context.ui_scale * self._ratio
        scale = self.session.state.pin(self.pin).scale
        return Markers(ring=RotationRing(ring.pin, ring.center, ring.angle, False, radius, scale))

    def move(self, event: PointerEvent) -> None:
        self._ratio = self._distance_to(event.position) / self._distance
        scale = self._scale * self._ratio
        if event.shift or "shift" in self.context.held:
            scale = _SNAP * round(scale / _SNAP)
        scale = min(max(scale, MIN_PIN_SCALE), MAX_PIN_SCALE)
        self.session.apply(SetScales({self.pin: round(scale, 4)}))

    def _distance_to(self, position: Point) -> float:
        """Distance from the pin to a point of the screen."""
        return distance(self.context.pins_on_screen()[self.pin], position)
