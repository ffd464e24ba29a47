"""Files for other programs, made in a thread beside the window, which draws the pictures that they hold."""

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from queue import Empty, SimpleQueue
from typing import Any

from ...errors import InputError
from ...io.images import Picture
from ...io.painter import Painter

_WAIT = 0.01  # seconds

Job = Callable[[Painter], str]


class _MainThreadPainter:
    """Painter of the thread: OpenGL belongs to the window, which is asked and waited for."""

    def __init__(self) -> None:
        self.asked: SimpleQueue[tuple[tuple[Any, ...], Future[Picture]]] = SimpleQueue()
        self.closed = False

    def render(self, *arguments: Any) -> Picture:
        """See `Painter.render`. Raises InputError where the window is closed."""
        answer: Future[Picture] = Future()
        self.asked.put((arguments, answer))
        while not self.closed:
            try:
                return answer.result(timeout=_WAIT)
            except TimeoutError:
                continue
        raise InputError("the window was closed before the picture was drawn")


class PoseExportQueue:
    """Writes files one after the other. `advance` is called by the window between two frames."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, "writer")
        self._asking = _MainThreadPainter()
        self._jobs: deque[Future[str]] = deque()

    def begin(self, job: Job) -> None:
        """Do ``job(painter)`` beside the window; it returns a few words on what was written."""
        self._jobs.append(self._thread.submit(job, self._asking))

    @property
    def moving(self) -> bool:
        """Whether there is anything to be written."""
        return bool(self._jobs)

    @property
    def waiting(self) -> bool:
        """Whether the window is not needed for it at the moment."""
        return self.moving and not self._jobs[0].done() and self._asking.asked.empty()

    def advance(self, painter: Painter) -> str:
        """Draw what was asked for; a few words on a file that is written, or "". Raises what writing does."""
        try:
            arguments, answer = self._asking.asked.get_nowait()
        except Empty:
            pass
        else:
            try:
                answer.set_result(painter.render(*arguments))
            except Exception as error:  # is raised where the picture was asked for
                answer.set_exception(error)
        return self._jobs.popleft().result() if self.moving and self._jobs[0].done() else ""

    def finish(self, painter: Painter) -> None:
        """Until all is written. Raises what writing does."""
        while self.moving:
            self.advance(painter)
            time.sleep(_WAIT)

    def close(self) -> None:
        """What still needs a picture is not written."""
        self._asking.closed = True
        self._thread.shutdown(wait=False)
