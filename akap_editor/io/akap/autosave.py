"""Recovery copies of unsaved work in the user's state folder: a crash costs seconds, at most a minute."""

import json
import os
import secrets
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import platformdirs
from filelock import FileLock, Timeout

from ...editor.document.document import ArtworkFile, Document, EditState
from ...errors import InputError, file_errors
from ...words import mark, tr
from ..atomic import TEMPORARY_PREFIX, TEMPORARY_SUFFIX, read_file, write_atomic
from .archive import Archive
from .json_records import optional, parse_record, require
from .project import PROJECT_SUFFIX, decode_document, encode_document

STATE_FOLDER_VARIABLE = "AKAP_EDITOR_STATE"  # environment variable with another folder, e.g. for tests
FIRST_COPY_SECONDS = 3.0  # from the first change to the first copy
COPY_SECONDS = 60.0  # from a change that is not in the copy to the next one
STALE_SECONDS = 3600.0  # age of a temporary file that no running program can still be writing
COPY_GESTURES = 10
ORIGIN_ENTRY = "autosave.json"  # only in recovery copies: path and digest of the document's own file
MAX_ORIGIN_BYTES = 2**16


def state_folder() -> Path:
    """The folder of the recovery copies."""
    folder = os.environ.get(STATE_FOLDER_VARIABLE) or platformdirs.user_state_dir(
        "akap-editor", appauthor=False
    )
    return Path(folder) / "autosave"


@dataclass(frozen=True)
class RecoveryCopy:
    """An .akap file with unsaved work. The program that holds its lock owns it; a crash releases the lock."""

    path: Path
    lock: FileLock

    @classmethod
    def claim(cls, path: Path) -> "RecoveryCopy | None":
        """Lock the copy at ``path``; None if another running program owns it. Raises OSError."""
        lock = FileLock(path.with_suffix(".lock"), thread_local=False)  # may be released in another thread
        try:
            lock.acquire(blocking=False)
        except Timeout:
            return None
        return cls(path, lock)

    @property
    def time(self) -> float:
        """When the copy was written, in seconds of `time.time`; 0 if the system cannot tell."""
        try:
            return self.path.stat().st_mtime
        except OSError:
            return 0.0

    def read(self) -> Document:
        """The document, with ``path`` and ``digest`` of its own file, if it has one. Raises InputError."""
        data = read_file(self.path, mark("a copy of a drawing"))
        with file_errors("recover", self.path):
            document = decode_document(data)
            origin = parse_record(Archive(data).read(ORIGIN_ENTRY, MAX_ORIGIN_BYTES))
            path, digest = require(origin, "path", str), optional(origin, "digest", str, "")
            artwork = optional(origin, "artwork", str, "")
            known = (
                ArtworkFile(Path(artwork), optional(origin, "artworkDigest", str, "")) if artwork else None
            )
        return replace(document, path=Path(path) if path else None, digest=digest, artwork=known)

    def write(self, document: Document) -> None:
        """Replace the copy. Raises InputError."""
        path = str(document.path.absolute()) if document.path else ""
        values = {"path": path, "digest": document.digest}
        if document.artwork is not None:
            values |= {"artwork": str(document.artwork.path), "artworkDigest": document.artwork.digest}
        origin = json.dumps(values).encode()
        write_atomic(self.path, encode_document(document, [(ORIGIN_ENTRY, origin, True)]))

    def discard(self) -> None:
        """Delete the copy."""
        self.path.unlink(missing_ok=True)
        self.release()

    def release(self) -> None:
        """Leave the copy to the next program that looks for copies."""
        self.lock.release()
        if not self.path.exists():
            with suppress(OSError):
                Path(self.lock.lock_file).unlink()


