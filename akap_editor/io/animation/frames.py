"""Checks of the pictures that become an animation, and how long each is shown."""

import zlib
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

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


Box = tuple[int, int, int, int]  # left, top, right, bottom


class PackedFrames(Sequence[NDArray[Any]]):
    """Arrays of one shape and dtype, compressed in memory: of cartoons a tenth is left."""

    def __init__(self) -> None:
        self._packed: list[bytes] = []
        self._shape: tuple[int, ...] = ()
        self._dtype: np.dtype[Any] = np.dtype(np.uint8)

    def append(self, array: NDArray[Any]) -> None:
        """Add a copy of an array."""
        self._shape, self._dtype = array.shape, array.dtype
        self._packed.append(zlib.compress(np.ascontiguousarray(array).data, 1))

    def __len__(self) -> int:
        return len(self._packed)

    @overload
    def __getitem__(self, number: int) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, number: slice) -> list[NDArray[Any]]: ...
    def __getitem__(self, number: int | slice) -> NDArray[Any] | list[NDArray[Any]]:
        if isinstance(number, slice):
            return [self[k] for k in range(*number.indices(len(self)))]
        return np.frombuffer(zlib.decompress(self._packed[number]), self._dtype).reshape(self._shape)


def collect_frames(frames: Iterable[Picture], max_side: int, suffix: str) -> PackedFrames:
    """All frames, (h, w, 4) uint8 each, packed; raises InputError as `bounded_frames`."""
    packed = PackedFrames()
    for image in bounded_frames(frames, max_side, suffix):
        packed.append(image)
    return packed


def bounded_frames(frames: Iterable[Picture], max_side: int, suffix: str) -> Iterator[Picture]:
    """Yield frames, (h, w, 4) uint8 each, as they come.

    Raises InputError as `checked_frames`, for more than ``max_side`` pixels a side, and for more than
    `MAX_ANIMATION_PIXELS`. suffix: the format's ending, for messages.
    """
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
        yield image


def bounding_box(mask: NDArray[np.bool_]) -> Box:
    """The smallest box around the pixels of a mask (h, w), one pixel if there is none."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def frame_durations(count: int, fps: float, unit: int) -> list[int]:
    """Durations of frames in ms: multiples of ``unit`` ms whose sums never drift from the rate."""
    ticks = [round(1000 / unit * number / fps) for number in range(count + 1)]
    return [unit * (end - start) for start, end in pairwise(ticks)]
