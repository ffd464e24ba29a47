"""The trails of the pins: the paths that they took in the last gesture."""

import numpy as np

from ..geometry.validation import Floats
from .session.session import Session

_MIN_MOVE = 1.0  # pixels: a shorter movement adds no point to a trail
_MAX_POINTS = 2000  # of one trail


class Trails:
    """The positions of each pin since the beginning of the last gesture."""

    def __init__(self) -> None:
        self._trails: dict[int, list[tuple[float, float]]] = {}

    def clear(self) -> None:
        """Remove all trails: a gesture begins, or the pose changed at once."""
        self._trails.clear()

    def follow(self, session: Session) -> None:
        """Add the current positions of the pins."""
        for pin, (x, y) in zip(session.state.pins, session.pin_positions().tolist(), strict=True):
            trail = self._trails.setdefault(pin.id, [(x, y)])
            if np.hypot(x - trail[-1][0], y - trail[-1][1]) >= _MIN_MOVE and len(trail) < _MAX_POINTS:
                trail.append((x, y))

    def segments(self) -> Floats:
        """The line segments (s, 2, 2) of all trails, drawing pixels."""
        trails = [trail for trail in self._trails.values() if len(trail) > 1]
        segments = [np.stack([trail[:-1], trail[1:]], axis=1) for trail in trails]
        return np.concatenate(segments) if segments else np.zeros((0, 2, 2))
