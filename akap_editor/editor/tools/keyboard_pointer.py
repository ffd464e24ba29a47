"""The pointer moved by keys: all that a click does, without a mouse."""

from typing import TYPE_CHECKING

from ..camera import Point
from ..events import ARROWS, KeyEvent, PointerEvent
from .pins import Idle

if TYPE_CHECKING:
    from ..editor import Editor

STEP, BIG_STEP = 4.0, 40.0  # points of the screen that an arrow key moves it by
MARGIN = 32.0  # points of the screen to the edge of the canvas
_LEAVES = "arrows move on, Esc ends"


class KeyboardPointer(Idle):
    """Nothing is pressed, and keys move the pointer; it begins where the mouse was last, or in the middle."""

    def __init__(self, editor: "Editor") -> None:
        super().__init__(editor)
        left, top, right, bottom = editor.canvas
        x, y = editor.last_pointer or (left, top)
        seen = left < x < right and top < y < bottom
        self._put((x, y) if seen else ((left + right) / 2, (top + bottom) / 2))

    @property
    def hint(self) -> str:  # type: ignore[override]
        """What Enter would do here."""
        editor = self.editor
        if editor.chosen_tool == "brush":
            does = "erases" if editor.brush.erasing else "stiffens"
            return f"Enter {does} what is in the circle, [ and ] change its size, {_LEAVES}"
        if editor.hovered_pin is not None:
            if "alt" in editor.held:
                return "Enter removes this pin"
            if "shift" in editor.held:
                return "Enter selects this pin too, or takes it out of the selection"
            return f"Enter selects this pin, with Shift this one too, with Alt it removes it; {_LEAVES}"
        if editor.would_add_pin:
            return f"Enter adds a pin; {_LEAVES}"
        return "Arrows move the crosshair, with Shift farther; Enter adds a pin on the drawing, Esc ends"

    def key(self, event: KeyEvent) -> bool:
        """Arrows move, Enter clicks, Escape ends."""
        if event.key in ARROWS:
            size = (BIG_STEP if event.shift else STEP) * self.editor.ui_scale
            dx, dy = ARROWS[event.key]
            self._move(size * dx, size * dy)
        elif event.key == "enter":
            self._click()
        elif event.key == "escape":
            self.editor.return_to_idle()
        else:
            return False
        return True

    def move(self, event: PointerEvent) -> None:
        """The mouse is used again."""
        self.editor.return_to_idle()

    def resized(self) -> None:
        """Another part of the window is the canvas."""
        left, top, right, bottom = self.editor.canvas
        x, y = self.place
        self._put((min(max(x, left), right), min(max(y, top), bottom)))

    @property
    def place(self) -> Point:
        """Where it is on the screen."""
        assert self.editor.pointer is not None
        return self.editor.pointer

    def _put(self, place: Point) -> None:
        self.editor.pointer = self.editor.last_pointer = place

    def _move(self, dx: float, dy: float) -> None:
        """Move on over the drawing; near the edge of the canvas it is that which moves."""
        editor, (x, y) = self.editor, self.place
        left, top, right, bottom = editor.canvas
        rim = MARGIN * editor.ui_scale
        pans_x = x + dx < left + rim if dx < 0 else x + dx > right - rim and dx > 0
        pans_y = y + dy < top + rim if dy < 0 else y + dy > bottom - rim and dy > 0
        editor.camera = editor.camera.panned(-dx * pans_x, -dy * pans_y)
        self._put((x + dx * (not pans_x), y + dy * (not pans_y)))

    def go_to_pin(self, pin: int) -> None:
        """Move onto a pin."""
        self._put(reveal(self.editor, self.editor.pins_on_screen()[pin]))

    def _click(self) -> None:
        editor, place = self.editor, self.place
        shift, alt = "shift" in editor.held, "alt" in editor.held
        editor.handle_event(PointerEvent("press", place, shift=shift, alt=alt))
        editor.handle_event(PointerEvent("release", place, shift=shift, alt=alt))
        editor.set_tool(self)


def reveal(editor: "Editor", place: Point) -> Point:
    """Move the canvas until a point of the screen is well in sight; where it is then."""
    left, top, right, bottom = editor.canvas
    ways = []
    for at, low, high in ((place[0], left, right), (place[1], top, bottom)):
        rim = min(MARGIN * editor.ui_scale, (high - low) / 2)
        ways.append(max(low + rim - at, 0.0) + min(high - rim - at, 0.0))
    if any(ways):
        editor.camera = editor.camera.panned(ways[0], ways[1])
    return place[0] + ways[0], place[1] + ways[1]


def toggle_keyboard_pointer(editor: "Editor") -> None:
    """Begin to move the pointer by keys, or end it; the hand is laid aside, as it has nothing to click."""
    if isinstance(editor.tool, KeyboardPointer):
        editor.return_to_idle()
    elif editor.session is not None and not editor.busy:
        if editor.chosen_tool == "hand":
            editor.chosen_tool = "pins"
        editor.set_tool(KeyboardPointer(editor))


def select_next(editor: "Editor", forward: bool = True) -> None:
    """Select the pin after the selected ones, or before them; after the last one comes the first."""
    if editor.session is None or not editor.session.state.pins:
        return
    ids = [pin.id for pin in editor.session.state.pins]
    chosen = [number for number, pin in enumerate(ids) if pin in editor.selection]
    at = max(chosen, default=-1) + 1 if forward else min(chosen, default=0) - 1
    pin = ids[at % len(ids)]
    editor.select({pin})
    if isinstance(editor.tool, KeyboardPointer):
        editor.tool.go_to_pin(pin)
    else:
        reveal(editor, editor.pins_on_screen()[pin])
