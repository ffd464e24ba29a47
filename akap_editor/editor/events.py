"""What a window tells the editor, in words that need no window."""

from dataclasses import dataclass
from typing import Literal

from .camera import Point

Button = Literal["left", "middle", "right"]


@dataclass(frozen=True)
class PointerEvent:
    """A press, a move or a release; position in points of the window, y down."""

    kind: Literal["press", "move", "release"]
    position: Point
    button: Button = "left"
    shift: bool = False


@dataclass(frozen=True)
class ScrollEvent:
    """The wheel, turned by ``amount`` notches (up is positive) at ``position``."""

    position: Point
    amount: float


@dataclass(frozen=True)
class KeyEvent:
    """A key pressed or let go, by its lower-case name: "escape", "space", ..."""

    key: str
    pressed: bool = True


Event = PointerEvent | ScrollEvent | KeyEvent
