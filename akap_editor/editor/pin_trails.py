"""The ways that pins went in the last gesture."""

import numpy as np

from ..geometry.validation import Floats
from .session.session import Session

_STEP = 1.0  # pixels: a shorter way adds nothing to a trail
_MOST = 2000  # places of one trail


class Trails:
    """Where each pin was, from the beginning of the last gesture on."""

    def __init__(self) -> None:
        self._paths: dict[int, list[tuple[float, float]]] = {}

    def clear(self) -> None:
        """A new gesture begins, or the pose jumped."""
        self._paths.clear()

    def follow(self, session: Session) -> None:
        """Note where the pins are now."""
        for pin, (x, y) in zip(session.state.pins, session.pin_positions().tolist(), strict=True):
            path = self._paths.setdefault(pin.id, [(x, y)])
            if np.hypot(x - path[-1][0], y - path[-1][1]) >= _STEP and len(path) < _MOST:
                path.append((x, y))

    def segments(self) -> Floats:
        """(s, 2, 2): the pieces of all trails, drawing pixels."""
        pieces = [np.stack([path[:-1], path[1:]], axis=1) for path in self._paths.values() if len(path) > 1]
        return np.concatenate(pieces) if pieces else np.zeros((0, 2, 2))
