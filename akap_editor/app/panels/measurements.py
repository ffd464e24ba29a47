"""Measures the pose and the work behind it, without ever costing a frame."""

import time
from collections import deque
from collections.abc import Callable

from ...editor.session.session import Session
from ...geometry.distortion import Distortion

SHARE = 0.1  # of the time that measuring may take while something moves
PAUSE = 0.25  # seconds: a longer time between two frames was a sleep, and counts for no rate
KEPT = 120  # measurements that are remembered
RECENT = 30  # frames and steps that rates are averaged over


class Measurements:
    """What was measured lately: the distortion of poses, and how long steps and frames took."""

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock
        self._begin(None)

    def _begin(self, session: Session | None) -> None:
        self._session = session
        self.distortion: Distortion | None = None
        self.areas: deque[float] = deque(maxlen=KEPT)
        self.angles: deque[float] = deque(maxlen=KEPT)
        self._steps: deque[float] = deque(maxlen=RECENT)
        self._frames: deque[float] = deque(maxlen=RECENT)
        self._pose: object = None
        self._step: object = None
        self._before = self._due = 0.0

    def look(self, session: Session, measure: Callable[[], Distortion | None]) -> None:
        """Once a frame: note what is new. While something moves, ``measure`` is called only now and then."""
        if session is not self._session:
            self._begin(session)
        now = self._clock()
        if 0 < now - self._before < PAUSE:
            self._frames.append(now - self._before)
        self._before = now
        if session.last_step is not None and session.last_step is not self._step:
            self._step = session.last_step
            self._steps.append(session.last_step.report.seconds)
        pose = session.state.positions
        if pose is self._pose or (session.is_moving and now < self._due):
            return
        self._pose, self.distortion = pose, measure()
        ended = self._clock()
        self._due = ended + (ended - now) / SHARE
        if self.distortion is not None:
            self.areas.append(self.distortion.area)
            self.angles.append(self.distortion.angle)

    @property
    def step_seconds(self) -> float | None:
        """Mean time of the last steps."""
        return sum(self._steps) / len(self._steps) if self._steps else None

    @property
    def frame_rate(self) -> float | None:
        """Frames per second, while there were any in a row."""
        return len(self._frames) / sum(self._frames) if self._frames else None
