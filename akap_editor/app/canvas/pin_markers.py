"""Draws the pins and the markers of the active tool over the drawing, under the panels."""

import math

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.camera import Point
from ...editor.document.pin import Pin
from ...editor.editor import Editor
from ...editor.mirroring import active_mirror
from ...editor.session.session import Session
from ...editor.tools.base import BrushCircle, Crosshair, Markers, RotationRing
from ...editor.tools.rotate import RING_RADIUS
from ...editor.tools.scale import scale_handle
from ...words import number_text
from ..app_state import AppState
from ..theme import ACCENT, DARK, packed
from ..timeline.motion_paths import draw_motion_paths
from .legend import draw_plate
from .rig_markers import draw_cuts, draw_joints

_WHITE = (1.0, 1.0, 1.0, 1.0)
_DASH, _GAP = 9.0, 6.0  # of the axis of the mirror, design points
_UP = -math.pi / 2  # direction of the ring's handle at angle 0
_HORIZONTAL, _VERTICAL, _RISING, _FALLING = (1, 0), (0, 1), (1, -1), (1, 1)  # strokes of + and ×
_PLUS, _MINUS, _TIMES = (_HORIZONTAL, _VERTICAL), (_HORIZONTAL,), (_FALLING, _RISING)


def draw_markers(state: AppState, scale: float) -> None:
    """Draw the pins, joints and motion paths, if they are shown, and the markers of the active tool."""
    editor, session = state.editor, state.editor.session
    if session is None:
        return
    draw_joints(state, scale)
    draw_cuts(state, scale)
    draw_motion_paths(state, scale)
    draw, markers = imgui.get_background_draw_list(), editor.tool.markers
    draw.push_clip_rect(ImVec2(*editor.canvas[:2]), ImVec2(*editor.canvas[2:]))
    if state.view.show_pins and "h" not in editor.held and not state.timeline.playback.is_playing:
        _draw_mirror(draw, editor, session, markers, scale)
        _draw_pins(draw, editor, session, markers, scale)
        if markers.new_pin is not None:
            _draw_new_pin(draw, markers.new_pin, scale)
        for number, center in enumerate(markers.suggested_pins):
            is_hovered = number == markers.hovered_suggestion
            _draw_suggestion(draw, center, scale, is_hovered, is_hovered and markers.removes_hovered_pin)
        if markers.ring is not None:
            _draw_ring(draw, markers.ring, scale, session.supports_scales)
    if markers.brush is not None:
        _draw_brush(draw, markers.brush, scale)
    if markers.crosshair is not None:
        _draw_crosshair(draw, markers.crosshair, editor.canvas, scale)
    if markers.selection_box is not None:
        low, high = (ImVec2(*corner) for corner in markers.selection_box)
        draw.add_rect_filled(low, high, packed(ACCENT, 0.12))
        draw.add_rect(low, high, packed(ACCENT, 0.9))
    draw.pop_clip_rect()


def draw_pin(
    draw: imgui.ImDrawList, center: Point, scale: float, selected: bool = False, hovered: bool = False
) -> None:
    """Draw a pin: a dot in a white ring in a dark ring, which contrasts with any picture."""
    position = ImVec2(*center)
    radius = (8.0 if hovered else 7.0) * scale
    draw.add_circle_filled(position, radius + 1.5 * scale, packed(DARK, 0.75))
    draw.add_circle_filled(position, radius, packed(_WHITE))
    draw.add_circle_filled(position, radius - 2.2 * scale, packed(ACCENT if selected else DARK))


def _draw_pins(
    draw: imgui.ImDrawList, editor: Editor, session: Session, markers: Markers, scale: float
) -> None:
    centers = editor.pins_on_screen()
    for pin in session.state.pins:
        if pin.is_hidden:
            continue
        center = centers[pin.id]
        if pin.id in markers.pin_targets:
            ends = ImVec2(*center), ImVec2(*markers.pin_targets[pin.id])
            draw.add_line(*ends, packed(ACCENT, 0.4), 1.0 * scale)
        draw_pin(draw, center, scale, pin.id in editor.selection, pin.id == markers.hovered_pin)
        if pin.is_locked:
            _draw_lock(draw, center)
        _draw_pin_values(draw, pin, center, scale, session.supports_rotation)
        if pin.id == markers.hovered_pin and markers.removes_hovered_pin:
            _draw_sign(draw, center, 4.0 * scale, scale, _TIMES)


