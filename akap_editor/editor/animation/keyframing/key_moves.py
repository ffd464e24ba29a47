"""Brings playhead and selection back when a move of keyframes is undone or redone."""

from weakref import WeakKeyDictionary

from ...document.keyframes import Animation

View = tuple[float, frozenset[float]]  # the time of the playhead, and those of the selected keyframes


class KeyMoves:
    """The views before and after each move of keyframes that playhead and selection followed."""

    def __init__(self) -> None:
        self._moves: WeakKeyDictionary[Animation, tuple[Animation, View, View]] = WeakKeyDictionary()
        self._seen: Animation | None = None

    def add(self, before: Animation, old: View, after: Animation, new: View) -> None:
        """Remember a move. before, old: animation and view before it; after, new: those after it."""
        if after is not before:
            self._moves[after] = before, old, new

    def view(self, animation: Animation, view: View) -> View:
        """The view for the animation shown now: another one than ``view``, the last one, after undo and redo.

        If the playhead or the selection has changed since the move, ``view`` stays.
        """
        seen, self._seen = self._seen, animation
        if seen is None or seen is animation:
            return view
        for before, after, is_undone in ((animation, seen, True), (seen, animation, False)):
            move = self._moves.get(after)
            if move is not None and move[0] is before:
                _, old, new = move
                left, shown = (new, old) if is_undone else (old, new)
                return shown if view == left else view
        return view
