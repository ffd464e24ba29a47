"""The states of the pointer, each named, each with the same way out."""

from typing import TYPE_CHECKING

import numpy as np

from .. import gestures
from ..camera import Point
from ..events import PointerEvent
from ..session.edits import SetTargets
from ..session.pin_edits import add_pin, hold_pins
from .base import Pointing, Tool
from .rotate import PointingRotationRing, hovered_ring, ring_at
from .stiffness_brush import Painting

if TYPE_CHECKING:
    from ..editor import Editor

ZOOM_STEP = 1.15


class Idle(Tool):
    """Nothing is pressed."""

    @property
    def hint(self) -> str:  # type: ignore[override]
        """What a press would do here."""
        editor = self.editor
        if editor.session is None:
            return "Open a picture or a drawing to begin"
        if editor.pans_on_drag:
            return "Drag to move the canvas, wheel to zoom"
        if editor.chosen_tool == "brush":
            return editor.brush.hint
        if hovered_ring(editor) is not None:
            return "Drag the ring to turn the drawing around this pin, with Shift by steps of 15°"
        if editor.hovered_pin is not None:
            if "alt" in editor.held:
                return "Click to remove this pin, drag its ring to turn the drawing around it"
            if "shift" in editor.held:
                return "Click to select this pin too, or to take it out of the selection"
            return "Drag to bend the drawing, Shift-click to select several pins, double-click for values"
        if editor.would_add_pin:
            return "Click to add a pin, or press and drag to bend from here"
        if not editor.session.state.pins:
            return "Click on the drawing to put a pin where it should hold still"
        if len(editor.session.state.pins) == 1:
            return "One pin takes all of the drawing along: click on the drawing where it should hold still"
        return "Drag a pin to bend the drawing, click on the drawing for another one"

    def press(self, event: PointerEvent) -> None:
        editor = self.editor
        if event.button == "middle" or (event.button == "left" and editor.pans_on_drag):
            editor.set_tool(Panning(editor, event))
            return
        if editor.session is None:
            return
        if editor.chosen_tool == "brush":
            editor.set_tool(Painting(editor, event))
            return
        pin = editor.pin_at(event.position)
        ring = ring_at(editor, event.position) if event.alt else None
        if event.button == "right":
            if pin is not None:
                editor.set_tool(OpeningPinMenu(editor, event, pin))
        elif ring is not None:
            editor.set_tool(PointingRotationRing(editor, event, ring))
        elif pin is None:
            self._press_beside_pins(event)
        elif event.alt:
            editor.set_tool(RemovingPin(editor, event, pin))
        elif event.clicks == 2 and pin != editor.newest_pin:
            editor.request_pin_popup("values", pin)
        else:
            editor.set_tool(PointingPin(editor, event, pin, is_new=False))

    def _press_beside_pins(self, event: PointerEvent) -> None:
        """A new pin where the drawing is; Shift and Alt are for pins that are there."""
        editor = self.editor
        assert editor.session is not None
        if event.shift or event.alt:
            editor.set_tool(PointingCanvas(editor, event))
            return
        editor.session.begin("Add pin")
        added = add_pin(editor.session, editor.camera.to_drawing(event.position))
        if added is None:
            editor.session.abort()
            editor.set_tool(PointingCanvas(editor, event))
        else:
            editor.set_tool(PointingPin(editor, event, added, is_new=True))


class PointingPin(Pointing):
    """Pressed on a pin, or on the drawing where a pin now is; not dragged yet."""

    hint = "Drag to bend the drawing"

    def __init__(self, editor: "Editor", event: PointerEvent, pin: int, is_new: bool) -> None:
        super().__init__(editor, event)
        self.pin, self.is_new = pin, is_new
        self._selection_before = editor.selection
        self._was_selected = pin in editor.selection
        if event.shift:
            editor.select(editor.selection | {pin})
        elif not self._was_selected:
            editor.select({pin})
        self._toggle = event.shift and self._was_selected

    def dragged(self, event: PointerEvent) -> None:
        drag = DraggingPin(self.editor, self.start, self._selection_before, self.is_new)
        self.editor.set_tool(drag)
        drag.move(event)

    def clicked(self, event: PointerEvent) -> None:
        editor = self.editor
        editor.newest_pin = self.pin if self.is_new else None
        if self.is_new:
            assert editor.session is not None
            editor.session.commit()
        elif self._toggle:
            editor.select(editor.selection - {self.pin})
        elif not event.shift:
            editor.select({self.pin})
        editor.set_tool(Idle(editor))

    def cancel(self) -> None:
        if self.is_new and self.editor.session is not None:
            self.editor.session.abort()
        self.editor.select(self._selection_before)
        super().cancel()


