"""The easing of an interval between two keyframes as a curve with two handles, to be dragged."""

from itertools import pairwise

from imgui_bundle import ImVec2, imgui

from ...editor.animation.keyframe_playback import KeyframePlayback
from ...editor.document.easing import EasingCurve, curve_like, easing_curve, keyframe_easing_function
from ...editor.document.keyframes import Keyframe
from ..theme import ACCENT, DARK, SECONDARY, TEXT, packed
from .track import TimeScale

OVERSHOOT = 0.35  # of the motion, by which a curve may pass a pose here, on either side
_REACH = 10  # design points around a handle, as all sizes here
_POINTS = 48  # of a curve
_SNAP = 0.03  # a handle this near to the height of a pose is level with it


class EasingHandles:
    """Draws the curve of the selected interval and drags its handles.

    dragged: 0 or 1 while a handle is dragged, else None.
    """

    def __init__(self) -> None:
        self.dragged: int | None = None
        self._curve = curve_like("in-out")

    def press(self, playback: KeyframePlayback, area: "CurveArea", scale: float) -> bool:
        """Take the handle under the pointer; return whether there is one."""
        interval = selected_interval(playback)
        if interval is None:
            return False
        curve, pointer = self._shown_curve(playback, interval[0]), imgui.get_mouse_pos()
        if curve is None:
            return False
        for number, (x, y) in enumerate(((curve.x1, curve.y1), (curve.x2, curve.y2))):
            place = area.place(interval, x, y)
            if max(abs(place.x - pointer.x), abs(place.y - pointer.y)) <= _REACH * scale:
                self.dragged, self._curve = number, curve
                return True
        return False

    def drag(self, playback: KeyframePlayback, area: "CurveArea") -> None:
        """Move the handle to the pointer."""
        interval = selected_interval(playback)
        if interval is None or self.dragged is None:
            return
        x, y = area.share(interval, imgui.get_mouse_pos())
        x, y = min(max(x, 0.0), 1.0), min(max(y, -OVERSHOOT), 1 + OVERSHOOT)
        y = float(round(y)) if abs(y - round(y)) < _SNAP else y
        curve = self._curve
        moved = (
            EasingCurve(x, y, curve.x2, curve.y2)
            if self.dragged == 0
            else EasingCurve(curve.x1, curve.y1, x, y)
        )
        playback.drag_easing(interval[0].time, moved.name)

    def draw(self, playback: KeyframePlayback, area: "CurveArea", scale: float) -> None:
        """Draw the curve of the selected interval, and its handles."""
        interval = selected_interval(playback)
        if interval is None:
            return
        draw, name = imgui.get_window_draw_list(), playback.animation.easing_after(interval[0])
        curve = self._shown_curve(playback, interval[0])
        has_own_curve = easing_curve(name) is not None
        function = keyframe_easing_function(name) if curve is None or name != "smooth" else curve.value
        for number in range(_POINTS + 1):
            share = number / _POINTS
            draw.path_line_to(area.place(interval, share, function(share)))
        draw.path_stroke(packed(TEXT, 0.9 if has_own_curve else 0.5), 1.6 * scale)
        if curve is None:
            return
        ends = ((0.0, 0.0), (curve.x1, curve.y1)), ((1.0, 1.0), (curve.x2, curve.y2))
        for number, (end, handle) in enumerate(ends):
            low, high = area.place(interval, *end), area.place(interval, *handle)
            draw.add_line(low, high, packed(SECONDARY), 1.2 * scale)
            draw.add_circle_filled(high, 5.5 * scale, packed(DARK))
            draw.add_circle_filled(high, 4.2 * scale, packed(ACCENT if number == self.dragged else TEXT))

    def _shown_curve(self, playback: KeyframePlayback, start: Keyframe) -> EasingCurve | None:
        """The curve with the handles that are shown; None for a pose that is held."""
        name = playback.animation.easing_after(start)
        return None if name == "hold" else curve_like(name)


class CurveArea:
    """Converts between places on the screen and shares of the time and the motion of an interval.

    top, bottom: y coordinates between which a curve may be, in points.
    """

    def __init__(self, time_scale: TimeScale, top: float, bottom: float) -> None:
        self._time_scale = time_scale
        unit = (bottom - top) / (1 + 2 * OVERSHOOT)
        self._low, self._unit = bottom - OVERSHOOT * unit, unit

    def place(self, interval: tuple[Keyframe, Keyframe], x: float, y: float) -> ImVec2:
        """The place on the screen."""
        start, end = (self._time_scale.x(keyframe.time) for keyframe in interval)
        return ImVec2(start + x * (end - start), self._low - y * self._unit)

    def share(self, interval: tuple[Keyframe, Keyframe], place: ImVec2) -> tuple[float, float]:
        """The shares of the time and of the motion at a place."""
        start, end = (self._time_scale.x(keyframe.time) for keyframe in interval)
        return (place.x - start) / max(end - start, 1e-6), (self._low - place.y) / self._unit


def selected_interval(playback: KeyframePlayback) -> tuple[Keyframe, Keyframe] | None:
    """The interval after the first selected keyframe, or else that at the playhead; None if there is none."""
    keyframes = playback.animation.keyframes
    time = min(playback.selected_in_drag, default=playback.time)
    for start, end in pairwise(keyframes):
        if start.time <= time < end.time:
            return start, end
    return None
