"""What can be done to an open session, one gesture each."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable

from ..geometry.validation import Floats
from .camera import Point
from .document.named_poses import free_name
from .document.pin import Pin
from .document.settings import Settings
from .nudges import Nudges
from .pin_trails import Trails
from .session.edits import (
    AddPose,
    DeletePose,
    ResetPose,
    SetPins,
    SetPose,
    SetRestPose,
    SetSettings,
    SetTargets,
)
from .session.pin_edits import add_pin, remove_pins, set_depths
from .session.session import Session


class Edits(ABC):
    """A session with a selection of its pins, and whatever changes the two at once. clock: in seconds."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self.session: Session | None = None
        self.selection: frozenset[int] = frozenset()
        self.trails = Trails()
        self._nudges = Nudges(clock)

    @property
    @abstractmethod
    def busy(self) -> bool:
        """Whether a gesture is under way."""

    @abstractmethod
    def cancel(self) -> None:
        """The one way out of a gesture: Escape, focus loss and errors all come here."""

    # -- one gesture each ----------------------------------------------------------------------------------

    def add_pin(self, at: Point) -> int | None:
        """A pin at a place in the drawing (pixels); its id, or None beside the drawing."""
        if self.session is None or self.busy:
            return None
        self.session.begin("Add pin")
        try:
            added = add_pin(self.session, at)
        except Exception:
            self.session.abort()
            raise
        self.session.commit()
        if added is not None:
            self.select({added})
        return added

    def remove_pins(self, ids: Iterable[int]) -> None:
        """Take pins off the drawing; it keeps its pose."""
        if self.session is None:
            return
        gone = frozenset(ids) & {pin.id for pin in self.session.state.pins}
        if gone:
            label = "Remove pin" if len(gone) == 1 else f"Remove {len(gone)} pins"
            self.edit(label, lambda session: remove_pins(session, gone))

    def remove_selected(self) -> None:
        """Take the selected pins off the drawing."""
        self.remove_pins(self.selection)

    def remove_last(self) -> None:
        """Take off the pin that was added last."""
        if self.session is not None and self.session.state.pins:
            self.remove_pins({self.session.state.pins[-1].id})

    def place_pin(self, pin_id: int, at: Point) -> None:
        """Send a pin to a place (pixels); the drawing follows. Raises InputError on an unknown id or NaN."""
        self.edit("Place pin", lambda session: session.apply(SetTargets({pin_id: at})))

    def set_depth(self, pin_id: int, depth: int) -> None:
        """Bring a pin to the front or back. Raises InputError on a depth out of range."""
        self.edit("Set depth", lambda session: set_depths(session, {pin_id: depth}))

    def shift_depth(self, by: int) -> None:
        """Bring the selected pins so much to the front, or to the back."""
        if self.session is not None and self.selection:
            depths = {pin.id: pin.depth + by for pin in self.session.state.pins if pin.id in self.selection}
            label = "Bring forward" if by > 0 else "Send back"
            self.edit(label, lambda session: set_depths(session, depths))

    def nudge_selected(self, dx: float, dy: float) -> None:
        """Send the selected pins so many pixels on; nudges in a row are one gesture."""
        if self.session is not None and not self.busy and self.selection:
            self._nudges.move(self.session, self.selection, dx, dy)

    def reset_pose(self) -> None:
        """The rest pose, with the pins where they then are."""
        self.edit("Reset pose", lambda session: session.apply(ResetPose()))

    def bake_pose(self) -> None:
        """Make the pose the rest pose; nothing moves. Raises InputError where faces are flipped."""
        self.edit("Make pose the rest pose", lambda session: session.apply(SetRestPose()))

    def keep_pose(self, name: str | None = None) -> None:
        """Remember the current pose by a name, by default "Pose" and a number. Raises InputError."""
        if self.session is not None:
            wanted = name if name is not None else free_name(self.session.state.poses)
            self.edit("Keep pose", lambda session: session.apply(AddPose(wanted)))

    def forget_pose(self, name: str) -> None:
        """Forget a pose; undo brings it back."""
        self.edit("Forget pose", lambda session: session.apply(DeletePose(name)))

    def set_pose(self, positions: Floats, label: str = "Apply pose") -> None:
        """Take over a pose (n, 2) of this mesh; pins go with it. Raises InputError."""
        self.edit(label, lambda session: session.apply(SetPose(positions)))

    def apply_pose(self, pins: tuple[Pin, ...], positions: Floats) -> None:
        """Take over pins and pose (n, 2) from another session on the same mesh. Raises InputError."""

        def take(session: Session) -> None:
            session.apply(SetPins(pins))
            session.apply(SetPose(positions))

        self.edit("Apply pose", take)

    def set_settings(self, settings: Settings) -> None:
        """Bend differently from now on. Raises InputError on unknown methods or parameters."""
        if self.session is not None and settings != self.session.state.settings:
            self.edit("Change settings", lambda session: session.apply(SetSettings(settings)))

    def undo(self) -> None:
        """Take back the last gesture; in the middle of one, that one."""
        self.trails.clear()
        if self.busy:
            self.cancel()
        elif self.session is not None:
            self.session.undo()
            self._prune_selection()

    def redo(self) -> None:
        """Do again what was undone."""
        self.trails.clear()
        if self.session is not None and not self.busy:
            self.session.redo()
            self._prune_selection()

    def go_to(self, depth: int) -> None:
        """Undo or redo until so many gestures can be undone, or there are no more."""
        if self.session is None or self.busy:
            return
        history = self.session.history
        while history.depth > max(depth, 0):
            self.undo()
        while history.depth < depth and history.redo_label is not None:
            self.redo()

    def edit(self, label: str, change: Callable[[Session], None]) -> None:
        """Change the session in one gesture; what goes wrong is taken back and raised."""
        if self.session is None or self.busy:
            return
        self.session.begin(label)
        try:
            change(self.session)
        except Exception:
            self.session.abort()
            raise
        self.session.commit()
        self._prune_selection()

    # -- selection -----------------------------------------------------------------------------------------

    def select(self, ids: Iterable[int]) -> None:
        """Select exactly these pins."""
        self.selection = frozenset(ids)
        self._prune_selection()

    def select_all(self) -> None:
        """Select every pin."""
        if self.session is not None:
            self.select(pin.id for pin in self.session.state.pins)

    def _prune_selection(self) -> None:
        there = {pin.id for pin in self.session.state.pins} if self.session is not None else set()
        self.selection &= there
