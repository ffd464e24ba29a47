"""Animations as files: frames of RGBA, 8 bit, straight alpha."""

from collections.abc import Callable, Iterable, Iterator
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.spatial import cKDTree

from ...errors import InputError
from ..atomic import Write, write_atomic
from ..images import Picture, check_picture, join_with_or
from .video import VIDEO_SUFFIXES, write_video

MAX_ANIMATION_PIXELS = 1_000_000_000
MAX_PLAYS = 65535

_GIF_MAX_FPS = 50
_GIF_TRANSPARENT = 255
_PALETTE_SAMPLES = 2**22


def animation_suffix(path: str | Path) -> str:
    """The ending of a name that `write_animation` knows, in lower case. Raises InputError on another."""
    suffix = Path(path).suffix.lower()
    known = [*_ENCODERS, *VIDEO_SUFFIXES]
    if suffix not in known:
        raise InputError(
            f"{path}: expected a name that ends in {join_with_or(known)}, got {suffix or 'none'}"
        )
    return suffix


def write_animation(
    path: str | Path, frames: Iterable[Picture], fps: float, plays: int = 0, write: Write = write_atomic
) -> None:
    """Write an animation; the name decides on GIF, WebP (.webp), APNG (.png, .apng), MP4 or WebM (`video`).

    frames: each (h, w, 4) uint8, straight alpha, all of one size; read once, in order, and held in memory
    until the file is written; plays: how often they are shown, 0 for ever (by videos, once); write: does it
    when all is encoded.
    Still frames in a row may be stored as one. WebP and APNG keep all that is
    visible. GIF has 255 colours, the same for all frames; alpha of 50 % and more becomes opaque, less becomes
    transparent. GIF counts time in units of 10 ms, so one frame may be shown 10 ms longer than the next, but
    sums do not drift. Players show at most 50 fps of a GIF; above that frames are left out, so that the speed
    is right (of 60 fps, each sixth).
    Raises InputError on another name, frame or rate (0.1 to 1000 fps), or where the file cannot be written.
    """
    suffix = animation_suffix(path)
    if not 0.1 <= fps <= 1000:
        raise InputError(f"fps: expected a number from 0.1 to 1000, got {fps}")
    if not 0 <= plays <= MAX_PLAYS:
        raise InputError(f"plays: expected a number from 0 to {MAX_PLAYS}, got {plays}")
    if suffix in VIDEO_SUFFIXES:
        write_video(path, frames, fps, write)
        return
    encode, max_side = _ENCODERS[suffix]
    images = _collect(frames, max_side, suffix)
    try:
        data = encode(images, fps, plays)
    except (OSError, OverflowError, RuntimeError, ValueError) as error:
        raise InputError(f"cannot write {path}: the encoder says {str(error)!r}") from error
    write(path, data)


def _collect(frames: Iterable[Picture], max_side: int, suffix: str) -> list[Picture]:
    images: list[Picture] = []
    pixels = 0
    for number, frame in enumerate(frames):
        check_picture(frame, f"frame {number}")
        height, width = frame.shape[:2]
        if images and frame.shape != images[0].shape:
            first = f"{images[0].shape[1]} x {images[0].shape[0]}"
            raise InputError(f"frame {number}: expected {first} pixels as in frame 0, got {width} x {height}")
        if max(width, height) > max_side:
            raise InputError(f"{suffix}: expected at most {max_side} pixels a side, got {width} x {height}")
        pixels += width * height
        if pixels > MAX_ANIMATION_PIXELS:
            most = MAX_ANIMATION_PIXELS // (width * height)
            raise InputError(f"frames: expected at most {most} frames of {width} x {height} pixels, got more")
        images.append(frame.copy())  # the caller may draw the next frame into the same array
    if not images:
        raise InputError("frames: expected at least one frame, got none")
    return images


def _save_all(pictures: Iterable[Image.Image], kind: str, **options: object) -> bytes:
    first, *others = pictures
    buffer = BytesIO()
    first.save(buffer, kind, save_all=True, append_images=others, **options)
    return buffer.getvalue()


