"""The pins tool: it adds, selects, drags and removes pins."""

import numpy as np

from ...words import mark, tr
from ..camera import Point
from ..events import PointerEvent, ScrollEvent
from ..gestures import remove_pins
from ..mirroring import add_partner, mirrored_targets, with_partners
from ..session.edits import OrderLimb, SetTargets
from ..session.pin_edits import add_pin, hold_stopped_pins
from .base import Cursor, IdleTool, Markers, PinGesture, Pointing, Tool, ToolContext
from .rotate import PointingRotationRing, pin_with_ring, ring_at, rotation_ring
from .scale import PointingScaleHandle, scale_handle_at


class PinsIdle(IdleTool):
    """The pins tool waits for a press."""

    newest_pin: int | None = None  # added by the last click: the second click of a double click selects it

    @property
    def press_hint(self) -> str:
        context = self.context
        if self._hovered_handle is not None:
            return tr(PointingScaleHandle.hint)
        if self._hovered_ring is not None:
            return tr("Drag the ring to rotate the drawing around this pin, Shift snaps to 15°")
        hovered_pin = self.hovered_pin
        if hovered_pin is not None:
            if "alt" in context.held:
                return tr("Click to remove this pin, drag its ring to rotate the drawing around it")
            if "shift" in context.held:
                return tr("Click to add this pin to the selection, or to remove it from there")
            if self.session.state.pin(hovered_pin).is_locked:
                return tr(
                    "This pin is locked: a click selects it, the padlock in the list of pins unlocks it"
                )
            return tr(
                "Drag to bend the drawing, Shift-click to select several pins, double-click to edit values"
            )
        if self._new_pin is not None:
            return tr("Click to add a pin, or drag to add one and bend the drawing")
        if not self.session.state.pins:
            return tr("Click on the drawing to add a pin")
        if len(self.session.state.pins) == 1:
            return tr("One pin moves the whole drawing: click to add another one that holds it in place")
        return tr("Drag a pin to bend the drawing, click on the drawing to add one")

    @property
    def keyboard_hint(self) -> str:
        if self.hovered_pin is not None:
            if "alt" in self.context.held:
                return tr("Enter removes this pin")
            if "shift" in self.context.held:
                return tr("Enter adds this pin to the selection, or removes it from there")
            return tr(
                "Enter selects this pin, Shift+Enter adds it to the selection, Alt+Enter removes it, "
                "arrows move on, Esc ends"
            )
        if self._new_pin is not None:
            return tr("Enter adds a pin, arrows move on, Esc ends")
        return tr(
            "Arrows move the crosshair, Shift moves it farther, Enter adds a pin on the drawing, Esc ends"
        )

    @property
    def cursor(self) -> Cursor:
        if self._hovered_handle is not None:
            return "hand"
        if self._hovered_ring is not None:
            return "rotate"
        return "hand" if self.hovered_pin is not None else "arrow"

    @property
    def markers(self) -> Markers:
        """The pin under the pointer, the pin that a click would add, and the rotation ring."""
        hovered_pin, ring_pin = self.hovered_pin, pin_with_ring(self.context)
        return Markers(
            hovered_pin=hovered_pin,
            removes_hovered_pin=hovered_pin is not None and "alt" in self.context.held,
            new_pin=self._new_pin,
            ring=None if ring_pin is None else rotation_ring(self.context, ring_pin),
        )

    @property
    def _hovered_ring(self) -> int | None:
        """The pin whose ring is under the pointer."""
        pointer = self.context.pointer
        return None if pointer is None else ring_at(self.context, pointer)

    @property
    def _hovered_handle(self) -> int | None:
        """The pin whose scale handle is under the pointer."""
        pointer = self.context.pointer
        return None if pointer is None else scale_handle_at(self.context, pointer)

    @property
    def _new_pin(self) -> Point | None:
        """The point of the screen where a click would add a pin."""
        context, pointer = self.context, self.context.pointer
        if pointer is None or self.hovered_pin is not None or context.held & {"shift", "alt"}:
            return None
        if self._hovered_ring is not None or self._hovered_handle is not None:
            return None
        return pointer if context.is_on_drawing(pointer) else None

    def press(self, event: PointerEvent) -> None:
        context = self.context
        if context.session is None:
            return
        pin = context.pin_at(event.position)
        ring_pin = None if event.shift and not event.alt else ring_at(context, event.position)
        scaled_pin = scale_handle_at(context, event.position)
        if event.button == "right":
            context.set_tool(OpeningMenu(context, event, pin))
        elif scaled_pin is not None:
            context.set_tool(PointingScaleHandle(context, event, scaled_pin))
        elif ring_pin is not None:
            context.set_tool(PointingRotationRing(context, event, ring_pin))
        elif pin is None:
            self._press_outside_pins(event)
        elif event.alt:
            context.set_tool(RemovingPin(context, event, pin))
        elif event.clicks == 2 and pin != self.newest_pin:
            context.request_pin_popup("values", pin)
        else:
            context.set_tool(PointingPin(context, event, pin, self, is_new=False))

    def _press_outside_pins(self, event: PointerEvent) -> None:
        """Add a pin on the drawing, except with Shift or Alt, which are for pins that exist."""
        context = self.context
        if event.shift or event.alt:
            context.set_tool(PointingCanvas(context, event))
            return
        self.session.begin(mark("Add Pin"))
        pin = add_pin(self.session, context.camera.to_drawing(event.position))
        if pin is None:
            self.session.abort()
            context.set_tool(PointingCanvas(context, event))
        else:
            add_partner(self.session, pin)
            context.set_tool(PointingPin(context, event, pin, self, is_new=True))


