"""Encodes shots to a file in a thread, while the window draws more of them."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from queue import Full, Queue
from typing import Protocol

from ...errors import InputError
from ...io.animation.formats import Shot
from ...io.atomic import Write, write_atomic
from ...progress import listening
from ...words import tr
from .background_thread import BackgroundThread, Wake, no_window

_MOST_QUEUED = 8  # pictures that may wait to be encoded: bounds the memory


class Export(Protocol):
    """Reads all shots, encodes them, and writes them with ``write``; a few words on what was written."""

    def __call__(self, *, shots: Iterable[Shot], write: Write) -> str: ...


class FrameEncoder:
    """Runs an export in a thread and hands it the pictures one after the other.

    wake: called in the thread when there is room for another picture, and when the file is written. `close`
    must be called in the end; if the file is not written by then, it never is.
    """

    def __init__(self, export: Export, wake: Wake = no_window) -> None:
        self._wake = wake
        self._queue: Queue[Shot | None] = Queue(_MOST_QUEUED)
        self._is_cancelled = False
        self._thread = BackgroundThread("encoder", wake)
        self._encoded = 0.0
        self._written = self._thread.submit(self._run, export)

    def take(self, picture: Shot | None) -> Iterator[None]:
        """Add a picture, or None after the last one; yields as long as the queue is full.

        Drops the picture if the export has ended, for example with an error.
        """
        while not self._written.done():
            try:
                self._queue.put_nowait(picture)
            except Full:
                yield
            else:
                return

    def finish(self) -> Iterator[None]:
        """End the pictures; yields until the file is written."""
        yield from self.take(None)
        while not self._written.done():
            yield

    @property
    def encoded(self) -> float:
        """The share of the encoding that is done after the last picture, 0 to 1."""
        return self._encoded

    @property
    def said(self) -> str:
        """A few words on the file. Raises the exception of the export."""
        return self._written.result()

    def close(self) -> None:
        """End the thread; cancels the export if the file is not written."""
        self._is_cancelled = not self._written.done()
        next(self.take(None), None)  # if the queue is full, the thread is about to read it and sees the flag
        self._thread.shutdown(wait=False)

    def _run(self, export: Export) -> str:
        with listening(self._hear):
            return export(shots=self._shots(), write=self._write)

    def _hear(self, share: float, _: str) -> None:
        self._check()
        self._encoded = share
        self._wake()

    def _shots(self) -> Iterator[Shot]:
        while (picture := self._queue.get()) is not None:
            self._check()
            self._wake()
            yield picture
        self._check()

    def _write(self, path: str | Path, data: bytes) -> None:
        self._check()
        write_atomic(path, data)

    def _check(self) -> None:
        if self._is_cancelled:
            raise InputError(tr("the export was cancelled"))
