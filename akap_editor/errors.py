"""The exceptions of the package, and what puts a file or an entry into their messages."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from .display_text import display_text, shortened
from .words import mark, tr

_MAX_PATH = 300  # characters of a path in a message
COULD_NOT = {
    "open": mark("Couldn't open “{file}”."),
    "save": mark("Couldn't save “{file}”."),
    "export": mark("Couldn't export “{file}”."),
    "use": mark("Couldn't use “{file}”."),
    "reload": mark("Couldn't reload “{file}”."),
    "remove": mark("Couldn't remove “{file}”."),
    "replay": mark("Couldn't replay “{file}”."),
    "recover": mark("Couldn't recover “{file}”."),
    "mesh": mark("Couldn't mesh “{file}”."),
}


class AkapError(Exception):
    """Base of all errors that the package raises on purpose; the message is one line for the user."""


class InputError(AkapError, ValueError):
    """The user's data cannot be used; the message says what was expected and what came."""


class FileError(InputError):
    """A file cannot be opened or written; the message names it and says why.

    verb: what failed, of `COULD_NOT` if the window may show it; reason: a phrase, e.g. “permission denied”.
    """

    def __init__(self, verb: str, path: str | Path, reason: str) -> None:
        shown = shortened(display_text(path), _MAX_PATH)
        text = COULD_NOT.get(verb, f"Couldn't {verb} “{{file}}”.")
        super().__init__(f"{tr(text, file=shown)} {_as_sentence(reason)}")


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
    if reason.split(" ", 1)[0].replace("-", "").isalpha():
        reason = reason[:1].upper() + reason[1:]
    return reason if reason.endswith((".", "?", "!", "。")) else tr("{sentence}.", sentence=reason)


def join_with_or(names: Sequence[str]) -> str:
    """Join names for a sentence: "a, b or c"."""
    return joined(names, tr("{names} or {last}"))


def joined(names: Sequence[str], end: str) -> str:
    """Join names by commas, and the last one as ``end`` says, with the fields ``names`` and ``last``."""
    return end.format(names=", ".join(names[:-1]), last=names[-1]) if len(names) > 1 else "".join(names)
