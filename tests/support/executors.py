"""Executors that stand in for the window's threads."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any


class HeldExecutor(Executor):
    """Holds what is submitted until `work` runs it, so that a test decides when a result is there.

    count: of the jobs that were submitted so far; last: the future of the last one.
    """

    def __init__(self) -> None:
        self.jobs: list[tuple[Future[Any], Callable[[], Any]]] = []
        self.count = 0
        self.last: Future[Any] | None = None

    def submit(self, job: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.jobs.append((future, lambda: job(*args, **kwargs)))
        self.count, self.last = self.count + 1, future
        return future

    def work(self) -> None:
        """Run all jobs that are held."""
        jobs, self.jobs = self.jobs, []
        for future, job in jobs:
            try:
                future.set_result(job())
            except Exception as error:
                future.set_exception(error)
