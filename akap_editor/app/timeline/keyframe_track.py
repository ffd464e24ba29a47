"""The track of the keyframes: a ruler, a diamond for each keyframe and the playhead, all for the mouse."""

from itertools import pairwise
from math import ceil
from typing import Literal

from imgui_bundle import ImVec2, ImVec4, imgui

from ...editor.animation.keyframe_playback import KeyframePlayback
from ...editor.animation.keyframe_times import stretch_times
from ...editor.animation.playback import VisibleRange
from ...editor.document.easing import easing_label
from ...words import number_text, tr
from .. import widgets
from ..app_state import AppState
from ..theme import ACCENT, DARK, FRAME, SECONDARY, STRONG_LINE, TEXT, packed
from .keyframe_menus import draw_keyframe_menu
from .timeline import snap_time
from .track import (
    MARK_REACH,
    TimeScale,
    draw_range_marks,
    draw_visible_part,
    mark_at_pointer,
    zoom_with_wheel,
)

POSE_PAYLOAD = "pose"  # the type of what is dragged when a thumbnail of a pose is
# Design points from the top: the ruler's end, the middle of the diamonds, the top of the marks, the bottom.
_RULER, _DIAMONDS, _MARKS, _BOTTOM = 16, 28, 39, 48
_GRIP_DISTANCE, _GRIP_REACH = 12, 4  # from the first and the last selected keyframe to the grips beside them
_DRAG_DISTANCE = 3  # design points: a press that moves less is a click
_TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0, 600.0)  # seconds
_MIN_TICK_DISTANCE = 52  # design points


