"""An estimate of the size of an animation's file: the real writer writes a few frames, in a thread."""

from collections.abc import Generator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from ....editor.framing import Box, Color
from ....errors import InputError
from ....io.animation.formats import AnimationFormat, Shot, write_animation
from ....io.painter import FramedPose
from ....words import number_text
from ...app_state import AppState
from ...jobs.frame_encoder import FrameEncoder

_PLACES = 8  # in the animation, at each of which two frames are looked at


@dataclass(frozen=True)
class WrittenAnimation:
    """What the size depends on, besides the motion.

    times: of all frames in playing order, seconds on the timeline; framing: the box that is shown, and pixels
    per drawing unit; background: None for transparent.
    """

    format: AnimationFormat
    times: tuple[float, ...]
    framing: tuple[Box, float]
    fps: float
    plays: int
    background: Color | None


def size_in_words(size: int) -> str:
    """A number of bytes with two digits, as an estimate has no more."""
    for unit in ("kB", "MB"):
        size_in_unit = size / 1000 if unit == "kB" else size / 1_000_000
        if size_in_unit < 995:
            return f"{_with_two_digits(size_in_unit)} {unit}"
    return f"{_with_two_digits(size / 1e9)} GB"


def _with_two_digits(number: float) -> str:
    return number_text(float(format(number, ".2g")), "g")


class SizeEstimate:
    """Writes a few frames to a temporary folder, at places spread over the animation.

    What a frame costs after the one before it is the difference between two files: one with a pair of frames
    of each place, and one with the first frame of each place. A rough one of a single pair comes first.
    `close` must be called in the end.
    """

    def __init__(self) -> None:
        self._content: tuple[object, ...] = ()
        self._steps: Generator[None, None, None] | None = None
        self._size: int | None = None

    @property
    def is_rough(self) -> bool:
        """Whether a better estimate than the last one will follow."""
        return self._steps is not None

    def advance(self, state: AppState, animation: WrittenAnimation) -> int | None:
        """The estimated size in bytes, at first that of the last options; None if it is not known.

        To be called once a frame; the window is woken, so that work goes on in the next one.
        """
        content = (animation, state.timeline.mode, *state.timeline.playback.content)
        if content != self._content:
            self._end()
            self._content = content
            self._steps = self._estimate(state, animation)
        if self._steps is not None:
            try:
                next(self._steps)
            except StopIteration:
                self._steps = None
            except (InputError, OSError):  # the export itself will tell
                self._steps = self._size = None
        return self._size

    def close(self) -> None:
        """End what is under way, and forget the estimate."""
        self._end()
        self._content, self._size = (), None

    def _end(self) -> None:
        steps, self._steps = self._steps, None
        if steps is not None:
            steps.close()

    def _estimate(self, state: AppState, animation: WrittenAnimation) -> Generator[None, None, None]:
        count, times = len(animation.times), animation.times
        if count <= 2 * _PLACES:
            self._size = yield from _written_size(state, animation, times)
            return
        places = [number * (count - 2) // (_PLACES - 1) for number in range(_PLACES)]
        firsts = tuple(times[place] for place in places)
        pairs = tuple(time for place in places for time in times[place : place + 2])
        size_of_one = yield from _written_size(state, animation, firsts[:1])
        middle = pairs[_PLACES : _PLACES + 2]
        size_of_pair = yield from _written_size(state, animation, middle)
        self._size = size_of_one + (count - 1) * max(size_of_pair - size_of_one, 0)
        size_of_firsts = yield from _written_size(state, animation, firsts)
        size_of_pairs = yield from _written_size(state, animation, pairs)
        self._size = size_of_one + (count - 1) * max(size_of_pairs - size_of_firsts, 0) // _PLACES


def _written_size(
    state: AppState, animation: WrittenAnimation, times: tuple[float, ...]
) -> Generator[None, None, int]:
    """Write frames and measure their files; yields while the writer has enough to do."""
    with TemporaryDirectory(prefix="akap-editor-", ignore_cleanup_errors=True) as folder:
        path = Path(folder) / f"sample{animation.format.suffix}"
        export = partial(
            write_animation,
            path,
            fps=animation.fps,
            plays=animation.plays,
            sheet=animation.format.is_sheet,
            overwrite=True,
        )
        encoder = FrameEncoder(export, state.wake)
        try:
            for time in times:
                for _ in encoder.take(_shot(state, animation, time)):
                    yield
                state.wake()
                yield
            for _ in encoder.finish():
                yield
            _ = encoder.said  # raises the exception of the writer
        finally:
            encoder.close()
        return sum(each.stat().st_size for each in Path(folder).rglob("*") if each.is_file())


def _shot(state: AppState, animation: WrittenAnimation, time: float) -> Shot:
    frame, (box, scale) = state.timeline.frame(time), animation.framing
    if animation.format.is_page:
        return FramedPose(frame, box, scale, animation.background)
    return state.offscreen_renderer.render(
        frame.drawing, frame.pose, box, scale, animation.background, frame.order
    )
