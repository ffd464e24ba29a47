"""Tasks that compute in a thread of their own, so that the window goes on and can cancel them."""

from collections.abc import Callable
from concurrent.futures import Future
from threading import Thread
from typing import Generic, TypeVar

from ...errors import InputError
from ...progress import Cancelled, listening
from .background_thread import Wake, no_window
from .task import START, Progress, Steps, Task

T = TypeVar("T")


class BackgroundWork(Generic[T]):
    """A function that runs in a new thread. It hears of its cancellation where it announces its next stage.

    The thread is a daemon: work that was cancelled does not keep the program from ending. wake: called in the
    thread at each stage and at the end.
    """

    def __init__(self, name: str, work: Callable[[], T], wake: Wake = no_window) -> None:
        self._work, self._wake = work, wake
        self._result: Future[T] = Future()
        self._is_cancelled = False
        self.progress: Progress = START._replace(is_blocked=True)
        Thread(target=self._run, name=name, daemon=True).start()

    @property
    def is_done(self) -> bool:
        """Whether `result` returns at once."""
        return self._result.done()

    def result(self) -> T:
        """Wait for the end; what the function returns. Raises what it raises."""
        return self._result.result()

    def cancel(self) -> None:
        """End the work at its next stage; nobody is to ask for its result any more."""
        self._is_cancelled = True

    def _run(self) -> None:
        try:
            with listening(self._hear):
                result = self._work()
        except BaseException as error:  # raised again by `result`
            self._result.set_exception(error)
        else:
            self._result.set_result(result)
        self._wake()

    def _hear(self, share: float, text: str) -> None:
        if self._is_cancelled:
            raise Cancelled("cancelled")
        self.progress = Progress(share, text, is_blocked=True)
        self._wake()


def background_task(
    title: str,
    work: Callable[[], T],
    use: Callable[[T], None],
    wake: Wake = no_window,
    fail: Callable[[], None] = lambda: None,
) -> Task:
    """A task that runs ``work()`` in a thread, then passes its result to ``use`` between two frames.

    Its dialog appears after a moment, so that short work does not let it flash up. fail: called between two
    frames if the work raises InputError, which the task then raises.
    """

    def steps() -> Steps:
        job = BackgroundWork(title, work, wake)
        try:
            while not job.is_done:
                yield job.progress
            result = job.result()
        except InputError:
            fail()
            raise
        finally:
            job.cancel()
        use(result)

    return Task(title, steps(), is_shown_late=True)
