"""The exceptions of the package, and what puts a file or an entry into their messages."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from .display_text import display_text, shortened

_MAX_PATH = 300  # characters of a path in a message


class AkapError(Exception):
    """Base of all errors that the package raises on purpose; the message is one line for the user."""


class InputError(AkapError, ValueError):
    """The user's data cannot be used; the message says what was expected and what came."""


class FileError(InputError):
    """A file cannot be opened or written; the message names it and says why.

    verb: what failed, as in “Couldn't open ...”; reason: a phrase, e.g. “permission denied”.
    """

    def __init__(self, verb: str, path: str | Path, reason: str) -> None:
        shown = shortened(display_text(path), _MAX_PATH)
        super().__init__(f"Couldn't {verb} “{shown}”. {_as_sentence(reason)}")


class SolverError(AkapError, ArithmeticError):
    """A computation has no finite result; the pose before it is still valid."""


class DisplayError(AkapError):
    """No display is available to open a window on."""


class GraphicsError(AkapError):
    """OpenGL 3.3 is not available."""


@contextmanager
def file_errors(verb: str, path: str | Path) -> Iterator[None]:
    """Turn an InputError raised in the block into a FileError."""
    try:
        yield
    except InputError as error:
        raise FileError(verb, path, str(error)) from error


@contextmanager
def error_context(name: str) -> Iterator[None]:
    """Put a name, e.g. of an entry of a file, before the message of an InputError raised in the block."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{name}: {error}") from error


def _as_sentence(reason: str) -> str:
    """The reason with a period, and with a capital letter unless it begins with a name, as in "crop: ..."."""
    if reason.split(" ", 1)[0].isalpha():
        reason = reason[:1].upper() + reason[1:]
    return reason if reason.endswith((".", "?", "!")) else f"{reason}."


def join_with_or(names: Sequence[str]) -> str:
    """Join names for a sentence: "a, b or c"."""
    return " or ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
