"""The base of what a timeline plays: a playhead, a range, and the part of the time that is visible."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from time import monotonic

from ...geometry.validation import Floats
from ..document.drawing import Drawing
from .frames import Frame
from .loose_motion import Crossed, Instant, LooseMotion, shown_frame

MIN_VISIBLE_SECONDS = 0.5


class VisibleRange:
    """The part of its time that a timeline shows: all of it, or less when it is zoomed in.

    start, seconds: beginning and length of that part; total: length of the whole time, which begins at 0.
    """

    def __init__(self, total: float) -> None:
        self.total = self.seconds = total
        self.start = 0.0

    @property
    def is_zoomed(self) -> bool:
        """Whether it is less than the whole time."""
        return self.seconds < self.total

    def fit(self, total: float) -> None:
        """Change the length of the whole time; a zoomed-in part keeps its place and length."""
        seconds = self.seconds if self.is_zoomed else total
        self.total = total
        self._show(self.start, seconds)

    def zoom(self, factor: float, time: float) -> None:
        """Zoom in by a factor; ``time`` keeps its place on the screen."""
        seconds = max(self.seconds / factor, min(MIN_VISIBLE_SECONDS, self.total))
        self._show(time - (time - self.start) / self.seconds * seconds, seconds)

    def pan(self, by: float) -> None:
        """Move by seconds, as far as the ends of the whole time."""
        self._show(self.start + by, self.seconds)

    def reveal(self, time: float) -> None:
        """Move a time into the middle unless it is visible."""
        if not self.start <= time <= self.start + self.seconds:
            self._show(time - self.seconds / 2, self.seconds)

    def _show(self, start: float, seconds: float) -> None:
        self.seconds = min(seconds, self.total)
        self.start = min(max(start, 0.0), self.total - self.seconds)


class Playback(ABC):
    """Shows a motion at any time and plays a range of it.

    time: of the playhead, in seconds; None while the present is shown. marked_range: start and end of the
    part that is played and exported; None for the whole motion. loop: whether playing starts over at the end.
    clock: returns seconds.
    """

    loop = True
    visible_range: VisibleRange

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self.time: float | None = None
        self.marked_range: tuple[float, float] | None = None
        self._loose: tuple[tuple[object, ...], LooseMotion] | None = None  # with the content that it is of
        self._last_update: float | None = None  # the clock at the last update while it plays

    @property
    @abstractmethod
    def duration(self) -> float:
        """Seconds from 0 to the end of the motion."""

    @property
    @abstractmethod
    def content(self) -> tuple[object, ...]:
        """What the poses depend on; equal as long as they are the same."""

    @abstractmethod
    def pose_at(self, time: float) -> tuple[Drawing, Floats]:
        """The drawing and its pose (n, 2) at a time; there must be a motion."""

    @abstractmethod
    def instant(self, time: float) -> Instant:
        """What is shown at a time without follow-through; there must be a motion."""

    @abstractmethod
    def crossed(self, time: float) -> Crossed:
        """A pose near that at a time, with its crossings; there must be a motion."""

    @abstractmethod
    def plain_frame(self, time: float) -> Frame:
        """The frame at a time without follow-through; there must be a motion."""

    @property
    def period(self) -> float | None:
        """Seconds after which the motion begins anew without a seam; None if it does not."""
        return None

    def loose_pose(self, time: float) -> Floats | None:
        """The pose (n, 2) at a time with follow-through; None if nothing swings then."""
        if self._loose is None or self._loose[0] != self.content:
            self._loose = self.content, LooseMotion(self.instant, self.period)
        return self._loose[1].pose(time)

    def frame(self, time: float) -> Frame:
        """The frame at a time, with follow-through; there must be a motion."""
        pose = self.loose_pose(time)
        if pose is None:
            return self.plain_frame(time)
        return shown_frame(self.instant(time).drawing, self.crossed(time), pose)

    @abstractmethod
    def scrub(self, time: float) -> None:
        """Move the playhead and show the pose there."""

    @property
    def is_playing(self) -> bool:
        """Whether the playhead moves with the clock."""
        return self._last_update is not None

    @property
    def playhead(self) -> float:
        """Time of the playhead, in seconds; the end while the present is shown."""
        return self.duration if self.time is None else self.time

    @property
    def played_range(self) -> tuple[float, float]:
        """Start and end of the part that is played and exported, seconds."""
        return self.marked_range or (0.0, self.duration)

    def stop_at(self, time: float) -> None:
        """Stop and move the playhead, to 0 at the earliest."""
        self._last_update = None
        self.scrub(max(time, 0.0))

    def toggle_playing(self) -> None:
        """Play from the playhead if it is in the range, otherwise from the start of the range; or stop."""
        start, end = self.played_range
        if self.is_playing:
            self.stop()
        elif end > start:
            is_inside = self.time is not None and start <= self.time < end
            self._last_update = self._clock()
            self.scrub(self.time if is_inside and self.time is not None else start)

    def stop(self) -> None:
        """Stop playing; the playhead stays."""
        self._last_update = None
        if self.time is not None:
            self.scrub(self.time)

    def advance(self) -> None:
        """Move the playhead by the time since the last call, if it plays; to be called once a frame."""
        if self._last_update is None or self.time is None:
            self._last_update = None
            return
        now = self._clock()
        time, (start, end) = self.time + now - self._last_update, self.played_range
        self._last_update = now
        if time < end:
            self.scrub(time)
        elif self.loop and end > start:
            self.scrub(start + (time - end) % (end - start))
        else:
            self._last_update = None
            self.scrub(end)

    def mark_range(self, start: float | None = None, end: float | None = None) -> None:
        """Change start or end of the range; an empty range means the whole motion."""
        low, high = self.played_range
        low = low if start is None else max(start, 0.0)
        high = high if end is None else min(end, self.duration)
        self.marked_range = (low, high) if low < high else None
