"""The History section: the list of undo steps.

Their labels are English, as recordings hold them, and are translated here.
"""

import re
from functools import cache

from imgui_bundle import ImVec4, imgui

from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..theme import SECONDARY
from . import parts

_ROWS = 6  # steps that are visible at once
_FIRST = mark("Open")  # the state before the first step
# Labels with a number or a name in them
_TEMPLATES = (
    mark("Remove {count} Pins"),
    mark("Drag {count} Pins"),
    mark("Nudge {count} Pins"),
    mark("Delete {count} Keyframes"),
    mark("Duplicate {count} Keyframes"),
    mark("Reverse {count} Keyframes"),
    mark("Move {count} Keyframes"),
    mark("Apply {name}"),
    mark("Rename {name}"),
)
_SINGLE = (  # made of a verb and a noun
    mark("Delete Keyframe"),
    mark("Duplicate Keyframe"),
    mark("Reverse Keyframe"),
    mark("Move Keyframe"),
)


def step_count(state: AppState) -> str:
    """The number of steps that can be undone, for the section's title; empty if there are none."""
    session = state.editor.session
    return str(session.history.depth or "") if session is not None else ""


def draw(state: AppState, scale: float) -> None:
    """Draw the steps, the oldest first, undone ones faint; a click goes to a step."""
    session = state.editor.session
    assert session is not None
    depth, labels = session.history.depth, [_FIRST, *session.history.labels]
    parts.begin_list("##history", _ROWS)
    for index, label in enumerate(labels):
        is_undone = index > depth
        if is_undone:
            imgui.push_style_color(imgui.Col_.text, ImVec4(*SECONDARY))
        if imgui.selectable(f"{widgets.as_label(shown_label(label))}##step {index}", index == depth)[0]:
            state.notice = ""
            state.run_reporting_errors(lambda index=index: state.editor.undo_or_redo_to(index))  # type: ignore[misc]
        if is_undone:
            imgui.pop_style_color()
        if index == depth:
            parts.scroll_to_row(index, _ROWS)
    parts.end_list()


def shown_label(label: str) -> str:
    """A label of the history, which is English, as it is shown."""
    found = tr(label)
    if found != label:
        return found
    for template in _TEMPLATES:
        match = _pattern(template).fullmatch(label)
        if match is not None:
            return tr(template, **match.groupdict())
    return label


@cache
def _pattern(template: str) -> re.Pattern[str]:
    """What matches the labels of a template, with a group for its field."""
    before, name, after = re.split(r"[{}]", template)
    values = r"\d+" if name == "count" else ".+"
    return re.compile(f"{re.escape(before)}(?P<{name}>{values}){re.escape(after)}")
