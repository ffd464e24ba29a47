"""What the tracks of the timeline have in common: the scale of time, the mouse wheel and the range marks."""

from typing import Literal

from imgui_bundle import ImVec2, imgui

from ...editor.animation.playback import VisibleRange
from ...editor.camera import ZOOM_STEP
from ..theme import ACCENT, SECONDARY, packed

RED = (0.93, 0.33, 0.31, 1.0)
MARK_REACH = 8  # design points: how near to a mark or a keyframe a press takes it
_PAN_STEP = 0.1  # of the visible part, for a notch of the wheel


class TimeScale:
    """Converts between times in seconds and places on a track in points of the screen.

    left, width: of the time on the track; visible_range: the times that it shows.
    """

    def __init__(self, left: float, width: float, visible_range: VisibleRange) -> None:
        self.left, self.width, self._visible_range = left, width, visible_range

    def x(self, time: float) -> float:
        """The x coordinate of a time; on an unzoomed track, times outside of it are at its ends."""
        share = (time - self._visible_range.start) / self._visible_range.seconds
        if not self._visible_range.is_zoomed:
            share = min(max(share, 0.0), 1.0)
        return self.left + self.width * share

    def seconds(self, length: float) -> float:
        """How many seconds ``length`` points of the track last."""
        return length / self.width * self._visible_range.seconds

    def time(self, x: float) -> float:
        """The time at an x coordinate, 0 or later; on a zoomed track, one that it shows."""
        share = (x - self.left) / self.width
        if self._visible_range.is_zoomed:
            share = min(max(share, 0.0), 1.0)
        return max(self._visible_range.start + share * self._visible_range.seconds, 0.0)


def zoom_with_wheel(visible_range: VisibleRange, scale: TimeScale) -> None:
    """Zoom about the time under the pointer; a sideways wheel or one with Shift pans."""
    io = imgui.get_io()
    pan = io.mouse_wheel if io.key_shift else -io.mouse_wheel_h
    if pan:
        visible_range.pan(-_PAN_STEP * visible_range.seconds * pan)
    elif io.mouse_wheel:
        visible_range.zoom(ZOOM_STEP**io.mouse_wheel, scale.time(imgui.get_mouse_pos().x))


def mark_at_pointer(
    played_range: tuple[float, float], scale: TimeScale, reach: float
) -> Literal["start", "end"] | None:
    """The mark of the range within ``reach`` points of the pointer, the nearer one of two."""
    x = imgui.get_mouse_pos().x
    to_start, to_end = (abs(scale.x(mark) - x) for mark in played_range)
    if min(to_start, to_end) >= reach:
        return None
    return "start" if to_start < to_end else "end"


def draw_visible_part(visible_range: VisibleRange, corner: ImVec2, width: float, scale: float) -> None:
    """Draw a line above a zoomed track that shows which part of the whole time is visible."""
    if visible_range.is_zoomed:
        ends = visible_range.start, visible_range.start + visible_range.seconds
        left, right = (corner.x + width * time / visible_range.total for time in ends)
        low, high = ImVec2(left, corner.y), ImVec2(right, corner.y + 2 * scale)
        imgui.get_window_draw_list().add_rect_filled(low, high, packed(SECONDARY), scale)


def draw_range_marks(start: float, end: float, bottom: float, scale: float) -> None:
    """Draw a triangle at either end of the range. start, end: x coordinates; bottom: y coordinate."""
    for x, direction in ((start, 1), (end, -1)):
        side = 8 * scale
        corners = ImVec2(x, bottom), ImVec2(x, bottom - side), ImVec2(x + direction * side, bottom)
        imgui.get_window_draw_list().add_triangle_filled(*corners, packed(ACCENT))
