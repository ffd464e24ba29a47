"""What opens at a pin: its menu on a right click, its values on a double click."""

import math
from collections.abc import Callable

from imgui_bundle import ImVec2, imgui

from ...editor import gestures
from ...editor.document.pin import Pin
from ...editor.events import PinRequest
from .. import widgets
from ..app_state import AppState
from ..commands import registry as commands
from ..commands.command import Command
from ..pending_values import T

_OFFSET = 14.0  # points from a pin's center to the popup's corner, so that the pin is still seen
_LABELS = 3.6  # times the font's size: width of the labels
_MENU: tuple[Command | None, ...] = (
    commands.LIMB_TO_FRONT,
    commands.LIMB_TO_BACK,
    commands.RAISE_DEPTH,
    commands.LOWER_DEPTH,
    commands.HOLD_ANGLE,
    None,
    commands.REMOVE,
    commands.SELECT_ALL,
)


class PinPopup:
    """Shows the editor's request as a popup and takes it back when that is closed."""

    def __init__(self) -> None:
        self._shown: PinRequest | None = None

    def draw(self, state: AppState, scale: float) -> None:
        """Draw what is asked for, if anything."""
        editor = state.editor
        request = editor.request
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
            _menu(state, pin)
        else:
            _values(state, pin, scale)
        imgui.end_popup()


def _menu(state: AppState, pin: Pin) -> None:
    if imgui.menu_item_simple("Values..."):
        state.editor.request_pin_popup("values", pin.id)
    if len(state.editor.selection) > 1 and imgui.menu_item_simple("Select Only This Pin"):
        state.editor.select({pin.id})
    for command in _MENU:
        if command is None:
            imgui.separator()
        else:
            on = command.checked is not None and command.checked(state)
            if imgui.menu_item(command.label, command.key_name, on, command.enabled(state))[0]:
                widgets.run(state, command)


def _field(state: AppState, pin: Pin, name: str, value: T, draw: Callable[[T], tuple[bool, T]]) -> T | None:
    """A value of the pin behind its name; another one once the field is left."""
    widgets.label(name, imgui.get_style().window_padding.x + _LABELS * imgui.get_font_size())
    return state.pending_values.edit((pin.id, name), value, draw)


def _angle(state: AppState, pin: Pin) -> None:
    """Whether the pin holds an angle, and in degrees which one."""
    session = state.editor.session
    assert session is not None
    imgui.begin_disabled(not session.supports_rotation)
    shown = math.degrees(session.pin_angle(pin.id) if pin.angle is None else pin.angle)
    shown = 0.0 if abs(shown) < 0.05 else shown  # not -0.0°
    angle = _field(
        state, pin, "Angle", shown, lambda draft: imgui.input_double("##Angle", draft, 0, 0, "%.1f°")
    )
    widgets.show_tooltip("By how many degrees the drawing around the pin is turned, clockwise.")
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + _LABELS * imgui.get_font_size())
    held = widgets.switch("Hold this angle", pin.angle is not None, "Off: the drawing turns as it will here.")
    imgui.end_disabled()
    if angle is not None:
        state.run_reporting_errors(lambda: gestures.set_pin_angle(state.editor, pin.id, math.radians(angle)))
    elif held[0]:
        state.run_reporting_errors(
            lambda: gestures.set_pin_angle(state.editor, pin.id, math.radians(shown) if held[1] else None)
        )


def _values(state: AppState, pin: Pin, scale: float) -> None:
    x, y = pin.target.tolist()
    widgets.secondary_text(f"Pin {pin.id}")
    imgui.push_item_width(126 * scale)
    if imgui.is_window_appearing():
        imgui.set_keyboard_focus_here()
    new_x = _field(state, pin, "X", x, lambda draft: imgui.input_double("##X", draft, 0, 0, "%.2f"))
    new_y = _field(state, pin, "Y", y, lambda draft: imgui.input_double("##Y", draft, 0, 0, "%.2f"))
    depth = _field(state, pin, "Depth", pin.depth, lambda draft: imgui.input_int("##Depth", draft, 0, 0))
    widgets.show_tooltip("Where limbs cross, the higher number passes in front.")
    _angle(state, pin)
    imgui.pop_item_width()
    if widgets.cancel_pressed():  # ImGui would only leave the field
        widgets.close_popup()
    if depth is not None:
        state.run_reporting_errors(lambda: gestures.set_depth(state.editor, pin.id, depth))
    if new_x is not None or new_y is not None:
        to = x if new_x is None else new_x, y if new_y is None else new_y
        state.run_reporting_errors(lambda: gestures.move_pin(state.editor, pin.id, to))
