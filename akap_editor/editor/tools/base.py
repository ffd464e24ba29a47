"""What all states of the pointer have in common."""

from typing import TYPE_CHECKING

import numpy as np

from ..camera import Point
from ..events import KeyEvent, PointerEvent

if TYPE_CHECKING:
    from ..editor import Editor

DRAG_DISTANCE = 3.0  # points of the screen: less is a click with a trembling hand


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

    def key(self, event: KeyEvent) -> bool:
        """A key goes down; whether it means something in this state alone."""
        return False

    def resized(self) -> None:
        """The canvas is another part of the window."""

    def cancel(self) -> None:
        """Escape, focus loss or an error: back to idle, everything as it was before the press."""
        self.editor.return_to_idle()


class Pointing(Tool):
    """A button is down and the pointer has not left the place: it may become a click or a drag."""

    def __init__(self, editor: "Editor", event: PointerEvent) -> None:
        super().__init__(editor)
        self.start, self.button = event.position, event.button

    def move(self, event: PointerEvent) -> None:
        if distance(event.position, self.start) >= DRAG_DISTANCE * self.editor.ui_scale:
            self.dragged(event)

    def release(self, event: PointerEvent) -> None:
        if event.button == self.button:
            self.clicked(event)

    def dragged(self, event: PointerEvent) -> None:
        """The pointer has left the place; by default that was not meant."""
        self.editor.return_to_idle()

    def clicked(self, event: PointerEvent) -> None:
        """The button went up where it went down."""
