"""What a mouse does on the canvas, by keys: point, go from pin to pin, ask for menus, look around."""

from collections.abc import Callable

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...editor.events import ARROWS
from ..app_state import AppState
from . import keying
from .command import CTRL, MENU_KEYS, SHIFT, Command, Key, has_drawing

_ARROWS = {"left": Key.left_arrow, "right": Key.right_arrow, "up": Key.up_arrow, "down": Key.down_arrow}
_PAN = 60.0  # points of the design by which the canvas moves


def _has_pins(state: AppState) -> bool:
    return state.document is not None and bool(state.document.state.pins)


def _point(state: AppState) -> None:
    """Keys belong to the canvas then, and the status bar says what they do."""
    state.notice = ""
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)
    state.editor.toggle_keyboard_pointer()


def _points(state: AppState) -> bool:
    return state.editor.tool.is_keyboard_driven


def _one_pin(state: AppState) -> bool:
    return len(state.editor.selection) == 1 and not _points(state)


def _menu(state: AppState) -> None:
    """Of the pin that was selected, or of a keyframe."""
    imgui.set_nav_cursor_visible(True)  # so that arrows walk through it
    if state.editor.selection:
        state.editor.request_pin_popup("menu", max(state.editor.selection))
    else:
        state.timeline.keyframe_menu_requested = True


def _can_ask(state: AppState) -> bool:
    return bool(state.editor.selection) or keying.shown(state)


def _look(x: int, y: int) -> Callable[[AppState], None]:
    """Shows what is farther that way, as if one looked there."""

    def look(state: AppState) -> None:
        way = _PAN * state.editor.ui_scale
        state.editor.camera = state.editor.camera.panned(-way * x, -way * y)

    return look


CROSSHAIR = Command("Crosshair", _point, (Key.c,), icons.ICON_FA_CROSSHAIRS, has_drawing, _points)
NEXT_PIN = Command("Next Pin", lambda state: state.editor.select_next(), (Key.j,), "", _has_pins)
PREVIOUS_PIN = Command(
    "Previous Pin", lambda state: state.editor.select_next(False), (SHIFT | Key.j,), "", _has_pins
)
PIN_VALUES = Command(
    "Pin Values...",
    lambda state: state.editor.request_pin_popup("values", *state.editor.selection),
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
