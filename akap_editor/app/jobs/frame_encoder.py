"""Pictures that become a file in another thread, while more of them are drawn."""

from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path
from queue import Full, Queue
from typing import Protocol

from ...errors import InputError
from ...io.atomic import Write, write_atomic
from ...io.images import Picture

_AHEAD = 8  # pictures that wait to be encoded
_WAIT = 0.02  # seconds


class Export(Protocol):
    """Reads all frames, encodes them, and writes them with ``write``; a few words on what was written."""

    def __call__(self, *, frames: Iterable[Picture], write: Write) -> str: ...


class FrameEncoder:
    """An export at work, which waits for its pictures. One that is closed too early writes no file."""

    def __init__(self, export: Export) -> None:
        self._waiting: Queue[Picture | None] = Queue(_AHEAD)
        self._wanted = True
        self._thread = ThreadPoolExecutor(1, "encoder")
        self._written = self._thread.submit(lambda: export(frames=self._pictures(), write=self._write))

    def take(self, picture: Picture | None) -> Iterator[None]:
        """Add a picture as soon as there is room, or not at all if nobody reads any more. None: the end."""
        while not self._written.done():
            try:
                self._waiting.put(picture, timeout=_WAIT)
            except Full:
                yield
            else:
                return

    def finish(self) -> Iterator[None]:
        """There are no more pictures; goes on until the file is written."""
        yield from self.take(None)
        while not wait([self._written], _WAIT).done:
            yield

    @property
    def said(self) -> str:
        """What was written. Raises what the export has raised."""
        return self._written.result()

    def close(self) -> None:
        """To be called in the end, come what may. What is still being encoded ends by itself."""
        self._wanted = self._written.done()
        for _ in self.take(None):
            pass
        self._thread.shutdown(wait=False)

    def _pictures(self) -> Iterator[Picture]:
        while (picture := self._waiting.get()) is not None:
            yield picture
        self._check()

    def _write(self, path: str | Path, data: bytes) -> None:
        self._check()
        write_atomic(path, data)

    def _check(self) -> None:
        if not self._wanted:
            raise InputError("the export was cancelled")
