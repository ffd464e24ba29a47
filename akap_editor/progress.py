"""Progress of long work: it announces its stages to whoever has started it and may cancel it there."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

from .errors import AkapError

Listener = Callable[
    [float, str], None
]  # gets the share of the work that is done, 0 to 1, and what comes next

T = TypeVar("T")

_listener: ContextVar[Listener | None] = ContextVar("listener", default=None)


class Cancelled(AkapError):
    """The work was cancelled: a listener raises it, and the work ends at the stage that it announces."""


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Let ``listener`` hear what the block announces in this thread."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


@contextmanager
def part(start: float, end: float) -> Iterator[None]:
    """Count the block as the part from ``start`` to ``end`` (shares, 0 to 1) of the work around it."""
    outer = _listener.get()
    if outer is None:
        yield
        return
    with listening(lambda share, text: outer(start + share * (end - start), text)):
        yield


def announce(share: float, text: str) -> None:
    """Tell the listener, if there is one, how much is done and what comes next. It may raise `Cancelled`."""
    listener = _listener.get()
    if listener is not None:
        listener(share, text)


def announced(items: Sequence[T], text: str) -> Iterator[T]:
    """Yield ``items`` and announce each as a stage; text: what is done with them."""
    for number, item in enumerate(items):
        announce(number / len(items), text)
        yield item
