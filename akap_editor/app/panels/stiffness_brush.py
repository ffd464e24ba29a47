"""The Stiffness Brush section: the options of the brush, while it is the current tool."""

from dataclasses import replace

from imgui_bundle import ImVec2, ImVec4, imgui

from ...deform.methods import get_method
from ...editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from ...editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS
from .. import widgets
from ..app_state import AppState
from ..commands.registry import CLEAR_STIFFNESS, ERASE
from ..theme import SECONDARY

_LABEL_WIDTH = 6.0  # times the font size


def is_shown(state: AppState) -> bool:
    """Whether a drawing is open and the brush is the current tool."""
    return state.document is not None and state.editor.chosen_tool is state.editor.brush_tool


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    assert state.document is not None
    brush = state.editor.brush_tool.brush
    limits = MIN_STIFFNESS, MAX_STIFFNESS
    factor = _slider("Strength", brush.factor, limits, "%.0f ×", "How many times stiffer painted areas are.")
    limits = MIN_RADIUS, MAX_RADIUS
    radius = _slider("Size", brush.radius, limits, "%.0f px", "Radius on the screen. Keys: [ and ]")
    state.editor.brush_tool.brush = replace(brush, factor=factor, radius=radius)
    if widgets.switch("Erase", brush.erasing, "Key: E, or drag with the right button")[0]:
        widgets.run(state, ERASE)
    if not get_method(state.document.state.settings.method).deformer.takes_stiffness:
        widgets.secondary_text("The current method ignores stiffness; it is kept for other methods.")
    imgui.begin_disabled(not CLEAR_STIFFNESS.enabled(state))
    if imgui.button(CLEAR_STIFFNESS.label, ImVec2(widgets.FULL, 0)):
        widgets.run(state, CLEAR_STIFFNESS)
    imgui.end_disabled()


def _slider(label: str, value: float, limits: tuple[float, float], text_format: str, tooltip: str) -> float:
    """Draw a label and a logarithmic slider; return its value."""
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*SECONDARY), label)
    widgets.show_tooltip(tooltip)
    imgui.same_line(_LABEL_WIDTH * imgui.get_font_size())
    return widgets.slider(f"##{label}", value, limits, text_format, imgui.SliderFlags_.logarithmic, tooltip)[
        1
    ]
