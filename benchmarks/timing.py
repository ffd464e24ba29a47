"""`FunctionTimer`: measures how long a benchmark spends in chosen functions."""

import time
from collections.abc import Callable, Iterable
from typing import Any


class FunctionTimer:
    """Adds up the seconds spent in wrapped functions, each without the wrapped functions that it calls."""

    def __init__(self, parts: Iterable[str]) -> None:
        self._parts = tuple(parts)
        self._seconds = dict.fromkeys(self._parts, 0.0)
        self._nested_seconds = [0.0]  # of each wrapped call in progress, innermost last

    def wrap(self, owner: Any, name: str, part: str) -> None:
        """Count every call of ``owner.name`` under ``part``."""
        original: Callable[..., Any] = getattr(owner, name)

        def timed(*args: Any, **kwargs: Any) -> Any:
            self._nested_seconds.append(0.0)
            started = time.perf_counter()
            try:
                return original(*args, **kwargs)
            finally:
                elapsed = time.perf_counter() - started
                self._seconds[part] += elapsed - self._nested_seconds.pop()
                self._nested_seconds[-1] += elapsed

        setattr(owner, name, timed)

    def take(self) -> dict[str, float]:
        """Return the seconds of each part since the last call."""
        seconds, self._seconds = self._seconds, dict.fromkeys(self._parts, 0.0)
        return seconds
