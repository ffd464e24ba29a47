"""Writes GIF animations; Pillow compresses the pixels.

Pillow's own writer of several frames begins a new file inside the file where a frame is empty, and stores a
palette with each frame.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from struct import pack

import numpy as np
from numpy.typing import NDArray
from PIL import GifImagePlugin, Image

from ...progress import announce, announced, part
from ...words import tr
from ..atomic import Write
from ..images import Picture
from .coverage import opaque_pixels
from .frames import ENCODING, collect_frames, frame_durations
from .palette import NearestColors, find_palette

MAX_GIF_FPS = 50  # players show at most 50 frames per second of a GIF

_MAX_SIDE = 65535
_COLORS = 255
_TRANSPARENT = 255  # palette index
_KEEP, _CLEAR = 1, 2  # what becomes of a frame's rectangle before the next one is drawn

Box = tuple[int, int, int, int]  # left, top, right, bottom


def write_gif(path: Path, frames: Iterable[Picture], fps: float, plays: int, write: Write) -> str:
    """Write a GIF, with one palette of 255 colors for all frames; see `write_animation`.

    Pixels are opaque or transparent, see `opaque_pixels`. GIF counts time in units of 10 ms, so one frame may
    be shown 10 ms longer than the next, but the sums do not drift. Above `MAX_GIF_FPS` frames are left out,
    so that the speed is right (of 60 fps, each sixth).
    """
    images = collect_frames(frames, _MAX_SIDE, ".gif")
    slots = [int(number * min(1.0, MAX_GIF_FPS / fps)) for number in range(len(images))]
    is_shown = [slot != before for slot, before in zip(slots, [-1, *slots], strict=False)]
    images = [image for image, shows in zip(images, is_shown, strict=True) if shows]
    fps = min(fps, MAX_GIF_FPS)
    write(path, encode_gif(images, frame_durations(len(images), fps, unit=10), plays))
    return tr("at {fps:g} frames per second", fps=fps)


def encode_gif(images: Sequence[Picture], durations: Sequence[int], plays: int) -> bytes:
    """The bytes of a GIF of frames (h, w, 4) uint8 and their durations in ms, multiples of 10.

    plays: how often it is shown, 0 for forever.
    """
    with part(0.0, 0.4):
        masks = [opaque_pixels(image) for image in announced(images, ENCODING)]
    announce(0.4, ENCODING)
    palette = find_palette(images, masks, _COLORS)
    nearest = NearestColors(palette)
    with part(0.6, 0.8):
        indexed = [
            np.where(mask, nearest.indices(image), np.uint8(_TRANSPARENT))
            for image, mask in zip(announced(images, ENCODING), masks, strict=True)
        ]
    height, width = images[0].shape[:2]
    blocks = [_header(width, height, palette, plays if len(images) > 1 else 1)]
    with part(0.8, 1.0):
        blocks += _frame_blocks(indexed, durations)
    return b"".join([*blocks, b";"])


def _header(width: int, height: int, palette: Picture, plays: int) -> bytes:
    """The blocks before the first frame: size, palette, and how often it is shown."""
    colors = np.zeros((256, 3), dtype=np.uint8)
    colors[: len(palette)] = palette
    header = b"GIF89a" + pack("<HHBBB", width, height, 0xF7, _TRANSPARENT, 0) + colors.tobytes()
    if plays == 1:
        return header
    # it says how often it is shown again, and says nothing if it is not
    return header + b"!\xff\x0bNETSCAPE2.0\x03\x01" + pack("<H", max(plays - 1, 0)) + b"\0"


def _frame_blocks(indexed: Sequence[Picture], durations: Sequence[int]) -> Iterable[bytes]:
    """The blocks of each frame (h, w) of palette indices: only the rectangle in which it changes.

    A pixel of it that stays is transparent. Where pixels become transparent, the frame before is cleared in
    a rectangle that contains all of them.
    """
    canvas = np.full_like(indexed[0], _TRANSPARENT)
    frames = announced(indexed, ENCODING)
    for number, (frame, duration) in enumerate(zip(frames, durations, strict=True)):
        following = indexed[number + 1] if number + 1 < len(indexed) else frame
        vanishing = (frame != _TRANSPARENT) & (following == _TRANSPARENT)
        left, top, right, bottom = box = _changed_box((frame != canvas) | vanishing)
        disposal = _CLEAR if vanishing.any() else _KEEP
        changed = frame[top:bottom, left:right].copy()
        changed[changed == canvas[top:bottom, left:right]] = _TRANSPARENT
        yield _frame_block(changed, box, duration, disposal)
        canvas = frame.copy()
        if disposal == _CLEAR:
            canvas[top:bottom, left:right] = _TRANSPARENT


def _changed_box(changed: NDArray[np.bool_]) -> Box:
    """The smallest box around the pixels ``changed`` (h, w), one pixel if none is."""
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    if not len(rows):
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def _frame_block(changed: Picture, box: Box, duration: int, disposal: int) -> bytes:
    picture = Image.fromarray(changed)
    options = {"transparency": _TRANSPARENT, "duration": duration, "disposal": disposal, "interlace": 0}
    return b"".join(GifImagePlugin.getdata(picture, box[:2], **options))
