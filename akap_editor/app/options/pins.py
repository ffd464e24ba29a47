"""What the options bar offers for the selected pins: values of one, arrangement of several."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...editor import gestures, pin_arrangement
from ...editor.document.pin import MAX_DEPTH, MAX_PIN_SCALE, MIN_PIN_SCALE, Pin
from ...editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from ...words import mark, tr, tr_plural
from .. import widgets
from ..app_state import AppState
from ..commands.edit.arrange import ALIGN_PINS, DISTRIBUTE_PINS
from ..commands.edit.mirror import PAIR_PINS, UNPAIR_PINS
from ..commands.registry import HOLD_ANGLE, REMOVE_SELECTED
from ..pending_values import PendingValues
from .items import FIELD_WIDTH, Item, command_button, draw_label, text

T = TypeVar("T", int, float)

_NAME_WIDTH = 8.0  # times the font size


def is_shown(state: AppState) -> bool:
    """Whether pins are selected, and the current tool is the one for pins."""
    editor = state.editor
    return bool(editor.selection) and editor.chosen_tool is editor.pins_tool


def items(state: AppState) -> Sequence[Item]:
    """The items for the selected pins."""
    pins = selected_pins(state)
    if len(pins) == 1:
        return (
            text(
                f"name of {pins[0].id}", widgets.shortened(pins[0].label, _NAME_WIDTH * imgui.get_font_size())
            ),
            Item("angle", partial(_draw_angle, pins[0])),
            command_button(HOLD_ANGLE),
            Item("scale", partial(_draw_scale, pins[0])),
            Item("depth", partial(_draw_depth, pins)),
            Item("stiffness", partial(_draw_stiffness, pins)),
            command_button(REMOVE_SELECTED, mark("Remove")),
        )
    mirror = state.document.state.mirror if state.document is not None else None
    is_pair = mirror is not None and mirror.partner(pins[0].id) == pins[1].id
    return (
        text("count", tr_plural("{count} pin", "{count} pins", len(pins))),
        Item("align", _draw_align),
        *((command_button(UNPAIR_PINS if is_pair else PAIR_PINS),) if len(pins) == 2 else ()),
        Item("depth", partial(_draw_depth, pins)),
        Item("stiffness", partial(_draw_stiffness, pins)),
        command_button(REMOVE_SELECTED, mark("Remove")),
    )


def selected_pins(state: AppState) -> list[Pin]:
    """The selected pins in the order of the document."""
    session = state.editor.session
    assert session is not None
    return [pin for pin in session.state.pins if pin.id in state.editor.selection]


def _draw_angle(pin: Pin, state: AppState) -> None:
    """Draw the angle in degrees, which a drag or a typed number changes."""
    session = state.editor.session
    assert session is not None
    degrees = math.degrees(session.pin_angle(pin.id) if pin.angle is None else pin.angle)
    degrees = 0.0 if abs(degrees) < 0.05 else degrees  # not -0.0°
    tooltip = tr("Rotation of the drawing around the pin, clockwise. Drag, or double-click to type.")
    imgui.begin_disabled(not session.supports_rotation)
    new = _drag_number(
        state,
        mark("Rotate"),
        (pin.id,),
        degrees,
        lambda value: widgets.number_in_language(
            "##angle", "%.1f°", lambda: imgui.drag_float("##angle", value, 0.5, 0, 0, "%.1f°")
        ),
        tooltip,
    )
    imgui.end_disabled()
    if new is not None and round(new, 1) != round(degrees, 1):
        state.run_reporting_errors(lambda: gestures.set_pin_angle(state.editor, pin.id, math.radians(new)))


def _draw_scale(pin: Pin, state: AppState) -> None:
    """Draw the scale in percent, which a drag or a typed number changes."""
    session = state.editor.session
    assert session is not None
    percent = 100 * (pin.scale or 1.0)
    imgui.begin_disabled(not session.supports_scales)
    new = _drag_number(
        state,
        mark("Scale"),
        (pin.id,),
        percent,
        lambda value: imgui.drag_float(
            "##scale", value, 0.5, 100 * MIN_PIN_SCALE, 100 * MAX_PIN_SCALE, "%.0f %%"
        ),
        tr("Size of the drawing around the pin, compared with the rest pose. Drag, or double-click to type."),
    )
    imgui.end_disabled()
    if new is not None and round(new) != round(percent):
        scale = min(max(new / 100, MIN_PIN_SCALE), MAX_PIN_SCALE)
        state.run_reporting_errors(lambda: gestures.set_pin_scale(state.editor, pin.id, scale))


def _draw_depth(pins: Sequence[Pin], state: AppState) -> None:
    """Draw the depth, which a drag or a typed number changes for all pins."""
    depth = pins[-1].depth
    text_format = "%+d" if depth else "%d"
    new = _drag_number(
        state,
        mark("Depth"),
        tuple(pin.id for pin in pins),
        depth,
        lambda value: imgui.drag_int("##depth", value, 0.05, -MAX_DEPTH, MAX_DEPTH, text_format),
        tr("Where limbs overlap, the higher number is in front. Drag, or double-click to type."),
    )
    if new is not None and any(pin.depth != new for pin in pins):
        ids = [pin.id for pin in pins]
        state.run_reporting_errors(lambda: pin_arrangement.set_depths(state.editor, ids, new))


def _draw_stiffness(pins: Sequence[Pin], state: AppState) -> None:
    """Draw the stiffness around the last pin, which a drag or a typed number changes around all pins."""
    session = state.editor.session
    assert session is not None
    stiffness = pin_arrangement.stiffness_at(session, pins[-1])
    flags = imgui.SliderFlags_.logarithmic | imgui.SliderFlags_.always_clamp
    limits = MIN_STIFFNESS, MAX_STIFFNESS
    new = _drag_number(
        state,
        mark("Stiffness"),
        tuple(pin.id for pin in pins),
        stiffness,
        lambda value: imgui.drag_float("##stiffness", value, 1.0, *limits, "%.0f ×", flags),
        tr("How much stiffer the drawing is around the pin, in place of what is painted there."),
    )
    if new is not None and round(new) != round(stiffness):
        ids = [pin.id for pin in pins]
        state.run_reporting_errors(lambda: pin_arrangement.stiffen_pins(state.editor, ids, round(new)))


def _drag_number(
    state: AppState,
    label: str,
    pins: tuple[int, ...],
    value: T,
    item: Callable[[T], tuple[bool, T]],
    tooltip: str,
) -> T | None:
    """Draw a label (English) and a field; return the new value in the frame in which its edit ends."""
    draw_label(tr(label), tooltip)
    imgui.set_next_item_width(FIELD_WIDTH * imgui.get_font_size())
    new = state.part(PendingValues).edit((label, "in options bar", pins), value, item)
    widgets.show_tooltip(tooltip)
    return new


def _draw_align(state: AppState) -> None:
    """Draw a button that opens the menu of alignments."""
    if imgui.button(f"{tr('Align')}  {icons.ICON_FA_CARET_DOWN}###align"):
        imgui.open_popup("align menu")
    imgui.set_next_window_pos(imgui.ImVec2(imgui.get_item_rect_min().x, imgui.get_item_rect_max().y))
    if imgui.begin_popup("align menu"):
        for command in (*ALIGN_PINS, None, *DISTRIBUTE_PINS):
            if command is None:
                imgui.separator()
            elif imgui.menu_item(command.text, command.key_name, False, command.enabled(state))[0]:
                widgets.run(state, command)
        imgui.end_popup()
