"""The Pins section: a list of the pins, which selects them."""

from imgui_bundle import ImVec2, ImVec4, imgui

from .. import widgets
from ..app_state import AppState
from ..commands.registry import REMOVE_SELECTED
from ..theme import SECONDARY

_ROWS = 6  # pins that are visible at once


def pin_count(state: AppState) -> str:
    """The number of pins for the section's title; empty if there are none."""
    count = len(state.document.state.pins) if state.document is not None else 0
    return str(count or "")


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    assert state.document is not None
    pins, editor = state.document.state.pins, state.editor
    if not pins:
        widgets.secondary_text("None yet. Click on the drawing where it should hold still.")
        return
    widgets.begin_list("##pins", len(pins), _ROWS)
    for index, pin in enumerate(pins):
        if imgui.selectable(f"  Pin {pin.id}##pin", pin.id in editor.selection)[0]:
            extends = imgui.get_io().key_shift
            editor.select(editor.selection ^ {pin.id} if extends else {pin.id})
        if editor.selection == {pin.id}:
            widgets.scroll_to_row(index, _ROWS)
        target = f"{pin.target[0]:.0f}, {pin.target[1]:.0f}"
        imgui.same_line(imgui.get_content_region_avail().x - imgui.calc_text_size(target).x - 6 * scale)
        imgui.text_colored(ImVec4(*SECONDARY), target)
    imgui.end_child()
    imgui.begin_disabled(not editor.selection)
    if imgui.button("Remove Selected", ImVec2(widgets.FULL, 0)):
        widgets.run(state, REMOVE_SELECTED)
    imgui.end_disabled()
