"""The status bar below everything: a notice or the hint of the tool, and the zoom."""

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..jobs.file_manager import show_in_folder
from ..theme import ACCENT, SECONDARY, TEXT


def draw(state: AppState, scale: float) -> None:
    """Draw the bar. scale: points per design point."""
    height = imgui.get_frame_height() + 2 * scale
    if widgets.side_bar("Status", imgui.Dir.down, height, ImVec2(14 * scale, 1 * scale)):
        imgui.align_text_to_frame_padding()
        zoom = f"{state.editor.camera.zoom * 100:.0f} %" if state.document is not None else ""
        zoom_left = imgui.get_window_width() - imgui.calc_text_size(zoom).x - 16 * scale
        text = state.notice or (f"{state.task.title} ..." if state.task is not None else state.editor.hint)
        shortened = widgets.shortened(text, zoom_left - (30 if state.exported is None else 180) * scale)
        imgui.text_colored(ImVec4(*(ACCENT if state.notice else TEXT)), shortened)
        widgets.show_tooltip(text if shortened != text else "")
        _draw_show_in_folder(state)
        if zoom:
            imgui.same_line(zoom_left)
            imgui.text_colored(ImVec4(*SECONDARY), zoom)
    imgui.end()


def _draw_show_in_folder(state: AppState) -> None:
    """Draw a button beside a notice that a file was exported."""
    if state.exported is None or state.notice != state.exported[0]:
        return
    path = state.exported[1]
    imgui.same_line(0, imgui.get_font_size())
    if imgui.small_button(f"{icons.ICON_FA_FOLDER_OPEN}  {tr('Show in Folder')}###show in folder"):
        state.run_reporting_errors(lambda: show_in_folder(path))
