"""The exceptions that callers may want to tell apart."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class AkapError(Exception):
    """Base of the errors that this package raises itself; the message is one sentence for the user."""


class InputError(AkapError, ValueError):
    """The user's data is unusable; the message says what was expected and what came."""


class SolverError(AkapError, ArithmeticError):
    """A computation has no finite result; the pose before it is still valid."""


class DisplayError(AkapError):
    """No display is available to open a window on."""


class GraphicsError(AkapError):
    """OpenGL 3.3 is not available."""


@contextmanager
def error_context(name: str | Path) -> Iterator[None]:
    """Put ``name``, e.g. of a file or an entry, before the message of an InputError raised in the block."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
