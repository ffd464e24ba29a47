"""The graph below a track: speeds over time, and the easing of the selected interval with its handles."""

from itertools import pairwise

import numpy as np
from imgui_bundle import ImVec2, imgui

from ...editor.animation.keyframe_playback import KeyframePlayback
from ...editor.animation.playback import Playback
from ...words import tr, tr_plural
from .. import widgets
from ..app_state import AppState
from ..theme import ACCENT, DARK, SECONDARY, TEXT, packed
from .easing_handles import CurveArea, EasingHandles, selected_interval
from .speed_samples import SpeedSamples
from .timeline import snap_time
from .track import MARK_REACH, TimeScale, zoom_with_wheel

_HEIGHT, _MIN_HEIGHT = 104, 52  # design points, as all sizes here; the lowest one has room for the title
_OTHER_HEIGHT = 340  # of canvas and panels, before the graph gets lower
_MARGIN = 6  # above and below the curve
_PIN_COLORS = (
    (0.43, 0.66, 1.0, 1.0),
    (1.0, 0.62, 0.25, 1.0),
    (0.45, 0.85, 0.55, 1.0),
    (0.95, 0.5, 0.75, 1.0),
    (0.75, 0.62, 1.0, 1.0),
)


def height(scale: float) -> float:
    """The height of the graph in points, less in a low window. scale: points per design point."""
    room = imgui.get_main_viewport().size.y / scale - _OTHER_HEIGHT
    return float(min(max(room, _MIN_HEIGHT), _HEIGHT) * scale)


class SpeedGraph:
    """Draws the graph; a press selects an interval and moves the playhead, handles change its easing."""

    def __init__(self) -> None:
        self._samples = SpeedSamples()
        self._handles = EasingHandles()

    def draw(self, state: AppState, time_scale: TimeScale, top: float, scale: float) -> None:
        """Draw one frame. time_scale: of the track; top: y coordinate; scale: points per design point."""
        playback = state.timeline.playback
        self._samples.update(state, playback)
        margin = MARK_REACH * scale
        corner, width = ImVec2(time_scale.left - margin, top), time_scale.width + 2 * margin
        bottom = top + height(scale)
        imgui.set_cursor_screen_pos(corner)
        imgui.invisible_button("##speed", ImVec2(width, bottom - top))
        area = CurveArea(time_scale, top + _MARGIN * scale, bottom - _MARGIN * scale)
        if imgui.is_item_hovered():
            zoom_with_wheel(playback.visible_range, time_scale)
        state.run_reporting_errors(lambda: self._handle_mouse(state, playback, time_scale, area, scale))
        draw = imgui.get_window_draw_list()
        draw.push_clip_rect(corner, ImVec2(corner.x + width, bottom), True)
        draw.add_rect_filled(corner, ImVec2(corner.x + width, bottom), packed(DARK), 5 * scale)
        self._draw_speeds(time_scale, top + _MARGIN * scale, bottom - _MARGIN * scale, scale)
        if isinstance(playback, KeyframePlayback):
            _draw_key_lines(playback, time_scale, top, bottom, scale)
            self._handles.draw(playback, area, scale)
        x = time_scale.x(playback.playhead)
        draw.add_line(ImVec2(x, top), ImVec2(x, bottom), packed(TEXT, 0.8), 1.5 * scale)
        draw.pop_clip_rect()
        self._draw_title(top, scale)

    def _handle_mouse(
        self, state: AppState, playback: Playback, time_scale: TimeScale, area: CurveArea, scale: float
    ) -> None:
        """Take a handle, or select the interval under the pointer and move the playhead."""
        keys = playback if isinstance(playback, KeyframePlayback) else None
        time, handles = time_scale.time(imgui.get_mouse_pos().x), self._handles
        if imgui.is_item_activated() and keys is not None and not handles.press(keys, area, scale):
            keys.selected = frozenset()
            keys.scrub(time)
            interval = selected_interval(keys)
            keys.selected = frozenset() if interval is None else frozenset({interval[0].time})
        if keys is not None and handles.dragged is not None:
            if imgui.is_key_pressed(imgui.Key.escape, False):
                handles.dragged = None
                keys.drop_keyframes(keep=False)
            elif imgui.is_item_active():
                handles.drag(keys, area)
            else:
                handles.dragged = None
                keys.drop_keyframes()
        elif imgui.is_item_active() and playback.duration > 0 and not imgui.is_item_activated():
            playback.scrub(time if keys is None or imgui.get_io().key_alt else snap_time(time))
        elif imgui.is_item_hovered():
            self._show_tooltip(time)

    def _show_tooltip(self, time: float) -> None:
        speeds, times = self._samples.speeds, self._samples.times
        index = int(np.searchsorted(times, time)) - 1
        if 0 <= index < len(speeds):
            values = " ".join(f"{value:.0f}" for value in speeds[index].tolist())
            widgets.show_tooltip(
                tr(
                    "{time:.2f} s: {values} px/s. Click an interval for the handles of its easing.",
                    time=time,
                    values=values,
                )
            )

    def _draw_speeds(self, time_scale: TimeScale, top: float, bottom: float, scale: float) -> None:
        samples = self._samples
        if not samples.speeds:
            return
        speeds = np.array(samples.speeds)
        unit = (bottom - top) / max(samples.highest, 1.0)
        draw, times = imgui.get_window_draw_list(), samples.times
        for number, column in enumerate(speeds.T.tolist()):
            color = _PIN_COLORS[number % len(_PIN_COLORS)]
            xs = [time_scale.x((times[k] + times[k + 1]) / 2) for k in range(len(column))]
            points = [ImVec2(x, bottom - unit * speed) for x, speed in zip(xs, column, strict=True)]
            if speeds.shape[1] == 1:
                for a, b in pairwise(points):
                    corners = a, b, ImVec2(b.x, bottom), ImVec2(a.x, bottom)
                    draw.add_quad_filled(*corners, packed(color, 0.22))
            for point in points:
                draw.path_line_to(point)
            draw.path_stroke(packed(color), 1.8 * scale)

    def _draw_title(self, top: float, scale: float) -> None:
        """Write whose speed it is, and the highest one, left of the graph."""
        samples = self._samples
        count = samples.pin_count
        imgui.set_cursor_screen_pos(ImVec2(imgui.get_window_pos().x + 10 * scale, top + 2 * scale))
        imgui.begin_group()
        if count:
            text = tr_plural("Speed of {count} pin", "Speed of {count} pins", count)
        else:
            text = tr("Speed of the drawing")
        widgets.secondary_text(text)
        widgets.secondary_text(
            tr("up to {speed:.0f} px/s", speed=samples.highest)
            if samples.times
            else tr("There is no motion yet")
        )
        imgui.end_group()


def _draw_key_lines(
    playback: KeyframePlayback, time_scale: TimeScale, top: float, bottom: float, scale: float
) -> None:
    """Draw a line at each keyframe."""
    draw, selected = imgui.get_window_draw_list(), playback.selected_in_drag
    for time in playback.animation.times:
        x, is_selected = time_scale.x(time), time in selected
        color = packed(ACCENT, 0.9) if is_selected else packed(SECONDARY, 0.45)
        draw.add_line(ImVec2(x, top), ImVec2(x, bottom), color, scale)
        draw.add_ngon_filled(ImVec2(x, bottom - 5 * scale), 4 * scale, color, 4)
