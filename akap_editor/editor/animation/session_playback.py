"""Playback of the session itself: every state that was seen, to look at again and to continue from."""

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic

from ...deform.pose_interpolation import InterpolationCache
from ...geometry.validation import Floats
from ..document.crossings import crossings_in_pose, draw_order
from ..document.document import EditState
from ..document.drawing import Drawing
from ..session.session import Session
from .frames import Frame
from .loose_motion import Crossed, Instant
from .motion import MAX_MOVE_SECONDS
from .playback import Playback, VisibleRange

MAX_PAUSE_SECONDS = 1.0  # longer pauses between edits are shortened to this
MAX_BYTES = 2**28  # of poses; when there are more, every second one of the older half is dropped


@dataclass(frozen=True, eq=False)
class Snapshot:
    """A state of the session.

    time: in seconds, with shortened pauses; line: number of lines of the recording before it;
    discontinuities: as the session counted them.
    """

    time: float
    line: int
    state: EditState
    drawing: Drawing
    discontinuities: int = 0


class SessionPlayback(Playback):
    """Records the states of a session and shows them again; see `Session.preview`.

    Times are seconds since the session began, with shortened pauses. An edit at an earlier time starts a new
    branch: later snapshots leave the timeline, but stay in the history and in the recording. take_start: time
    at which the current take began, None if there is none.
    """

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        super().__init__(clock)
        self._session: Session | None = None
        self._interpolation = InterpolationCache()
        self._reset()

    def _reset(self) -> None:
        self.snapshots: list[Snapshot] = []
        self.time = self.marked_range = self._last_update = None
        self.visible_range = VisibleRange(1.0)
        self.take_start: float | None = None
        self._before_branch: list[Snapshot] | None = None  # snapshots that the last branch has cut off
        self._branch_time: float | None = None  # of the branch, until its first gesture ends
        self._last_change = self._clock()

    @property
    def duration(self) -> float:
        """Seconds from the first snapshot to the last one."""
        return self.snapshots[-1].time if self.snapshots else 0.0

    def follow(self, session: Session | None) -> bool:
        """Record the session's state if it has changed; to be called once a frame.

        Returns whether a gesture that continued from an earlier time has just ended: what came later is cut
        off, and comes back when the gesture is undone.
        """
        if session is not self._session:
            self._session = session
            self._reset()
        if session is None or session.is_previewing or session.has_pending_step:
            return False
        is_open, continues = session.history.is_open, False
        if not is_open and self._before_branch is not None:
            if self._before_branch[-1].state is session.state:  # undone, or a gesture that was cancelled
                self._end_branch()
                return False
            continues, self._branch_time = self._branch_time is not None, None
        is_at_end = bool(self.snapshots) and self.snapshots[-1].state is session.state
        if self.time is not None and is_at_end and not is_open:
            self.scrub(self.time)  # a gesture has begun and changed nothing
            return False
        if self.time is not None:  # an edit continued from an earlier snapshot
            self._start_branch(self.time)
        if not (self.snapshots and self.snapshots[-1].state is session.state):
            self._add_snapshot(session)
        return continues

    def _add_snapshot(self, session: Session) -> None:
        now = self._clock()
        pause = min(now - self._last_change, MAX_PAUSE_SECONDS) if self.snapshots else 0.0
        self._last_change = now
        time, line = self.duration + pause, len(session.recording.events) + 1
        self.snapshots.append(Snapshot(time, line, session.state, session.drawing, session.discontinuities))
        if len(self.snapshots) * session.state.positions.nbytes > MAX_BYTES:
            half = len(self.snapshots) // 2
            self.snapshots = self.snapshots[:half:2] + self.snapshots[half:]

    def _end_branch(self) -> None:
        """Return to the snapshots from before the branch, and to its time if nothing was edited there."""
        assert self._before_branch is not None
        time, self._branch_time = self._branch_time, None
        self.snapshots, self._before_branch = self._before_branch, None
        if time is not None:
            self.scrub(time)

    def _start_branch(self, time: float) -> None:
        """Drop the snapshots after a time, and what refers to them."""
        self._before_branch, self._branch_time = self.snapshots, time
        self.snapshots = self.snapshots[: self._index(time) + 1]
        self.time = self._last_update = None
        if self.take_start is not None:
            self.take_start = self.duration
        if self.marked_range is not None and self.marked_range[1] > self.duration:
            self.marked_range = None
        self._last_change = self._clock()

    def _index(self, time: float) -> int:
        return max(0, bisect_right(self.snapshots, time, key=lambda snapshot: snapshot.time) - 1)

    def snapshot_at(self, time: float) -> Snapshot:
        """The last snapshot up to a time."""
        return self.snapshots[self._index(time)]

    def scrub(self, time: float) -> None:
        """Show the session at a time, while playing also between snapshots; at the end show the present."""
        if self._session is None or self._session.history.is_open or not self.snapshots:
            return
        if time >= self.duration:
            self.show_present()
            return
        self.time = max(time, 0.0)
        self.visible_range.reveal(self.time)
        snapshot = self.snapshot_at(self.time)
        if self.is_playing:
            self._session.preview(snapshot.state, snapshot.line, self._pose(self.time))
        elif snapshot.state is not self._session.state:
            self._session.preview(snapshot.state, snapshot.line)

    def show_present(self) -> None:
        """Show the session as it is now."""
        self.time = self._last_update = None
        if self._session is not None:
            self._session.end_preview()

    def start_take(self) -> None:
        """Start a take at the playhead: what is done until its end becomes the range."""
        self.stop()
        self._last_change = self._clock()
        self.take_start = self.playhead

    def end_take(self) -> None:
        """End the take, if there is one, and mark it as the range."""
        if self.take_start is not None:
            is_empty = self.duration <= self.take_start
            self.marked_range = None if is_empty else (self.take_start, self.duration)
            self.take_start = None

    @property
    def content(self) -> tuple[object, ...]:
        """What the poses depend on; equal as long as they are the same."""
        return self._session, len(self.snapshots), *self.snapshots[-1:]

    def pose_at(self, time: float) -> tuple[Drawing, Floats]:
        """The drawing and its pose (n, 2) at a time, see `frame`; there must be a snapshot."""
        snapshot = self.snapshot_at(time)
        return snapshot.drawing, self._pose(time)

    def instant(self, time: float) -> Instant:
        snapshot = self.snapshot_at(time)
        return Instant(snapshot.drawing, snapshot.state, self._pose(time))

    def crossed(self, time: float) -> Crossed:
        state = self.snapshot_at(time).state
        return Crossed(state.pins, state.positions, state.crossings)

    def plain_frame(self, time: float) -> Frame:
        """The frame at a time; between two snapshots each edge rotates and grows at a constant rate.

        After a long pause the motion takes only its last `MAX_MOVE_SECONDS`. A pose that no step led to
        appears at once.
        """
        snapshot, pose = self.snapshot_at(time), self._pose(time)
        mesh, state = snapshot.drawing.mesh, snapshot.state
        crossings = state.crossings
        if pose is not state.positions:
            crossings = crossings_in_pose(mesh, state.pins, state.positions, crossings, pose)
        return Frame(snapshot.drawing, pose, draw_order(snapshot.drawing, state.pins, pose, crossings))

    def _pose(self, time: float) -> Floats:
        index = self._index(time)
        snapshot = self.snapshots[index]
        following = self.snapshots[min(index + 1, len(self.snapshots) - 1)]
        start = max(snapshot.time, following.time - MAX_MOVE_SECONDS)
        mesh, pose = snapshot.drawing.mesh, snapshot.state.positions
        is_continuous = (
            following.discontinuities == snapshot.discontinuities and following.drawing is snapshot.drawing
        )
        if time > start and is_continuous:
            share = min((time - start) / (following.time - start), 1.0)
            pose = self._interpolation.pose(mesh, pose, following.state.positions, share)
        return pose
