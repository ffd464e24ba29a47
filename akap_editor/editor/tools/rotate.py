"""The ring around a pin that turns the drawing there, and pins that hold their angle."""

import math
from typing import TYPE_CHECKING

from ..camera import Point
from ..events import PointerEvent
from ..session.edits import SetAngles
from ..session.pin_edits import hold_pins
from .base import Pointing, Tool, distance

if TYPE_CHECKING:
    from ..editor import Editor

RING = 28.0  # points of the screen: radius of the ring
_GRIP = 14.0  # how far beside the ring a press takes it
SNAP = math.radians(15.0)


def ring_pin(editor: "Editor") -> int | None:
    """The pin whose ring is shown: with Alt the one near the pointer, or the only one that is selected."""
    if isinstance(editor.tool, RotatingPin):
        return editor.tool.pin
    session = editor.session
    idle = (
        session is not None and session.supports_rotation and not editor.busy and editor.chosen_tool == "pins"
    )
    if not idle or editor.pans_on_drag or "alt" not in editor.held or editor.pointer is None:
        return None
    pointer, places = editor.pointer, editor.pins_on_screen()
    near = min(((distance(place, pointer), pin) for pin, place in places.items()), default=None)
    if near is not None and near[0] <= (RING + _GRIP) * editor.ui_scale:
        return near[1]
    return next(iter(editor.selection)) if len(editor.selection) == 1 else None


def ring_at(editor: "Editor", position: Point) -> int | None:
    """The pin whose ring a press at a point of the screen would take."""
    pin = ring_pin(editor)
    if pin is None or editor.pin_at(position) is not None:
        return None
    away = distance(editor.pins_on_screen()[pin], position)
    return pin if away <= (RING + _GRIP) * editor.ui_scale else None


def hovered_ring(editor: "Editor") -> int | None:
    """The pin whose ring is under the pointer."""
    return ring_at(editor, editor.pointer) if editor.pointer is not None else None


class PointingRotationRing(Pointing):
    """Pressed on a ring, not dragged yet."""

    hint = "Drag to turn the drawing around this pin"

    def __init__(self, editor: "Editor", event: PointerEvent, pin: int) -> None:
        super().__init__(editor, event)
        self.pin = pin

    def dragged(self, event: PointerEvent) -> None:
        turning = RotatingPin(self.editor, self.start, self.pin)
        self.editor.set_tool(turning)
        turning.move(event)

    def clicked(self, event: PointerEvent) -> None:
        self.editor.return_to_idle()


class RotatingPin(Tool):
    """The drawing turns around a pin with the pointer; in the end the pin holds that angle."""

    def __init__(self, editor: "Editor", start: Point, pin: int) -> None:
        super().__init__(editor)
        session = editor.session
        assert session is not None
        self.pin, self._selection_before = pin, editor.selection
        held = session.state.pin(pin).angle
        self._angle = session.pin_angle(pin) if held is None else held
        self._direction = self._towards(start)
        editor.select({pin})
        session.begin("Turn")
        hold_pins(session)
        editor.trails.clear()

    @property
    def hint(self) -> str:  # type: ignore[override]
        """The angle, and how to end."""
        session = self.editor.session
        assert session is not None
        angle = math.degrees(session.state.pin(self.pin).angle or 0.0)
        return f"{angle:+.1f}°: release to hold this angle, Shift for steps of 15°, Escape to go back"

    def move(self, event: PointerEvent) -> None:
        session = self.editor.session
        assert session is not None
        direction = self._towards(event.position)
        self._angle += math.remainder(direction - self._direction, 2 * math.pi)
        self._direction = direction
        snaps = event.shift or "shift" in self.editor.held
        angle = SNAP * round(self._angle / SNAP) if snaps else self._angle
        session.apply(SetAngles({self.pin: angle}))

    def _towards(self, position: Point) -> float:
        x, y = self.editor.pins_on_screen()[self.pin]
        return math.atan2(position[1] - y, position[0] - x)

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            assert self.editor.session is not None
            self.editor.session.commit()
            self.editor.return_to_idle()

    def cancel(self) -> None:
        if self.editor.session is not None:
            self.editor.session.abort()
        self.editor.trails.clear()
        self.editor.select(self._selection_before)
        super().cancel()
