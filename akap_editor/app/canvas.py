"""The part of the window where the drawing is: pointer in, pins out."""

from imgui_bundle import ImVec2, imgui

from ..editor.events import Button, KeyEvent, PointerEvent, ScrollEvent
from ..editor.tools import DraggingPin, Idle, PointingPin, RubberBand
from .theme import ACCENT, DARK, packed
from .workspace import Workspace

_BUTTONS: tuple[Button, ...] = ("left", "right", "middle")  # in ImGui's order
_WHITE = (1.0, 1.0, 1.0, 1.0)


class Canvas:
    """Turns what ImGui saw into editor events.

    Input is read from ImGui, not from the window system, so that its Test Engine can drag pins as well.
    """

    def __init__(self) -> None:
        self._last = (0.0, 0.0)

    def read_input(self, space: Workspace) -> None:
        """Pass this frame's pointer and keys on, unless a panel wants them."""
        io, editor = imgui.get_io(), space.editor
        if not io.want_text_input:
            self._read_keys(space)
        at = imgui.get_mouse_pos()
        position = (at.x, at.y)
        free = not io.want_capture_mouse
        idle = isinstance(editor.tool, Idle)
        inside = imgui.is_mouse_pos_valid()
        if inside and position != self._last and (free or not idle):
            self._last = position
            editor.handle_event(PointerEvent("move", position))
        if idle and not (free and inside):
            editor.pointer_left()
        for index, button in enumerate(_BUTTONS):
            if free and imgui.is_mouse_clicked(index):
                space.notice = ""
                editor.handle_event(PointerEvent("press", position, button, shift=io.key_shift))
            if imgui.is_mouse_released(index) and not isinstance(editor.tool, Idle):
                editor.handle_event(PointerEvent("release", position, button, shift=io.key_shift))
        if free and io.mouse_wheel:
            editor.handle_event(ScrollEvent(position, io.mouse_wheel))

    @staticmethod
    def let_go(space: Workspace) -> None:
        """End what is held half-way: its end goes to a dialog or another window and will not be seen here."""
        space.editor.cancel()
        space.editor.handle_event(KeyEvent("space", pressed=False))

    @staticmethod
    def _read_keys(space: Workspace) -> None:
        if imgui.is_key_pressed(imgui.Key.space, False):
            space.editor.handle_event(KeyEvent("space"))
        if imgui.is_key_released(imgui.Key.space):
            space.editor.handle_event(KeyEvent("space", pressed=False))
        if imgui.is_key_pressed(imgui.Key.escape, False):
            space.editor.handle_event(KeyEvent("escape"))

    @staticmethod
    def choose_cursor(space: Workspace) -> None:
        """The shape of the pointer says what a press would do."""
        editor = space.editor
        if imgui.get_io().want_capture_mouse:
            return
        if editor.hand:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_all)
        elif isinstance(editor.tool, (PointingPin, DraggingPin)) or editor.hovered_pin is not None:
            imgui.set_mouse_cursor(imgui.MouseCursor_.hand)

    @staticmethod
    def draw_overlay(space: Workspace, scale: float) -> None:
        """Pins, the pin that a click would add, and the selection box: over the drawing, under the panels."""
        editor, session = space.editor, space.editor.session
        if session is None:
            return
        draw = imgui.get_background_draw_list()
        draw.push_clip_rect(ImVec2(*editor.canvas[:2]), ImVec2(*editor.canvas[2:]))
        if space.show_pins:
            hovered = editor.hovered_pin if isinstance(editor.tool, Idle) else None
            targets = {pin.id: editor.camera.to_screen(tuple(pin.target)) for pin in session.state.pins}
            for pin, place in editor.pins_on_screen().items():
                if pin in editor.selection and isinstance(editor.tool, DraggingPin):
                    draw.add_line(ImVec2(*place), ImVec2(*targets[pin]), packed(ACCENT, 0.8), 1.5 * scale)
                _draw_pin(draw, place, scale, pin in editor.selection, pin == hovered)
            if editor.pointer is not None and editor.would_add_pin:
                center = ImVec2(*editor.pointer)
                draw.add_circle(center, 6.5 * scale, packed(DARK, 0.5), 0, 3.0 * scale)
                draw.add_circle(center, 6.5 * scale, packed(_WHITE, 0.8), 0, 1.5 * scale)
        if isinstance(editor.tool, RubberBand):
            corners = ImVec2(*editor.tool.start), ImVec2(*editor.tool.end)
            low = ImVec2(min(c.x for c in corners), min(c.y for c in corners))
            high = ImVec2(max(c.x for c in corners), max(c.y for c in corners))
            draw.add_rect_filled(low, high, packed(ACCENT, 0.12))
            draw.add_rect(low, high, packed(ACCENT, 0.9))
        draw.pop_clip_rect()


def _draw_pin(
    draw: imgui.ImDrawList, place: tuple[float, float], scale: float, selected: bool, hovered: bool
) -> None:
    """A dot in a white ring in a dark one, which stand out from any picture."""
    center = ImVec2(*place)
    radius = (8.0 if hovered else 7.0) * scale
    draw.add_circle_filled(center, radius + 1.5 * scale, packed(DARK, 0.75))
    draw.add_circle_filled(center, radius, packed(_WHITE))
    draw.add_circle_filled(center, radius - 2.2 * scale, packed(ACCENT if selected else DARK))
