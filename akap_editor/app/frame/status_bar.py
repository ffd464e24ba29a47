"""The status bar below everything: a notice or the hint of the tool, and the zoom."""

from imgui_bundle import ImVec2, ImVec4, imgui

from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..theme import ACCENT, SECONDARY, TEXT


def draw(state: AppState, scale: float) -> None:
    """Draw the bar. scale: points per design point."""
    height = imgui.get_frame_height() + 2 * scale
    if widgets.side_bar("Status", imgui.Dir.down, height, ImVec2(14 * scale, 1 * scale)):
        imgui.align_text_to_frame_padding()
        zoom = f"{state.editor.camera.zoom * 100:.0f} %" if state.document is not None else ""
        zoom_left = imgui.get_window_width() - imgui.calc_text_size(zoom).x - 16 * scale
        text = state.notice or (f"{state.task.title} ..." if state.task is not None else state.editor.hint)
        button = state.notice_button
        if button is not None and button.notice != state.notice:
            button = None
        label = "" if button is None else f"{button.icon}  {tr(button.label)}"
        room = zoom_left - 30 * scale - (imgui.calc_text_size(label).x + 30 * scale if label else 0)
        shortened = widgets.shortened(text, room)
        imgui.text_colored(ImVec4(*(ACCENT if state.notice else TEXT)), shortened)
        widgets.show_tooltip(text if shortened != text else "")
        if button is not None:
            imgui.same_line(0, imgui.get_font_size())
            if imgui.small_button(f"{label}###{button.label}"):
                state.run_reporting_errors(button.run)
        if zoom:
            imgui.same_line(zoom_left)
            imgui.text_colored(ImVec4(*SECONDARY), zoom)
    imgui.end()
