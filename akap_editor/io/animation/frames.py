"""Checks of the pictures that become an animation."""

from collections.abc import Iterable, Iterator

from ...errors import InputError
from ...geometry.validation import as_picture
from ..images import Picture


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
            raise InputError(f"frame {number}: expected {expected} pixels as in frame 0, got {came}")
        yield image
    if first is None:
        raise InputError("frames: expected at least one frame, got none")
