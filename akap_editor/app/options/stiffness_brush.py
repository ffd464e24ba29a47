"""The options of the stiffness brush, in the options bar while it is the current tool."""

from collections.abc import Sequence
from dataclasses import replace

from imgui_bundle import ImVec4, imgui

from ...deform.methods import get_method
from ...editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from ...editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS
from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..commands.registry import CLEAR_STIFFNESS, ERASE
from ..theme import ACCENT
from .items import Item, command_button, draw_label, text

_SLIDER_WIDTH = 8.4  # times the font size


def is_shown(state: AppState) -> bool:
    """Whether a drawing is open and the brush is the current tool."""
    return state.document is not None and state.editor.chosen_tool is state.editor.brush_tool


def items(state: AppState) -> Sequence[Item]:
    """Strength, size, eraser, and what removes all stiffness."""
    assert state.document is not None
    listed = [Item("strength", _draw_strength), Item("size", _draw_size), Item("erase", _draw_erase)]
    listed.append(command_button(CLEAR_STIFFNESS))
    if not get_method(state.document.state.settings.method).deformer.takes_stiffness:
        listed.insert(0, text("ignored", tr("The current method ignores stiffness.")))
    return listed


def _draw_strength(state: AppState) -> None:
    brush, limits = state.editor.brush_tool.brush, (MIN_STIFFNESS, MAX_STIFFNESS)
    tooltip = tr("How many times stiffer painted areas are.")
    factor = _slider(mark("Strength"), brush.factor, limits, "%.0f ×", tooltip)
    state.editor.brush_tool.brush = replace(brush, factor=factor)


def _draw_size(state: AppState) -> None:
    brush, limits = state.editor.brush_tool.brush, (MIN_RADIUS, MAX_RADIUS)
    radius = _slider(mark("Size"), brush.radius, limits, "%.0f px", tr("Radius on the screen. Keys: [ and ]"))
    state.editor.brush_tool.brush = replace(brush, radius=radius)


def _draw_erase(state: AppState) -> None:
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
    tooltip = tr("Key: {key}, or drag with the right button", key=ERASE.key_name)
    if widgets.switch(tr("Erase") + "###Erase", state.editor.brush_tool.brush.erasing, tooltip)[0]:
        widgets.run(state, ERASE)


def _slider(label: str, value: float, limits: tuple[float, float], text_format: str, tooltip: str) -> float:
    """Draw a label (English) and a logarithmic slider of a fixed width; return its value."""
    draw_label(tr(label), tooltip)
    clamp = imgui.SliderFlags_.always_clamp | imgui.SliderFlags_.logarithmic
    imgui.set_next_item_width(_SLIDER_WIDTH * imgui.get_font_size())
    imgui.push_style_color(imgui.Col_.slider_grab, ImVec4(*ACCENT[:3], 0.45))  # the number is over it
    _, value = imgui.slider_float(f"##{label}", value, *limits, text_format, clamp)
    imgui.pop_style_color()
    widgets.show_tooltip(tooltip)
    return float(value)
