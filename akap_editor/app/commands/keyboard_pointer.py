"""Commands that replace the mouse on the canvas: point, select pins, open menus, pan."""

from collections.abc import Callable

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...editor.events import ARROWS
from ...words import mark
from ..app_state import AppState
from .command import CONTEXT_MENU_KEYS, CTRL, SHIFT, Command, Key, has_drawing
from .timeline import has_keyframes

_ARROW_KEYS = {"left": Key.left_arrow, "right": Key.right_arrow, "up": Key.up_arrow, "down": Key.down_arrow}
_PAN_STEP = 60.0  # design points


def _has_pins(state: AppState) -> bool:
    return state.document is not None and bool(state.document.state.pins)


def _toggle_crosshair(state: AppState) -> None:
    """Show or hide the crosshair; the canvas gets the keyboard focus, the status bar shows the hint."""
    state.notice = ""
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)
    state.editor.toggle_keyboard_pointer()


def _has_crosshair(state: AppState) -> bool:
    return state.editor.tool.is_keyboard_driven


def _has_one_selected_pin(state: AppState) -> bool:
    return len(state.editor.selection) == 1 and not _has_crosshair(state)


def _finish(state: AppState) -> None:
    """Keep what the gesture under way has done; without one, deselect the pins."""
    if state.editor.tool.can_finish:
        state.editor.finish()
    else:
        state.editor.select(())


def _can_finish(state: AppState) -> bool:
    return (state.editor.tool.can_finish or bool(state.editor.selection)) and not _has_crosshair(state)


def _open_context_menu(state: AppState) -> None:
    """Open the menu of the selected pin; if there is none, of the selected keyframe."""
    imgui.set_nav_cursor_visible(True)  # lets the arrow keys move through the menu
    if state.editor.selection:
        state.editor.request_pin_popup("menu", max(state.editor.selection))
    else:
        state.timeline.keyframe_menu_requested = True


def _has_context_menu(state: AppState) -> bool:
    return bool(state.editor.selection) or has_keyframes(state)


def _pan(x: int, y: int) -> Callable[[AppState], None]:
    """Moves the view over the drawing in a direction."""

    def pan(state: AppState) -> None:
        step = _PAN_STEP * state.editor.ui_scale
        state.editor.camera = state.editor.camera.panned(-step * x, -step * y)

    return pan


CROSSHAIR = Command(
    "Crosshair", _toggle_crosshair, (Key.c,), icons.ICON_FA_CROSSHAIRS, has_drawing, _has_crosshair
)
NEXT_PIN = Command("Next Pin", lambda state: state.editor.select_next(), (Key.j,), "", _has_pins)
PREVIOUS_PIN = Command(
    "Previous Pin", lambda state: state.editor.select_next(False), (SHIFT | Key.j,), "", _has_pins
)
PIN_VALUES = Command(
    "Pin Values...",
    lambda state: state.editor.request_pin_popup("values", *state.editor.selection),
    (Key.f2,),
    "",
    _has_one_selected_pin,
)
FINISH = Command("Finish", _finish, (Key.enter, Key.keypad_enter), "", _can_finish)
CONTEXT_MENU = Command("Context Menu", _open_context_menu, CONTEXT_MENU_KEYS, "", _has_context_menu)
_PAN_LABELS = {
    "left": mark("Pan Left"),
    "right": mark("Pan Right"),
    "up": mark("Pan Up"),
    "down": mark("Pan Down"),
}
PANNING = tuple(
    Command(_PAN_LABELS[name], _pan(x, y), (CTRL | _ARROW_KEYS[name],), "", has_drawing, repeats=True)
    for name, (x, y) in ARROWS.items()
)
