"""What the bar offers while pins are suggested: to add them, or to cancel."""

from imgui_bundle import ImVec4, imgui

from ...editor.tools.suggested_pins import SuggestedPins
from .. import widgets
from ..app_state import AppState
from ..theme import SECONDARY


def is_shown(state: AppState) -> bool:
    """Whether pins are suggested."""
    return isinstance(state.editor.tool, SuggestedPins)


def draw(state: AppState, is_wide: bool, scale: float) -> None:
    """Draw the number of suggestions, what can be done with them, and two buttons."""
    tool = state.editor.tool
    assert isinstance(tool, SuggestedPins)
    count = len(tool.positions)
    imgui.align_text_to_frame_padding()
    imgui.text(f"{count} pins suggested" if count != 1 else "1 pin suggested")
    imgui.same_line(0, 16 * scale)
    imgui.text_colored(ImVec4(*SECONDARY), "Drag to move, Alt-click to remove")
    if is_wide:
        imgui.same_line(0, 16 * scale)
    imgui.begin_disabled(count == 0)
    if widgets.button("Add Pins", primary=True):
        state.run_reporting_errors(state.editor.finish)
    imgui.end_disabled()
    widgets.show_tooltip("Key: Enter")
    imgui.same_line()
    if imgui.button("Cancel"):
        state.editor.return_to_idle()
    widgets.show_tooltip("Key: Esc")
