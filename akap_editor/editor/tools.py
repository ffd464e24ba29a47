"""The states of the pointer, each named, each with the same way out."""

from typing import TYPE_CHECKING

import numpy as np

from .camera import Point
from .events import PointerEvent

if TYPE_CHECKING:
    from .editor import Editor

DRAG_DISTANCE = 3.0  # points of the screen: less is a click with a trembling hand
ZOOM_STEP = 1.15


def distance(a: Point, b: Point) -> float:
    """Between two points of the screen."""
    return float(np.hypot(a[0] - b[0], a[1] - b[1]))


class Tool:
    """A state of the pointer. Events lead to others; `cancel` leaves as if it had never been entered."""

    hint = ""

    def __init__(self, editor: "Editor") -> None:
        self.editor = editor

    def press(self, event: PointerEvent) -> None:
        """A button goes down."""

    def move(self, event: PointerEvent) -> None:
        """The pointer moves, buttons up or down."""

    def release(self, event: PointerEvent) -> None:
        """A button goes up."""

    def cancel(self) -> None:
        """Escape, focus loss or an error: back to idle, everything as it was before the press."""
        self.editor.enter(Idle(self.editor))


class Idle(Tool):
    """Nothing is pressed."""

    @property
    def hint(self) -> str:  # type: ignore[override]
        """What a press would do here."""
        editor = self.editor
        if editor.session is None:
            return "Open a picture or a drawing to begin"
        if editor.hand:
            return "Drag to move the canvas, wheel to zoom"
        if editor.hovered_pin is not None:
            return "Drag to bend the drawing, Shift-click to select several pins"
        if editor.would_add_pin:
            return "Click to add a pin, or press and drag to bend from here"
        if not editor.session.state.pins:
            return "Click on the drawing to put a pin where it should hold still"
        return "Drag a pin to bend the drawing, click on the drawing for another one"

    def press(self, event: PointerEvent) -> None:
        editor = self.editor
        if event.button == "middle" or (event.button == "left" and editor.hand):
            editor.enter(Panning(editor, event))
            return
        if event.button != "left" or editor.session is None:
            return
        pin = editor.pin_at(event.position)
        if pin is not None:
            editor.enter(PointingPin(editor, event, pin, is_new=False))
            return
        editor.session.begin("Add pin")
        added = editor.session.add_pin(editor.camera.to_drawing(event.position))
        if added is None:
            editor.session.abort()
            editor.enter(PointingCanvas(editor, event))
        else:
            editor.enter(PointingPin(editor, event, added, is_new=True))


class PointingPin(Tool):
    """Pressed on a pin, or on the drawing where a pin now is; not dragged yet."""

    hint = "Drag to bend the drawing"

    def __init__(self, editor: "Editor", event: PointerEvent, pin: int, is_new: bool) -> None:
        super().__init__(editor)
        self.start, self.pin, self.is_new = event.position, pin, is_new
        self._selection_before = editor.selection
        self._was_selected = pin in editor.selection
        if event.shift:
            editor.select(editor.selection | {pin})
        elif not self._was_selected:
            editor.select({pin})
        self._toggle = event.shift and self._was_selected

    def move(self, event: PointerEvent) -> None:
        if distance(event.position, self.start) >= DRAG_DISTANCE * self.editor.ui_scale:
            drag = DraggingPin(self.editor, self.start, self._selection_before, self.is_new)
            self.editor.enter(drag)
            drag.move(event)

    def release(self, event: PointerEvent) -> None:
        editor = self.editor
        if event.button != "left":
            return
        if self.is_new:
            assert editor.session is not None
            editor.session.commit()
        elif self._toggle:
            editor.select(editor.selection - {self.pin})
        elif not event.shift:
            editor.select({self.pin})
        editor.enter(Idle(editor))

    def cancel(self) -> None:
        if self.is_new and self.editor.session is not None:
            self.editor.session.abort()
        self.editor.select(self._selection_before)
        super().cancel()


class DraggingPin(Tool):
    """The selected pins follow the pointer; the drawing follows them."""

    hint = "Release to keep this pose, Escape to go back"

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
            session.history.rename("Add pin and bend")
        else:
            session.begin(label)
        session.hold_pins()
        where = zip(session.state.pins, session.pin_positions(), strict=True)
        self._from = {pin.id: (x, y) for pin, (x, y) in where if pin.id in editor.selection}

    def move(self, event: PointerEvent) -> None:
        assert self.editor.session is not None
        x, y = self.editor.camera.to_drawing(event.position)
        dx, dy = x - self._start[0], y - self._start[1]
        self.editor.session.set_targets({pin: (a + dx, b + dy) for pin, (a, b) in self._from.items()})

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            assert self.editor.session is not None
            self.editor.session.commit()
            self.editor.enter(Idle(self.editor))

    def cancel(self) -> None:
        if self.editor.session is not None:
            self.editor.session.abort()
        self.editor.select(self._selection_before)
        super().cancel()


class PointingCanvas(Tool):
    """Pressed beside the drawing; not dragged yet."""

    hint = "Drag to select pins with a box"

    def __init__(self, editor: "Editor", event: PointerEvent) -> None:
        super().__init__(editor)
        self.start, self._adds = event.position, event.shift

    def move(self, event: PointerEvent) -> None:
        if distance(event.position, self.start) >= DRAG_DISTANCE * self.editor.ui_scale:
            band = RubberBand(self.editor, self.start, self._adds)
            self.editor.enter(band)
            band.move(event)

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            if not self._adds:
                self.editor.select(())
            self.editor.enter(Idle(self.editor))


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
            self.editor.enter(Idle(self.editor))

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
            self.editor.enter(Idle(self.editor))

    def cancel(self) -> None:
        self.editor.camera = self._before
        super().cancel()
