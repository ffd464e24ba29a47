"""The popups of the canvas: the menu of a pin or of the canvas, and the values of a pin."""

import math
from collections.abc import Callable
from typing import TypeVar

from imgui_bundle import ImVec2, imgui

from ...editor import gestures
from ...editor.document.pin import Pin
from ...editor.events import PinRequest
from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..commands.clipboard import COPY_PICTURE, COPY_POSE, PASTE
from ..commands.command import Command
from ..commands.registry import (
    ACTUAL_SIZE,
    DESELECT,
    FIT,
    HOLD_ANGLE,
    LIMB_TO_BACK,
    LIMB_TO_FRONT,
    LOWER_DEPTH,
    RAISE_DEPTH,
    REDO,
    REMOVE_SELECTED,
    RESET_POSE,
    SELECT_ALL,
    SHOW_CHECKERBOARD,
    SHOW_MESH,
    SHOW_PINS,
    UNDO,
)
from ..pending_values import PendingValues

T = TypeVar("T")

_OFFSET = 14.0  # design points from the pin's center to the popup's corner, so that the pin stays visible
_LABEL_WIDTH = 3.6  # times the font size
_FIELD_WIDTH = 126  # design points
_MENU: tuple[Command | None, ...] = (
    *(LIMB_TO_FRONT, LIMB_TO_BACK, RAISE_DEPTH, LOWER_DEPTH, HOLD_ANGLE),
    None,
    *(REMOVE_SELECTED, SELECT_ALL),
)


_CANVAS_POPUP = "###canvas menu"
_CANVAS_MENU: tuple[Command | None, ...] = (
    *(UNDO, REDO, None),
    *(COPY_PICTURE, COPY_POSE, PASTE, None),
    *(SELECT_ALL, DESELECT, RESET_POSE, None),
    *(FIT, ACTUAL_SIZE, SHOW_MESH, SHOW_PINS, SHOW_CHECKERBOARD),
)


