"""What a session looked like at every moment, to be watched again, and gone on with from anywhere."""

import time
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass

from .depth import face_order
from .document import Drawing, EditState
from .session import Session
from .timeline import Frame

LONGEST_PAUSE = 1.0  # seconds: pauses between edits are not shown for longer
MOST_BYTES = 2**28  # of poses; beyond, every second of the older ones is forgotten


@dataclass(frozen=True, eq=False)
class Shot:
    """A state of the session; time: in seconds, with pauses shortened; line: of the recording before it."""

    time: float
    line: int
    state: EditState
    drawing: Drawing


class Player:
    """Watches a session and shows it again; see `Session.visit`.

    Times are seconds since the session began, pauses shortened. Going on from an earlier moment starts a new
    branch: what came after that moment leaves the timeline, and stays in history and recording.
    cut: the part that is played and exported, all of it where None; loop: whether playing starts over.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._session: Session | None = None
        self._forget()
        self.loop = True

    def _forget(self) -> None:
        self.shots: list[Shot] = []
        self.at: float | None = None  # where the session is looked at; None: now
        self.cut: tuple[float, float] | None = None
        self.taking: float | None = None  # since when a take is recorded
        self._seen = self._clock()
        self._played: float | None = None  # the clock at the last frame of playing

    @property
    def duration(self) -> float:
        """Seconds from the first to the last shot."""
        return self.shots[-1].time if self.shots else 0.0

    @property
    def playing(self) -> bool:
        """Whether time passes on the timeline."""
        return self._played is not None

    @property
    def range(self) -> tuple[float, float]:
        """What is played and exported, in seconds."""
        return self.cut or (0.0, self.duration)

    def watch(self, session: Session | None) -> None:
        """Note the session's state, where it is another than before; to be called once a frame."""
        if session is not self._session:
            self._session = session
            self._forget()
        if session is None or session.visiting:
            return
        if self.at is not None:  # a gesture went on from there
            self.shots = self.shots[: self._index(self.at) + 1]
            self.at = self._played = None
            self.cut = None if self.cut is not None and self.cut[1] > self.duration else self.cut
            self._seen = self._clock()
        if self.shots and self.shots[-1].state is session.state:
            return
        now = self._clock()
        passed = min(now - self._seen, LONGEST_PAUSE) if self.shots else 0.0
        self._seen = now
        line = len(session.recording.events) + 1
        self.shots.append(Shot(self.duration + passed, line, session.state, session.drawing))
        if len(self.shots) * session.state.positions.nbytes > MOST_BYTES:
            half = len(self.shots) // 2
            self.shots = self.shots[:half:2] + self.shots[half:]

    def _index(self, moment: float) -> int:
        return max(0, bisect_right(self.shots, moment, key=lambda shot: shot.time) - 1)

    def shot(self, moment: float) -> Shot:
        """What was seen at a time."""
        return self.shots[self._index(moment)]

    def scrub(self, moment: float) -> None:
        """Show the session as it was at a time; at its end, as it is."""
        if self._session is None or self._session.history.is_open or not self.shots:
            return
        if moment >= self.duration:
            self.now()
            return
        self.at = max(moment, 0.0)
        shot = self.shot(self.at)
        if shot.state is not self._session.state:
            self._session.visit(shot.state, shot.line)

    def now(self) -> None:
        """Show the session as it is."""
        self.at = self._played = None
        if self._session is not None:
            self._session.leave()

    def play(self) -> None:
        """Play the range from where it is looked at, or from its start; stop where it plays."""
        start, end = self.range
        if self.playing:
            self._played = None
        elif end > start:
            inside = self.at is not None and start <= self.at < end
            self._played = self._clock()
            self.scrub(self.at if inside and self.at is not None else start)

    def advance(self) -> None:
        """Let time pass on the timeline; to be called once a frame."""
        if self._played is None or self.at is None:
            self._played = None
            return
        now = self._clock()
        moment, (start, end) = self.at + now - self._played, self.range
        self._played = now
        if moment < end:
            self.scrub(moment)
        elif self.loop:
            self.scrub(start)
        else:
            self._played = None
            self.scrub(end)

    def take(self, on: bool) -> None:
        """Start or end a take: the part of the session between the two becomes the range."""
        if on:
            self.now()
            self._seen = self._clock()
            self.taking = self.duration
        elif self.taking is not None:
            self.cut = (self.taking, self.duration) if self.duration > self.taking else None
            self.taking = None

    def cut_to(self, start: float | None = None, end: float | None = None) -> None:
        """Change the range; an empty one is all there is."""
        low, high = self.range
        low = low if start is None else max(start, 0.0)
        high = high if end is None else min(end, self.duration)
        self.cut = (low, high) if low < high else None

    def frames(self, fps: float) -> list[Frame]:
        """What is seen in each frame of the range."""
        start, end = self.range
        count = int((end - start) * fps + 1e-6)
        shots = [self.shot(start + number / fps) for number in range(count + 1)]
        return [
            Frame(shot.drawing, shot.state.positions, face_order(shot.drawing.mesh, shot.state.pins))
            for shot in shots
        ]
