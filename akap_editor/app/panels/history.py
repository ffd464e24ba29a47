"""The History section: the list of undo steps."""

from imgui_bundle import ImVec4, imgui

from ...words import mark
from .. import widgets
from ..app_state import AppState
from ..history_labels import shown_label
from ..theme import SECONDARY

_ROWS = 6  # steps that are visible at once
_FIRST = mark("Open")  # the state before the first step


def step_count(state: AppState) -> str:
    """The number of steps that can be undone, for the section's title; empty if there are none."""
    session = state.editor.session
    return str(session.history.depth or "") if session is not None else ""


def draw(state: AppState, scale: float) -> None:
    """Draw the steps, the oldest first, undone ones faint; a click goes to a step."""
    session = state.editor.session
    assert session is not None
    depth, labels = session.history.depth, [_FIRST, *session.history.labels]
    widgets.begin_list("##history", _ROWS)
    for index, label in enumerate(labels):
        is_undone = index > depth
        if is_undone:
            imgui.push_style_color(imgui.Col_.text, ImVec4(*SECONDARY))
        if imgui.selectable(f"  {widgets.as_label(shown_label(label))}##step {index}", index == depth)[0]:
            state.notice = ""
            state.run_reporting_errors(lambda index=index: state.editor.undo_or_redo_to(index))  # type: ignore[misc]
        if is_undone:
            imgui.pop_style_color()
        if index == depth:
            widgets.scroll_to_row(index, _ROWS)
    imgui.end_child()