class KeyframeTrack:
    """Draws the track; the mouse moves playhead, range marks and keyframes."""

    def __init__(self) -> None:
        self._dragged: Literal["start", "end", "playhead", "keyframes", "edge", "box", "nothing"] = "playhead"
        self._pressed_time = 0.0  # of the keyframe, the edge or the place that was pressed
        self._selected_before: frozenset[float] = frozenset()  # before the box was drawn

    def draw(self, state: AppState, scale: float) -> TimeScale:
        """Draw one frame and return the scale of its time. scale: points per design point."""
        playback = state.timeline.keyframe_playback
        label = time_label(playback)
        duration = number_text(playback.duration, ".2f")
        longest = f"{duration}* / {duration} s"
        label_width = max(imgui.calc_text_size(each).x for each in (label, longest)) + 12 * scale
        corner, height = imgui.get_cursor_screen_pos(), _BOTTOM * scale
        width = max(imgui.get_content_region_avail().x - label_width, 40 * scale)
        margin = MARK_REACH * scale
        time_scale = TimeScale(corner.x + margin, width - 2 * margin, playback.visible_range)
        imgui.invisible_button("##keys", ImVec2(width, height))
        state.run_reporting_errors(lambda: self._handle_mouse(state, time_scale, corner.y, scale))
        if imgui.is_item_hovered() and not imgui.is_item_active():
            _show_tooltip(playback, time_scale, scale)
            zoom_with_wheel(playback.visible_range, time_scale)
        _accept_pose(state, time_scale)
        draw = imgui.get_window_draw_list()
        draw.push_clip_rect(corner, ImVec2(corner.x + width, corner.y + height), True)
        _draw_ruler(playback.visible_range, time_scale, corner, width, scale)
        if playback.duration > 0:
            start, end = (time_scale.x(mark) for mark in playback.played_range)
            draw_range_marks(start, end, corner.y + (_BOTTOM - 1) * scale, scale)
        _draw_keyframes(playback, time_scale, corner.y + _DIAMONDS * scale, scale)
        if self._dragged == "box" and imgui.is_item_active():
            box = time_scale.x(self._pressed_time), imgui.get_mouse_pos().x
            low, high = (
                ImVec2(min(box), corner.y + _RULER * scale),
                ImVec2(max(box), corner.y + _MARKS * scale),
            )
            draw.add_rect_filled(low, high, packed(ACCENT, 0.25))
        _draw_playhead(playback, time_scale, corner.y, scale)
        draw.pop_clip_rect()
        label_y = corner.y + (height - imgui.get_text_line_height()) / 2
        imgui.set_cursor_screen_pos(ImVec2(corner.x + width + 12 * scale, label_y))
        imgui.text_colored(ImVec4(*SECONDARY), label)
        if "*" in label:
            widgets.show_tooltip(
                tr("* The pose on the canvas is not the animation's at this time. K keeps it there.")
            )
        return time_scale

    def _handle_mouse(self, state: AppState, time_scale: TimeScale, top: float, scale: float) -> None:
        """Press, drag and release on the track, Escape during a drag, and the context menu."""
        playback = state.timeline.keyframe_playback
        if playback.is_dragging and imgui.is_key_pressed(imgui.Key.escape, False):
            playback.drop_keyframes(keep=False)
            self._dragged = "nothing"
        if imgui.is_item_activated():
            self._press(state, time_scale, top, scale)
        if imgui.is_item_active():
            self._drag(playback, time_scale, scale)
        if imgui.is_item_deactivated():
            playback.drop_keyframes()
        if imgui.is_item_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.right):
            _select_at_pointer(playback, time_scale, scale)
            imgui.open_popup("key menu")
        if state.timeline.keyframe_menu_requested:
            state.timeline.keyframe_menu_requested = False
            time = min(playback.selected, default=playback.time)
            # above the track, so that the keyframe stays visible
            imgui.set_next_window_pos(ImVec2(time_scale.x(time), top - 8 * scale), pivot=ImVec2(0, 1))
            imgui.open_popup("key menu")
        if imgui.begin_popup("key menu"):
            draw_keyframe_menu(state)
            imgui.end_popup()

    def _press(self, state: AppState, time_scale: TimeScale, top: float, scale: float) -> None:
        """Decide what is dragged from here; select the keyframe under the pointer, if any.

        A double click beside the keyframes adds one.
        """
        playback, pointer = state.timeline.keyframe_playback, imgui.get_mouse_pos()
        if pointer.y - top > _MARKS * scale and playback.duration > 0:
            mark = mark_at_pointer(playback.played_range, time_scale, MARK_REACH * scale)
            if mark is not None:
                self._dragged = mark
                return
        time, is_in_ruler = _time_at_pointer(playback, time_scale, scale), pointer.y - top < _RULER * scale
        edge = None if is_in_ruler else _edge_at_pointer(playback, time_scale, scale)
        if edge is not None:
            self._dragged, self._pressed_time = "edge", edge
            return
        if time is None and not is_in_ruler and imgui.get_io().key_shift:
            self._dragged, self._pressed_time = "box", time_scale.time(pointer.x)
            self._selected_before = playback.selected
            return
        if time is None or is_in_ruler:
            self._dragged = "playhead"
            playback.selected = frozenset()
            if imgui.is_mouse_double_clicked(0) and not is_in_ruler:
                state.editor.select(())
                playback.set_keyframe(snap_time(time_scale.time(pointer.x)))
            return
        self._dragged, self._pressed_time = "keyframes", time
        state.editor.select(())
        if imgui.get_io().key_shift:
            playback.selected ^= {time}
        elif time not in playback.selected:
            playback.selected = frozenset({time})
        playback.scrub(time)

    def _drag(self, playback: KeyframePlayback, time_scale: TimeScale, scale: float) -> None:
        """Move what was pressed to the pointer; times snap, except those of the playhead with Alt."""
        time, moves_freely = time_scale.time(imgui.get_mouse_pos().x), imgui.get_io().key_alt
        if self._dragged == "start" or self._dragged == "end":
            playback.mark_range(**{self._dragged: snap_time(time)})
        elif self._dragged == "playhead" and not imgui.is_mouse_double_clicked(0):
            playback.scrub(time if moves_freely else snap_time(time))
        elif self._dragged == "box":
            low, high = sorted((self._pressed_time, time))
            inside = {each for each in playback.stored_animation.times if low <= each <= high}
            playback.selected = self._selected_before | inside
        elif self._dragged in ("keyframes", "edge") and playback.selected:
            self._drag_keyframes(playback, time_scale, scale)

    def _drag_keyframes(self, playback: KeyframePlayback, time_scale: TimeScale, scale: float) -> None:
        """Move the selected keyframes by the length of the drag; copy them with Ctrl, stretch with Alt.

        An edge of the selection stretches, too.
        """
        distance, io = imgui.get_mouse_drag_delta(0, 0.0).x, imgui.get_io()
        if abs(distance) < _DRAG_DISTANCE * scale and not playback.is_dragging:
            return
        time = max(snap_time(self._pressed_time + time_scale.seconds(distance)), 0.0)
        if io.key_alt or self._dragged == "edge":
            several = len(playback.selected) > 1
            stretched = playback.selected if several else playback.stored_animation.times
            playback.drag_keyframes(stretch_times(stretched, self._pressed_time, time))
        else:
            shift = max(time - self._pressed_time, -min(playback.selected))
            moves = {selected: selected + shift for selected in playback.selected}
            playback.drag_keyframes(moves, copy=io.key_ctrl)


