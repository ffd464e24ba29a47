"""The list of steps, to click through."""

from imgui_bundle import ImVec4, imgui

from .. import widgets
from ..app_state import AppState
from ..theme import QUIET

_ROWS = 6  # that are seen at once
_START = "As opened"


def draw(state: AppState, scale: float) -> None:
    """The steps, the oldest first; a click goes there. What is undone is quiet."""
    session = state.editor.session
    assert session is not None
    depth, names = session.history.depth, [_START, *session.history.labels]
    widgets.begin_list("##history", len(names), _ROWS)
    for index, name in enumerate(names):
        if index > depth:
            imgui.push_style_color(imgui.Col_.text, ImVec4(*QUIET))
        if imgui.selectable(f"  {name}##step {index}", index == depth)[0]:
            state.notice = ""
            state.run_reporting_errors(lambda index=index: state.editor.undo_or_redo_to(index))  # type: ignore[misc]
        if index > depth:
            imgui.pop_style_color()
        if index == depth:
            widgets.scroll_to_row(index, _ROWS)
    imgui.end_child()


def step_count(state: AppState) -> str:
    """How many steps there are to go back, in digits; nothing where there are none."""
    return str((state.editor.session.history.depth if state.editor.session is not None else 0) or "")
