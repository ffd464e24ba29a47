"""The part of the window where the drawing is: pointer in, pins out."""

from imgui_bundle import ImVec2, imgui

from ...editor.editor import HELD_KEYS
from ...editor.events import ARROWS, Button, KeyEvent, PointerEvent, ScrollEvent
from ...editor.tools.base import DRAG_DISTANCE, distance
from ...editor.tools.keyboard_pointer import KeyboardPointer
from ...editor.tools.pins import DraggingPin, Idle, PointingPin, RubberBand
from ...editor.tools.rotate import PointingRotationRing, RotatingPin, hovered_ring
from ..app_state import AppState
from ..panels.pin_popup import PinPopup
from ..theme import ACCENT, DARK, packed
from .pin_markers import draw_brush, draw_crosshair, draw_held_angle, draw_ring

_BUTTONS: tuple[Button, ...] = ("left", "right", "middle")  # in ImGui's order
_ARROW_KEYS = {name: imgui.Key[f"{name}_arrow"] for name in ARROWS}
_CLICK_KEYS = (imgui.Key.enter, imgui.Key.keypad_enter, imgui.Key.space)  # of the crosshair
_HOLDING = (PointingPin, DraggingPin, PointingRotationRing, RotatingPin)  # tools
_WHITE = (1.0, 1.0, 1.0, 1.0)


class Canvas:
    """Turns what ImGui saw into editor events.

    Input is read from ImGui, not from the window system, so that its Test Engine can drag pins as well.
    """

    def __init__(self) -> None:
        self._last = (0.0, 0.0)
        self._taking = False  # whether the gesture is recorded as a take
        self._popup = PinPopup()
        self._interrupted = -1  # the last frame with a dialog or a menu

    def read_input(self, state: AppState) -> None:
        """Pass this frame's pointer and keys on, unless a panel wants them."""
        io, editor = imgui.get_io(), state.editor
        self._read_keys(state)
        at = imgui.get_mouse_pos()
        position = (at.x, at.y)
        free = not io.want_capture_mouse
        idle = isinstance(editor.tool, Idle)
        inside = imgui.is_mouse_pos_valid()
        # a mouse that lies there trembles
        still = DRAG_DISTANCE * editor.ui_scale if isinstance(editor.tool, KeyboardPointer) else 0.0
        if inside and distance(position, self._last) > still and (free or not idle):
            self._last = position
            editor.handle_event(PointerEvent("move", position))
        if idle and not (free and inside):
            editor.pointer_left()
        for index, button in enumerate(_BUTTONS):
            if free and imgui.is_mouse_clicked(index):
                state.notice = ""
                event = PointerEvent(
                    "press", position, button, io.key_shift, io.key_alt, io.mouse_clicked_count[index]
                )
                if io.key_ctrl:
                    state.timeline.session_playback.take(True)
                    self._taking = True
                editor.handle_event(event)
            if imgui.is_mouse_released(index) and not isinstance(editor.tool, Idle):
                editor.handle_event(PointerEvent("release", position, button, io.key_shift, io.key_alt))
                if self._taking:
                    state.timeline.session_playback.take(False)
                    self._taking = False
        if free and io.mouse_wheel:
            editor.handle_event(ScrollEvent(position, io.mouse_wheel))

    def cancel_input(self, state: AppState) -> None:
        """End what is held half-way: its end goes to a dialog or another window and will not be seen here."""
        at = imgui.get_mouse_pos()
        self._last, self._interrupted = (at.x, at.y), imgui.get_frame_count()
        state.editor.cancel()
        for name in HELD_KEYS:
            state.editor.handle_event(KeyEvent(name, pressed=False))

    def _read_keys(self, state: AppState) -> None:
        io, editor = imgui.get_io(), state.editor
        pointing = isinstance(editor.tool, KeyboardPointer)
        held = {
            "space": imgui.is_key_down(imgui.Key.space) and not pointing,
            "h": imgui.is_key_down(imgui.Key.h) and not io.key_ctrl,
            "alt": io.key_alt,
            "shift": io.key_shift,
        }
        for name, is_down in held.items():
            is_meant = is_down and not io.want_text_input
            if is_meant != (name in editor.held):
                editor.handle_event(KeyEvent(name, is_meant))
        if io.want_text_input:
            return
        if pointing and not io.nav_visible and any(imgui.is_key_pressed(key, False) for key in _CLICK_KEYS):
            state.notice = ""
            editor.handle_event(KeyEvent("enter"))
        closed_menu = imgui.get_frame_count() <= self._interrupted + 1  # before this frame began
        if imgui.is_key_pressed(imgui.Key.escape, False) and not closed_menu:
            editor.handle_event(KeyEvent("escape"))
            imgui.set_window_focus(None)  # from a panel that was walked into
        # a panel that was clicked must not take the arrows away; one that is walked through with keys does
        if imgui.is_mouse_released(0) and not io.nav_visible and not imgui.is_any_item_active():
            imgui.set_window_focus(None)
        for name, key in _ARROW_KEYS.items():
            if imgui.is_key_pressed(key) and not io.nav_visible and not io.key_ctrl:
                editor.handle_event(KeyEvent(name, shift=io.key_shift))

    def draw_popup(self, state: AppState, scale: float) -> None:
        """The menu or the values of a pin, if asked for."""
        self._popup.draw(state, scale)

    @staticmethod
    def choose_cursor(state: AppState) -> None:
        """The shape of the pointer says what a press would do."""
        editor = state.editor
        if imgui.get_io().want_capture_mouse:
            return
        if editor.pans_on_drag:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
        elif editor.chosen_tool == "brush" and editor.session is not None:
            imgui.set_mouse_cursor(imgui.MouseCursor_.none)
        elif isinstance(editor.tool, _HOLDING) or {editor.hovered_pin, hovered_ring(editor)} != {None}:
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)

    @staticmethod
    def draw_overlay(state: AppState, scale: float) -> None:
        """Pins, the pin that a click would add, and the selection box: over the drawing, under the panels."""
        editor, session = state.editor, state.editor.session
        if session is None:
            return
        draw = imgui.get_background_draw_list()
        draw.push_clip_rect(ImVec2(*editor.canvas[:2]), ImVec2(*editor.canvas[2:]))
        if state.show_pins and "h" not in editor.held:
            hovered = editor.hovered_pin if isinstance(editor.tool, Idle) else None
            targets = {pin.id: editor.camera.to_screen(tuple(pin.target)) for pin in session.state.pins}
            depths = {pin.id: pin.depth for pin in session.state.pins}
            angles = {pin.id: pin.angle for pin in session.state.pins}
            for pin, place in editor.pins_on_screen().items():
                if pin in editor.selection and isinstance(editor.tool, DraggingPin):
                    draw.add_line(ImVec2(*place), ImVec2(*targets[pin]), packed(ACCENT, 0.8), 1.5 * scale)
                draw_pin(draw, place, scale, pin in editor.selection, pin == hovered)
                angle = angles[pin]
                if angle is not None:
                    draw_held_angle(draw, place, scale, angle, session.supports_rotation)
                if depths[pin]:
                    _draw_label(draw, (place[0] + 12 * scale, place[1]), f"{depths[pin]:+d}", scale)
                if pin == hovered and "alt" in editor.held:
                    _draw_sign(draw, place, 4.0 * scale, scale, "×")
            if editor.pointer is not None and editor.would_add_pin:
                center = ImVec2(*editor.pointer)
                draw.add_circle(center, 7.5 * scale, packed(DARK, 0.5), 0, 3.0 * scale)
                draw.add_circle(center, 7.5 * scale, packed(_WHITE, 0.9), 0, 1.5 * scale)
                _draw_sign(draw, editor.pointer, 3.0 * scale, scale, "+")
            draw_ring(draw, editor, scale)
        draw_brush(draw, editor, scale)
        draw_crosshair(draw, editor, scale)
        if isinstance(editor.tool, RubberBand):
            corners = ImVec2(*editor.tool.start), ImVec2(*editor.tool.end)
            low = ImVec2(min(c.x for c in corners), min(c.y for c in corners))
            high = ImVec2(max(c.x for c in corners), max(c.y for c in corners))
            draw.add_rect_filled(low, high, packed(ACCENT, 0.12))
            draw.add_rect(low, high, packed(ACCENT, 0.9))
        draw.pop_clip_rect()


