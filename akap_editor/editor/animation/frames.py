"""The frames of an animation: what each shows, at which times, and in which order they are played."""

from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from ...errors import InputError
from ...geometry.validation import Floats, Ints, as_number
from ...overlap.seams import CutMesh
from ...words import tr
from ..document.drawing import Drawing
from ..document.easing import easing_function
from ..session.recording import MAX_TIME

MAX_FRAMES = 1_000_000
POSE_TOLERANCE = 0.01  # pixels: poses that differ by less look alike

T = TypeVar("T")


class Frame(NamedTuple):
    """A drawing in a pose (n, 2); order: what is drawn from back to front, see `Document.draw_order`."""

    drawing: Drawing
    pose: Floats
    order: Ints | CutMesh | None = None


def frame_times(start: float, end: float, fps: float, speed: float = 1.0, ease: str = "none") -> list[float]:
    """The times in seconds, from ``start`` to ``end``, at which a motion is shown; the last one is ``end``.

    fps: frames per second, 1 to 240; speed: 2 is twice as fast, 0.01 to 100; ease: see `easing_function`.
    Raises InputError.
    """
    as_number(fps, "fps", 1, 240)
    as_number(speed, "speed", 0.01, 100)
    as_number(start, "start", 0, MAX_TIME)
    as_number(end, "end", start, MAX_TIME)
    eased, span = easing_function(ease), end - start
    count = int(span / speed * fps + 1e-6)
    if count > MAX_FRAMES:
        raise InputError(
            tr(
                "expected at most {most} frames, got {count} for {span:g} s; "
                "take fewer frames a second, a higher speed, a part of the time, or shorter pauses",
                most=MAX_FRAMES,
                count=count,
                span=span,
            )
        )
    return [*(start + span * eased(k * speed / fps / span) for k in range(count)), end]


def loops_seamlessly(first: Frame, last: Frame) -> bool:
    """Whether an animation ends as it begins, so that one of the two frames is enough when it repeats."""
    return first.drawing is last.drawing and np.allclose(first.pose, last.pose, rtol=0.0, atol=POSE_TOLERANCE)


def playing_order(frames: Sequence[T], ping_pong: bool, is_seamless_loop: bool) -> list[T]:
    """Frames, or their times, in the order in which an animation shows them.

    ping_pong: forwards, then backwards without the first and the last frame. Otherwise, in a seamless loop of
    more than two frames, the last frame is dropped.
    """
    if ping_pong:
        return [*frames, *frames[-2:0:-1]]
    if is_seamless_loop and len(frames) > 2:
        return list(frames[:-1])
    return list(frames)
