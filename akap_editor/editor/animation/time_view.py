"""Which part of its time a timeline shows: all of it, or some of it from nearer by."""

SHORTEST = 0.5  # seconds


class VisibleRange:
    """start, seconds: of what is shown; whole: how long all of it is, from 0 on."""

    def __init__(self, whole: float) -> None:
        self.whole = self.seconds = whole
        self.start = 0.0

    @property
    def zoomed(self) -> bool:
        """Whether it is not all that is shown."""
        return self.seconds < self.whole

    def fit(self, whole: float) -> None:
        """Another length of all; what is shown of it stays, where it is not all."""
        seconds = self.seconds if self.zoomed else whole
        self.whole = whole
        self._show(self.start, seconds)

    def zoom(self, factor: float, around: float) -> None:
        """Show so many times less, where a moment stays in its place."""
        seconds = max(self.seconds / factor, min(SHORTEST, self.whole))
        self._show(around - (around - self.start) / self.seconds * seconds, seconds)

    def pan(self, by: float) -> None:
        """Show what is so many seconds later."""
        self._show(self.start + by, self.seconds)

    def reveal(self, moment: float) -> None:
        """Show a moment, in the middle if it is not seen already."""
        if not self.start <= moment <= self.start + self.seconds:
            self._show(moment - self.seconds / 2, self.seconds)

    def _show(self, start: float, seconds: float) -> None:
        self.seconds = min(seconds, self.whole)
        self.start = min(max(start, 0.0), self.whole - self.seconds)