def _draw_label(draw: imgui.ImDrawList, place: tuple[float, float], text: str, scale: float) -> None:
    """A few signs on a dark plate; ``place`` is the middle of its left side."""
    size = imgui.calc_text_size(text)
    low = ImVec2(place[0], place[1] - 0.5 * size.y - 1 * scale)
    high = ImVec2(place[0] + size.x + 8 * scale, place[1] + 0.5 * size.y + 1 * scale)
    draw.add_rect_filled(low, high, packed(DARK, 0.75), 4 * scale)
    draw.add_text(ImVec2(place[0] + 4 * scale, place[1] - 0.5 * size.y), packed(_WHITE), text)


def _draw_sign(
    draw: imgui.ImDrawList, place: tuple[float, float], size: float, scale: float, sign: str
) -> None:
    """What a click would do with the pin there: add it (+) or take it away (×)."""
    x, y = place
    turns = ((1, 1), (1, -1)) if sign == "×" else ((1, 0), (0, 1))
    for color, width in ((packed(DARK, 0.7), 3.5 * scale), (packed(_WHITE), 1.6 * scale)):
        for dx, dy in turns:
            ends = ImVec2(x - size * dx, y - size * dy), ImVec2(x + size * dx, y + size * dy)
            draw.add_line(*ends, color, width)


def draw_pin(
    draw: imgui.ImDrawList, place: tuple[float, float], scale: float, selected: bool, hovered: bool
) -> None:
    """A dot in a white ring in a dark one, which stand out from any picture."""
    center = ImVec2(*place)
    radius = (8.0 if hovered else 7.0) * scale
    draw.add_circle_filled(center, radius + 1.5 * scale, packed(DARK, 0.75))
    draw.add_circle_filled(center, radius, packed(_WHITE))
    draw.add_circle_filled(center, radius - 2.2 * scale, packed(ACCENT if selected else DARK))
