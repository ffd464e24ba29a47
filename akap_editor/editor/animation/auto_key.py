"""Auto-key: each pose that a gesture leaves becomes a keyframe at the playhead."""

from typing import NamedTuple

import numpy as np

from ...geometry.validation import Floats, Ints
from ...layers.layer_view import LayerView
from ...words import mark
from ..document.easing import NEW_EASING
from ..document.keyframes import Animation, as_keyframe_time
from ..document.pin import PinDepths, pin_depths
from ..gestures import EditContext
from ..session.edits import SetEasing, SetKeyframe
from ..session.edits.keyframes import KeyframeEdit
from ..session.session import Session


class KeyedValues(NamedTuple):
    """What a keyframe holds: a pose (n, 2), its crossings (s, 2), the layers shown, and the pins' depths."""

    positions: Floats
    crossings: Ints
    layers: LayerView | None
    depths: PinDepths

    def differs_from(self, before: "KeyedValues") -> bool:
        """Whether anything has changed since ``before``; pins that are new or gone do not count."""
        depths = dict(before.depths)
        is_shifted = any(depths.get(pin, depth) != depth for pin, depth in self.depths)
        is_moved = self.positions is not before.positions
        is_reordered = not np.array_equal(self.crossings, before.crossings)
        return is_moved or is_reordered or is_shifted or self.layers != before.layers


def keyed_values(session: Session) -> KeyedValues:
    """What a keyframe of the present pose would hold."""
    present, drawing = session.present, session.present_document.drawing
    return KeyedValues(present.positions, present.crossings, drawing.layer_view, pin_depths(present.pins))


class AutoKey:
    """Watches a session for gestures that change the pose.

    is_on: whether they make keyframes; is_armed: whether the next one does.
    """

    def __init__(self) -> None:
        self.is_on = self.is_armed = False
        self.forget()

    def forget(self) -> None:
        """Disregard what has been done so far; to be called while the keyframes are not shown."""
        self._session: Session | None = None
        self._commits = 0
        self._seen: KeyedValues | None = None  # at the last keyframe, or at the last time without one
        self._pending: tuple[float, int] | None = None  # time of a keyframe to make, and depth of the history

    def update(self, editor: EditContext, time: float) -> bool:
        """Make the keyframe of the last gesture once its pose has settled; return whether there is a new one.

        To be called once a frame. time: of the playhead, seconds. The keyframe is in one undo entry with the
        gesture. Undo and redo make none.
        """
        session = editor.session
        if session is None or editor.is_busy:
            return False
        is_active = self.is_on or self.is_armed
        if not is_active or session is not self._session:
            self.forget()
            self._session, self._commits = session, session.history.commits
            self._seen = keyed_values(session)
            return False
        due = self._due_time(session, time)
        self.is_armed = self.is_armed and self._pending is not None
        if due is None:
            return False
        session.end_preview()
        session.begin(mark("Auto Key"))
        depths = pin_depths(session.present.pins)
        for edit in key_edits(session.present.animation, as_keyframe_time(due), depths=depths):
            session.apply(edit)
        session.commit(join=True)
        self._commits = session.history.commits
        return True

    def _due_time(self, session: Session, time: float) -> float | None:
        """The time at which the present pose becomes a keyframe now; None if it does not."""
        history = session.history
        if history.commits != self._commits:
            self._commits = history.commits
            is_undone = history.redo_label is not None
            self._pending = None if is_undone else (time, history.depth)
        if self._pending is not None and history.depth < self._pending[1]:
            self._pending = None  # it was undone before it had settled
        if self._pending is None:
            self._seen = keyed_values(session)
            return None
        if session.is_moving and not session.is_previewing:
            return None
        (due, _), self._pending = self._pending, None
        seen = keyed_values(session)
        is_changed = self._seen is None or seen.differs_from(self._seen)
        self._seen = seen
        return due if is_changed else None


def key_edits(
    animation: Animation,
    time: float,
    positions: Floats | None = None,
    crossings: Ints | None = None,
    layers: LayerView | None = None,
    depths: PinDepths = (),
) -> list[KeyframeEdit]:
    """The edits that make a keyframe of a pose (n, 2) and a layer list, by default the present ones.

    depths: of the pins.
    """
    key = SetKeyframe(time, positions, None, crossings, layers, depths)
    if not animation.keyframes and animation.ease != NEW_EASING:
        return [SetEasing(None, NEW_EASING), key]
    return [key]
