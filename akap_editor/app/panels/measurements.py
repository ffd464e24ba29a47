"""The Measurements section: distortion of the pose, distance of the pins, time of steps and frames."""

import time
from collections import deque
from collections.abc import Callable, Sequence
from itertools import pairwise

from imgui_bundle import ImVec2, imgui

from ...editor.session.session import Session
from ...geometry.distortion import Distortion
from ...render.overlays import Rgba
from ...words import number_text, tr
from .. import widgets
from ..app_state import AppState
from ..theme import SECONDARY, WELL, packed

MAX_SHARE = 0.1  # of the time may be spent on measuring while something moves
MAX_FRAME_SECONDS = 0.25  # a longer time between two frames was a sleep, and does not count for the rate
HISTORY_LENGTH = 120  # distortions in the sparkline
AVERAGED = 30  # frames and steps that rates are averaged over
AREA_COLOR: Rgba = (0.45, 0.68, 1.0, 1.0)
ANGLE_COLOR: Rgba = (1.0, 0.71, 0.23, 1.0)
MIN_SPAN = 0.01  # of the sparkline, so that the rest pose is a flat line
_UNDISTORTED = 2.0  # value of both energies without distortion


class Measurements:
    """What was measured lately in a session.

    distortion: of the last measured pose; areas, angles: the energies of the last poses, the oldest first.
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self._reset(None)

    def _reset(self, session: Session | None) -> None:
        self._session = session
        self.distortion: Distortion | None = None
        self.areas: deque[float] = deque(maxlen=HISTORY_LENGTH)
        self.angles: deque[float] = deque(maxlen=HISTORY_LENGTH)
        self._step_seconds: deque[float] = deque(maxlen=AVERAGED)
        self._frame_seconds: deque[float] = deque(maxlen=AVERAGED)
        self._pose: object = None
        self._step: object = None
        self._last_frame = self._next_measurement = 0.0

    def update(self, session: Session, measure: Callable[[], Distortion | None]) -> None:
        """Note what is new; to be called once a frame. During a motion, ``measure`` is rarely called."""
        if session is not self._session:
            self._reset(session)
        now = self._clock()
        if 0 < now - self._last_frame < MAX_FRAME_SECONDS:
            self._frame_seconds.append(now - self._last_frame)
        self._last_frame = now
        if session.last_step is not None and session.last_step is not self._step:
            self._step = session.last_step
            self._step_seconds.append(session.last_step.report.seconds)
        pose = session.state.positions
        if pose is self._pose or (session.is_moving and now < self._next_measurement):
            return
        self._pose, self.distortion = pose, measure()
        end = self._clock()
        self._next_measurement = end + (end - now) / MAX_SHARE
        if self.distortion is not None:
            self.areas.append(self.distortion.area)
            self.angles.append(self.distortion.angle)

    @property
    def step_seconds(self) -> float | None:
        """Mean time of the last steps."""
        return sum(self._step_seconds) / len(self._step_seconds) if self._step_seconds else None

    @property
    def frame_rate(self) -> float | None:
        """Frames per second, without the time that the window slept."""
        return len(self._frame_seconds) / sum(self._frame_seconds) if self._frame_seconds else None


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    session, measurements = state.editor.session, state.part(Measurements)
    assert session is not None
    measurements.update(session, state.measure_distortion)
    distortion = measurements.distortion
    assert distortion is not None
    area, angle = distortion.area, distortion.angle
    _draw_energy("E_area", area, AREA_COLOR, tr("Change of areas, averaged over the drawing."), scale)
    _draw_energy("E_angle", angle, ANGLE_COLOR, tr("Shear and stretch, averaged over the drawing."), scale)
    _draw_sparkline(((measurements.areas, AREA_COLOR), (measurements.angles, ANGLE_COLOR)), scale)
    worst = max(float(distortion.face_area.max()), float(distortion.face_angle.max()))
    flipped = distortion.flipped
    text = tr("{count} flipped", count=flipped) if flipped else number_text(worst, ".3f")
    widgets.row(
        tr("Worst face"), text, tr("E_area or E_angle of the most distorted triangle; 2 is undistorted.")
    )
    error = f"{number_text(session.pin_error(), '.2f')} px"
    widgets.row(tr("Pin error"), error, tr("Largest distance of a pin from its target."))
    step, rate = measurements.step_seconds, measurements.frame_rate
    step_text = "–" if step is None else f"{number_text(1000 * step, '.1f')} ms"
    widgets.row(tr("Step time"), step_text, tr("Time of one solver step."))
    rate_text = "–" if rate is None else tr("{rate:.0f} per s", rate=rate)
    widgets.row(tr("Frame rate"), rate_text, tr("While something moves; otherwise the window sleeps."))


def _draw_energy(name: str, value: float, color: Rgba, tooltip: str, scale: float) -> None:
    corner, height = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
    center = ImVec2(corner.x + 4 * scale, corner.y + 0.55 * height)
    imgui.get_window_draw_list().add_circle_filled(center, 3.5 * scale, packed(color))
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + 14 * scale)
    widgets.row(name, number_text(value, ".4f"), f"{tooltip} {tr('2 is undistorted.')}")


def _draw_sparkline(lines: Sequence[tuple[Sequence[float], Rgba]], scale: float) -> None:
    """Draw the last energies, from 2 at the bottom to the largest one."""
    corner, width, height = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x, 34 * scale
    draw = imgui.get_window_draw_list()
    draw.add_rect_filled(corner, ImVec2(corner.x + width, corner.y + height), packed(WELL), 4 * scale)
    if all(len(values) < 2 for values, _ in lines):
        hint = widgets.shortened(tr("Their curves, once a pin is dragged"), width - 16 * scale)
        place = ImVec2(corner.x + 8 * scale, corner.y + (height - imgui.get_text_line_height()) / 2)
        draw.add_text(place, packed(SECONDARY), hint)
    finite = (value for values, _ in lines for value in values if value < float("inf"))
    span = max(max(finite, default=_UNDISTORTED) - _UNDISTORTED, MIN_SPAN)
    plot_height = height - 8 * scale
    for values, color in lines:
        first, points = HISTORY_LENGTH - len(values), []
        for index, value in enumerate(values):
            share = min(max(value - _UNDISTORTED, 0.0) / span, 1.0)
            x = corner.x + width * (first + index) / (HISTORY_LENGTH - 1)
            points.append(ImVec2(x, corner.y + height - 4 * scale - plot_height * share))
        for start, end in pairwise(points):
            draw.add_line(start, end, packed(color), 1.4 * scale)
    imgui.dummy(ImVec2(width, height))
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal):
        imgui.set_tooltip(tr("E_area and E_angle, from 2 to {end:.3f}", end=_UNDISTORTED + span))
