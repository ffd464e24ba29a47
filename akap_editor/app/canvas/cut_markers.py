"""Draws the strokes of the knife over the drawing."""

from collections.abc import Sequence

from imgui_bundle import ImVec2, imgui

from ...editor.camera import Point
from ...editor.tools.knife import cuts_on_screen
from ..app_state import AppState
from ..theme import ACCENT, DARK, packed

_COLOR = (1.0, 0.35, 0.35, 1.0)


def draw_cuts(state: AppState, scale: float) -> None:
    """Draw all strokes while the knife is chosen, or one that the list points at, and the one under way."""
    editor = state.editor
    knife = editor.knife_tool
    is_chosen = editor.chosen_tool is knife
    if editor.session is None or not (is_chosen or knife.highlighted is not None):
        return
    draw, markers = imgui.get_background_draw_list(), editor.tool.markers
    hovered = markers.hovered_cut if is_chosen else knife.highlighted
    draw.push_clip_rect(ImVec2(*editor.canvas[:2]), ImVec2(*editor.canvas[2:]))
    for index, lips in enumerate(cuts_on_screen(editor)):
        for lip in lips if is_chosen or index == hovered else ():
            _draw_line(draw, lip, scale, index == hovered)
    if markers.cut_stroke:
        _draw_line(draw, markers.cut_stroke, scale, True)
    draw.pop_clip_rect()


def _draw_line(draw: imgui.ImDrawList, line: Sequence[Point], scale: float, is_hovered: bool) -> None:
    color = packed(ACCENT if is_hovered else _COLOR)
    for stroke, width in ((packed(DARK, 0.6), 4.0), (color, 1.8)):
        for point in line:
            draw.path_line_to(ImVec2(*point))
        draw.path_stroke(stroke, width * scale)
