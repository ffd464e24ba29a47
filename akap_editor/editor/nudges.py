"""Pins sent on by small ways, as arrow keys do; what is pressed in a row is one gesture."""

from collections.abc import Callable

from .session.edits import SetTargets
from .session.history import Entry
from .session.pin_edits import hold_pins
from .session.session import Session

SERIES_PAUSE = 1.0  # seconds: nudges in a row without a longer pause are one gesture


class Nudges:
    """Remembers the last nudge, so that the next one can join it. clock: in seconds."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._last: tuple[Entry | None, frozenset[int], float] | None = None  # entry, pins, time

    def move(self, session: Session, pins: frozenset[int], dx: float, dy: float) -> None:
        """Send pins so many pixels on."""
        now = self._clock()
        entry, moved_pins, when = self._last or (None, pins, now)
        joins = entry is not None and entry is session.history.last and moved_pins == pins
        session.begin("Nudge" if len(pins) == 1 else f"Nudge {len(pins)} pins")
        try:
            hold_pins(session)
            moved = (session.state.pin(pin) for pin in sorted(pins))
            targets = {pin.id: (pin.target[0] + dx, pin.target[1] + dy) for pin in moved}
            session.apply(SetTargets(targets))
        except Exception:
            session.abort()
            raise
        session.commit(join=joins and now - when < SERIES_PAUSE)
        self._last = session.history.last, pins, now
