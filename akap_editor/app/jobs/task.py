"""Long work, done in slices between frames, so that a dialog shows its progress and can cancel it."""

import time
from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from typing import NamedTuple

from ...words import mark

SLICE = 0.03  # seconds of work between two frames
LATE_SECONDS = 0.4  # until the dialog of work that is usually short appears


class Progress(NamedTuple):
    """How far a task is.

    share: of the work that is done, 0 to 1; text: what is being done; is_blocked: whether the task can only
    go on when a thread is done, which then wakes the window.
    """

    share: float = 0.0
    text: str = mark("Beginning ...")
    is_blocked: bool = False


START = Progress()
Steps = Generator[Progress, None, None]


@dataclass(eq=False)
class Task:
    """Work that the window shows in a dialog.

    title: of the dialog; steps: the work, yields its progress often; finish_early: ends the work with the
    result so far, None if that makes no sense; is_shown_late: whether the dialog waits for `LATE_SECONDS`;
    blocks_at_once: whether the task takes all input even before its dialog appears.
    """

    title: str
    steps: Steps
    finish_early: Callable[[], None] | None = None
    progress: Progress = START
    is_shown_late: bool = False
    blocks_at_once: bool = True
    _started: float = field(default_factory=time.perf_counter)

    @property
    def seconds_until_shown(self) -> float:
        """Time until the dialog is to appear; 0 from then on."""
        if not self.is_shown_late:
            return 0.0
        return max(self._started + LATE_SECONDS - time.perf_counter(), 0.0)

    @property
    def is_blocking(self) -> bool:
        """Whether nothing else can be done now."""
        return self.blocks_at_once or self.seconds_until_shown == 0

    def advance(self, seconds: float = SLICE) -> bool:
        """Work for ``seconds`` or until blocked; whether the task is done. Raises what the work raises."""
        end = time.perf_counter() + seconds
        while True:
            try:
                self.progress = next(self.steps)
            except StopIteration:
                return True
            if self.progress.is_blocked or time.perf_counter() >= end:
                return False

    def cancel(self) -> None:
        """End the work without a result; everything stays as it was."""
        self.steps.close()
