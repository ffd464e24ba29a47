"""Keys that move the keyboard focus from the canvas to the panels and from panel to panel."""

from imgui_bundle import imgui

from ..app_state import AppState

_CANVAS = ""
_PANELS = (
    "Start",
    "Panel",
    "Tools",
    "Timeline",
    "Comparison",
    "##legend",
    "First steps",
    "Options",
    "Tabs",
)  # names of ImGui windows, in the order of F6


def handle_focus_keys(state: AppState) -> None:
    """Move the focus if one of the keys was pressed; to be called before the panels are drawn.

    F6 and Shift+F6: to the next and the previous panel, the canvas among them; Tab: to the start page. Over a
    drawing, Tab hides the panels.
    """
    context, io = imgui.get_current_context(), imgui.get_io()
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup) or io.key_ctrl or io.key_alt:
        return
    if imgui.is_key_pressed(imgui.Key.f6, False):
        has_focus = context.nav_window is not None and io.nav_visible
        focused = context.nav_window.name if has_focus else _CANVAS
        stops = [_CANVAS, *(name for name in _PANELS if _can_be_focused(name))]
        index = stops.index(focused) if focused in stops else 0
        _focus(stops[(index + (-1 if io.key_shift else 1)) % len(stops)])
    elif state.document is not None or io.want_text_input or io.nav_visible:
        return
    elif imgui.is_key_pressed(imgui.Key.tab, False):
        _focus("Start")


def _can_be_focused(name: str) -> bool:
    window = imgui.internal.find_window_by_name(name)
    return window is not None and window.was_active and not window.flags & imgui.WindowFlags_.no_nav_inputs


def _focus(name: str) -> None:
    """Give the keyboard focus to a window, or to the canvas if there is no such window."""
    window = imgui.internal.find_window_by_name(name) if name else None
    if window is None:
        imgui.set_window_focus(None)
        imgui.set_nav_cursor_visible(False)
        return
    imgui.internal.focus_window(window)
    imgui.internal.nav_init_window(window, True)
    imgui.set_nav_cursor_visible(True)
