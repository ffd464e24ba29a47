"""Work that takes seconds: done in slices between frames, so that one sees how far it is and can stop it."""

import time
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import NamedTuple

SLICE = 0.03  # seconds of work between two frames


class Progress(NamedTuple):
    """share: of the work that is done, 0 to 1; text: what is being done."""

    share: float = 0.0
    text: str = "Beginning ..."


BEGINNING = Progress()
Steps = Generator[Progress, None, None]


@dataclass(eq=False)
class Task:
    """title: of the dialog; steps: the work; enough: ends it with what there is so far, if that makes sense.

    A task that is stopped leaves all as it was: its generator is closed.
    """

    title: str
    steps: Steps
    enough: Callable[[], None] | None = None
    progress: Progress = BEGINNING

    def advance(self, seconds: float = SLICE) -> bool:
        """Work for so long; whether it is done. Raises what the work raises."""
        until = time.perf_counter() + seconds
        while True:
            try:
                self.progress = next(self.steps)
            except StopIteration:
                return True
            if time.perf_counter() >= until:
                return False

    def cancel(self) -> None:
        """Stop."""
        self.steps.close()
