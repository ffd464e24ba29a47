"""Motion paths: where the selected pins are at each frame of the keyframes, drawn on the canvas."""

from collections.abc import Callable
from time import perf_counter

import numpy as np
from imgui_bundle import ImVec2, imgui

from ...editor.camera import Point
from ...editor.document.pin import pin_points
from ...editor.tools.base import distance
from ...geometry.mesh import MeshPoints
from ...geometry.validation import Floats
from ..app_state import AppState
from ..theme import ACCENT, DARK, packed

FPS = 24.0  # dots a second
_MOST_DOTS = 1000  # of a pin; longer animations have fewer a second
_SLICE = 0.008  # seconds of computing in a frame of the window
_REACH = 8.0  # design points around a key
_WHITE = (1.0, 1.0, 1.0, 1.0)


class MotionPaths:
    """Computes the paths beside the drawing of the window, a few poses in each frame.

    times: of the dots, seconds, those of keyframes among them; points: (s, k, 2) places of the selected pins
    in drawing pixels, at the times so far. clock: seconds.
    """

    def __init__(self, clock: Callable[[], float] = perf_counter) -> None:
        self._clock = clock
        self._content: tuple[object, ...] = ()
        self._mesh_points: MeshPoints | None = None
        self.times: list[float] = []
        self.points: list[Floats] = []

    @property
    def is_complete(self) -> bool:
        """Whether all dots are known."""
        return len(self.points) == len(self.times)

    def update(self, state: AppState) -> None:
        """Go on computing; the window is woken while there is more to do."""
        session, playback = state.editor.session, state.timeline.keyframe_playback
        if session is None:
            self._content, self.times, self.points = (), [], []
            return
        selected = [pin for pin in session.state.pins if pin.id in state.editor.selection]
        places = tuple((pin.face, pin.weights.tobytes()) for pin in selected)
        content = *playback.content, session.drawing, places
        if content != self._content:
            self._content, self.points = content, []
            self._mesh_points = pin_points(selected)
            self.times = dot_times(playback.animation.times) if selected else []
        end = self._clock() + _SLICE
        while not self.is_complete:
            pose = playback.pose(self.times[len(self.points)])
            assert pose is not None
            assert self._mesh_points is not None
            self.points.append(session.drawing.mesh.evaluate(self._mesh_points, pose))
            if self._clock() >= end:
                break
        if not self.is_complete:
            state.wake()


def dot_times(keyframe_times: tuple[float, ...]) -> list[float]:
    """The times of the dots: each frame from the first keyframe to the last one, and the keyframes."""
    if len(keyframe_times) < 2:
        return []
    first, last = keyframe_times[0], keyframe_times[-1]
    rate = min(FPS, _MOST_DOTS / (last - first))
    frames = first + np.arange(int((last - first) * rate + 1e-6) + 1) / rate
    return sorted({*frames.round(3).tolist(), *keyframe_times})


def grab_keyframe(state: AppState, position: Point) -> None:
    """If a key of a path is at a position of the screen, let the press that follows drag its pin.

    The playhead goes to the keyframe, which brings the pin to the position; the drag updates the keyframe.
    Of several keys there, the one at the playhead is taken, or else the nearest one.
    """
    editor, playback = state.editor, state.timeline.keyframe_playback
    if not _are_shown(state) or editor.is_busy or not editor.selection:
        return
    pin = editor.pin_at(position)
    if pin is not None and pin not in editor.selection:
        return
    paths = state.part(MotionPaths)
    near = []
    for time, points in zip(paths.times, paths.points, strict=False):
        if time in playback.animation.times:
            reach = min(distance(position, editor.camera.to_screen((x, y))) for x, y in points.tolist())
            if reach <= _REACH * editor.ui_scale:
                near.append((time != playback.time, reach, abs(time - playback.time), time))
    if near:
        playback.scrub(min(near)[-1])
        playback.auto_key.is_armed = True


def _are_shown(state: AppState) -> bool:
    if not state.view.show_motion_paths or not state.timeline.shows_keyframes:
        return False
    return not state.timeline.playback.is_playing and "h" not in state.editor.held


def draw_motion_paths(state: AppState, scale: float) -> None:
    """Draw the paths, if they are shown. scale: points per design point."""
    if not _are_shown(state):
        return
    paths, editor = state.part(MotionPaths), state.editor
    paths.update(state)
    if len(paths.points) < 2:
        return
    draw = imgui.get_background_draw_list()
    draw.push_clip_rect(ImVec2(*editor.canvas[:2]), ImVec2(*editor.canvas[2:]))
    keyed = set(state.timeline.keyframe_playback.animation.times)
    for path in np.stack(paths.points, axis=1).tolist():
        places = [ImVec2(*editor.camera.to_screen((x, y))) for x, y in path]
        for color, width in ((packed(DARK, 0.6), 3.5 * scale), (packed(_WHITE, 0.9), 1.5 * scale)):
            for place in places:
                draw.path_line_to(place)
            draw.path_stroke(color, width)
        for place, time in zip(places, paths.times, strict=False):
            if time not in keyed:
                draw.add_circle_filled(place, 2.6 * scale, packed(DARK, 0.8))
                draw.add_circle_filled(place, 1.8 * scale, packed(_WHITE))
        for place, time in zip(places, paths.times, strict=False):
            if time in keyed:
                draw.add_ngon_filled(place, 6.0 * scale, packed(DARK, 0.9), 4)
                draw.add_ngon_filled(place, 4.4 * scale, packed(ACCENT), 4)
    draw.pop_clip_rect()