def _draw_mirror(
    draw: imgui.ImDrawList, editor: Editor, session: Session, markers: Markers, scale: float
) -> None:
    """Draw the axis of a mirror that is on, or the one that is being drawn, and rings around partners."""
    if markers.mirror_axis is not None:
        _draw_axis(draw, editor, *markers.mirror_axis, scale, 1.0)
        return
    mirror = active_mirror(session)
    if mirror is None:
        return
    start = editor.camera.to_screen((mirror.x, mirror.y))
    end = start[0] + math.cos(mirror.angle), start[1] + math.sin(mirror.angle)
    _draw_axis(draw, editor, start, end, scale, 0.75)
    centers = editor.pins_on_screen()
    shown = {pin.id for pin in session.state.pins if not pin.is_hidden}
    for pin in editor.selection:
        partner = mirror.partner(pin)
        if partner in shown and partner not in editor.selection and partner is not None:
            center = ImVec2(*centers[partner])
            draw.add_circle(center, 11.5 * scale, packed(DARK, 0.6), 0, 3.5 * scale)
            draw.add_circle(center, 11.5 * scale, packed(ACCENT), 0, 1.8 * scale)


def _draw_axis(
    draw: imgui.ImDrawList, editor: Editor, start: Point, end: Point, scale: float, strength: float
) -> None:
    """Draw the line through two points of the screen across the whole canvas, in dashes."""
    left, top, right, bottom = editor.canvas
    length = math.hypot(end[0] - start[0], end[1] - start[1])
    if length == 0:
        return
    dx, dy = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    reach = math.hypot(right - left, bottom - top) + math.hypot(start[0] - left, start[1] - top)
    step, at = (_DASH + _GAP) * scale, -reach
    while at < reach:
        x, y = start[0] + at * dx, start[1] + at * dy
        if left - step <= x <= right + step and top - step <= y <= bottom + step:
            ends = ImVec2(x, y), ImVec2(x + _DASH * scale * dx, y + _DASH * scale * dy)
            draw.add_line(*ends, packed(DARK, 0.5 * strength), 3.0 * scale)
            draw.add_line(*ends, packed(_WHITE, strength), 1.2 * scale)
        at += step


def _draw_lock(draw: imgui.ImDrawList, center: Point) -> None:
    """Draw a small padlock on a pin."""
    imgui.push_font(None, 0.55 * imgui.get_style().font_size_base)
    size = imgui.calc_text_size(icons.ICON_FA_LOCK)
    corner = ImVec2(center[0] - size.x / 2, center[1] - size.y / 2)
    draw.add_text(corner, packed(_WHITE), icons.ICON_FA_LOCK)
    imgui.pop_font()


def _draw_pin_values(
    draw: imgui.ImDrawList, pin: Pin, center: Point, scale: float, supports_rotation: bool
) -> None:
    """Draw a tick at the held angle, paler if the method ignores it, and the depth if it is not 0."""
    if pin.angle is not None:
        ends = _on_circle(center, pin.angle, 5.0 * scale), _on_circle(center, pin.angle, 14.0 * scale)
        draw.add_line(*ends, packed(DARK, 0.75), 5.0 * scale)
        draw.add_line(*ends, packed(_WHITE, 1.0 if supports_rotation else 0.5), 2.2 * scale)
    if pin.depth:
        middle = center[1] - 0.5 * imgui.calc_text_size("0").y
        _draw_label(draw, (center[0] + 12 * scale, middle), f"{pin.depth:+d}", (4.0, 1.0), scale)


def _draw_new_pin(draw: imgui.ImDrawList, center: Point, scale: float) -> None:
    """Draw the outline of the pin that a click would add."""
    position = ImVec2(*center)
    draw.add_circle(position, 7.5 * scale, packed(DARK, 0.5), 0, 3.0 * scale)
    draw.add_circle(position, 7.5 * scale, packed(_WHITE, 0.9), 0, 1.5 * scale)
    _draw_sign(draw, center, 3.0 * scale, scale, _PLUS)


def _draw_suggestion(
    draw: imgui.ImDrawList, center: Point, scale: float, is_hovered: bool, is_removed: bool
) -> None:
    """Draw the ghost of a pin: a plus, or a cross, on a dark disc in a ring, seen on any picture."""
    position, radius = ImVec2(*center), (9.0 if is_hovered else 8.0) * scale
    draw.add_circle_filled(position, radius + 2.0 * scale, packed(DARK, 0.75))
    draw.add_circle(position, radius, packed(ACCENT), 0, 2.0 * scale)
    _draw_sign(draw, center, 3.5 * scale, scale, _TIMES if is_removed else _PLUS)


def _draw_scale_handle(draw: imgui.ImDrawList, ring: RotationRing, scale: float) -> None:
    """Draw the square by which the drawing around a pin is scaled."""
    x, y = scale_handle(ring, scale)
    is_dragged = ring.handle_radius is not None
    if is_dragged:
        draw.add_line(ImVec2(*ring.center), ImVec2(x, y), packed(DARK, 0.6), 4.0 * scale)
        draw.add_line(ImVec2(*ring.center), ImVec2(x, y), packed(ACCENT), 1.6 * scale)
    for size, color in ((5.5, packed(DARK, 0.75)), (4.0, packed(ACCENT if is_dragged else _WHITE))):
        low, high = ImVec2(x - size * scale, y - size * scale), ImVec2(x + size * scale, y + size * scale)
        draw.add_rect_filled(low, high, color, 1.0 * scale)


