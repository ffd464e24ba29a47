"""The options of the stiffness brush, in the bar over the canvas while it is the current tool."""

from dataclasses import replace

from imgui_bundle import ImVec4, imgui

from ...deform.methods import get_method
from ...editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from ...editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS
from .. import widgets
from ..app_state import AppState
from ..commands.registry import CLEAR_STIFFNESS, ERASE
from ..theme import SECONDARY

_SLIDER_WIDTH, _LABEL_WIDTH = 13.0, 4.6  # times the font size


def is_shown(state: AppState) -> bool:
    """Whether a drawing is open and the brush is the current tool."""
    return state.document is not None and state.editor.chosen_tool is state.editor.brush_tool


def draw(state: AppState, is_wide: bool, scale: float) -> None:
    """Draw the options in one line, or in several on a narrow canvas. scale: points per design point."""
    assert state.document is not None
    _draw_options(state, is_wide, scale)
    if not get_method(state.document.state.settings.method).deformer.takes_stiffness:
        imgui.text_colored(ImVec4(*SECONDARY), "The current method ignores stiffness.")
        widgets.show_tooltip("It is kept for other methods.")


def _draw_options(state: AppState, is_wide: bool, scale: float) -> None:
    brush = state.editor.brush_tool.brush
    gap = 16 * scale
    limits = MIN_STIFFNESS, MAX_STIFFNESS
    factor = _slider("Strength", brush.factor, limits, "%.0f ×", "How many times stiffer painted areas are.")
    if is_wide:
        imgui.same_line(0, gap)
    limits = MIN_RADIUS, MAX_RADIUS
    radius = _slider("Size", brush.radius, limits, "%.0f px", "Radius on the screen. Keys: [ and ]")
    state.editor.brush_tool.brush = replace(brush, factor=factor, radius=radius)
    if is_wide:
        imgui.same_line(0, gap)
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
    if widgets.switch("Erase", brush.erasing, f"Key: {ERASE.key_name}, or drag with the right button")[0]:
        widgets.run(state, ERASE)
    imgui.same_line(0, gap)
    imgui.begin_disabled(not CLEAR_STIFFNESS.enabled(state))
    if is_wide:
        imgui.set_cursor_pos_y(imgui.get_style().window_padding.y)
    if imgui.button(CLEAR_STIFFNESS.label):
        widgets.run(state, CLEAR_STIFFNESS)
    imgui.end_disabled()


def _slider(label: str, value: float, limits: tuple[float, float], text_format: str, tooltip: str) -> float:
    """Draw a label and a logarithmic slider of a fixed width; return its value."""
    imgui.begin_group()
    imgui.align_text_to_frame_padding()
    start = imgui.get_cursor_pos_x()
    imgui.text_colored(ImVec4(*SECONDARY), label)
    widgets.show_tooltip(tooltip)
    imgui.same_line()
    imgui.set_cursor_pos_x(start + _LABEL_WIDTH * imgui.get_font_size())
    clamp = imgui.SliderFlags_.always_clamp | imgui.SliderFlags_.logarithmic
    imgui.set_next_item_width((_SLIDER_WIDTH - _LABEL_WIDTH) * imgui.get_font_size())
    imgui.push_style_color(imgui.Col_.slider_grab, ImVec4(1.0, 0.706, 0.227, 0.45))  # the number is over it
    _, value = imgui.slider_float(f"##{label}", value, *limits, text_format, clamp)
    imgui.pop_style_color()
    widgets.show_tooltip(tooltip)
    imgui.end_group()
    return float(value)
