"""What the options bar offers while pins are suggested: to add them, or to cancel."""

from collections.abc import Sequence

from imgui_bundle import imgui

from ...editor.tools.suggested_pins import SuggestedPins
from ...words import tr, tr_plural
from .. import widgets
from ..app_state import AppState
from .items import Item, text


def is_shown(state: AppState) -> bool:
    """Whether pins are suggested."""
    return isinstance(state.editor.tool, SuggestedPins)


def items(state: AppState) -> Sequence[Item]:
    """Two buttons, and what can be done with the suggestions."""
    return (
        Item("buttons", _draw_buttons),
        text("hint", tr("Drag to move, Alt-click to remove")),
    )


def _draw_buttons(state: AppState) -> None:
    tool = state.editor.tool
    assert isinstance(tool, SuggestedPins)
    count = len(tool.ghosts)
    imgui.align_text_to_frame_padding()
    imgui.text(tr_plural("{count} pin suggested", "{count} pins suggested", count))
    imgui.same_line(0, imgui.get_font_size())
    imgui.begin_disabled(count == 0)
    if widgets.button(tr("Add Pins") + "###Add Pins", primary=True):
        state.run_reporting_errors(state.editor.finish)
    imgui.end_disabled()
    widgets.show_tooltip(tr("Key: {key}", key="Enter"))
    imgui.same_line()
    if imgui.button(tr("Cancel") + "###Cancel"):
        state.editor.return_to_idle()
    widgets.show_tooltip(tr("Key: {key}", key="Esc"))
