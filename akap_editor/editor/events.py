"""What a window tells the editor, in words that need no window."""

from dataclasses import dataclass
from typing import Literal

from .camera import Point

Button = Literal["left", "middle", "right"]
ARROWS = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}  # keys, and where to


@dataclass(frozen=True)
class PointerEvent:
    """A press, a move or a release; position in points of the window, y down.

    clicks: how many times in a row the button went down there, 2 for a double click.
    """

    kind: Literal["press", "move", "release"]
    position: Point
    button: Button = "left"
    shift: bool = False
    alt: bool = False
    clicks: int = 1


@dataclass(frozen=True)
class ScrollEvent:
    """The wheel, turned by ``amount`` notches (up is positive) at ``position``."""

    position: Point
    amount: float


@dataclass(frozen=True)
class KeyEvent:
    """A key pressed or let go, by its lower-case name: "escape", "space", "alt", "left", "enter", ..."""

    key: str
    pressed: bool = True
    shift: bool = False


@dataclass(frozen=True)
class PinRequest:
    """What the pointer asked the window to open for a pin."""

    kind: Literal["values", "menu"]
    pin: int


Event = PointerEvent | ScrollEvent | KeyEvent
