"""The ring around a pin that rotates the drawing there; afterwards the pin holds its angle."""

import math

from ...words import mark, tr
from ..camera import Point
from ..events import PointerEvent
from ..gestures import add_pin
from ..mirroring import with_partners
from ..session.edits import SetAngles
from ..session.pin_edits import hold_stopped_pins
from .base import Markers, PinGesture, Pointing, RotationRing, ToolContext, distance

RING_RADIUS = 28.0  # points of the screen
_REACH = 14.0  # points of the screen: with Alt, a press this close to the ring takes it
_HALF_WIDTH = 7.0  # points of the screen: without Alt, a press this close to the ring's line takes it
SNAP_ANGLE = math.radians(15.0)


def pin_with_ring(context: ToolContext) -> int | None:
    """The pin that shows its ring: the only selected one; while Alt is held, rather the one near the pointer.

    None with a method that cannot rotate pins, and during a gesture.
    """
    session, pointer = context.session, context.pointer
    if session is None or not session.supports_rotation or context.is_busy:
        return None
    fixed = {pin.id for pin in session.state.pins if pin.is_hidden or pin.is_locked}
    if "alt" in context.held and pointer is not None:
        centers = context.pins_on_screen().items()
        distances = [(distance(center, pointer), pin) for pin, center in centers if pin not in fixed]
        nearest = min(distances, default=None)
        if nearest is not None and nearest[0] <= (RING_RADIUS + _REACH) * context.ui_scale:
            return nearest[1]
    selected = context.selection - fixed
    return next(iter(selected)) if len(selected) == len(context.selection) == 1 else None


def ring_at(context: ToolContext, position: Point) -> int | None:
    """The pin whose ring a press at a point of the screen takes."""
    pin = pin_with_ring(context)
    if pin is None or context.pin_at(position) is not None:
        return None
    radius = distance(context.pins_on_screen()[pin], position) / context.ui_scale
    if "alt" in context.held:
        return pin if radius <= RING_RADIUS + _REACH else None
    return pin if abs(radius - RING_RADIUS) <= _HALF_WIDTH else None


def rotation_ring(context: ToolContext, pin: int, is_dragged: bool = False) -> RotationRing:
    """The ring of a pin; its handle is at the held angle or else at the current one."""
    assert context.session is not None
    held_angle = context.session.state.pin(pin).angle
    angle = context.session.pin_angle(pin) if held_angle is None else held_angle
    return RotationRing(pin, context.pins_on_screen()[pin], angle, is_dragged)


class PointingRotationRing(Pointing):
    """The ring of a pin is pressed and not dragged yet. A click without Alt does what it does elsewhere."""

    hint = mark("Drag to rotate the drawing around this pin")
    cursor = "rotate"

    def __init__(self, context: ToolContext, event: PointerEvent, pin: int) -> None:
        super().__init__(context, event)
        self.pin = pin

    def drag(self, event: PointerEvent) -> None:
        rotating = RotatingPin(self.context, self.start, self.pin)
        self.context.set_tool(rotating)
        rotating.move(event)

    def click(self, event: PointerEvent) -> None:
        context = self.context
        context.return_to_idle()
        is_plain = not (event.alt or event.shift or context.held & {"alt", "shift"})
        if is_plain and add_pin(context, context.camera.to_drawing(self.start)) is None:
            context.select(())


class RotatingPin(PinGesture):
    """The drawing around a pin rotates with the pointer; Shift snaps to steps of 15°."""

    cursor = "rotate"

    def __init__(self, context: ToolContext, start: Point, pin: int) -> None:
        super().__init__(context, context.selection)
        self.pin = pin
        held_angle = self.session.state.pin(pin).angle
        self._angle = self.session.pin_angle(pin) if held_angle is None else held_angle
        self._first_angle = self._angle
        partners = with_partners(self.session, frozenset({pin})) - {pin}
        self._partner = next(iter(partners), None)
        self._partner_angle = 0.0
        if self._partner is not None:
            held_angle = self.session.state.pin(self._partner).angle
            self._partner_angle = self.session.pin_angle(self._partner) if held_angle is None else held_angle
        self._direction = self._direction_to(start)
        context.select({pin})
        self.session.begin(mark("Rotate Pin"))
        hold_stopped_pins(self.session)

    @property
    def hint(self) -> str:
        """The angle, and how to end."""
        angle = math.degrees(self.session.state.pin(self.pin).angle or 0.0)
        return tr("{angle:+.1f}°: release to hold this angle, Shift snaps to 15°, Esc to cancel", angle=angle)

    @property
    def markers(self) -> Markers:
        """The ring, with the angle."""
        return Markers(ring=rotation_ring(self.context, self.pin, is_dragged=True))

    def move(self, event: PointerEvent) -> None:
        direction = self._direction_to(event.position)
        self._angle += math.remainder(direction - self._direction, 2 * math.pi)
        self._direction = direction
        snaps = event.shift or "shift" in self.context.held
        angle = SNAP_ANGLE * round(self._angle / SNAP_ANGLE) if snaps else self._angle
        angles = {self.pin: angle}
        if self._partner is not None:
            angles[self._partner] = self._partner_angle - (angle - self._first_angle)
        self.session.apply(SetAngles(angles))

    def _direction_to(self, position: Point) -> float:
        """Direction from the pin to a point of the screen, radians."""
        x, y = self.context.pins_on_screen()[self.pin]
        return math.atan2(position[1] - y, position[0] - x)
