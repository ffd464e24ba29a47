"""What the canvas shows of angles that pins hold, of the ring that turns them, brush and crosshair."""

import math

from imgui_bundle import ImVec2, imgui

from ...editor.camera import Point
from ...editor.editor import Editor
from ...editor.tools.keyboard_pointer import KeyboardPointer
from ...editor.tools.rotate import RING, RotatingPin, ring_pin
from ..theme import ACCENT, DARK, packed

_WHITE = (1.0, 1.0, 1.0, 1.0)
_UP = -math.pi / 2  # where the handle of a pin is that is not turned


def _beside(center: Point, angle: float, radius: float) -> ImVec2:
    direction = _UP + angle
    return ImVec2(center[0] + radius * math.cos(direction), center[1] + radius * math.sin(direction))


def draw_held_angle(draw: imgui.ImDrawList, center: Point, scale: float, angle: float, counts: bool) -> None:
    """A tick on a pin's rim at the angle (radians) that it holds; paler where the method does not care."""
    ends = _beside(center, angle, 5.0 * scale), _beside(center, angle, 14.0 * scale)
    draw.add_line(*ends, packed(DARK, 0.75), 5.0 * scale)
    draw.add_line(*ends, packed(_WHITE, 1.0 if counts else 0.5), 2.2 * scale)


def draw_ring(draw: imgui.ImDrawList, editor: Editor, scale: float) -> None:
    """The ring of the pin at hand, its handle at the angle of the pin, which is shown while it turns."""
    pin, session = ring_pin(editor), editor.session
    if pin is None or session is None:
        return
    place, turning = editor.pins_on_screen()[pin], isinstance(editor.tool, RotatingPin)
    held = session.state.pin(pin).angle
    angle = session.pin_angle(pin) if held is None else held
    center, radius = ImVec2(*place), RING * scale
    color = packed(ACCENT if turning else _WHITE)
    draw.add_circle(center, radius, packed(DARK, 0.6), 64, 4.5 * scale)
    draw.add_circle(center, radius, packed(_WHITE, 0.85), 64, 1.8 * scale)
    if turning:
        ends = sorted((_UP, _UP + max(-2 * math.pi, min(angle, 2 * math.pi))))
        draw.path_arc_to(center, radius, ends[0], ends[1], 64)
        draw.path_stroke(color, 3.0 * scale)
    handle = _beside(place, angle, radius)
    draw.add_circle_filled(handle, 6.0 * scale, packed(DARK, 0.75))
    draw.add_circle_filled(handle, 4.5 * scale, color)
    if turning:
        text = f"{round(math.degrees(angle), 1) + 0.0:+.1f}°"
        size = imgui.calc_text_size(text)
        low = ImVec2(place[0] - size.x / 2 - 6 * scale, place[1] + radius + 12 * scale)
        high = ImVec2(low.x + size.x + 12 * scale, low.y + size.y + 4 * scale)
        draw.add_rect_filled(low, high, packed(DARK, 0.8), 4 * scale)
        draw.add_text(ImVec2(low.x + 6 * scale, low.y + 2 * scale), packed(_WHITE), text)


def draw_brush(draw: imgui.ImDrawList, editor: Editor, scale: float) -> None:
    """The rim of the brush around the pointer, and the inner circle in which it works fully."""
    if (
        editor.session is None
        or editor.chosen_tool != "brush"
        or editor.pans_on_drag
        or editor.pointer is None
    ):
        return
    center, radius = ImVec2(*editor.pointer), editor.brush.radius * scale
    draw.add_circle(center, radius, packed(DARK, 0.6), 0, 3.0 * scale)
    draw.add_circle(center, radius, packed(_WHITE, 0.9), 0, 1.4 * scale)
    draw.add_circle(center, radius / 2, packed(_WHITE, 0.35), 0, 1.0 * scale)
    sign = 3.5 * scale
    for dx, dy in ((1, 0),) if editor.brush.erasing else ((1, 0), (0, 1)):
        start = ImVec2(center.x - sign * dx, center.y - sign * dy)
        end = ImVec2(center.x + sign * dx, center.y + sign * dy)
        draw.add_line(start, end, packed(DARK, 0.7), 3.5 * scale)
        draw.add_line(start, end, packed(_WHITE), 1.6 * scale)


def draw_crosshair(draw: imgui.ImDrawList, editor: Editor, scale: float) -> None:
    """Four arms around the place that it points at, which stays free; thin lines lead to them."""
    if not isinstance(editor.tool, KeyboardPointer):
        return
    (x, y), (left, top, right, bottom) = editor.tool.place, editor.canvas
    inner = 13 * scale
    if editor.chosen_tool == "brush":
        inner = max(inner, editor.brush.radius * scale + 3 * scale)
    outer = inner + 18 * scale
    for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        start = ImVec2(x + inner * dx, y + inner * dy)
        end = ImVec2(x + outer * dx, y + outer * dy)
        edge = ImVec2((right if dx > 0 else left) if dx else x, (bottom if dy > 0 else top) if dy else y)
        draw.add_line(end, edge, packed(DARK, 0.35), 3.0 * scale)
        draw.add_line(end, edge, packed(_WHITE, 0.45), 1.0 * scale)
        draw.add_line(start, end, packed(DARK, 0.8), 5.0 * scale)
        draw.add_line(start, end, packed(ACCENT), 2.4 * scale)
