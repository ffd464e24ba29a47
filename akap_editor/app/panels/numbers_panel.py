"""Live numbers of the pose and of the work behind it, in one small panel."""

from collections.abc import Sequence
from itertools import pairwise

from imgui_bundle import ImVec2, imgui

from ...render.overlays import Rgba
from .. import widgets
from ..app_state import AppState
from ..theme import FRAME, packed
from .measurements import KEPT

AREA_COLOR: Rgba = (0.45, 0.68, 1.0, 1.0)
ANGLE_COLOR: Rgba = (1.0, 0.71, 0.23, 1.0)
LEAST_RANGE = 0.01  # of the sparkline, so that rest is a flat line


def draw(state: AppState, scale: float) -> None:
    """How far the pose is from the rest pose, and how fast it got there."""
    session, measurements = state.editor.session, state.measurements
    assert session is not None
    measurements.look(session, state.measure)
    found = measurements.distortion
    assert found is not None
    _energy("E_area", found.area, AREA_COLOR, "How much areas change, on average over the drawing.", scale)
    _energy("E_angle", found.angle, ANGLE_COLOR, "How much shapes are sheared or stretched.", scale)
    _sparkline(((measurements.areas, AREA_COLOR), (measurements.angles, ANGLE_COLOR)), scale)
    worst = max(float(found.face_area.max()), float(found.face_angle.max()))
    text = f"{worst:.3f}" if found.flipped == 0 else f"{found.flipped} flipped"
    widgets.row("Worst face", text, "The area or angle measure of the triangle that is bent most; 2 is none.")
    widgets.row(
        "Pins off target", f"{session.pin_error():.2f} px", "How far the farthest pin is from its place."
    )
    step, rate = measurements.step_seconds, measurements.frame_rate
    widgets.row(
        "Step", "–" if step is None else f"{1000 * step:.1f} ms", "One solve and move of the drawing."
    )
    widgets.row(
        "Frames", "–" if rate is None else f"{rate:.0f} per s", "While something happens; else it rests."
    )


def _energy(name: str, value: float, color: Rgba, tooltip: str, scale: float) -> None:
    at, height = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
    center = ImVec2(at.x + 4 * scale, at.y + 0.55 * height)
    imgui.get_window_draw_list().add_circle_filled(center, 3.5 * scale, packed(color))
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 14 * scale)
    widgets.row(name, f"{value:.4f}", f"{tooltip} 2 is none.")


def _sparkline(lines: Sequence[tuple[Sequence[float], Rgba]], scale: float) -> None:
    """The measures since a while ago, from 2 at the bottom up to the largest of them."""
    at, width, height = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x, 34 * scale
    draw = imgui.get_window_draw_list()
    draw.add_rect_filled(at, ImVec2(at.x + width, at.y + height), packed(FRAME), 4 * scale)
    top = max((value for values, _ in lines for value in values if value < float("inf")), default=2.0)
    span, room = max(top - 2.0, LEAST_RANGE), height - 8 * scale
    for values, color in lines:
        points = [
            ImVec2(at.x + width * (index + KEPT - len(values)) / (KEPT - 1), y)
            for index, value in enumerate(values)
            for y in [at.y + height - 4 * scale - room * min(max(value - 2.0, 0.0) / span, 1.0)]
        ]
        for start, end in pairwise(points):
            draw.add_line(start, end, packed(color), 1.4 * scale)
    imgui.dummy(ImVec2(width, height))
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal):
        imgui.set_tooltip(f"E_area and E_angle, from 2 to {2.0 + span:.3f}")
