"""The options of the stiffness brush, in the options bar while it is the current tool."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

from imgui_bundle import ImVec2, imgui

from ...deform.follow_through import MAX_BOUNCE, MAX_SPEED, MIN_SPEED
from ...deform.methods import get_method
from ...editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from ...editor.session.edits import SetSwing
from ...editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS
from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..commands.registry import CLEAR_LOOSE, CLEAR_STIFFNESS, ERASE
from ..pending_values import PendingValues
from .items import Item, command_button, draw_label, text

T = TypeVar("T")

_SLIDER_WIDTH = 9.0  # with its number, times the font size


def is_shown(state: AppState) -> bool:
    """Whether a drawing is open and the brush is the current tool."""
    return state.document is not None and state.editor.chosen_tool is state.editor.brush_tool


def items(state: AppState) -> Sequence[Item]:
    """What it paints and how, its size, eraser, and what removes all that was painted."""
    assert state.document is not None
    kind, size, erase = Item("kind", _draw_kind), Item("size", _draw_size), Item("erase", _draw_erase)
    if state.editor.brush_tool.brush.paints == "loose":
        swing = Item("speed", _draw_speed), Item("bounce", _draw_bounce)
        return (kind, *swing, size, erase, command_button(CLEAR_LOOSE))
    listed = [kind, Item("strength", _draw_strength), size, erase, command_button(CLEAR_STIFFNESS)]
    if not get_method(state.document.state.settings.method).deformer.takes_stiffness:
        listed.insert(0, text("ignored", tr("The current method ignores stiffness.")))
    return listed


def _draw_kind(state: AppState) -> None:
    """Draw the switch between stiffness and loose parts."""
    brush = state.editor.brush_tool.brush
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
    if widgets.radio(tr("Stiff") + "###Stiff", brush.paints == "stiff"):
        state.editor.brush_tool.brush = replace(brush, paints="stiff")
    widgets.show_tooltip(tr("Paint areas that bend less"))
    imgui.same_line(0, 0.6 * imgui.get_font_size())
    if widgets.radio(tr("Loose") + "###Loose", brush.paints == "loose"):
        state.editor.brush_tool.brush = replace(brush, paints="loose")
    widgets.show_tooltip(tr("Paint ears, tails or hair that swing when the drawing moves"))


def _draw_speed(state: AppState) -> None:
    speed, bounce = _swing(state)
    tooltip = tr("How many times a second loose parts swing. Long hair is slow, a short ear is fast.")
    new = _pending_slider(state, mark("Speed"), speed, (MIN_SPEED, MAX_SPEED), "%.1f Hz", tooltip)
    if new is not None:
        _set_swing(state, round(new, 2), bounce)


def _draw_bounce(state: AppState) -> None:
    speed, bounce = _swing(state)
    tooltip = tr("How much of a swing is left for the next one. At 0 loose parts lag, but do not overshoot.")
    new = _pending_slider(state, mark("Bounce"), 100 * bounce, (0.0, 100 * MAX_BOUNCE), "%.0f %%", tooltip)
    if new is not None:
        _set_swing(state, speed, round(new) / 100)


def _swing(state: AppState) -> tuple[float, float]:
    """Speed and bounce of the drawing's loose parts, or of those that the brush is to paint."""
    assert state.document is not None
    shown = state.document.state.loose or state.editor.brush_tool.brush
    return shown.speed, shown.bounce


def _set_swing(state: AppState, speed: float, bounce: float) -> None:
    editor = state.editor
    editor.brush_tool.brush = replace(editor.brush_tool.brush, speed=speed, bounce=bounce)
    if editor.session is not None and editor.session.state.loose is not None:
        state.run_reporting_errors(lambda: editor.apply(mark("Change Swing"), SetSwing(speed, bounce)))


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
    """Draw a label (English) and a logarithmic slider; return its value."""
    flags = imgui.SliderFlags_.logarithmic
    return _labeled(label, tooltip, lambda: _bare_slider(label, value, limits, text_format, flags)[1])


def _pending_slider(
    state: AppState, label: str, value: float, limits: tuple[float, float], text_format: str, tooltip: str
) -> float | None:
    """Draw a label (English) and a slider; return the new value in the frame in which its edit ends."""
    return _labeled(
        label,
        tooltip,
        lambda: state.part(PendingValues).edit(
            (label, "of the brush"), value, lambda shown: _bare_slider(label, shown, limits, text_format)
        ),
    )


def _bare_slider(
    label: str, value: float, limits: tuple[float, float], text_format: str, flags: int = 0
) -> tuple[bool, float]:
    """Draw a slider with its number; return whether it was moved, and its value."""
    width = _SLIDER_WIDTH * imgui.get_font_size()
    return widgets.slider(f"##{label}", value, limits, text_format, flags, width=width)[:2]


def _labeled(label: str, tooltip: str, draw: Callable[[], T]) -> T:
    """Draw a label (English) and a slider of a fixed width; return what ``draw`` returns."""
    draw_label(tr(label), tooltip)
    value = draw()
    widgets.show_tooltip(tooltip)
    number_width = _SLIDER_WIDTH * imgui.get_font_size() - imgui.get_item_rect_size().x
    imgui.same_line(0, 0)
    imgui.dummy(ImVec2(number_width, 0))  # the number is no item
    return value
