"""Undo and redo: stacks of whole states, one entry a gesture."""

from dataclasses import dataclass

from ..document.document import EditState

MAX_ENTRIES = 1000
MAX_BYTES = 2**28  # of poses


@dataclass(frozen=True, eq=False)
class HistoryEntry:
    """A state to go back to, and what was done after it."""

    label: str
    state: EditState


class History:
    """Stacks of `EditState`: whatever is in the state is undoable, and nobody has to write an inverse.

    `begin` when a gesture starts, `commit` when it ends, `abort` returns the state from before, bit for bit.
    """

    def __init__(self) -> None:
        self._undo: list[HistoryEntry] = []
        self._redo: list[HistoryEntry] = []
        self._open: HistoryEntry | None = None

    def begin(self, label: str, state: EditState) -> None:
        """Open a gesture at ``state``. Gestures do not nest."""
        assert self._open is None, "a gesture is already open"
        self._open = HistoryEntry(label, state)

    def rename(self, label: str) -> None:
        """Say better what the open gesture turned out to be."""
        assert self._open is not None, "no gesture is open"
        self._open = HistoryEntry(label, self._open.state)

    def commit(self, join: bool = False) -> None:
        """Close the gesture as one entry; what was undone before can no longer be redone.

        join: as a part of the entry before it, so that undo takes both back.
        """
        assert self._open is not None, "no gesture is open"
        if not (join and self._undo):
            self._undo.append(self._open)
        self._redo.clear()
        self._forget_oldest()
        self._open = None

    def _forget_oldest(self) -> None:
        """Keep so much that nobody misses the rest, and a day's work does not fill the memory."""
        size = sum(entry.state.positions.nbytes for entry in self._undo)
        while len(self._undo) > MAX_ENTRIES or (size > MAX_BYTES and len(self._undo) > 1):
            size -= self._undo.pop(0).state.positions.nbytes

    def abort(self) -> EditState:
        """Close the gesture without an entry; the state from before it."""
        assert self._open is not None, "no gesture is open"
        entry, self._open = self._open, None
        return entry.state

    @property
    def is_open(self) -> bool:
        """Whether a gesture is under way."""
        return self._open is not None

    def is_unchanged(self, now: EditState) -> bool:
        """Whether the open gesture has changed nothing yet."""
        return self._open is not None and self._open.state is now

    def undo(self, now: EditState) -> EditState:
        """The state before the last entry; ``now`` can be redone. Raises IndexError on an empty stack."""
        entry = self._undo.pop()
        self._redo.append(HistoryEntry(entry.label, now))
        return entry.state

    def redo(self, now: EditState) -> EditState:
        """The state after the entry last undone. Raises IndexError on an empty stack."""
        entry = self._redo.pop()
        self._undo.append(HistoryEntry(entry.label, now))
        return entry.state

    @property
    def undo_label(self) -> str | None:
        """What undo would take back."""
        return self._undo[-1].label if self._undo else None

    @property
    def redo_label(self) -> str | None:
        """What redo would do again."""
        return self._redo[-1].label if self._redo else None

    @property
    def last(self) -> HistoryEntry | None:
        """The entry that undo would take back; an object of its own for each commit."""
        return self._undo[-1] if self._undo else None

    @property
    def labels(self) -> list[str]:
        """Of all entries, the oldest first: those that can be undone, then those that can be redone."""
        return [entry.label for entry in (*self._undo, *reversed(self._redo))]

    @property
    def depth(self) -> int:
        """Number of entries that can be undone."""
        return len(self._undo)
