"""The Bending section: the deformation method and its parameters."""

from imgui_bundle import ImVec2, imgui

from ...deform.methods import get_method, nearest_preset, presets
from ...editor.document.settings import Settings
from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..commands.registry import REMEMBER_REST_SHAPE, RESET_POSE, remembers_rest_shape
from . import method_parameters

_MEMORY_TOOLTIP = mark(
    "On: the drawing springs back towards its rest shape as you drag, so that a drag back and forth leaves "
    "no trace. Off: it keeps the effect of each drag, like clay."
)


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    assert state.document is not None
    _draw_method(state, state.document.state.settings)
    imgui.begin_disabled(not REMEMBER_REST_SHAPE.enabled(state))
    if widgets.switch(tr("Remember rest shape"), remembers_rest_shape(state), tr(_MEMORY_TOOLTIP))[0]:
        widgets.run(state, REMEMBER_REST_SHAPE)
    imgui.end_disabled()
    method_parameters.draw(state)
    imgui.begin_disabled(not RESET_POSE.enabled(state))
    if imgui.button(RESET_POSE.text, ImVec2(widgets.FULL, 0)):
        widgets.run(state, RESET_POSE)
    imgui.end_disabled()


def _draw_method(state: AppState, settings: Settings) -> None:
    """Draw the list of methods. A new choice keeps whether the rest shape is remembered."""
    choices, current = presets(), nearest_preset(settings.method, dict(settings.parameters))
    imgui.set_next_item_width(widgets.FULL)
    labels = [tr(preset.label) for preset in choices]
    is_changed, index = widgets.combo("##method", choices.index(current), labels)
    widgets.show_tooltip(current.description)
    if is_changed:
        chosen = Settings.parse(choices[index].spec)
        if chosen.method == settings.method and get_method(chosen.method).deformer.has_memory:
            chosen = chosen.with_parameter("memory", settings.get("memory", 0.0))
        widgets.change_settings(state, chosen)
