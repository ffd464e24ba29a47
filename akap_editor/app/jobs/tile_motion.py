"""The motion of a bundled drawing for a small picture: its recording, replayed in a thread."""

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, replace
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
from ...io.images import Picture, read_image
from ...io.layers.open_layers import open_layers
from ...layers.layered_picture import LayeredPicture, trimmed
from ...resources import PUPPET_SUFFIX, resource
from .background_thread import BackgroundThread, Wake

VERTICES, FRAMES_PER_SECOND = 300, 24
_LONG_SIDE, _SHORT_SIDE = 320, 64  # of the picture that is bent, pixels: not more, and not less
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
    """The motion of the recording that is bundled with a drawing, on a coarse mesh; none if there is none."""
    try:
        recording = read_recording(resource("assets", "recordings", f"{path.stem}.akaprec"))
    except (FileNotFoundError, AkapError):
        return TileMotion(())
    if path.suffix == PUPPET_SUFFIX:
        drawing = make_drawing(layers=_small_layers(open_layers(path)), vertices=VERTICES, name=path.stem)
    else:
        drawing = make_drawing(_small(read_image(path)), vertices=VERTICES, name=path.stem)
    document, frames = new_document(drawing), [Frame(drawing, drawing.mesh.vertices)]
    time, shown, due = 0.0, 0.0, 0.0
    for event in replay(recording, drawing):
        shown += min(event.time - time, _PAUSE)
        time = event.time
        if event.step is None or shown < due:
            continue
        due = shown + 1 / FRAMES_PER_SECOND
        shown_drawing = event.state.drawing or drawing  # of a puppet, with other layers visible
        order = replace(document, drawing=shown_drawing, state=event.state).draw_order
        frames.append(Frame(shown_drawing, event.state.positions, order))
    return TileMotion(tuple(frames))


def _small(picture: Picture) -> Picture:
    """A picture (h, w, 4) of `_LONG_SIDE` pixels, or of more where it would be too thin."""
    height, width = picture.shape[:2]
    scale = max(_LONG_SIDE / max(width, height), _SHORT_SIDE / min(width, height))
    if scale >= 1:
        return picture
    size = round(scale * width), round(scale * height)
    return np.asarray(Image.fromarray(picture).resize(size, Image.Resampling.LANCZOS))


def _small_layers(layered: LayeredPicture) -> LayeredPicture:
    """A picture in layers on a canvas of the size that `_small` gives."""
    width, height = layered.size
    layers = []
    for layer in layered.layers:
        canvas = np.zeros((height, width, 4), np.uint8)
        left, top, right, bottom = layer.box
        canvas[top:bottom, left:right] = layer.picture
        canvas = _small(canvas)
        cut = trimmed(canvas, (0, 0))
        if cut is not None:
            layers.append(replace(layer, picture=cut[0], offset=cut[1]))
    return LayeredPicture((canvas.shape[1], canvas.shape[0]), tuple(layers))


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
