"""The dialog for an error that the user must read before going on."""

from imgui_bundle import imgui

from ...words import tr
from .. import widgets
from ..app_state import AppState

_WIDTH = 420  # design points


def draw(state: AppState, scale: float) -> None:
    """Draw one frame of the dialog for `AppState.error`. scale: points per design point."""
    if widgets.begin_dialog("Error"):
        widgets.paragraph(state.error, _WIDTH * scale)
        imgui.spacing()
        if (
            widgets.button(tr("OK"), primary=True)
            or widgets.cancel_pressed()
            or (widgets.confirm_pressed() and not imgui.is_window_appearing())
        ):
            state.error = ""
            widgets.close_popup()
        imgui.end_popup()
