"""Draws the frame part by part, each at a side of the room that the ones before have left."""

from imgui_bundle import imgui

from ..app_state import AppState
from ..commands import menu_bar
from ..dialogs.first_steps import FirstSteps
from ..options import bar
from ..panels import side_panel
from ..timeline import panel as timeline_panel
from . import layout, status_bar, toolbar


def draw(state: AppState, scale: float) -> tuple[float, float, float, float]:
    """Draw the frame; return the canvas as (left, top, right, bottom) in points of the window.

    scale: points per design point.
    """
    menu_bar.draw(state)
    has_drawing = state.document is not None
    is_hidden = state.panels_are_hidden and has_drawing
    if has_drawing and layout.is_shown(state, "options"):
        bar.draw(state, scale)
    if not is_hidden:
        status_bar.draw(state, scale)
    timeline_panel.draw(state, scale, is_hidden)
    if has_drawing and layout.is_shown(state, "toolbar"):
        toolbar.draw(state, scale)
    if has_drawing and layout.is_shown(state, "side panel"):
        side_panel.draw(state, scale)
    if not is_hidden:
        state.part(FirstSteps).draw(state, scale)
    viewport = imgui.get_main_viewport()
    left, top = viewport.work_pos.x, viewport.work_pos.y
    canvas = left, top, left + viewport.work_size.x, top + viewport.work_size.y
    if has_drawing and not layout.is_shown(state, "options"):
        bar.draw_over_canvas(state, canvas, scale)
    return canvas
