"""Checks of the pictures that become an animation, and how long each is shown."""

from collections.abc import Iterable, Iterator
from itertools import pairwise

from ...errors import InputError
from ...geometry.validation import as_picture
from ...words import mark, tr
from ..images import Picture

ENCODING = mark("Encoding")  # what is announced while a file is made of all frames
MAX_ANIMATION_PIXELS = 1_000_000_000  # of all frames together


def checked_frames(frames: Iterable[Picture]) -> Iterator[Picture]:
    """Yield frames, (h, w, 4) uint8 each, as they come.

    Raises InputError at the first one of another shape or size, or if there is none at all.
    """
    first = None
    for number, image in enumerate(frames):
        as_picture(image, f"frame {number}")
        first = image.shape if first is None else first
        if image.shape != first:
            expected, came = (f"{width} x {height}" for height, width, _ in (first, image.shape))
            raise InputError(
                tr(
                    "frame {number}: expected {expected} pixels as in frame 0, got {came}",
                    number=number,
                    expected=expected,
                    came=came,
                )
            )
        yield image
    if first is None:
        raise InputError(tr("frames: expected at least one frame, got none"))


def collect_frames(frames: Iterable[Picture], max_side: int, suffix: str) -> list[Picture]:
    """Copies of all frames, (h, w, 4) uint8 each.

    Raises InputError as `checked_frames`, for more than ``max_side`` pixels a side, and for more than
    `MAX_ANIMATION_PIXELS`. suffix: the format's ending, for messages.
    """
    images: list[Picture] = []
    pixels = 0
    for image in checked_frames(frames):
        height, width = image.shape[:2]
        if max(width, height) > max_side:
            raise InputError(
                tr(
                    "{suffix}: expected at most {most} pixels a side, got {width} x {height}",
                    suffix=suffix,
                    most=max_side,
                    width=width,
                    height=height,
                )
            )
        pixels += width * height
        if pixels > MAX_ANIMATION_PIXELS:
            most = MAX_ANIMATION_PIXELS // (width * height)
            raise InputError(
                tr(
                    "frames: expected at most {most} frames of {width} x {height} pixels, got more",
                    most=most,
                    width=width,
                    height=height,
                )
            )
        images.append(image.copy())  # the caller may draw the next frame into the same array
    return images


def frame_durations(count: int, fps: float, unit: int) -> list[int]:
    """Durations of frames in ms: multiples of ``unit`` ms whose sums never drift from the rate."""
    ticks = [round(1000 / unit * number / fps) for number in range(count + 1)]
    return [unit * (end - start) for start, end in pairwise(ticks)]
