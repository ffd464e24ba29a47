"""A thread that computes beside the window and wakes it when a result is there."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

Wake = Callable[[], None]  # makes the window's loop draw a frame; may be called from any thread


def no_window() -> None:
    """The `Wake` of a script or a test that has no window."""


class BackgroundThread(ThreadPoolExecutor):
    """An executor with one thread: jobs run one after the other, and each wakes the window when it is done.

    name: of the thread, for debuggers; wake: called in the thread after each job.
    """

    def __init__(self, name: str, wake: Wake) -> None:
        super().__init__(1, name)
        self._wake = wake

    def submit(self, job: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run ``job(*args, **kwargs)`` in the thread."""
        future = super().submit(job, *args, **kwargs)
        future.add_done_callback(lambda _: self._wake())
        return future