class Autosave:
    """Keeps a recovery copy of the open document as long as it has unsaved changes.

    Copies are written in another thread: the first one seconds after the first change, the next ones a minute
    after the first change that is not in the copy, or at every tenth gesture. Several programs may share a
    folder: each has its own copy, which it locks while it runs.
    clock: seconds that never decrease; worker: has one thread, so that no job overtakes another.
    """

    def __init__(
        self,
        folder: Path | None = None,
        clock: Callable[[], float] = time.monotonic,
        worker: Executor | None = None,
    ) -> None:
        self._folder = folder or state_folder()
        self._clock = clock
        self._worker = worker or ThreadPoolExecutor(1, "autosave")
        self._job: Future[None] | None = None
        self._copy: RecoveryCopy | None = None  # used in the worker's thread only
        self._has_copy = False  # or will have when the worker is done
        self._copied_state: EditState | None = None
        self._changed_at: float | None = None  # time of the first change that is not in the copy
        self._gesture_count = 0  # since the last copy
        self._last_gesture: object = None
        self._has_failed = False  # and has said so

    def watch(self, document: Document | None, modified: bool, gesture: object = None) -> None:
        """Start a copy if one is due. Called about once a frame; takes microseconds.

        modified: whether there are unsaved changes; gesture: an object that differs after each gesture.
        Raises InputError if a copy could not be written, whatever the reason, but only once until one
        succeeds; the next attempt is a minute later.
        """
        if document is None or not modified:
            self._discard_copy()
            self._last_gesture = gesture
            return
        if gesture is not self._last_gesture:
            self._last_gesture = gesture
            self._gesture_count += 1
        if self._job is not None and self._job.done():
            job, self._job = self._job, None
            had_failed = self._has_failed
            try:
                self._check(job)
            except InputError:
                if not had_failed:
                    raise
        if document.state is self._copied_state:
            return
        now = self._clock()
        self._changed_at = now if self._changed_at is None else self._changed_at
        is_first = not self._has_copy and not self._has_failed
        delay = FIRST_COPY_SECONDS if is_first else COPY_SECONDS
        is_due = now - self._changed_at >= delay or self._gesture_count >= COPY_GESTURES
        if self._job is None and is_due:
            self._job, self._has_copy = self._worker.submit(self._write, document), True
            self._copied_state, self._changed_at, self._gesture_count = document.state, None, 0

    def rescue(self, document: Document) -> None:
        """Write the copy now and release it, because the program is about to crash. Raises InputError."""
        self._check(self._worker.submit(self._write, document))
        self._worker.submit(self._release).result()

    def close(self) -> None:
        """Delete the copy, because the program ends normally."""
        self._discard_copy()
        self._worker.shutdown()

    def _check(self, job: "Future[None]") -> None:
        """Raise InputError if a copy could not be written, by whatever exception."""
        try:
            job.result()
        except Exception as error:  # a bug in what it writes must not end the program
            self._copied_state, self._has_failed = None, True
            reason = str(error) or type(error).__name__
            raise InputError(
                tr("Unsaved work is not protected against a crash. {reason}", reason=reason)
            ) from error
        self._has_failed = False

    def _discard_copy(self) -> None:
        """Delete the copy in the worker's thread, because its content is saved or not wanted."""
        if self._has_copy:
            self._worker.submit(self._discard)
        self._has_copy = False
        self._job = self._copied_state = self._changed_at = None
        self._gesture_count = 0

    # -- in the worker's thread ------------------------------------------------------------------------------

    def _write(self, document: Document) -> None:
        if self._copy is None:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            self._copy = RecoveryCopy.claim(self._folder / f"{secrets.token_hex(8)}{PROJECT_SUFFIX}")
            assert self._copy is not None, "no other program has this name"
        self._copy.write(document)

    def _discard(self) -> None:
        if self._copy is not None:
            self._copy.discard()
            self._copy = None

    def _release(self) -> None:
        if self._copy is not None:
            self._copy.release()
            self._copy = None

    # -- after a crash ---------------------------------------------------------------------------------------

    def claim_lost_copies(self) -> list[RecoveryCopy]:
        """The copies of programs that have crashed, the newest first.

        This program owns them until it calls `adopt`, or `RecoveryCopy.discard` or `RecoveryCopy.release`.
        """
        copies = []
        with suppress(OSError):  # there is no folder
            for path in self._folder.glob(f"*{PROJECT_SUFFIX}"):
                # Without rights, or on a file system without locks; other copies may still be readable.
                with suppress(OSError, NotImplementedError):
                    copy = RecoveryCopy.claim(path)
                    if copy is not None and path.exists():
                        copies.append(copy)
                    elif copy is not None:
                        copy.release()
        return sorted(copies, key=lambda copy: copy.time, reverse=True)

    def remove_leftovers(self) -> None:
        """Delete the temporary files of killed programs, and their locks if no copy is left."""
        with suppress(OSError):
            for path in self._folder.glob("*.lock"):
                with suppress(OSError, NotImplementedError):
                    copy = RecoveryCopy.claim(path.with_suffix(PROJECT_SUFFIX))
                    if copy is not None and not copy.path.exists():
                        copy.release()  # which deletes the lock
                    elif copy is not None:
                        copy.lock.release()
            for path in self._folder.glob(f"{TEMPORARY_PREFIX}*{TEMPORARY_SUFFIX}"):
                with suppress(OSError):
                    if time.time() - path.stat().st_mtime > STALE_SECONDS:
                        path.unlink()

    def adopt(self, copy: RecoveryCopy, document: Document) -> None:
        """Continue a lost copy as this program's own; ``document`` is what was read from it."""
        self._discard_copy()
        self._worker.submit(setattr, self, "_copy", copy)
        self._has_copy, self._copied_state = True, document.state
