"""The log of a session's events, compressed in memory."""

import json
import zlib
from collections.abc import Iterator, Sequence
from typing import Any, overload

PACK_SIZE = 1000  # events that are compressed together

Event = dict[str, Any]


class EventLog(Sequence[Event]):
    """A sequence of events, stored as JSON; all but the newest ones are compressed.

    Two hours of dragging are some hundred thousand events: hundreds of megabytes as dictionaries, a few here.
    Each access decodes an event anew, so changing it does not change the log.
    """

    def __init__(self) -> None:
        self._packs: list[bytes] = []  # PACK_SIZE lines each, compressed
        self._lines: list[str] = []  # the events after those of the packs

    def append(self, event: Event) -> None:
        """Add an event; its values must be JSON."""
        self._lines.append(_to_line(event))
        if len(self._lines) == PACK_SIZE:
            self._packs.append(_compress(self._lines))
            self._lines.clear()

    def replace(self, index: int, event: Event) -> None:
        """Replace the event at an index. Raises IndexError."""
        pack, line = divmod(range(len(self))[index], PACK_SIZE)
        lines = self._lines_of(pack)
        lines[line] = _to_line(event)
        if pack < len(self._packs):
            self._packs[pack] = _compress(lines)

    def __len__(self) -> int:
        return PACK_SIZE * len(self._packs) + len(self._lines)

    def __iter__(self) -> Iterator[Event]:
        for pack in range(len(self._packs) + 1):
            yield from map(json.loads, self._lines_of(pack))

    @overload
    def __getitem__(self, index: int) -> Event: ...
    @overload
    def __getitem__(self, index: slice) -> list[Event]: ...
    def __getitem__(self, index: int | slice) -> Event | list[Event]:
        if isinstance(index, slice):
            return [self[each] for each in range(*index.indices(len(self)))]
        pack, line = divmod(range(len(self))[index], PACK_SIZE)
        return json.loads(self._lines_of(pack)[line])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]

    def _lines_of(self, pack: int) -> list[str]:
        """The lines of a pack by its index; the index after the last pack gives the uncompressed lines."""
        if pack == len(self._packs):
            return self._lines
        return zlib.decompress(self._packs[pack]).decode().split("\n")


def _to_line(event: Event) -> str:
    return json.dumps(event, separators=(",", ":"))


def _compress(lines: list[str]) -> bytes:
    return zlib.compress("\n".join(lines).encode(), 1)
