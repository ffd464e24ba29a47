"""The track of the session: its time so far, with the played range, the current take and the playhead."""

from typing import Literal

from imgui_bundle import ImVec2, ImVec4, imgui

from ...editor.animation.session_playback import SessionPlayback
from ...words import number_text
from ..app_state import AppState
from ..theme import ACCENT, FRAME, SECONDARY, TEXT, packed
from .track import (
    MARK_REACH,
    RED,
    TimeScale,
    draw_range_marks,
    draw_visible_part,
    mark_at_pointer,
    zoom_with_wheel,
)

_HEIGHT = 28  # design points, as all sizes here
_MARGIN = 8  # at either end, so that the playhead can be pressed there
_MARKS_TOP = 0.6  # of the height: the marks are below


class SessionTrack:
    """Draws the track and lets the mouse move the playhead and the range marks."""

    def __init__(self) -> None:
        self._dragged: Literal["start", "end", "playhead"] = "playhead"

    def draw(self, state: AppState, scale: float) -> TimeScale:
        """Draw one frame and return the scale of its time. scale: points per design point."""
        playback = state.timeline.session_playback
        duration = number_text(playback.duration, ".1f")
        label = f"{number_text(playback.playhead, '.1f')} / {duration} s"
        label_width = imgui.calc_text_size(f"{duration} / {duration} s").x + 12 * scale
        corner, margin = imgui.get_cursor_screen_pos(), _MARGIN * scale
        width = max(imgui.get_content_region_avail().x - label_width, 40 * scale)
        height = _HEIGHT * scale
        imgui.invisible_button("##track", ImVec2(width, height))
        corner.x, width = corner.x + margin, width - 2 * margin
        playback.visible_range.fit(playback.duration or 1.0)
        time_scale = TimeScale(corner.x, width, playback.visible_range)
        self._handle_mouse(playback, time_scale, corner.y + _MARKS_TOP * height, scale)
        is_highlighted = imgui.is_item_active() or imgui.is_item_hovered()
        draw = imgui.get_window_draw_list()
        high = ImVec2(corner.x + width + margin, corner.y + height)
        draw.push_clip_rect(ImVec2(corner.x - margin, corner.y), high, True)
        _draw_content(playback, time_scale, corner, ImVec2(width, height), is_highlighted, scale)
        draw.pop_clip_rect()
        imgui.same_line(0, 12 * scale)
        imgui.align_text_to_frame_padding()
        imgui.text_colored(ImVec4(*SECONDARY), label)
        return time_scale

    def _handle_mouse(
        self, playback: SessionPlayback, time_scale: TimeScale, marks_top: float, scale: float
    ) -> None:
        """Move what is dragged to the pointer's time. marks_top: y coordinate below which marks are taken."""
        if imgui.is_item_hovered() and not imgui.is_item_active():
            zoom_with_wheel(playback.visible_range, time_scale)
        pointer = imgui.get_mouse_pos()
        if imgui.is_item_activated():
            mark = mark_at_pointer(playback.played_range, time_scale, MARK_REACH * scale)
            self._dragged = mark if mark is not None and pointer.y > marks_top else "playhead"
        if not imgui.is_item_active() or not playback.snapshots:
            return
        time = time_scale.time(pointer.x)
        if self._dragged == "playhead":
            playback.scrub(time)
        else:
            playback.mark_range(**{self._dragged: time})


def _draw_content(
    playback: SessionPlayback,
    time_scale: TimeScale,
    corner: ImVec2,
    size: ImVec2,
    is_highlighted: bool,
    scale: float,
) -> None:
    """Draw the bars of the whole time, the range and the take; then marks and playhead."""
    middle, bottom = corner.y + size.y / 2, corner.y + size.y
    start, end = (time_scale.x(mark) for mark in playback.played_range)
    draw_visible_part(playback.visible_range, corner, size.x, scale)
    _draw_bar(corner.x, corner.x + size.x, middle, scale, packed(FRAME))
    _draw_bar(start, end, middle, scale, packed(ACCENT, 0.55))
    draw_range_marks(start, end, bottom, scale)
    if playback.take_start is not None:
        take = time_scale.x(playback.take_start), time_scale.x(playback.duration)
        _draw_bar(*take, middle, scale, packed(RED))
    playhead = time_scale.x(playback.time if playback.time is not None else playback.visible_range.total)
    thickness = (2.5 if is_highlighted else 2) * scale
    top = ImVec2(playhead, corner.y)
    imgui.get_window_draw_list().add_line(top, ImVec2(playhead, bottom), packed(TEXT), thickness)


def _draw_bar(left: float, right: float, middle: float, scale: float, color: int) -> None:
    low, high = ImVec2(left, middle - 3 * scale), ImVec2(right, middle + 3 * scale)
    imgui.get_window_draw_list().add_rect_filled(low, high, color, 3 * scale)
