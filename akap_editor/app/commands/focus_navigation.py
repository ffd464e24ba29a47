"""Keys that lead from the canvas to the panels around it, and from one of these to the next."""

from imgui_bundle import imgui

from ..app_state import AppState

_PANES = (
    "Start",
    "Panel",
    "Tools",
    "Timeline",
    "Comparison",
    "##legend",
    "First steps",
)  # windows, as F6 goes


def give_keys_to_panels(state: AppState) -> None:
    """With Tab to the side panel or the start page, with Shift+Tab to the tools; before these are drawn.

    F6 goes on to the next pane, and in the end back to the canvas; Shift+F6 the other way.
    """
    context, io = imgui.get_current_context(), imgui.get_io()
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup) or io.key_ctrl or io.key_alt:
        return
    here = context.nav_window.name if context.nav_window is not None and io.nav_visible else ""
    if imgui.is_key_pressed(imgui.Key.f6, False):
        stops = ["", *(name for name in _PANES if _is_shown(name))]
        at = stops.index(here) if here in stops else 0
        _enter(stops[(at + (-1 if io.key_shift else 1)) % len(stops)])
    elif not (io.want_text_input or io.nav_visible) and imgui.is_key_pressed(imgui.Key.tab, False):
        _enter("Start" if state.document is None else "Tools" if io.key_shift else "Panel")


def _is_shown(name: str) -> bool:
    window = imgui.internal.find_window_by_name(name)
    return window is not None and window.was_active and not window.flags & imgui.WindowFlags_.no_nav_inputs


def _enter(name: str) -> None:
    """Give the keys to a window, or without a name to the canvas."""
    window = imgui.internal.find_window_by_name(name) if name else None
    if window is None:
        imgui.set_window_focus(None)
        imgui.set_nav_cursor_visible(False)
        return
    imgui.internal.focus_window(window)
    imgui.internal.nav_init_window(window, True)
    imgui.set_nav_cursor_visible(True)