def time_label(playback: KeyframePlayback) -> str:
    """The time of the playhead, and the duration if there is one; * for a pose without a keyframe."""
    time = number_text(playback.time, ".2f") + "*" * playback.shows_unkeyed_pose
    if not playback.animation.keyframes:
        return f"{time} s"
    return f"{time} / {number_text(playback.duration, '.2f')} s"


def _time_at_pointer(playback: KeyframePlayback, time_scale: TimeScale, scale: float) -> float | None:
    """The time of the keyframe under the pointer; None if there is none."""
    x = imgui.get_mouse_pos().x
    time = min(playback.animation.times, key=lambda each: abs(time_scale.x(each) - x), default=None)
    return time if time is not None and abs(time_scale.x(time) - x) <= MARK_REACH * scale else None


def _edge_at_pointer(playback: KeyframePlayback, time_scale: TimeScale, scale: float) -> float | None:
    """The time of the first or the last selected keyframe if the grip beside it is under the pointer."""
    if len(playback.selected) > 1:
        x = imgui.get_mouse_pos().x
        for time, direction in ((min(playback.selected), -1), (max(playback.selected), 1)):
            if abs(time_scale.x(time) + direction * _GRIP_DISTANCE * scale - x) <= _GRIP_REACH * scale:
                return time
    return None


def _select_at_pointer(playback: KeyframePlayback, time_scale: TimeScale, scale: float) -> None:
    """Move the playhead to the pointer; select the keyframe there unless it is among the selected ones."""
    time = _time_at_pointer(playback, time_scale, scale)
    playback.scrub(snap_time(time_scale.time(imgui.get_mouse_pos().x)) if time is None else time)
    if time is None or time not in playback.selected:
        playback.selected = frozenset() if time is None else frozenset({time})


def _show_tooltip(playback: KeyframePlayback, time_scale: TimeScale, scale: float) -> None:
    if _edge_at_pointer(playback, time_scale, scale) is not None:
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        widgets.show_tooltip(tr("Drag to make the selected keyframes faster or slower"))
        return
    time = _time_at_pointer(playback, time_scale, scale)
    keyframe = next((each for each in playback.animation.keyframes if each.time == time), None)
    if keyframe is not None:
        easing = tr(easing_label(keyframe.ease or playback.animation.ease))
        widgets.show_tooltip(
            tr(
                "{time:.2f} s, {easing}. Drag to move, Ctrl-drag to copy, Alt-drag to stretch; "
                "right-click for more.",
                time=keyframe.time,
                easing=easing,
            )
        )


def _accept_pose(state: AppState, time_scale: TimeScale) -> None:
    """Set a keyframe where the thumbnail of a pose is dropped on the track."""
    if not imgui.begin_drag_drop_target():
        return
    payload, playback = imgui.accept_drag_drop_payload_py_id(POSE_PAYLOAD), state.timeline.keyframe_playback
    if payload is not None and state.document is not None:
        pose = state.document.state.poses[payload.data_id]
        time = snap_time(time_scale.time(imgui.get_mouse_pos().x))
        state.run_reporting_errors(lambda: playback.set_keyframe(time, pose.positions, pose.crossings))
        playback.scrub(time)
    imgui.end_drag_drop_target()


