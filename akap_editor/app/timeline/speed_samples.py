"""Speeds of the selected pins, or of the drawing, over the time of a playback."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from ...editor.animation.playback import Playback
from ...editor.document.pin import pin_points
from ...geometry.mesh import MeshPoints
from ...geometry.validation import Floats
from ..app_state import AppState

_RATE = 60.0  # samples a second
_MOST_SAMPLES = 600  # longer motions have fewer a second
_SLICE = 0.006  # seconds of computing in a frame of the window


class SpeedSamples:
    """Computes speeds beside the drawing of the window, a few poses in each frame.

    times: of the samples, seconds; speeds: (k,) of the selected pins, or (1,) the root mean square of all
    vertices, drawing pixels a second, each between two times. pin_count: 0 for the drawing. highest: of all
    speeds, including those before the last change until the new ones are known. clock: seconds.
    """

    def __init__(self, clock: Callable[[], float] = perf_counter) -> None:
        self._clock = clock
        self._content: tuple[object, ...] = ()  # what the speeds depend on
        self._mesh_points: MeshPoints | None = None
        self._last: tuple[object, Floats] | None = None  # drawing and places at the last time
        self.times: list[float] = []
        self.speeds: list[Floats] = []
        self.pin_count = 0
        self.highest = 0.0

    @property
    def is_complete(self) -> bool:
        """Whether all speeds are known."""
        return len(self.speeds) >= len(self.times) - 1

    def update(self, state: AppState, playback: Playback) -> None:
        """Go on computing, but not during a gesture; the window is woken while there is more to do."""
        session = state.editor.session
        if session is None or playback.duration <= 0:
            self._content, self.times, self.speeds, self.highest = (), [], [], 0.0
            return
        if session.history.is_open:
            return
        selected = [pin for pin in session.present.pins if pin.id in state.editor.selection]
        places = tuple((pin.face, pin.weights.tobytes()) for pin in selected)
        content = playback, *playback.content, places
        if content != self._content:
            self._content, self._last, self.speeds = content, None, []
            self._mesh_points, self.pin_count = pin_points(selected), len(selected)
            self.times = sample_times(playback.duration)
        end = self._clock() + _SLICE
        while not self.is_complete:
            self._add(playback)
            if self._clock() >= end:
                break
        highest = max((float(each.max()) for each in self.speeds), default=0.0)
        self.highest = highest if self.is_complete else max(highest, self.highest)
        if not self.is_complete:
            state.wake()

    def _add(self, playback: Playback) -> None:
        """Compute the speed before the next time. Another mesh appears at once: its speed is 0."""
        if self._last is None:
            self._last = self._places(playback, self.times[0])
        before, here = self._last, self._places(playback, self.times[len(self.speeds) + 1])
        if before[0] is here[0]:
            seconds = self.times[len(self.speeds) + 1] - self.times[len(self.speeds)]
            lengths = np.linalg.norm(here[1] - before[1], axis=1) / seconds
        else:
            lengths = np.zeros(max(self.pin_count, 1))
        speed = lengths if self.pin_count else np.sqrt((lengths**2).mean(keepdims=True))
        self.speeds.append(speed)
        self._last = here

    def _places(self, playback: Playback, time: float) -> tuple[object, Floats]:
        drawing, pose = playback.pose_at(time)
        assert self._mesh_points is not None
        mesh = drawing.mesh
        fits = int(self._mesh_points.faces.max(initial=-1)) < len(mesh.faces)
        if self.pin_count and fits:
            return drawing, mesh.evaluate(self._mesh_points, pose)
        return drawing, pose if not self.pin_count else np.zeros((self.pin_count, 2))


def sample_times(duration: float) -> list[float]:
    """The times between which speeds are computed, seconds, from 0 to the end of the motion."""
    count = max(2, int(min(_RATE * duration, _MOST_SAMPLES)))
    return np.linspace(0.0, duration, count + 1).tolist()