class PointingPin(Pointing):
    """A pin is pressed and not dragged yet; ``is_new`` if the press added it."""

    hint = mark("Drag to bend the drawing")
    cursor = "hand"

    def __init__(
        self, context: ToolContext, event: PointerEvent, pin: int, idle_tool: PinsIdle, is_new: bool
    ) -> None:
        super().__init__(context, event)
        self.pin, self._idle_tool, self._is_new = pin, idle_tool, is_new
        self._selection_before = context.selection
        self._deselects = event.shift and pin in context.selection
        if event.shift:
            context.select(context.selection | {pin})
        elif pin not in context.selection:
            context.select({pin})

    def drag(self, event: PointerEvent) -> None:
        if self.session.state.pin(self.pin).is_locked:
            self.context.return_to_idle()
            return
        dragging = DraggingPin(self.context, self.start, self._selection_before, self._is_new, self.pin)
        self.context.set_tool(dragging)
        dragging.move(event)

    def click(self, event: PointerEvent) -> None:
        context = self.context
        self._idle_tool.newest_pin = self.pin if self._is_new else None
        if self._is_new:
            self.session.commit()
        elif self._deselects:
            context.select(context.selection - {self.pin})
        elif not event.shift:
            context.select({self.pin})
        context.return_to_idle()

    def cancel(self) -> None:
        if self._is_new:
            self.session.abort()
        self.context.select(self._selection_before)
        super().cancel()


