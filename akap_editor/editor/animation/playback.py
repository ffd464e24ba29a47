"""What all that can be played has in common: a moment that is looked at, a range, and time that passes."""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable

from .time_view import VisibleRange


class Playback(ABC):
    """at: the moment that is looked at, in seconds, None where none is; loop: whether playing starts over;
    cut: the part that is played and exported, all of it where None; view: the part that the timeline shows.
    """

    loop = True
    view: VisibleRange

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.at: float | None = None
        self.cut: tuple[float, float] | None = None
        self._played: float | None = None  # the clock at the last frame of playing

    @property
    @abstractmethod
    def duration(self) -> float:
        """Seconds from 0 to the end."""

    @abstractmethod
    def scrub(self, moment: float) -> None:
        """Show what is seen at a time."""

    @property
    def playing(self) -> bool:
        """Whether time passes."""
        return self._played is not None

    @property
    def range(self) -> tuple[float, float]:
        """What is played and exported, in seconds."""
        return self.cut or (0.0, self.duration)

    @property
    def position(self) -> float:
        """Where one is, in seconds; at the end where no moment is looked at."""
        return self.duration if self.at is None else self.at

    def look(self, moment: float) -> None:
        """Stop at a moment; before the start there is none."""
        self._played = None
        self.scrub(max(moment, 0.0))

    def play(self) -> None:
        """Play the range from where it is looked at, or from its start; stop where it plays."""
        start, end = self.range
        if self.playing:
            self.stop()
        elif end > start:
            inside = self.at is not None and start <= self.at < end
            self._played = self._clock()
            self.scrub(self.at if inside and self.at is not None else start)

    def stop(self) -> None:
        """Let no more time pass."""
        self._played = None
        if self.at is not None:
            self.scrub(self.at)

    def advance(self) -> None:
        """Let time pass; to be called once a frame."""
        if self._played is None or self.at is None:
            self._played = None
            return
        now = self._clock()
        moment, (start, end) = self.at + now - self._played, self.range
        self._played = now
        if moment < end:
            self.scrub(moment)
        elif self.loop and end > start:
            self.scrub(start + (moment - end) % (end - start))
        else:
            self._played = None
            self.scrub(end)

    def cut_to(self, start: float | None = None, end: float | None = None) -> None:
        """Change the range; an empty one is all there is."""
        low, high = self.range
        low = low if start is None else max(start, 0.0)
        high = high if end is None else min(end, self.duration)
        self.cut = (low, high) if low < high else None
