"""The base of all tools: what a tool sees of the editor, which events it gets and what it shows."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

import numpy as np

from ...geometry.validation import Floats
from ...words import tr
from ..camera import Camera, Point
from ..document.rig.loose_parts import LooseParts
from ..events import BUTTONS, KeyEvent, PointerEvent, ScrollEvent
from ..gestures import EditContext
from ..pin_trails import Trails
from ..session.session import Session

DRAG_DISTANCE = 3.0  # points of the screen: a shorter movement between press and release is a click

Cursor = Literal["arrow", "hand", "grab", "rotate", "pan", "panning", "zoom", "cross", "hidden"]


def distance(a: Point, b: Point) -> float:
    """Distance between two points of the screen."""
    return float(np.hypot(a[0] - b[0], a[1] - b[1]))


@dataclass(frozen=True)
class RotationRing:
    """The ring around a pin by which the drawing is rotated, with a handle that scales it.

    angle: of the pin, radians from the rest pose, clockwise on the screen; is_dragged: whether it is rotated
    now; handle_radius: distance of the scale's handle from the pin, in points of the screen, while it is
    dragged; scale: the one that is shown then.
    """

    pin: int
    center: Point
    angle: float
    is_dragged: bool = False
    handle_radius: float | None = None
    scale: float | None = None


@dataclass(frozen=True)
class BrushCircle:
    """The rim of the brush around the pointer."""

    center: Point
    radius: float
    erases: bool


@dataclass(frozen=True)
class Crosshair:
    """Four arms around the keyboard pointer; they begin at distance ``gap`` from the center."""

    center: Point
    gap: float


@dataclass(frozen=True)
class Markers:
    """What a tool shows over the drawing, in points of the screen; the app draws it.

    hovered_pin: the pin under the pointer, by id; removes_hovered_pin: whether a click removes it; new_pin:
    where a click would add a pin; pin_targets: of the pins that are dragged, by id; selection_box: its upper
    left and lower right corners; mirror_axis: two points of the axis that is drawn;
    hovered_joint: the joint under the pointer, by id; new_joint: where it goes;
    hovered_cut: the stroke of the knife under the pointer, by index; cut_stroke: the one that is drawn;
    suggested_pins: of which the number hovered_suggestion is under the pointer.
    """

    hovered_pin: int | None = None
    removes_hovered_pin: bool = False
    new_pin: Point | None = None
    suggested_pins: tuple[Point, ...] = ()
    hovered_suggestion: int | None = None
    pin_targets: Mapping[int, Point] = field(default_factory=dict)
    ring: RotationRing | None = None
    brush: BrushCircle | None = None
    crosshair: Crosshair | None = None
    selection_box: tuple[Point, Point] | None = None
    mirror_axis: tuple[Point, Point] | None = None
    hovered_joint: int | None = None
    new_joint: Point | None = None
    hovered_cut: int | None = None
    cut_stroke: tuple[Point, ...] = ()


class ToolContext(EditContext, Protocol):
    """The part of the editor that tools see and change; see `Editor`."""

    camera: Camera
    pointer: Point | None
    last_pointer: Point | None
    ui_scale: float
    held: frozenset[str]
    trails: Trails
    chosen_tool: "IdleTool"
    menu_request: Point | None

    @property
    def canvas(self) -> tuple[float, float, float, float]:
        """The part of the window that shows the drawing: left, top, right, bottom."""

    @property
    def tool(self) -> "Tool":
        """The active tool, which gets the events."""

    @property
    def idle_tool(self) -> "IdleTool":
        """The tool whose gesture a press starts."""

    def set_tool(self, tool: "Tool") -> None:
        """Make a state the active tool."""

    def return_to_idle(self) -> None:
        """Make `idle_tool` the active tool."""

    def request_pin_popup(self, kind: Literal["values", "menu"], pin: int) -> None:
        """Ask the window to open the values or the menu of a pin."""

    def pins_on_screen(self) -> dict[int, Point]:
        """Positions of the pins on the screen, by id."""

    def pin_at(self, position: Point) -> int | None:
        """The pin at a point of the screen."""

    def is_on_drawing(self, position: Point) -> bool:
        """Whether the drawing is under a point of the screen."""

    def reveal(self, position: Point) -> Point:
        """Pan until a point of the screen is inside the canvas; return where it is then."""


class Tool:
    """A state of the pointer: it handles events, which lead to other states, and says what to show.

    is_idle: whether no gesture is under way; is_keyboard_driven: whether keys move the pointer, and not the
    mouse; drags_pins: whether pins follow the pointer.
    """

    is_idle = False
    is_keyboard_driven = False
    drags_pins = False

    def __init__(self, context: ToolContext) -> None:
        self.context = context

    @property
    def session(self) -> Session:
        """The open session; a gesture exists only while there is one."""
        assert self.context.session is not None
        return self.context.session

    @property
    def can_finish(self) -> bool:
        """Whether there is something that `finish` keeps."""
        return not self.is_idle

    @property
    def hint(self) -> str:
        """What the user can do now, in one sentence."""
        return ""

    @property
    def cursor(self) -> Cursor:
        """The shape of the mouse pointer."""
        return "arrow"

    @property
    def markers(self) -> Markers:
        """What the tool shows over the drawing."""
        return Markers()

    @property
    def shown_stiffness(self) -> Floats | None:
        """(m,) stiffness of the faces that the canvas shows, None for none; by default the chosen tool's."""
        chosen = self.context.chosen_tool
        return None if chosen is self else chosen.shown_stiffness

    @property
    def shown_loose(self) -> LooseParts | None:
        """The loose parts that the canvas shows, None for none; by default the chosen tool's."""
        chosen = self.context.chosen_tool
        return None if chosen is self else chosen.shown_loose

    def press(self, event: PointerEvent) -> None:
        """Handle a button that went down."""

    def move(self, event: PointerEvent) -> None:
        """Handle a movement of the pointer, whether buttons are down or up."""

    def release(self, event: PointerEvent) -> None:
        """Handle a button that went up."""

    def key(self, event: KeyEvent) -> bool:
        """Handle a key that went down; return whether this state uses it."""
        return False

    def scroll(self, event: ScrollEvent) -> bool:
        """Handle a turn of the wheel; return whether this state uses it. Else it zooms."""
        return False

    def resize(self) -> None:
        """Handle a change of the canvas."""

    def reveal_pin(self, pin: int) -> None:
        """Bring a pin into view."""
        self.context.reveal(self.context.pins_on_screen()[pin])

    def finish(self) -> None:
        """Keep what the gesture has done, as a release of its button does."""
        for button in BUTTONS:
            if self.context.last_pointer is not None:
                self.context.tool.release(PointerEvent("release", self.context.last_pointer, button))

    def cancel(self) -> None:
        """Leave the gesture and restore everything from before the press."""
        self.context.return_to_idle()