class DraggingPin(PinGesture):
    """The selected pins follow the pointer, and the drawing follows them."""

    drags_pins = True

    def __init__(
        self, context: ToolContext, start: Point, selection_before: frozenset[int], is_new: bool, pin: int
    ) -> None:
        super().__init__(context, selection_before)
        session = self.session
        self._start = context.camera.to_drawing(start)
        if is_new:
            session.rename(mark("Add and Drag Pin"))
        else:
            count = len(context.selection)
            session.begin(mark("Drag Pin") if count == 1 else f"Drag {count} Pins")
        hold_stopped_pins(session)
        positions = zip(session.state.pins, session.pin_positions(), strict=True)
        self._pin = pin
        dragged = with_partners(session, context.selection)
        self._positions_before = {
            pin.id: (x, y) for pin, (x, y) in positions if pin.id in dragged and not pin.is_locked
        }

    @property
    def hint(self) -> str:
        """What a release does; or that nothing bends because no pin stays where it is."""
        if len(self._positions_before) == len(self.session.state.pins):
            return tr("No other pin holds the drawing, so all of it moves; Esc to cancel")
        if len(self.session.state.crossings):
            return tr("Release to keep this pose, wheel to bring it to the front or back, Esc to cancel")
        return tr("Release to keep this pose, Esc to cancel")

    def scroll(self, event: ScrollEvent) -> bool:
        """Bring what is dragged to the front, or send it to the back."""
        self.session.apply(OrderLimb(sorted(self._positions_before), event.amount > 0))
        return True

    @property
    def markers(self) -> Markers:
        """The targets of the pins that are dragged."""
        targets = {
            pin.id: self.context.camera.to_screen(tuple(pin.target))
            for pin in self.session.state.pins
            if pin.id in self._positions_before
        }
        return Markers(pin_targets=targets)

    def move(self, event: PointerEvent) -> None:
        x, y = self.context.camera.to_drawing(event.position)
        moved = np.array([x - self._start[0], y - self._start[1]])
        targets = mirrored_targets(self.session, self._positions_before, moved, self._pin)
        self.session.apply(SetTargets(targets))


class RemovingPin(Pointing):
    """A pin is pressed with Alt; a click removes it."""

    hint = mark("Release to remove this pin, Esc to cancel")
    cursor = "hand"

    def __init__(self, context: ToolContext, event: PointerEvent, pin: int) -> None:
        super().__init__(context, event)
        self.pin = pin

    def click(self, event: PointerEvent) -> None:
        self.context.return_to_idle()
        remove_pins(self.context, {self.pin})


class OpeningMenu(Pointing):
    """The right button is pressed; a click opens the menu of a pin, or of the canvas if it is None."""

    hint = mark("Release to open the menu")
    cursor = "hand"

    def __init__(self, context: ToolContext, event: PointerEvent, pin: int | None) -> None:
        super().__init__(context, event)
        self.pin = pin

    def click(self, event: PointerEvent) -> None:
        self.context.return_to_idle()
        if self.pin is None:
            self.context.menu_request = event.position
        else:
            self.context.request_pin_popup("menu", self.pin)


class PointingCanvas(Pointing):
    """The canvas is pressed outside the drawing, or with Shift or Alt, and not dragged yet."""

    hint = mark("Drag to select pins with a box")

    def __init__(self, context: ToolContext, event: PointerEvent) -> None:
        super().__init__(context, event)
        self._extends_selection = event.shift

    def drag(self, event: PointerEvent) -> None:
        rubber_band = RubberBand(self.context, self.start, self._extends_selection)
        self.context.set_tool(rubber_band)
        rubber_band.move(event)

    def click(self, event: PointerEvent) -> None:
        if not self._extends_selection:
            self.context.select(())
        self.context.return_to_idle()


class RubberBand(Tool):
    """A box from the press to the pointer selects the pins inside it."""

    hint = mark("Release to select the pins in the box, Esc to cancel")

    def __init__(self, context: ToolContext, start: Point, extends_selection: bool) -> None:
        super().__init__(context)
        self._start = self._end = start
        self._selection_before = context.selection
        self._extended_selection = context.selection if extends_selection else frozenset()

    @property
    def markers(self) -> Markers:
        """The box."""
        (x0, y0), (x1, y1) = self._start, self._end
        return Markers(selection_box=((min(x0, x1), min(y0, y1)), (max(x0, x1), max(y0, y1))))

    def move(self, event: PointerEvent) -> None:
        self._end = event.position
        low, high = np.minimum(self._start, self._end), np.maximum(self._start, self._end)
        hidden = {pin.id for pin in self.session.state.pins if pin.is_hidden}
        pins_inside = {
            pin
            for pin, position in self.context.pins_on_screen().items()
            if pin not in hidden and (low <= position).all() and (position <= high).all()
        }
        self.context.select(self._extended_selection | pins_inside)

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            self.context.return_to_idle()

    def cancel(self) -> None:
        self.context.select(self._selection_before)
        super().cancel()