class PinPopup:
    """Shows the editor's request as a popup, and withdraws the request when the popup is closed."""

    def __init__(self) -> None:
        self._shown: PinRequest | None = None

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame if there is a request. scale: points per design point."""
        editor, request = state.editor, state.editor.request
        if request is None or editor.session is None:
            self._shown = None
            return
        name = f"###pin {request.kind}"
        if request is not self._shown:
            imgui.open_popup(name)
            self._shown = request
            x, y = editor.pins_on_screen()[request.pin]
            imgui.set_next_window_pos(ImVec2(x + _OFFSET * scale, y + _OFFSET * scale))
        if not imgui.begin_popup(name):
            editor.request = None
            return
        pin = editor.session.state.pin(request.pin)
        if request.kind == "menu":
            _draw_menu(state, pin)
        else:
            _draw_values(state, pin, scale)
        imgui.end_popup()


def _draw_values(state: AppState, pin: Pin, scale: float) -> None:
    """Draw fields for target, depth and angle; each is applied when its edit ends."""
    x, y = pin.target.tolist()
    widgets.secondary_text(tr("Pin {number}", number=pin.id))
    imgui.push_item_width(_FIELD_WIDTH * scale)
    if imgui.is_window_appearing():
        imgui.set_keyboard_focus_here()
    new_x = _number_field(state, pin, "X", x, "%.2f")
    new_y = _number_field(state, pin, "Y", y, "%.2f")
    depth = _field(state, pin, tr("Depth"), pin.depth, lambda value: imgui.input_int("##Depth", value, 0, 0))
    widgets.show_tooltip(tr("Where limbs overlap, the higher number is in front."))
    _draw_angle(state, pin)
    _draw_scale(state, pin)
    imgui.pop_item_width()
    if widgets.cancel_pressed():  # ImGui would only leave the field
        widgets.close_popup()
    if depth is not None:
        state.run_reporting_errors(lambda: gestures.set_depth(state.editor, pin.id, depth))
    if new_x is not None or new_y is not None:
        target = x if new_x is None else new_x, y if new_y is None else new_y
        state.run_reporting_errors(lambda: gestures.move_pin(state.editor, pin.id, target))


def _draw_angle(state: AppState, pin: Pin) -> None:
    """Draw a field for the angle in degrees, and a switch for whether the pin holds it."""
    session = state.editor.session
    assert session is not None
    imgui.begin_disabled(not session.supports_rotation)
    degrees = math.degrees(session.pin_angle(pin.id) if pin.angle is None else pin.angle)
    degrees = 0.0 if abs(degrees) < 0.05 else degrees  # not -0.0°
    new_degrees = _number_field(state, pin, tr("Angle"), degrees, "%.1f°")
    widgets.show_tooltip(tr("Rotation of the drawing around the pin, clockwise."))
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + _label_width())
    is_clicked, is_held = widgets.switch(
        tr("Hold angle"), pin.angle is not None, tr("Off: the drawing can rotate freely around the pin.")
    )
    imgui.end_disabled()
    if new_degrees is not None:
        angle: float | None = math.radians(new_degrees)
    elif is_clicked:
        angle = math.radians(degrees) if is_held else None
    else:
        return
    state.run_reporting_errors(lambda: gestures.set_pin_angle(state.editor, pin.id, angle))


def _draw_scale(state: AppState, pin: Pin) -> None:
    """Draw a field for the scale in percent."""
    session = state.editor.session
    assert session is not None
    imgui.begin_disabled(not session.supports_scales)
    percent = _number_field(state, pin, tr("Scale"), 100 * (pin.scale or 1.0), "%.0f %%")
    widgets.show_tooltip(tr("Size of the drawing around the pin, compared with the rest pose."))
    imgui.end_disabled()
    if percent is not None:
        scale = percent / 100
        state.run_reporting_errors(lambda: gestures.set_pin_scale(state.editor, pin.id, scale))


def _label_width() -> float:
    """The width of the column of labels, in points."""
    font_size = imgui.get_font_size()
    longest = max(imgui.calc_text_size(tr(label)).x for label in ("Depth", "Angle", "Scale"))
    return float(max(_LABEL_WIDTH * font_size, longest + 0.5 * font_size))


def _number_field(state: AppState, pin: Pin, name: str, value: float, text_format: str) -> float | None:
    """Draw a label and a field; return the new value in the frame in which its edit ends.

    A field that is only looked at would return the digits that it shows, so these are no new value.
    """
    new = _field(
        state, pin, name, value, lambda each: imgui.input_double(f"##{name}", each, 0, 0, text_format)
    )
    return None if new is None or text_format % new == text_format % value else new


def _field(state: AppState, pin: Pin, name: str, value: T, item: Callable[[T], tuple[bool, T]]) -> T | None:
    """Draw a label and a field; return the new value in the frame in which its edit ends."""
    widgets.label(name, imgui.get_style().window_padding.x + _label_width())
    return state.part(PendingValues).edit((pin.id, name), value, item)


def _draw_menu(state: AppState, pin: Pin) -> None:
    """Draw the content of a pin's context menu."""
    if imgui.menu_item_simple(tr("Values...")):
        state.editor.request_pin_popup("values", pin.id)
    if len(state.editor.selection) > 1 and imgui.menu_item_simple(tr("Select Only This Pin")):
        state.editor.select({pin.id})
    _draw_commands(state, _MENU)


def draw_canvas_menu(state: AppState) -> None:
    """Draw the menu of the canvas beside the pins, if the editor requests it or it is open."""
    request, state.editor.menu_request = state.editor.menu_request, None
    if request is not None:
        imgui.set_next_window_pos(ImVec2(*request))
        imgui.open_popup(_CANVAS_POPUP)
    if imgui.begin_popup(_CANVAS_POPUP):
        _draw_commands(state, _CANVAS_MENU)
        imgui.end_popup()


def _draw_commands(state: AppState, commands: tuple[Command | None, ...]) -> None:
    """Draw the lines of a menu; None is a separator."""
    for command in commands:
        if command is None:
            imgui.separator()
        else:
            is_checked, is_enabled = command.is_checked(state), command.enabled(state)
            if imgui.menu_item(command.text, command.key_name, is_checked, is_enabled)[0]:
                widgets.run(state, command)