# -- drawing ------------------------------------------------------------------------------------------------


def _draw_ruler(
    visible_range: VisibleRange, time_scale: TimeScale, corner: ImVec2, width: float, scale: float
) -> None:
    """Draw the background, and ticks with their seconds."""
    draw, high = imgui.get_window_draw_list(), ImVec2(corner.x + width, corner.y + _BOTTOM * scale)
    draw.add_rect_filled(corner, high, packed(DARK), 5 * scale)
    font, size = imgui.get_font(), 0.8 * imgui.get_font_size()
    shortest = time_scale.seconds(_MIN_TICK_DISTANCE * scale)
    tick = next((seconds for seconds in _TICKS if seconds >= shortest), _TICKS[-1])
    form = ".1f" if tick < 1 else ".0f"
    first = ceil(visible_range.start / tick - 1e-6)
    last = int((visible_range.start + visible_range.seconds) / tick + 1e-6)
    for number in range(first, last + 1):
        x = time_scale.x(number * tick)
        top, bottom = corner.y + (_RULER - 4) * scale, corner.y + _RULER * scale
        draw.add_line(ImVec2(x, top), ImVec2(x, bottom), packed(STRONG_LINE))
        if x + 24 * scale < high.x:
            text_corner = ImVec2(x + 3 * scale, corner.y + 1 * scale)
            draw.add_text(font, size, text_corner, packed(SECONDARY), number_text(number * tick, form))
    draw_visible_part(visible_range, corner, width, scale)


def _draw_keyframes(playback: KeyframePlayback, time_scale: TimeScale, middle: float, scale: float) -> None:
    """Draw a bar for each motion between two keyframes, a thin one for a hold; then the diamonds."""
    draw, keyframes = imgui.get_window_draw_list(), playback.animation.keyframes
    start, end = playback.played_range
    for keyframe, following in pairwise(keyframes):
        holds = (keyframe.ease or playback.animation.ease) == "hold"
        half = (0.8 if holds else 3) * scale
        is_played = start <= keyframe.time and following.time <= end
        low = ImVec2(time_scale.x(keyframe.time), middle - half)
        high = ImVec2(time_scale.x(following.time), middle + half)
        draw.add_rect_filled(low, high, packed(ACCENT, 0.5) if is_played else packed(FRAME))
    selected = playback.selected_in_drag
    for keyframe in keyframes:
        center, radius = ImVec2(time_scale.x(keyframe.time), middle), 8 * scale
        draw.add_ngon_filled(center, radius + 1.5 * scale, packed(DARK), 4)
        draw.add_ngon_filled(center, radius, packed(ACCENT if keyframe.time in selected else TEXT), 4)
    if len(selected) > 1:
        for time, direction in ((min(selected), -1), (max(selected), 1)):
            x, half = time_scale.x(time) + direction * _GRIP_DISTANCE * scale, 7 * scale
            low, high = ImVec2(x - 2 * scale, middle - half), ImVec2(x + 2 * scale, middle + half)
            draw.add_rect_filled(low, high, packed(ACCENT), 2 * scale)


def _draw_playhead(playback: KeyframePlayback, time_scale: TimeScale, top: float, scale: float) -> None:
    """Draw the playhead, faint while the canvas shows the present pose instead of the one at its time."""
    draw, x, half = imgui.get_window_draw_list(), time_scale.x(playback.time), 5 * scale
    color = packed(TEXT) if playback.is_previewing else packed(SECONDARY, 0.6)
    draw.add_line(ImVec2(x, top), ImVec2(x, top + _BOTTOM * scale), color, 2 * scale)
    draw.add_triangle_filled(ImVec2(x - half, top), ImVec2(x + half, top), ImVec2(x, top + 1.4 * half), color)
