"""The exceptions that callers may want to tell apart."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class AkapError(Exception):
    """Base of every error this package raises on purpose; the message is one sentence for the user."""


class InputError(AkapError, ValueError):
    """The user's data is unusable; says what was expected and what came."""


class SolverError(AkapError, ArithmeticError):
    """The numbers gave no finite answer; the last good pose is still valid."""


class DisplayError(AkapError):
    """There is no display to open a window on."""


class GraphicsError(AkapError):
    """There is no OpenGL 3.3."""


@contextmanager
def error_context(name: str | Path) -> Iterator[None]:
    """Put ``name``, e.g. of a file or an entry, before the message of an InputError raised in the block."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