def _durations(count: int, fps: float, unit: int) -> list[int]:
    """How long each frame is shown, in ms: multiples of ``unit`` ms whose sums never drift from the rate."""
    ticks = [round(1000 / unit * number / fps) for number in range(count + 1)]
    return [unit * (end - start) for start, end in pairwise(ticks)]


def _encode_apng(images: list[Picture], fps: float, plays: int) -> bytes:
    return _save_all(map(Image.fromarray, images), "PNG", duration=1000 / fps, loop=plays)


def _encode_webp(images: list[Picture], fps: float, plays: int) -> bytes:
    durations = _durations(len(images), fps, unit=1)
    # a medium effort: 4/5 of the size that the fastest gives, in half the time of the thorough ones
    effort = {"quality": 50, "method": 2, "loop": plays}
    return _save_all(map(Image.fromarray, images), "WEBP", duration=durations, lossless=True, **effort)


def _encode_gif(images: list[Picture], fps: float, plays: int) -> bytes:
    slots = [int(number * min(1.0, _GIF_MAX_FPS / fps)) for number in range(len(images))]
    kept = [image for image, slot, last in zip(images, slots, [-1, *slots], strict=False) if slot != last]
    durations = _durations(len(kept), min(fps, _GIF_MAX_FPS), unit=10)
    look = {"disposal": 2, "transparency": _GIF_TRANSPARENT, "optimize": False}
    if plays != 1:  # a GIF says how often it is shown again, and nothing where it is not
        look["loop"] = max(plays - 1, 0)
    return _save_all(_indexed(kept, _palette(kept)), "GIF", duration=durations, **look)


def _palette(images: list[Picture]) -> Picture:
    """At most 255 colours (c, 3) for all frames alike: with a palette each, colours would flicker."""
    samples = []
    for number, image in enumerate(images):
        opaque = image[image[..., 3] >= 128, :3]
        step = 1 + len(opaque) * len(images) // _PALETTE_SAMPLES
        samples.append(opaque[number % step :: step])
    colours = np.concatenate(samples)
    if not len(colours):
        return np.zeros((1, 3), dtype=np.uint8)
    distinct = np.unique(_pack(colours))
    if len(distinct) < 256:
        return _unpack(distinct)
    sheet = Image.fromarray(colours[None]).quantize(255, Image.Quantize.MEDIANCUT)
    return np.array(sheet.getpalette(), dtype=np.uint8).reshape(-1, 3)[:255]


def _indexed(images: list[Picture], palette: Picture) -> Iterator[Image.Image]:
    """The frames in the nearest colours, without dithering, whose noise would flicker."""
    nearest = cKDTree(palette)
    table = np.full(2**24, -1, dtype=np.int16)  # index of each colour, filled in as colours appear
    for image in images:
        colours = _pack(image[..., :3])
        missing = np.unique(colours[table[colours] < 0])
        table[missing] = nearest.query(_unpack(missing))[1]
        indices = np.where(image[..., 3] >= 128, table[colours], _GIF_TRANSPARENT).astype(np.uint8)
        picture = Image.fromarray(indices)
        picture.putpalette(np.resize(palette, (256, 3)).tobytes())
        yield picture


def _pack(colours: Picture) -> NDArray[np.int32]:
    """One number for each colour (..., 3)."""
    red, green, blue = np.moveaxis(colours.astype(np.int32), -1, 0)
    return red << 16 | green << 8 | blue


def _unpack(packed: NDArray[np.int32]) -> Picture:
    return np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=-1).astype(np.uint8)


_ENCODERS: dict[str, tuple[Callable[[list[Picture], float, int], bytes], int]] = {
    ".gif": (_encode_gif, 65535),
    ".webp": (_encode_webp, 16383),
    ".png": (_encode_apng, 2**31 - 1),
    ".apng": (_encode_apng, 2**31 - 1),
}