def _draw_ring(draw: imgui.ImDrawList, ring: RotationRing, scale: float, has_scale: bool) -> None:
    """Draw the ring of a pin with its handles; while it is dragged, also its angle or scale as a number.

    has_scale: whether the method can scale the drawing.
    """
    center, radius = ImVec2(*ring.center), RING_RADIUS * scale
    color = packed(ACCENT if ring.is_dragged else _WHITE)
    draw.add_circle(center, radius, packed(DARK, 0.6), 64, 4.5 * scale)
    draw.add_circle(center, radius, packed(_WHITE, 0.85), 64, 1.8 * scale)
    if ring.is_dragged:
        ends = sorted((_UP, _UP + max(-2 * math.pi, min(ring.angle, 2 * math.pi))))
        draw.path_arc_to(center, radius, ends[0], ends[1], 64)
        draw.path_stroke(color, 3.0 * scale)
    handle = _on_circle(ring.center, ring.angle, radius)
    draw.add_circle_filled(handle, 6.0 * scale, packed(DARK, 0.75))
    draw.add_circle_filled(handle, 4.5 * scale, color)
    if has_scale:
        _draw_scale_handle(draw, ring, scale)
    if ring.is_dragged or ring.scale is not None:
        degrees = round(math.degrees(ring.angle), 1) + 0.0  # + 0.0 turns -0.0 into 0.0
        text = f"{number_text(degrees, '+.1f')}°"
        if ring.scale is not None:
            text = f"{100 * ring.scale:.0f} %"
        left = ring.center[0] - imgui.calc_text_size(text).x / 2 - 6 * scale
        _draw_label(draw, (left, ring.center[1] + radius + 14 * scale), text, (6.0, 2.0), scale)


def _draw_brush(draw: imgui.ImDrawList, brush: BrushCircle, scale: float) -> None:
    """Draw the rim of the brush, the inner circle of full strength, and a + or − in the middle."""
    center = ImVec2(*brush.center)
    draw.add_circle(center, brush.radius, packed(DARK, 0.6), 0, 3.0 * scale)
    draw.add_circle(center, brush.radius, packed(_WHITE, 0.9), 0, 1.4 * scale)
    draw.add_circle(center, brush.radius / 2, packed(_WHITE, 0.35), 0, 1.0 * scale)
    _draw_sign(draw, brush.center, 3.5 * scale, scale, _MINUS if brush.erases else _PLUS)


def _draw_crosshair(
    draw: imgui.ImDrawList, crosshair: Crosshair, canvas: tuple[float, float, float, float], scale: float
) -> None:
    """Draw four arms around the center, and thin lines from them to the edges of the canvas."""
    (x, y), (left, top, right, bottom) = crosshair.center, canvas
    inner, outer = crosshair.gap, crosshair.gap + 18 * scale
    for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        start = ImVec2(x + inner * dx, y + inner * dy)
        end = ImVec2(x + outer * dx, y + outer * dy)
        edge = ImVec2((right if dx > 0 else left) if dx else x, (bottom if dy > 0 else top) if dy else y)
        draw.add_line(end, edge, packed(DARK, 0.35), 3.0 * scale)
        draw.add_line(end, edge, packed(_WHITE, 0.45), 1.0 * scale)
        draw.add_line(start, end, packed(DARK, 0.8), 5.0 * scale)
        draw.add_line(start, end, packed(ACCENT), 2.4 * scale)


def _on_circle(center: Point, angle: float, radius: float) -> ImVec2:
    """The point of a circle around a pin at an angle of the pin (radians)."""
    direction = _UP + angle
    return ImVec2(center[0] + radius * math.cos(direction), center[1] + radius * math.sin(direction))


def _draw_label(
    draw: imgui.ImDrawList, corner: Point, text: str, padding: tuple[float, float], scale: float
) -> None:
    """Draw text on a dark plate. corner: left edge of the plate and top of the text."""
    across, along = padding[0] * scale, padding[1] * scale
    draw_plate(draw, ImVec2(corner[0] + across, corner[1]), text, ImVec2(across, along))


def _draw_sign(
    draw: imgui.ImDrawList,
    center: Point,
    size: float,
    scale: float,
    strokes: tuple[tuple[int, int], ...],
) -> None:
    """Draw a sign of straight strokes through the center, white with a dark rim."""
    x, y = center
    for color, width in ((packed(DARK, 0.7), 3.5 * scale), (packed(_WHITE), 1.6 * scale)):
        for dx, dy in strokes:
            ends = ImVec2(x - size * dx, y - size * dy), ImVec2(x + size * dx, y + size * dy)
            draw.add_line(*ends, color, width)
