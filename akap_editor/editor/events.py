"""Input events of the editor, independent of any window system."""

from dataclasses import dataclass
from typing import Literal, get_args

from .camera import Point

Button = Literal["left", "middle", "right"]
BUTTONS: tuple[Button, ...] = get_args(Button)
ARROWS = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}  # keys and their directions


@dataclass(frozen=True)
class PointerEvent:
    """A press, a movement or a release of the mouse; position in points of the window, y down.

    clicks: number of quick presses at the same place, 2 for a double click.
    """

    kind: Literal["press", "move", "release"]
    position: Point
    button: Button = "left"
    shift: bool = False
    alt: bool = False
    clicks: int = 1


@dataclass(frozen=True)
class ScrollEvent:
    """A turn of the mouse wheel by ``amount`` notches, up is positive, at ``position``.

    sideways: notches to the left, of a horizontal wheel or of the other one with Shift.
    """

    position: Point
    amount: float
    sideways: float = 0.0


@dataclass(frozen=True)
class KeyEvent:
    """A press or a release of a key with a lower-case name: "escape", "space", "alt", "left", "enter", ..."""

    key: str
    pressed: bool = True
    shift: bool = False


@dataclass(frozen=True)
class PinRequest:
    """A request to the window: open the values or the menu of a pin."""

    kind: Literal["values", "menu"]
    pin: int


Event = PointerEvent | ScrollEvent | KeyEvent
