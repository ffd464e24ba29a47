"""What a mouse does on the canvas, by keys: point, go from pin to pin, ask for menus, look around."""

from collections.abc import Callable

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...editor.events import ARROWS
from ...editor.tools.keyboard_pointer import Crosshair, select_next, toggle_crosshair
from ..app_state import Workspace
from . import keying
from .command import CTRL, MENU_KEYS, SHIFT, Command, Key, has_drawing

_ARROWS = {"left": Key.left_arrow, "right": Key.right_arrow, "up": Key.up_arrow, "down": Key.down_arrow}
_PAN = 60.0  # points of the design by which the canvas moves


def _has_pins(space: Workspace) -> bool:
    return space.document is not None and bool(space.document.state.pins)


def _point(space: Workspace) -> None:
    """Keys belong to the canvas then, and the status bar says what they do."""
    space.notice = ""
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)
    toggle_crosshair(space.editor)


def _points(space: Workspace) -> bool:
    return isinstance(space.editor.tool, Crosshair)


def _one_pin(space: Workspace) -> bool:
    return len(space.editor.selection) == 1 and not _points(space)


def _menu(space: Workspace) -> None:
    """Of the pin that was selected, or of a keyframe."""
    imgui.set_nav_cursor_visible(True)  # so that arrows walk through it
    if space.editor.selection:
        space.editor.ask("menu", max(space.editor.selection))
    else:
        space.key_menu = True


def _can_ask(space: Workspace) -> bool:
    return bool(space.editor.selection) or keying.shown(space)


def _look(x: int, y: int) -> Callable[[Workspace], None]:
    """Shows what is farther that way, as if one looked there."""

    def look(space: Workspace) -> None:
        way = _PAN * space.editor.ui_scale
        space.editor.camera = space.editor.camera.panned(-way * x, -way * y)

    return look


CROSSHAIR = Command("Crosshair", _point, (Key.c,), icons.ICON_FA_CROSSHAIRS, has_drawing, _points)
NEXT_PIN = Command("Next Pin", lambda space: select_next(space.editor), (Key.j,), "", _has_pins)
PREVIOUS_PIN = Command(
    "Previous Pin", lambda space: select_next(space.editor, False), (SHIFT | Key.j,), "", _has_pins
)
PIN_VALUES = Command(
    "Pin Values...",
    lambda space: space.editor.ask("values", *space.editor.selection),
    (Key.enter, Key.keypad_enter),
    "",
    _one_pin,
)
MENU_HERE = Command("Menu of Pin or Keyframe", _menu, MENU_KEYS, "", _can_ask)
PANNING = tuple(
    Command(
        f"Look {name.capitalize()}",
        _look(*way),
        (CTRL | _ARROWS[name],),
        "",
        has_drawing,
        repeats=True,
    )
    for name, way in ARROWS.items()
)
