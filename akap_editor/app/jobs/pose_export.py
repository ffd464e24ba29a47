"""Pose exports: files for other programs, written in a thread while the window goes on."""

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from threading import Event, Lock
from typing import Any

from ...errors import InputError
from ...io.images import Picture
from ...io.painter import Painter
from ...words import tr
from .background_thread import BackgroundThread, Wake, no_window

Job = Callable[[Painter], str]


class _MainThreadPainter:
    """The painter of the thread: asks the main thread, which owns the OpenGL context, for each picture.

    notify: called in the thread after each request.
    """

    def __init__(self, notify: Wake) -> None:
        self._notify = notify
        self._lock = Lock()
        self._requests: deque[tuple[tuple[Any, ...], Future[Picture]]] = deque()
        self._is_closed = False

    def render(self, *arguments: Any) -> Picture:
        """Wait for the picture, see `Painter.render`. Raises InputError if the window is closed."""
        picture: Future[Picture] = Future()
        with self._lock:
            if self._is_closed:
                picture.set_exception(_window_closed())
            else:
                self._requests.append((arguments, picture))
        self._notify()
        return picture.result()

    def answer_request(self, painter: Painter) -> None:
        """In the main thread: draw the picture of the oldest request, if there is one."""
        with self._lock:
            if not self._requests:
                return
            arguments, picture = self._requests.popleft()
        try:
            picture.set_result(painter.render(*arguments))
        except Exception as error:  # raised again where the picture was requested
            picture.set_exception(error)

    def close(self) -> None:
        """Refuse all requests from now on, and those that wait."""
        with self._lock:
            self._is_closed = True
            refused, self._requests = self._requests, deque()
        for _, picture in refused:
            picture.set_exception(_window_closed())


def _window_closed() -> InputError:
    return InputError(tr("the window was closed before the picture was drawn"))


class PoseExportQueue:
    """Writes files one after the other, in a thread.

    The window calls `advance` between frames, because only the main thread can draw the pictures; ``wake`` is
    called when the thread requests one, and when a file is written.
    """

    def __init__(self, wake: Wake = no_window) -> None:
        self._wake = wake
        self._news = Event()  # a picture was requested, or a file written
        self._thread = BackgroundThread("pose export", self._notify)
        self._painter = _MainThreadPainter(self._notify)
        self._jobs: deque[Future[str]] = deque()

    def begin(self, job: Job) -> None:
        """Run ``job(painter)`` in the thread; it returns a few words on what was written."""
        self._jobs.append(self._thread.submit(job, self._painter))

    @property
    def is_busy(self) -> bool:
        """Whether a file has not been written yet."""
        return bool(self._jobs)

    def advance(self, painter: Painter) -> str:
        """Draw a picture that the thread has requested; take over a file that is written.

        Returns the words of its job, or "" if no file was finished. Raises the exception of the job.
        """
        self._painter.answer_request(painter)
        return self._jobs.popleft().result() if self._jobs and self._jobs[0].done() else ""

    def finish(self, painter: Painter) -> None:
        """Wait until all files are written. Raises the exception of a job; call it again for the others."""
        while self._jobs:
            self._news.clear()
            if not self.advance(painter) and self._jobs and not self._jobs[0].done():
                self._news.wait()

    def close(self) -> None:
        """End the thread; a job that still needs a picture fails."""
        self._painter.close()
        self._thread.shutdown(wait=False)

    def _notify(self) -> None:
        self._news.set()
        self._wake()
