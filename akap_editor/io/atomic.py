"""Whole files: read at once, and written at once or not at all."""

import errno
import os
import reprlib
import secrets
import shutil
import stat
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import Any, BinaryIO

from ..errors import FileError, InputError
from ..words import mark, tr

MAX_FILE_BYTES = 2**30
TEMPORARY_PREFIX, TEMPORARY_SUFFIX = ".akap-", ".tmp"  # of a file that is being written

_noted: ContextVar[list[Path] | None] = ContextVar("noted", default=None)

Write = Callable[[str | Path, bytes], None]  # writes a file, as `write_atomic` does


def as_path(value: Any) -> Path:
    """Return ``value`` as a path. Raises InputError if it is neither text nor a path."""
    if not isinstance(value, (str, os.PathLike)):
        raise InputError(tr("path: expected a path or text, got {value}", value=reprlib.repr(value)))
    return Path(value)


@contextmanager
def noted_reads() -> Iterator[list[Path]]:
    """Collect the files that `read_file` reads in the block: what was named, and all that this refers to.

    Blocks may be nested.
    """
    files: list[Path] = []
    outer = _noted.get()
    token = _noted.set(files)
    try:
        yield files
    finally:
        _noted.reset(token)
        if outer is not None:
            outer += files


def read_file(path: str | Path, expected: str) -> bytes:
    """All bytes of a regular file; ``expected`` says in messages what it should be, e.g. "a picture".

    Raises FileError if there is no such file, it cannot be read, or has over `MAX_FILE_BYTES`.
    """
    with open_file(path, expected) as file:
        try:
            return file.read()
        except OSError as error:
            raise FileError("open", as_path(path), os_error_reason(error)) from error


def open_file(path: str | Path, expected: str) -> BinaryIO:
    """A regular file, open for reading; it is one that `noted_reads` collects. Raises as `read_file` does."""
    path = as_path(path)
    try:
        status = path.stat()
        if stat.S_ISREG(status.st_mode) and status.st_size <= MAX_FILE_BYTES:
            noted = _noted.get()
            if noted is not None:
                noted.append(path)
            return path.open("rb")
    except FileNotFoundError:
        raise FileError("open", path, tr("there is no such file")) from None
    except (OSError, ValueError) as error:
        raise FileError("open", path, os_error_reason(error)) from error
    if stat.S_ISREG(status.st_mode):
        size, most = status.st_size, MAX_FILE_BYTES
        came = tr("a file of {size} bytes, more than {most}", size=size, most=most)
    elif stat.S_ISDIR(status.st_mode):
        came = tr("a folder")
    else:
        came = tr("something that is not a regular file")
    raise FileError("open", path, tr("expected {expected}, got {came}", expected=tr(expected), came=came))


def write_atomic(path: str | Path, data: bytes) -> None:
    """Write a file under a temporary name in its folder and move it into place.

    If anything fails, the old file stays as it was and no temporary file is left; only if the process is
    killed, a file .akap-*.tmp may remain. After the call, the new file survives a power cut, as far as the
    system can promise it. A link is followed; permission bits, owner and group of the old file are kept, and
    nobody else may read the temporary one; the bits of a new file follow the umask. Raises FileError, also
    for a link that leads to itself.
    """
    path = as_path(path)
    try:
        target = _link_target(path)
        exists = target.exists()
        if exists and not target.is_file():  # moving over a device would destroy it
            raise OSError(errno.EINVAL, tr("it is not a regular file"))
        if exists and not os.access(target, os.W_OK):  # moving over a protected file would succeed
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        temporary = target.with_name(f"{TEMPORARY_PREFIX}{secrets.token_hex(8)}{TEMPORARY_SUFFIX}")
        file = open_new(temporary, 0o600 if exists else 0o666)
        try:
            with file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            if exists:
                _keep_owner(target.stat(), temporary)
                shutil.copymode(target, temporary)
            os.replace(temporary, target)
            _flush_folder(target.parent)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
    except (OSError, ValueError) as error:
        raise FileError("save", path, os_error_reason(error)) from error


def open_new(path: Path, mode: int) -> BinaryIO:
    """A file to write that did not exist; the umask takes bits from ``mode``. Raises OSError."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    return os.fdopen(os.open(path, flags, mode), "wb")


def resolved(path: Path) -> Path:
    """The absolute path without links, as far as there are files; unlike `Path.resolve` it never fails."""
    try:
        return Path(os.path.realpath(path))
    except ValueError:  # no file has such a name
        return path.absolute()


# What systems say most often
_REASONS = (
    mark("permission denied"),
    mark("no such file or directory"),
    mark("not a directory"),
    mark("is a directory"),
    mark("no space left on device"),
    mark("read-only file system"),
    mark("file name too long"),
    mark("input/output error"),
    mark("disk quota exceeded"),
    mark("too many levels of symbolic links"),
    mark("operation not permitted"),
)


def os_error_reason(error: OSError | ValueError) -> str:
    """The cause alone, e.g. "permission denied", without number and file name."""
    if isinstance(error, UnicodeError):
        encoding = sys.getfilesystemencoding()
        text = mark("the names of files have no such characters in the present locale ({encoding})")
        return tr(text, encoding=encoding)
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return tr(text[:1].lower() + text[1:])


def _link_target(path: Path) -> Path:
    """The file that a link leads to in the end, or ``path`` itself. Raises OSError."""
    try:
        return path.resolve()
    except RuntimeError as error:  # of Python 3.12 and before
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP)) from error


def _keep_owner(old: os.stat_result, new: Path) -> None:
    """Give a file the owner and group of the one that it replaces, as far as the user may: root, others."""
    if os.name != "posix":
        return
    for owner in {(old.st_uid, old.st_gid), (-1, old.st_gid)}:
        with suppress(OSError):
            os.chown(new, *owner)


def _flush_folder(folder: Path) -> None:
    """Write the folder's list of names to the disk, on systems that can do that."""
    if os.name != "posix":
        return
    with suppress(OSError):  # some file systems refuse; the new file is in place in any case
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
