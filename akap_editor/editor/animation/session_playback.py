"""What a session looked like at every moment, to be watched again, and gone on with from anywhere."""

import time
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass

from ...deform.pose_interpolation import InterpolationCache
from ..document.depth import face_order
from ..document.document import EditState
from ..document.drawing import Drawing
from ..session.session import Session
from .frames import Frame
from .motion import LONGEST_MOVE
from .playback import Playback
from .time_view import VisibleRange

LONGEST_PAUSE = 1.0  # seconds: pauses between edits are not shown for longer
MOST_BYTES = 2**28  # of poses; beyond, every second of the older ones is forgotten


@dataclass(frozen=True, eq=False)
class Snapshot:
    """A state of the session.

    time: in seconds, with pauses shortened; line: of the recording before it; jumps: as the session had them.
    """

    time: float
    line: int
    state: EditState
    drawing: Drawing
    jumps: int = 0


class SessionPlayback(Playback):
    """Watches a session and shows it again; see `Session.visit`.

    Times are seconds since the session began, pauses shortened. Going on from an earlier moment starts a new
    branch: what came after that moment leaves the timeline, and stays in history and recording.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(clock)
        self._session: Session | None = None
        self._ways = InterpolationCache()
        self._forget()

    def _forget(self) -> None:
        self.snapshots: list[Snapshot] = []
        self.at = self.cut = self._played = None  # at None is now
        self.view = VisibleRange(1.0)  # the part of it that the timeline shows
        self.taking: float | None = None  # since when a take is recorded
        self._seen = self._clock()

    @property
    def duration(self) -> float:
        """Seconds from the first to the last shot."""
        return self.snapshots[-1].time if self.snapshots else 0.0

    def watch(self, session: Session | None) -> None:
        """Note the session's state, where it is another than before; to be called once a frame."""
        if session is not self._session:
            self._session = session
            self._forget()
        if session is None or session.is_previewing or session.has_pending_step:
            return
        if self.at is not None:  # a gesture went on from there
            self.snapshots = self.snapshots[: self._index(self.at) + 1]
            self.at = self._played = None
            self.taking = self.duration if self.taking is not None else None
            self.cut = None if self.cut is not None and self.cut[1] > self.duration else self.cut
            self._seen = self._clock()
        if self.snapshots and self.snapshots[-1].state is session.state:
            return
        now = self._clock()
        passed = min(now - self._seen, LONGEST_PAUSE) if self.snapshots else 0.0
        self._seen = now
        line = len(session.recording.events) + 1
        self.snapshots.append(
            Snapshot(self.duration + passed, line, session.state, session.drawing, session.discontinuities)
        )
        if len(self.snapshots) * session.state.positions.nbytes > MOST_BYTES:
            half = len(self.snapshots) // 2
            self.snapshots = self.snapshots[:half:2] + self.snapshots[half:]

    def _index(self, moment: float) -> int:
        return max(0, bisect_right(self.snapshots, moment, key=lambda shot: shot.time) - 1)

    def shot(self, moment: float) -> Snapshot:
        """What was seen at a time."""
        return self.snapshots[self._index(moment)]

    def scrub(self, moment: float) -> None:
        """Show the session as it was at a time; at its end, as it is. While it plays, also between shots."""
        if self._session is None or self._session.history.is_open or not self.snapshots:
            return
        if moment >= self.duration:
            self.now()
            return
        self.at = max(moment, 0.0)
        self.view.reveal(self.at)
        shot = self.shot(self.at)
        if self.playing:
            self._session.preview(shot.state, shot.line, self.frame(self.at).pose)
        elif shot.state is not self._session.state:
            self._session.preview(shot.state, shot.line)

    def now(self) -> None:
        """Show the session as it is."""
        self.at = self._played = None
        if self._session is not None:
            self._session.end_preview()

    def take(self, on: bool) -> None:
        """Start or end a take: the part of the session between the two becomes the range."""
        if on:
            self.stop()
            self._seen = self._clock()
            self.taking = self.duration if self.at is None else self.at
        elif self.taking is not None:
            self.cut = (self.taking, self.duration) if self.duration > self.taking else None
            self.taking = None

    def frame(self, moment: float) -> Frame:
        """What is seen at a time, also between two shots: each edge turns and grows at a constant rate.

        After a longer pause, the motion takes the last of it. What was not reached by steps comes at once.
        """
        index = self._index(moment)
        shot = self.snapshots[index]
        after = self.snapshots[min(index + 1, len(self.snapshots) - 1)]
        start = max(shot.time, after.time - LONGEST_MOVE)
        pose = shot.state.positions
        if moment > start and after.jumps == shot.jumps and after.drawing is shot.drawing:
            share = (moment - start) / (after.time - start)
            pose = self._ways.pose(shot.drawing.mesh, pose, after.state.positions, min(share, 1.0))
        return Frame(shot.drawing, pose, face_order(shot.drawing.mesh, shot.state.pins))
