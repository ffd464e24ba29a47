"""The motion of a bundled drawing for a small picture: its recording, replayed in a thread."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import numpy as np
from PIL import Image

from ...editor.animation.frames import Frame
from ...editor.document.document import new_document
from ...editor.document.drawing import make_drawing
from ...editor.session.replay import replay
from ...errors import AkapError
from ...io.akap.recording import read_recording
from ...io.images import read_image
from ...resources import PUPPET_SUFFIX, resource
from .background_thread import BackgroundThread, Wake

VERTICES, FRAMES_PER_SECOND = 300, 24
_SIDE = 320  # of the picture that is bent, pixels at most
_PAUSE = 0.6  # longest pause that is kept, seconds


@dataclass(frozen=True)
class TileMotion:
    """Frames at `FRAMES_PER_SECOND`, which play forwards and backwards; none if there is no motion."""

    frames: tuple[Frame, ...]

    def frame(self, seconds: float) -> Frame:
        """The frame that is shown after so many seconds."""
        last = len(self.frames) - 1
        number = int(seconds * FRAMES_PER_SECOND) % max(2 * last, 1)
        return self.frames[min(number, 2 * last - number)]


def recorded_motion(path: Path) -> TileMotion:
    """The motion of the recording that is bundled with a drawing; none if there is none, or for a puppet.

    A puppet's recording belongs to its own fine mesh, whose replay takes too long for a tile.
    """
    if path.suffix == PUPPET_SUFFIX:
        return TileMotion(())
    try:
        recording = read_recording(resource("assets", "recordings", f"{path.stem}.akaprec"))
    except (FileNotFoundError, AkapError):
        return TileMotion(())
    picture = Image.fromarray(read_image(path))
    picture.thumbnail((_SIDE, _SIDE), Image.Resampling.LANCZOS)
    drawing = make_drawing(np.asarray(picture), vertices=VERTICES, name=path.stem)
    document, frames = new_document(drawing), [Frame(drawing, drawing.mesh.vertices)]
    time, shown, due = 0.0, 0.0, 0.0
    for event in replay(recording, drawing):
        shown += min(event.time - time, _PAUSE)
        time = event.time
        if event.step is None or shown < due:
            continue
        due = shown + 1 / FRAMES_PER_SECOND
        order = document.with_state(event.state).draw_order
        frames.append(Frame(drawing, event.state.positions, order))
    return TileMotion(tuple(frames))


class TileMotions:
    """The motions of the tiles over which the pointer has been, computed when it comes there.

    clock: seconds.
    """

    def __init__(self, clock: Callable[[], float] = perf_counter) -> None:
        self._clock = clock
        self._motions: dict[Path, Future[TileMotion]] = {}
        self._thread: BackgroundThread | None = None
        self._current: tuple[Path, float] | None = None  # the tile that plays, and since when

    def frame(self, path: Path, wake: Wake) -> Frame | None:
        """The frame of a tile that is shown now; None until the motion is known, or if there is none."""
        if path not in self._motions:
            if self._thread is None:
                self._thread = BackgroundThread("tiles", wake)
            self._motions[path] = self._thread.submit(recorded_motion, path)
        future = self._motions[path]
        if not future.done():
            return None
        if self._current is None or self._current[0] != path:
            self._current = path, self._clock()
        motion = future.result()
        return motion.frame(self._clock() - self._current[1]) if motion.frames else None

    def stop(self, path: Path) -> None:
        """Note that the pointer is not over a tile; it starts from its first frame the next time."""
        if self._current is not None and self._current[0] == path:
            self._current = None
