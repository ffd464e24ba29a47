"""The parameters of the current method, under *Advanced* in the Bending section."""

from functools import partial
from typing import Any

from imgui_bundle import ImVec4, imgui

from ...deform.methods import Choice, NumberRange, Parameter, Switch, default_parameters, get_method
from ...editor.document.settings import Settings
from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..pending_values import PendingValues
from ..theme import SECONDARY
from . import parts


def default_value(method: str, name: str) -> Any:
    """The value of a parameter in a new document; None if the method chooses it."""
    return Settings.parse(method).get(name, default_parameters(method)[name])


def with_default_values(settings: Settings) -> Settings:
    """The settings with all parameters as in a new document."""
    for parameter in get_method(settings.method).parameters:
        settings = settings.with_parameter(parameter.name, default_value(settings.method, parameter.name))
    return settings


def draw_value(kind: Switch | Choice | NumberRange, value: Any) -> tuple[bool, Any]:
    """Draw the item that edits a parameter; return whether its value has changed, and the value."""
    match kind:
        case Switch():
            imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
            return widgets.switch("##value", bool(value))
        case Choice(labels):
            names = list(labels)
            is_changed, index = widgets.combo(
                "##value", names.index(value), [tr(label) for label in labels.values()]
            )
            return is_changed, names[index]
    limits, flags = (kind.low, kind.high), imgui.SliderFlags_.logarithmic if kind.is_logarithmic else 0
    if value is None:
        return widgets.slider("##value", kind.low, limits, kind.format, flags, word=tr("auto"))[:2]
    is_changed, number, _ = widgets.slider("##value", float(value), limits, kind.format, flags)
    return is_changed, round(number) if kind.is_whole else number


def draw(state: AppState) -> None:
    """Draw the parameters of the current method, collapsed at first; nothing if it has none."""
    assert state.document is not None
    settings = state.document.state.settings
    parameters = get_method(settings.method).parameters
    if not parameters:
        return
    if parts.draw_advanced(state, "Parameters"):
        column = widgets.label_column(*(tr(parameter.label) for parameter in parameters))
        for parameter in parameters:
            _draw_parameter(state, settings, parameter, column)


def _draw_parameter(state: AppState, settings: Settings, parameter: Parameter, column: float) -> None:
    """Draw label and item of a parameter. Its value is applied when the edit of the item ends.

    column: where the item begins, points.
    """
    default = default_value(settings.method, parameter.name)
    value = settings.get(parameter.name, default)
    imgui.push_id(parameter.name)
    imgui.align_text_to_frame_padding()
    if value == default:
        imgui.text_colored(ImVec4(*SECONDARY), tr(parameter.label))
    else:
        imgui.text(tr(parameter.label))
    widgets.show_tooltip(f"{tr(parameter.tooltip)} {tr('Double-click to reset.')}")
    is_reset = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(0)
    imgui.same_line(column)
    imgui.set_next_item_width(widgets.FULL)
    item = partial(draw_value, parameter.kind)
    new_value = state.part(PendingValues).edit((settings.method, parameter.name), value, item)
    imgui.pop_id()
    if is_reset and value != default:
        widgets.change_settings(state, settings.with_parameter(parameter.name, default))
    elif new_value is not None and new_value != value:
        widgets.change_settings(state, settings.with_parameter(parameter.name, new_value))
