"""The options of the stiffness brush, in the side panel while it is at hand."""

from dataclasses import replace

from imgui_bundle import ImVec2, ImVec4, imgui

from ...deform.methods import get_method
from ...editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from ...editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS
from .. import widgets
from ..app_state import AppState
from ..commands import registry as commands
from ..theme import QUIET

_LABELS = 6.0  # times the font's size: width of the labels


def is_at_hand(state: AppState) -> bool:
    """Whether there is something to paint on, and the brush to do it."""
    return state.document is not None and state.editor.chosen_tool is state.editor.brush_tool


def draw(state: AppState, scale: float) -> None:
    """Strength, size, eraser."""
    assert state.document is not None
    brush = state.editor.brush_tool.brush
    factor = _slider(
        "Strength", brush.factor, (MIN_STIFFNESS, MAX_STIFFNESS), "%.0f ×", "How much less a part bends."
    )
    radius = _slider(
        "Size", brush.radius, (MIN_RADIUS, MAX_RADIUS), "%.0f px", "Radius on the screen: [ and ]."
    )
    state.editor.brush_tool.brush = replace(brush, factor=factor, radius=radius)
    if widgets.switch("Erase", brush.erasing, "E, or drag with the right button.")[0]:
        widgets.run(state, commands.ERASE)
    if not get_method(state.document.state.settings.method).deformer.takes_stiffness:
        widgets.secondary_text(
            "The method chosen under Bending bends all parts alike; stiffness is kept for others."
        )
    imgui.begin_disabled(not commands.SOFTEN_ALL.enabled(state))
    if imgui.button(commands.SOFTEN_ALL.label.capitalize(), ImVec2(widgets.FULL, 0)):
        widgets.run(state, commands.SOFTEN_ALL)
    imgui.end_disabled()


def _slider(label: str, value: float, limits: tuple[float, float], form: str, tooltip: str) -> float:
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*QUIET), label)
    widgets.show_tooltip(tooltip)
    imgui.same_line(_LABELS * imgui.get_font_size())
    return widgets.slider(f"##{label}", value, limits, form, imgui.SliderFlags_.logarithmic, tooltip)[1]
