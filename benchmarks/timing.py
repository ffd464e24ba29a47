"""What the benchmarks share: time spent in chosen functions, by name."""

import time
from collections.abc import Callable, Iterable
from typing import Any


class Clock:
    """Adds up the seconds spent in wrapped functions; what is nested is taken off the outer one."""

    def __init__(self, parts: Iterable[str]) -> None:
        self._parts = tuple(parts)
        self._seconds = dict.fromkeys(self._parts, 0.0)
        self._inner = [0.0]

    def wrap(self, owner: Any, name: str, part: str) -> None:
        """Time every call of ``owner.name`` as ``part``."""
        original: Callable[..., Any] = getattr(owner, name)

        def timed(*args: Any, **kwargs: Any) -> Any:
            self._inner.append(0.0)
            started = time.perf_counter()
            try:
                return original(*args, **kwargs)
            finally:
                spent = time.perf_counter() - started
                self._seconds[part] += spent - self._inner.pop()
                self._inner[-1] += spent

        setattr(owner, name, timed)

    def take(self) -> dict[str, float]:
        """Seconds by part since the last call."""
        taken, self._seconds = self._seconds, dict.fromkeys(self._parts, 0.0)
        return taken
