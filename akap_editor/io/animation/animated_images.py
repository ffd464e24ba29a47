"""Writes animated pictures: WebP, GIF and APNG.

All writers take frames (h, w, 4) uint8, straight alpha, all of one size, which are read once, in order, and
held in memory until the file is written; fps: frames per second; plays: how often they are shown, 0 for
forever; write: writes the encoded file. Equal frames in a row may be stored as one. They return a few words
on the result, and raise InputError for bad frames, or if the file cannot be written.
"""

from collections.abc import Callable, Iterable, Iterator
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.spatial import cKDTree

from ...errors import FileError, InputError
from ..atomic import Write
from ..images import Picture
from .frames import checked_frames

MAX_ANIMATION_PIXELS = 1_000_000_000  # of all frames together

_MAX_WEBP_SIDE, _MAX_GIF_SIDE, _MAX_APNG_SIDE = 16383, 65535, 2**31 - 1
_GIF_MAX_FPS = 50
_GIF_TRANSPARENT = 255  # palette index
_PALETTE_SAMPLES = 2**22


def write_webp(path: Path, frames: Iterable[Picture], fps: float, plays: int, write: Write) -> str:
    """Write a lossless WebP animation, which keeps everything that is visible."""

    def encode(images: list[Picture]) -> bytes:
        durations = frame_durations(len(images), fps, unit=1)
        # a medium effort: 4/5 of the size that the fastest gives, in half the time of the thorough ones
        options = {"quality": 50, "method": 2, "loop": plays, "duration": durations, "lossless": True}
        return _save_all(map(Image.fromarray, images), "WEBP", options)

    return _write(path, frames, fps, write, _MAX_WEBP_SIDE, encode)


def write_apng(path: Path, frames: Iterable[Picture], fps: float, plays: int, write: Write) -> str:
    """Write an APNG, which keeps everything that is visible."""

    def encode(images: list[Picture]) -> bytes:
        return _save_all(map(Image.fromarray, images), "PNG", {"duration": 1000 / fps, "loop": plays})

    return _write(path, frames, fps, write, _MAX_APNG_SIDE, encode)


def write_gif(path: Path, frames: Iterable[Picture], fps: float, plays: int, write: Write) -> str:
    """Write a GIF, with one palette of 255 colors for all frames.

    Alpha of 50 % and more becomes opaque, less becomes transparent. GIF counts time in units of 10 ms, so one
    frame may be shown 10 ms longer than the next, but the sums do not drift. Players show at most 50 fps of a
    GIF; above that frames are left out, so that the speed is right (of 60 fps, each sixth).
    """

    def encode(images: list[Picture]) -> bytes:
        slots = [int(number * min(1.0, _GIF_MAX_FPS / fps)) for number in range(len(images))]
        is_shown = [slot != before for slot, before in zip(slots, [-1, *slots], strict=False)]
        shown = [image for image, shows in zip(images, is_shown, strict=True) if shows]
        durations = frame_durations(len(shown), min(fps, _GIF_MAX_FPS), unit=10)
        options = {"disposal": 2, "transparency": _GIF_TRANSPARENT, "optimize": False, "duration": durations}
        if plays != 1:  # a GIF says how often it is shown again, and says nothing if it is not
            options["loop"] = max(plays - 1, 0)
        return _save_all(_indexed(shown, _palette(shown)), "GIF", options)

    return _write(path, frames, fps, write, _MAX_GIF_SIDE, encode)


def frame_durations(count: int, fps: float, unit: int) -> list[int]:
    """Durations of frames in ms: multiples of ``unit`` ms whose sums never drift from the rate."""
    ticks = [round(1000 / unit * number / fps) for number in range(count + 1)]
    return [unit * (end - start) for start, end in pairwise(ticks)]


def _write(
    path: Path,
    frames: Iterable[Picture],
    fps: float,
    write: Write,
    max_side: int,
    encode: Callable[[list[Picture]], bytes],
) -> str:
    images = _collect(frames, max_side, path.suffix.lower())
    try:
        data = encode(images)
    except (OSError, OverflowError, RuntimeError, ValueError) as error:
        raise FileError("export", path, f"the encoder says {str(error)!r}") from error
    write(path, data)
    return f"at {fps:g} frames per second"


def _collect(frames: Iterable[Picture], max_side: int, suffix: str) -> list[Picture]:
    images: list[Picture] = []
    pixels = 0
    for image in checked_frames(frames):
        height, width = image.shape[:2]
        if max(width, height) > max_side:
            raise InputError(f"{suffix}: expected at most {max_side} pixels a side, got {width} x {height}")
        pixels += width * height
        if pixels > MAX_ANIMATION_PIXELS:
            most = MAX_ANIMATION_PIXELS // (width * height)
            raise InputError(f"frames: expected at most {most} frames of {width} x {height} pixels, got more")
        images.append(image.copy())  # the caller may draw the next frame into the same array
    return images


def _save_all(pictures: Iterable[Image.Image], kind: str, options: dict[str, object]) -> bytes:
    first, *others = pictures
    buffer = BytesIO()
    first.save(buffer, kind, save_all=True, append_images=others, **options)
    return buffer.getvalue()


def _palette(images: list[Picture]) -> Picture:
    """At most 255 colors (c, 3) for all frames: with a palette each, colors would flicker."""
    samples = []
    for number, image in enumerate(images):
        opaque = image[image[..., 3] >= 128, :3]
        step = 1 + len(opaque) * len(images) // _PALETTE_SAMPLES
        samples.append(opaque[number % step :: step])
    colors = np.concatenate(samples)
    if not len(colors):
        return np.zeros((1, 3), dtype=np.uint8)
    distinct = np.unique(_pack(colors))
    if len(distinct) < 256:
        return _unpack(distinct)
    sheet = Image.fromarray(colors[None]).quantize(255, Image.Quantize.MEDIANCUT)
    return np.array(sheet.getpalette(), dtype=np.uint8).reshape(-1, 3)[:255]


def _indexed(images: list[Picture], palette: Picture) -> Iterator[Image.Image]:
    """The frames in the nearest colors of the palette; not dithered, because its noise would flicker."""
    nearest = cKDTree(palette)
    table = np.full(2**24, -1, dtype=np.int16)  # palette index of each color, filled in as colors appear
    for image in images:
        colors = _pack(image[..., :3])
        missing = np.unique(colors[table[colors] < 0])
        table[missing] = nearest.query(_unpack(missing))[1]
        indices = np.where(image[..., 3] >= 128, table[colors], _GIF_TRANSPARENT).astype(np.uint8)
        picture = Image.fromarray(indices)
        picture.putpalette(np.resize(palette, (256, 3)).tobytes())
        yield picture


def _pack(colors: Picture) -> NDArray[np.int32]:
    """One number for each color of an array (..., 3)."""
    red, green, blue = np.moveaxis(colors.astype(np.int32), -1, 0)
    return red << 16 | green << 8 | blue


def _unpack(packed: NDArray[np.int32]) -> Picture:
    """The colors (..., 3) of packed numbers."""
    return np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=-1).astype(np.uint8)
