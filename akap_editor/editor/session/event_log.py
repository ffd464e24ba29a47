"""A long list of small events in little memory."""

import json
import zlib
from collections.abc import Iterator, Sequence
from typing import Any, overload

PACK_SIZE = 1000  # events that are compressed together

Event = dict[str, Any]


class EventLog(Sequence[Event]):
    """What happened, in order, as JSON; all but the newest events are compressed.

    Two hours of dragging are some hundred thousand events: hundreds of megabytes as dictionaries, a few here.
    Each reading gives an event anew, so what is in the log never changes.
    """

    def __init__(self) -> None:
        self._packs: list[bytes] = []
        self._lines: list[str] = []

    def append(self, event: Event) -> None:
        """Add an event, of values that JSON can hold."""
        self._lines.append(json.dumps(event, separators=(",", ":")))
        if len(self._lines) == PACK_SIZE:
            self._packs.append(_packed(self._lines))
            self._lines.clear()

    def replace(self, index: int, event: Event) -> None:
        """Put an event in the place of another one. Raises IndexError."""
        number, line = divmod(range(len(self))[index], PACK_SIZE)
        lines = self._pack(number)
        lines[line] = json.dumps(event, separators=(",", ":"))
        if number < len(self._packs):
            self._packs[number] = _packed(lines)

    def __len__(self) -> int:
        return PACK_SIZE * len(self._packs) + len(self._lines)

    def __iter__(self) -> Iterator[Event]:
        for number in range(len(self._packs) + 1):
            yield from map(json.loads, self._pack(number))

    @overload
    def __getitem__(self, index: int) -> Event: ...
    @overload
    def __getitem__(self, index: slice) -> list[Event]: ...
    def __getitem__(self, index: int | slice) -> Event | list[Event]:
        if isinstance(index, slice):
            return [self[each] for each in range(*index.indices(len(self)))]
        pack, line = divmod(range(len(self))[index], PACK_SIZE)
        return json.loads(self._pack(pack)[line])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]

    def _pack(self, number: int) -> list[str]:
        """The lines of one pack; those that are not packed yet come last."""
        if number == len(self._packs):
            return self._lines
        return zlib.decompress(self._packs[number]).decode().split("\n")


def _packed(lines: list[str]) -> bytes:
    return zlib.compress("\n".join(lines).encode(), 1)