class IdleTool(Tool):
    """The root state of a tool: no gesture is under way, and a press starts one."""

    is_idle = True

    def finish(self) -> None:
        """Do nothing: there is no gesture to finish."""

    @property
    def hint(self) -> str:
        if self.context.session is None:
            return tr("Open a picture or a drawing to begin")
        return self.press_hint

    @property
    def press_hint(self) -> str:
        """What a press does where the pointer is."""
        return ""

    @property
    def keyboard_hint(self) -> str:
        """What Enter does where the pointer is, while keys move it."""
        return tr("Arrows move the crosshair, Shift moves it farther, Esc ends")

    @property
    def hovered_pin(self) -> int | None:
        """The pin under the pointer."""
        pointer = self.context.pointer
        return None if pointer is None else self.context.pin_at(pointer)

    def cancel(self) -> None:
        """Do nothing: there is no gesture to cancel."""


class Pointing(Tool):
    """A button is down and has not moved yet: a release makes it a click, a movement a drag."""

    def __init__(self, context: ToolContext, event: PointerEvent) -> None:
        super().__init__(context)
        self.start, self.button = event.position, event.button

    def move(self, event: PointerEvent) -> None:
        if distance(event.position, self.start) >= DRAG_DISTANCE * self.context.ui_scale:
            self.drag(event)

    def release(self, event: PointerEvent) -> None:
        if event.button == self.button:
            self.click(event)

    def drag(self, event: PointerEvent) -> None:
        """Handle the start of a drag; by default it ends the gesture."""
        self.context.return_to_idle()

    def click(self, event: PointerEvent) -> None:
        """Handle a click."""


class PinGesture(Tool):
    """A drag that edits pins: a release of the left button commits it, `cancel` also restores the selection.

    selection_before: the selection before the press.
    """

    cursor: Cursor = "grab"

    def __init__(self, context: ToolContext, selection_before: frozenset[int]) -> None:
        super().__init__(context)
        self._selection_before = selection_before
        context.trails.clear()

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            self.session.commit()
            self.context.return_to_idle()

    def cancel(self) -> None:
        self.session.abort()
        self.context.trails.clear()
        self.context.select(self._selection_before)
        super().cancel()