class RemovingPin(Pointing):
    """Pressed on a pin with Alt."""

    hint = "Release to remove this pin, Escape to keep it"

    def __init__(self, editor: "Editor", event: PointerEvent, pin: int) -> None:
        super().__init__(editor, event)
        self.pin = pin

    def clicked(self, event: PointerEvent) -> None:
        self.editor.set_tool(Idle(self.editor))
        gestures.remove_pins(self.editor, {self.pin})


class OpeningPinMenu(Pointing):
    """Pressed on a pin with the right button; a drag with that button does nothing."""

    hint = "Release for the menu of this pin"

    def __init__(self, editor: "Editor", event: PointerEvent, pin: int) -> None:
        super().__init__(editor, event)
        self.pin = pin

    def clicked(self, event: PointerEvent) -> None:
        self.editor.set_tool(Idle(self.editor))
        self.editor.request_pin_popup("menu", self.pin)


class DraggingPin(Tool):
    """The selected pins follow the pointer; the drawing follows them."""

    def __init__(
        self, editor: "Editor", start: Point, selection_before: frozenset[int], is_new: bool
    ) -> None:
        super().__init__(editor)
        session = editor.session
        assert session is not None
        self._start = editor.camera.to_drawing(start)
        self._selection_before = selection_before
        label = "Bend" if len(editor.selection) == 1 else f"Bend with {len(editor.selection)} pins"
        if is_new:
            session.rename("Add pin and bend")
        else:
            session.begin(label)
        hold_pins(session)
        editor.trails.clear()
        where = zip(session.state.pins, session.pin_positions(), strict=True)
        self._from = {pin.id: (x, y) for pin, (x, y) in where if pin.id in editor.selection}

    @property
    def hint(self) -> str:  # type: ignore[override]
        """What a release would do, and why nothing bends where no pin holds still."""
        session = self.editor.session
        if session is not None and len(self._from) == len(session.state.pins):
            return "No other pin holds the drawing, so all of it goes along; Escape to go back"
        return "Release to keep this pose, Escape to go back"

    def move(self, event: PointerEvent) -> None:
        assert self.editor.session is not None
        x, y = self.editor.camera.to_drawing(event.position)
        dx, dy = x - self._start[0], y - self._start[1]
        targets = {pin: (a + dx, b + dy) for pin, (a, b) in self._from.items()}
        self.editor.session.apply(SetTargets(targets))

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            assert self.editor.session is not None
            self.editor.session.commit()
            self.editor.set_tool(Idle(self.editor))

    def cancel(self) -> None:
        if self.editor.session is not None:
            self.editor.session.abort()
        self.editor.trails.clear()
        self.editor.select(self._selection_before)
        super().cancel()


class PointingCanvas(Pointing):
    """Pressed beside the drawing, or on it with Shift; not dragged yet."""

    hint = "Drag to select pins with a box"

    def __init__(self, editor: "Editor", event: PointerEvent) -> None:
        super().__init__(editor, event)
        self._adds = event.shift

    def dragged(self, event: PointerEvent) -> None:
        band = RubberBand(self.editor, self.start, self._adds)
        self.editor.set_tool(band)
        band.move(event)

    def clicked(self, event: PointerEvent) -> None:
        if not self._adds:
            self.editor.select(())
        self.editor.set_tool(Idle(self.editor))


class RubberBand(Tool):
    """A box that selects the pins inside it."""

    hint = "Release to select the pins in the box, Escape to go back"

    def __init__(self, editor: "Editor", start: Point, adds: bool) -> None:
        super().__init__(editor)
        self.start = self.end = start
        self._before = editor.selection
        self._kept = editor.selection if adds else frozenset()

    def move(self, event: PointerEvent) -> None:
        self.end = event.position
        low, high = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        inside = {
            pin
            for pin, place in self.editor.pins_on_screen().items()
            if (low <= place).all() and (place <= high).all()
        }
        self.editor.select(self._kept | inside)

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            self.editor.set_tool(Idle(self.editor))

    def cancel(self) -> None:
        self.editor.select(self._before)
        super().cancel()


class Panning(Tool):
    """The canvas follows the pointer; not an edit, so nothing to undo."""

    hint = "Release to stop moving the canvas"

    def __init__(self, editor: "Editor", event: PointerEvent) -> None:
        super().__init__(editor)
        self._button, self._before, self._last = event.button, editor.camera, event.position

    def move(self, event: PointerEvent) -> None:
        dx, dy = event.position[0] - self._last[0], event.position[1] - self._last[1]
        self.editor.camera = self.editor.camera.panned(dx, dy)
        self._last = event.position

    def release(self, event: PointerEvent) -> None:
        if event.button == self._button:
            self.editor.set_tool(Idle(self.editor))

    def cancel(self) -> None:
        self.editor.camera = self._before
        super().cancel()
