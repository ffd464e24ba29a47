"""Which parts of the frame are shown, the tab and the width of the side panel; the preferences keep them."""

from typing import Literal, get_args

from ..app_state import AppState

Part = Literal["toolbar", "options", "side panel"]
Tab = Literal["Pose", "Animate", "Mesh"]

TABS: tuple[Tab, ...] = get_args(Tab)

MIN_WIDTH, DEFAULT_WIDTH, MAX_WIDTH = 236, 288, 560  # of the side panel, design points
MAX_SHARE = 0.45  # of the window's width
_HIDDEN, _WIDTH, _TAB = "hidden panels", "side panel width", "tab"  # names of preferences


def is_shown(state: AppState, part: Part) -> bool:
    """Whether a part is to be drawn over an open drawing."""
    return not state.panels_are_hidden and part not in _hidden(state)


def is_chosen(state: AppState, part: Part) -> bool:
    """Whether a part is shown unless all panels are hidden."""
    return part not in _hidden(state)


def toggle(state: AppState, part: Part) -> None:
    """Hide a part, or show it again; if all panels are hidden, they are shown."""
    hidden = _hidden(state)
    if part in hidden or not state.panels_are_hidden:
        state.preferences.put(_HIDDEN, sorted(hidden ^ {part}))
    state.panels_are_hidden = False


def _hidden(state: AppState) -> set[str]:
    names: list[object] = state.preferences.get(_HIDDEN, [])
    return {name for name in names if isinstance(name, str)}


def side_panel_width(state: AppState, scale: float, room: float) -> float:
    """The width of the side panel in points; the canvas keeps its share of ``room``, the window's width."""
    width: float = state.preferences.get(_WIDTH, float(DEFAULT_WIDTH))
    return min(_clamped(width) * scale, max(MAX_SHARE * room, MIN_WIDTH * scale))


def resize_side_panel(state: AppState, width: float, scale: float) -> None:
    """Set the width of the side panel, points, within its limits."""
    state.preferences.put(_WIDTH, round(_clamped(width / scale), 1))


def reset_side_panel_width(state: AppState) -> None:
    """Give the side panel the width that it has for a new user."""
    state.preferences.put(_WIDTH, float(DEFAULT_WIDTH))


def _clamped(width: float) -> float:
    return max(MIN_WIDTH, min(MAX_WIDTH, width))  # NaN becomes the largest


def current_tab(state: AppState) -> Tab:
    """The tab of the side panel that is shown, by default the first one."""
    name = state.preferences.get(_TAB, "")
    return next((tab for tab in TABS if tab == name), TABS[0])


def show_tab(state: AppState, tab: Tab) -> None:
    """Show a tab, and the side panel if it is hidden."""
    state.preferences.put(_TAB, tab)
    if not is_shown(state, "side panel"):
        toggle(state, "side panel")
