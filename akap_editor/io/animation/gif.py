"""Writes GIF animations; Pillow compresses the pixels.

Pillow's own writer of several frames begins a new file inside the file where a frame is empty, and stores a
palette with each frame.
"""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from struct import pack

import numpy as np
from PIL import GifImagePlugin, Image

from ...progress import announce, announced, part
from ...words import tr
from ..atomic import Write
from ..images import Picture
from .frames import ENCODING, Box, PackedFrames, bounded_frames, bounding_box, frame_durations

MAX_GIF_FPS = 50  # players show at most 50 frames per second of a GIF

_MAX_SIDE = 65535
_COLORS = 255
_TRANSPARENT = 255  # palette index
_KEEP, _CLEAR = 1, 2  # what becomes of a frame's rectangle before the next one is drawn


def write_gif(path: Path, frames: Iterable[Picture], fps: float, plays: int, write: Write) -> str:
    """Write a GIF, with one palette of 255 colors for all frames; see `write_animation`.

    Pixels are opaque or transparent, see `opaque_pixels`. GIF counts time in units of 10 ms, so one frame may
    be shown 10 ms longer than the next, but the sums do not drift. Above `MAX_GIF_FPS` frames are left out,
    so that the speed is right (of 60 fps, each sixth).
    """
    images = bounded_frames(frames, _MAX_SIDE, ".gif")
    kept = (image for number, image in enumerate(images) if _is_shown(number, fps))
    shown_fps = min(fps, MAX_GIF_FPS)
    write(path, encode_gif(kept, shown_fps, plays))
    return tr("at {fps:g} frames per second", fps=shown_fps)


def _is_shown(number: int, fps: float) -> bool:
    """Whether a frame is kept: at rates that GIF does not have, some are left out."""
    share = min(1.0, MAX_GIF_FPS / fps)
    return number == 0 or int(number * share) != int((number - 1) * share)


def encode_gif(images: Iterable[Picture], fps: float, plays: int) -> bytes:
    """The bytes of a GIF of frames (h, w, 4) uint8, read once.

    fps: at most `MAX_GIF_FPS`; plays: how often it is shown, 0 for forever.
    """
    from .coverage import opaque_pixels
    from .palette import ColorCounts, NearestColors, find_palette, packed_colors

    counts, packed = ColorCounts(), PackedFrames()
    for image in images:
        colors = packed_colors(image, opaque_pixels(image))
        counts.add(colors)
        packed.append(colors)
    announce(0.0, ENCODING)
    nearest = NearestColors(palette := find_palette(counts, _COLORS), hidden=_TRANSPARENT)
    height, width = packed[0].shape
    blocks = [_header(width, height, palette, plays if len(packed) > 1 else 1)]
    with part(0.3, 1.0):
        indexed = (nearest.indices(colors) for colors in announced(packed, ENCODING))
        blocks += _frame_blocks(indexed, frame_durations(len(packed), fps, unit=10))
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


def _frame_blocks(indexed: Iterable[Picture], durations: Sequence[int]) -> Iterator[bytes]:
    """The blocks of each frame (h, w) of palette indices: only the rectangle in which it changes.

    A pixel of it that stays is transparent. Where pixels become transparent, the frame before is cleared in
    a rectangle that contains all of them.
    """
    canvas: Picture | None = None
    for (frame, following), duration in zip(_with_following(indexed), durations, strict=True):
        canvas = np.full_like(frame, _TRANSPARENT) if canvas is None else canvas
        vanishing = (frame != _TRANSPARENT) & (following == _TRANSPARENT)
        left, top, right, bottom = box = bounding_box((frame != canvas) | vanishing)
        disposal = _CLEAR if vanishing.any() else _KEEP
        changed = frame[top:bottom, left:right].copy()
        changed[changed == canvas[top:bottom, left:right]] = _TRANSPARENT
        yield _frame_block(changed, box, duration, disposal)
        canvas = frame.copy()
        if disposal == _CLEAR:
            canvas[top:bottom, left:right] = _TRANSPARENT


def _with_following(frames: Iterable[Picture]) -> Iterator[tuple[Picture, Picture]]:
    """Each frame with the next one; the last one with itself."""
    frame = None
    for following in frames:
        if frame is not None:
            yield frame, following
        frame = following
    if frame is not None:
        yield frame, frame


def _frame_block(changed: Picture, box: Box, duration: int, disposal: int) -> bytes:
    picture = Image.fromarray(changed)
    options = {"transparency": _TRANSPARENT, "duration": duration, "disposal": disposal, "interlace": 0}
    return b"".join(GifImagePlugin.getdata(picture, box[:2], **options))
