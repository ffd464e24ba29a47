"""Mouse and keys on the canvas: turns ImGui's input into events of the editor."""

from imgui_bundle import imgui

from ...editor.editor import HELD_KEYS
from ...editor.events import ARROWS, Button, KeyEvent, PointerEvent, ScrollEvent
from ...editor.tools.base import DRAG_DISTANCE, distance
from .. import widgets
from ..app_state import AppState
from ..commands.timeline import PLAY
from ..timeline.motion_paths import grab_keyframe
from .cursors import show_cursor
from .pin_popup import PinPopup, draw_canvas_menu

TAP_SECONDS = 0.3  # Space held longer pans only
_BUTTONS: tuple[Button, ...] = ("left", "right", "middle")  # in ImGui's order
_ARROW_KEYS = {name: imgui.Key[f"{name}_arrow"] for name in ARROWS}
_CLICK_KEYS = (imgui.Key.enter, imgui.Key.keypad_enter, imgui.Key.space)  # of the keyboard pointer


class Canvas:
    """The part of the window that shows the drawing.

    It reads input from ImGui, not from GLFW, so that ImGui's Test Engine can drag pins as well.
    """

    def __init__(self) -> None:
        self._last_position = (0.0, 0.0)
        self._records_take = False  # whether a take of the timeline ends with the gesture
        self._popup = PinPopup()
        self._tap_began: float | None = None  # when Space went down, None if it cannot be a tap any more
        self._panel_had_focus = False  # whether keys moved through a panel in the last frame
        self._last_interruption = -1  # number of the last frame with a dialog or a menu

    def read_input(self, state: AppState) -> None:
        """Pass this frame's pointer and keys to the editor, except what panels use."""
        self._read_keys(state)
        self._read_movement(state)
        self._read_buttons(state)
        io = imgui.get_io()
        if (io.mouse_wheel or io.mouse_wheel_h) and not io.want_capture_mouse:
            pans = io.key_shift and state.editor.tool.is_idle
            amount, sideways = (0.0, io.mouse_wheel) if pans else (io.mouse_wheel, 0.0)
            scroll = ScrollEvent(_mouse_position(), amount, sideways + io.mouse_wheel_h)
            state.editor.handle_event(scroll)

    def cancel_input(self, state: AppState) -> None:
        """Cancel the gesture and release the held keys: a dialog or another window gets the rest of them."""
        self._last_position, self._last_interruption = _mouse_position(), imgui.get_frame_count()
        state.editor.cancel()
        state.editor.pointer_left()
        for name in HELD_KEYS:
            state.editor.handle_event(KeyEvent(name, pressed=False))

    def draw_popup(self, state: AppState, scale: float) -> None:
        """Draw the menu or the values of a pin, or the menu of the canvas, if the editor requests them."""
        self._popup.draw(state, scale)
        draw_canvas_menu(state)

    @staticmethod
    def choose_cursor(state: AppState) -> None:
        """Give the mouse pointer the cursor of the active tool."""
        if imgui.is_mouse_pos_valid() and not imgui.get_io().want_capture_mouse:
            show_cursor(state.editor.tool.cursor, state.editor.ui_scale)

    def _read_movement(self, state: AppState) -> None:
        editor, position = state.editor, _mouse_position()
        is_idle, is_free = editor.tool.is_idle, not imgui.get_io().want_capture_mouse
        is_inside = imgui.is_mouse_pos_valid()
        # A mouse that nobody holds trembles; that must not end the keyboard pointer.
        threshold = DRAG_DISTANCE * editor.ui_scale if editor.tool.is_keyboard_driven else 0.0
        if is_inside and distance(position, self._last_position) > threshold and (is_free or not is_idle):
            self._last_position = position
            editor.handle_event(PointerEvent("move", position))
        if is_idle and not (is_free and is_inside):
            editor.pointer_left()

    def _read_buttons(self, state: AppState) -> None:
        """Pass presses and releases; a press with Ctrl also records a take until the release."""
        io, editor, position = imgui.get_io(), state.editor, _mouse_position()
        for index, button in enumerate(_BUTTONS):
            if imgui.is_mouse_clicked(index) and not io.want_capture_mouse:
                state.notice = ""
                clicks = io.mouse_clicked_count[index]
                if io.key_ctrl:
                    state.timeline.session_playback.start_take()
                    self._records_take = True
                if button == "left":
                    grab_keyframe(state, position)
                editor.handle_event(PointerEvent("press", position, button, io.key_shift, io.key_alt, clicks))
            if imgui.is_mouse_released(index) and not editor.tool.is_idle:
                editor.handle_event(PointerEvent("release", position, button, io.key_shift, io.key_alt))
                if self._records_take:
                    state.timeline.session_playback.end_take()
                    self._records_take = False

    def _read_keys(self, state: AppState) -> None:
        io, editor = imgui.get_io(), state.editor
        self._read_held_keys(state)
        if io.want_text_input:
            return
        self._play_on_tap(state)
        clicks = any(imgui.is_key_pressed(key, False) for key in _CLICK_KEYS)
        if clicks and editor.tool.is_keyboard_driven and not io.nav_visible:
            state.notice = ""
            editor.handle_event(KeyEvent("enter"))
        closed_popup = imgui.get_frame_count() <= self._last_interruption + 1
        if imgui.is_key_pressed(imgui.Key.escape, False) and not closed_popup:
            if not self._panel_had_focus or editor.is_busy:
                editor.handle_event(KeyEvent("escape"))
            imgui.set_window_focus(None)  # if the keyboard was in a panel
        self._panel_had_focus = io.nav_visible
        # A panel that was clicked must not keep the arrows; one that keys walk through does.
        if imgui.is_mouse_released(0) and not io.nav_visible and not imgui.is_any_item_active():
            imgui.set_window_focus(None)
        for name, key in _ARROW_KEYS.items():
            if imgui.is_key_pressed(key) and not io.nav_visible and not io.key_ctrl:
                editor.handle_event(KeyEvent(name, shift=io.key_shift))

    def _play_on_tap(self, state: AppState) -> None:
        """Play, or stop, when Space is released soon and no button was pressed meanwhile."""
        io, editor = imgui.get_io(), state.editor
        if imgui.is_key_pressed(imgui.Key.space, False):
            is_free = not (io.nav_visible or io.key_ctrl or editor.tool.is_keyboard_driven)
            self._tap_began = imgui.get_time() if is_free and editor.tool.is_idle else None
        if any(imgui.is_mouse_clicked(index) for index in range(len(_BUTTONS))):
            self._tap_began = None
        if imgui.is_key_released(imgui.Key.space) and self._tap_began is not None:
            is_tap = imgui.get_time() - self._tap_began < TAP_SECONDS
            self._tap_began = None
            if is_tap and PLAY.enabled(state):
                widgets.run(state, PLAY)
            elif is_tap and state.document is not None:
                state.notice = PLAY.missing

    @staticmethod
    def _read_held_keys(state: AppState) -> None:
        """Pass changes of the keys that have a meaning while they are held."""
        io, editor = imgui.get_io(), state.editor
        is_space_down = imgui.is_key_down(imgui.Key.space) and not editor.tool.is_keyboard_driven
        held = {
            "space": is_space_down and not io.key_ctrl,
            "zoom": is_space_down and io.key_ctrl,
            "h": imgui.is_key_down(imgui.Key.h) and not io.key_ctrl,
            "alt": io.key_alt,
            "shift": io.key_shift,
        }
        for name, is_down in held.items():
            is_held = is_down and not io.want_text_input
            if is_held != (name in editor.held):
                editor.handle_event(KeyEvent(name, is_held))


def _mouse_position() -> tuple[float, float]:
    position = imgui.get_mouse_pos()
    return position.x, position.y
