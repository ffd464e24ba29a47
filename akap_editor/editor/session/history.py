"""Undo and redo: stacks of whole states, one entry a gesture."""

from dataclasses import dataclass

from ...display_text import display_text
from ..document.document import EditState

MAX_ENTRIES = 1000
MAX_BYTES = 2**28  # of the poses of all entries


@dataclass(frozen=True, eq=False)
class HistoryEntry:
    """One gesture: its label, and the state that undo or redo restores."""

    label: str
    state: EditState


class History:
    """Stacks of `EditState`: whatever is in the state is undoable, and no edit needs an inverse.

    `begin` opens a gesture; `commit` ends it with an entry, `abort` without one. Gestures do not nest.
    """

    def __init__(self) -> None:
        self._undo: list[HistoryEntry] = []
        self._redo: list[HistoryEntry] = []
        self._open: HistoryEntry | None = None
        self.commits = 0  # how many gestures have been committed, undone ones too

    def begin(self, label: str, state: EditState) -> None:
        """Open a gesture that starts from ``state``."""
        assert self._open is None, "a gesture is already open"
        self._open = HistoryEntry(display_text(label), state)

    def rename(self, label: str) -> None:
        """Replace the label of the open gesture."""
        assert self._open is not None, "no gesture is open"
        self._open = HistoryEntry(display_text(label), self._open.state)

    def commit(self, join: bool = False) -> None:
        """End the open gesture as one entry, and clear redo.

        join: merge it into the entry before, so that one undo restores the state before both.
        """
        assert self._open is not None, "no gesture is open"
        if not (join and self._undo):
            self._undo.append(self._open)
        self._redo.clear()
        self.commits += 1
        self._drop_oldest()
        self._open = None

    def _drop_oldest(self) -> None:
        """Drop the oldest entries beyond the limits; the newest one always stays."""
        size = sum(entry.state.positions.nbytes for entry in self._undo)
        while len(self._undo) > MAX_ENTRIES or (size > MAX_BYTES and len(self._undo) > 1):
            size -= self._undo.pop(0).state.positions.nbytes

    def abort(self) -> EditState:
        """End the open gesture without an entry; returns the state that it started from."""
        assert self._open is not None, "no gesture is open"
        entry, self._open = self._open, None
        return entry.state

    @property
    def is_open(self) -> bool:
        """Whether a gesture is open."""
        return self._open is not None

    def is_unchanged(self, state: EditState) -> bool:
        """Whether a gesture is open and ``state``, the current one, is still the one it started from."""
        return self._open is not None and self._open.state is state

    def undo(self, state: EditState) -> EditState:
        """The state before the last entry; ``state``, the current one, is what redo restores.

        Raises IndexError if there is no entry.
        """
        entry = self._undo.pop()
        self._redo.append(HistoryEntry(entry.label, state))
        return entry.state

    def redo(self, state: EditState) -> EditState:
        """The state after the entry last undone; ``state``, the current one, is what undo restores.

        Raises IndexError if there is no entry.
        """
        entry = self._redo.pop()
        self._undo.append(HistoryEntry(entry.label, state))
        return entry.state

    @property
    def undo_label(self) -> str | None:
        """The label of the entry that `undo` takes, None if there is none."""
        return self._undo[-1].label if self._undo else None

    @property
    def redo_label(self) -> str | None:
        """The label of the entry that `redo` takes, None if there is none."""
        return self._redo[-1].label if self._redo else None

    @property
    def last(self) -> HistoryEntry | None:
        """The entry that `undo` takes; another object after each commit."""
        return self._undo[-1] if self._undo else None

    @property
    def labels(self) -> list[str]:
        """The labels of all entries, oldest first: those of undo, then those of redo."""
        return [entry.label for entry in (*self._undo, *reversed(self._redo))]

    @property
    def depth(self) -> int:
        """The number of entries of undo."""
        return len(self._undo)
