"""Copies of unsaved work in the user's state folder, so that a crash costs a minute at most."""

import json
import os
import secrets
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import platformdirs
from filelock import FileLock, Timeout

from ...editor.document.document import Document, EditState
from ...errors import InputError, file_errors
from ..atomic import read_file, write_atomic
from .archive import Archive
from .json_records import parse_record, require
from .project import PROJECT_SUFFIX, decode_document, encode_document

FOLDER_VARIABLE = "AKAP_EDITOR_STATE"  # environment: another folder, e.g. for tests
SECONDS = 60.0
GESTURES = 10
ORIGIN = "autosave.json"  # an entry that .akap files do not have: where the drawing belongs
MAX_ORIGIN_BYTES = 2**16


def state_folder() -> Path:
    """Where the copies of the user who runs the program are."""
    folder = os.environ.get(FOLDER_VARIABLE) or platformdirs.user_state_dir("akap-editor", appauthor=False)
    return Path(folder) / "autosave"


@dataclass(frozen=True)
class RecoveryCopy:
    """A copy that belongs to this program as long as it holds the lock; a dead one's is free."""

    path: Path
    lock: FileLock

    @classmethod
    def claim(cls, path: Path) -> "RecoveryCopy | None":
        """The copy at ``path``, unless another running program has it. Raises OSError."""
        lock = FileLock(
            path.with_suffix(".lock"), thread_local=False
        )  # one thread takes, another may free it
        try:
            lock.acquire(blocking=False)
        except Timeout:
            return None
        return cls(path, lock)

    @property
    def time(self) -> float:
        """When it was written, in seconds of `time.time`."""
        return self.path.stat().st_mtime

    def read(self) -> Document:
        """The document; ``path`` is that of the file it belongs to, if any. Raises InputError."""
        data = read_file(self.path, "a copy of a drawing")
        with file_errors("recover", self.path):
            document = decode_document(data)
            origin = require(parse_record(Archive(data).read(ORIGIN, MAX_ORIGIN_BYTES)), "path", str)
        return replace(document, path=Path(origin) if origin else None)

    def write(self, document: Document) -> None:
        """Replace the copy. Raises InputError."""
        origin = json.dumps({"path": str(document.path.absolute()) if document.path else ""})
        write_atomic(self.path, encode_document(document, [(ORIGIN, origin.encode(), True)]))

    def discard(self) -> None:
        """Remove it."""
        self.path.unlink(missing_ok=True)
        self.leave()

    def leave(self) -> None:
        """Leave it to the next program that looks for copies."""
        self.lock.release()
        if not self.path.exists():
            with suppress(OSError):
                Path(self.lock.lock_file).unlink()


class Autosave:
    """Keeps a copy of the open document as long as it has unsaved changes.

    `watch` is told of the document all the time. It has it written on another thread, a minute after the
    first change that is not in the copy, or at every tenth gesture. Several programs may share a folder: each
    has a file of its own, locked as long as it runs.
    clock: seconds that never fall.
    """

    def __init__(self, folder: Path | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        self._folder = folder or state_folder()
        self._clock = clock
        self._worker = ThreadPoolExecutor(1, "autosave")  # one job after the other, so none overtakes
        self._job: Future[None] | None = None
        self._copy: RecoveryCopy | None = None  # belongs to the worker
        self._has_copy = False  # or will have, once the worker is done
        self._kept: EditState | None = None  # the state in the copy
        self._changed_at: float | None = None  # since when there is something that is not in the copy
        self._gestures = 0
        self._last: object = None

    def watch(self, document: Document | None, modified: bool, gesture: object = None) -> None:
        """Take notice of the document; called about once a frame, takes microseconds.

        modified: whether there are unsaved changes; gesture: another object after each gesture.
        Raises InputError, once, where the last copy could not be written; the next try is a minute later.
        """
        if document is None or not modified:
            self._forget()
            self._last = gesture
            return
        if gesture is not self._last:
            self._last = gesture
            self._gestures += 1
        if self._job is not None and self._job.done():
            job, self._job = self._job, None
            self._check(job)
        if document.state is self._kept:
            return
        now = self._clock()
        self._changed_at = now if self._changed_at is None else self._changed_at
        if self._job is None and (now - self._changed_at >= SECONDS or self._gestures >= GESTURES):
            self._job, self._has_copy = self._worker.submit(self._write, document), True
            self._kept, self._changed_at, self._gestures = document.state, None, 0

    def _check(self, job: "Future[None]") -> None:
        try:
            job.result()
        except (OSError, InputError, NotImplementedError) as error:
            self._kept = None
            raise InputError(f"unsaved work is not protected against a crash: {error}") from error

    def _forget(self) -> None:
        """What is in the copy is saved elsewhere, or not wanted."""
        if self._has_copy:
            self._worker.submit(self._discard)
        self._has_copy = False
        self._job = self._kept = self._changed_at = None
        self._gestures = 0

    def rescue(self, document: Document) -> None:
        """Write the copy now, because the program is about to end by mistake. Raises InputError."""
        self._check(self._worker.submit(self._write, document))

    def close(self) -> None:
        """The program ends as it should, and leaves no copy."""
        self._forget()
        self._worker.shutdown()

    # -- on the worker ---------------------------------------------------------------------------------------

    def _write(self, document: Document) -> None:
        if self._copy is None:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            self._copy = RecoveryCopy.claim(self._folder / f"{secrets.token_hex(8)}{PROJECT_SUFFIX}")
            assert self._copy is not None, "nobody else has this name"
        self._copy.write(document)

    def _discard(self) -> None:
        if self._copy is not None:
            self._copy.discard()
            self._copy = None

    # -- after a crash ---------------------------------------------------------------------------------------

    def lost(self) -> list[RecoveryCopy]:
        """The copies of programs that have ended by mistake, the newest first.

        They belong to this program until it calls `adopt`, or `RecoveryCopy.discard` or `RecoveryCopy.leave`.
        """
        copies = []
        with suppress(OSError, NotImplementedError):  # without a folder, or without locks, there is nothing
            for path in self._folder.glob(f"*{PROJECT_SUFFIX}"):
                copy = RecoveryCopy.claim(path)
                if copy is not None and path.exists():
                    copies.append(copy)
                elif copy is not None:
                    copy.leave()
        return sorted(copies, key=lambda copy: copy.time, reverse=True)

    def adopt(self, copy: RecoveryCopy, document: Document) -> None:
        """A lost copy becomes the one of this program, and holds what was read from it."""
        self._forget()
        self._worker.submit(setattr, self, "_copy", copy)
        self._has_copy, self._kept = True, document.state
