"""Writes animated pictures: WebP and APNG.

All writers take frames (h, w, 4) uint8, straight alpha, all of one size, which are read once, in order; only
compressed frames are held in memory. fps: frames per second; plays: how often they are shown, 0 for forever;
write: writes the encoded file. Equal frames in a row may be stored as one. They return a few words on the
result, and raise InputError for bad frames, or if the file cannot be written.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from io import BytesIO
from pathlib import Path
from struct import pack

import numpy as np
from PIL import Image

from ...errors import FileError
from ...progress import announce
from ...words import tr
from ..atomic import Write
from ..images import Picture, png_chunk, png_header, png_pixels
from .frames import ENCODING, PackedFrames, bounded_frames, bounding_box, collect_frames, frame_durations

_MAX_WEBP_SIDE, _MAX_APNG_SIDE = 16383, 2**31 - 1
_MOST_TICKS = 65535  # numerator and denominator of the time for which a frame of an APNG is shown


def write_webp(
    path: Path,
    frames: Iterable[Picture],
    fps: float,
    plays: int,
    write: Write,
    quality: int | None = None,
) -> str:
    """Write a WebP animation.

    quality: of the colors, from 1 to 100, with alpha as it is; None for a lossless file, which keeps
    everything that is visible.
    """
    images = collect_frames(frames, _MAX_WEBP_SIDE, path.suffix.lower())
    durations = frame_durations(len(images), fps, unit=1)
    # a medium effort: 4/5 of the size that the fastest gives, in half the time of the thorough ones
    options = {"quality": 50, "method": 2, "lossless": True}
    if quality is not None:
        options = {"quality": quality, "method": 4, "lossless": False, "alpha_quality": 100}
    buffer = BytesIO()
    try:
        picture = _moving_picture(images)
        picture.save(buffer, "WEBP", save_all=True, loop=plays, duration=durations, **options)
    except (OSError, OverflowError, RuntimeError, ValueError) as error:
        raise FileError("export", path, tr("the encoder says {error!r}", error=str(error))) from error
    write(path, buffer.getvalue())
    return tr("at {fps:g} frames per second", fps=fps)


def _moving_picture(frames: PackedFrames) -> Image.Image:
    """An animated picture of Pillow's that unpacks one frame after the other, and announces each."""
    picture = Image.fromarray(frames[0].copy())
    if len(frames) == 1:
        return picture
    shown = 0

    def seek(number: int) -> None:
        nonlocal shown
        if number >= shown:  # at the end, Pillow returns to where it began
            announce(number / len(frames), ENCODING)
            picture.paste(Image.fromarray(frames[number]))
            shown = number

    picture.n_frames = len(frames)  # type: ignore[attr-defined]
    picture.seek = seek  # type: ignore[method-assign, assignment]
    return picture


def write_apng(path: Path, frames: Iterable[Picture], fps: float, plays: int, write: Write) -> str:
    """Write an APNG, which keeps everything that is visible; each frame is encoded when it comes."""
    images = bounded_frames(frames, _MAX_APNG_SIDE, path.suffix.lower())
    write(path, encode_apng(images, fps, plays))
    return tr("at {fps:g} frames per second", fps=fps)


def encode_apng(images: Iterable[Picture], fps: float, plays: int) -> bytes:
    """The bytes of an APNG of at least one frame; of a PNG if all frames are equal.

    A frame holds the rectangle in which it differs from the one before. See
    https://www.w3.org/TR/png-3/#apng-frame-based-animation.
    """
    header, chunks, numbers = b"", list[bytes](), 0  # numbers: of the chunks of the animation
    frame_count = 0
    for image, before, count in _runs(images, int(_MOST_TICKS / max(1 / fps, 1))):
        changed = np.ones(image.shape[:2], bool) if before is None else (image != before).any(axis=2)
        left, top, right, bottom = bounding_box(changed)
        time = (count / Fraction(fps).limit_denominator(1001)).limit_denominator(_MOST_TICKS)
        fields = right - left, bottom - top, left, top
        control = pack(">5I2H2B", numbers, *fields, time.numerator, time.denominator, 0, 0)
        pixels = png_pixels([image[top:bottom, left:right]])
        chunks.append(png_chunk(b"fcTL", control))
        if before is None:
            header = png_header(image.shape[1::-1])
            chunks.append(png_chunk(b"IDAT", pixels))
            numbers += 1
        else:
            chunks.append(png_chunk(b"fdAT", pack(">I", numbers + 1) + pixels))
            numbers += 2
        frame_count += 1
    if frame_count == 1:
        return b"".join([header, chunks[1], png_chunk(b"IEND", b"")])
    animation = png_chunk(b"acTL", pack(">2I", frame_count, plays))
    return b"".join([header, animation, *chunks, png_chunk(b"IEND", b"")])


def _runs(images: Iterable[Picture], most: int) -> Iterator[tuple[Picture, Picture | None, int]]:
    """Frames that differ, each with the one before, and how many equal ones, at most ``most``, it stands for.

    Only where a frame would be shown for too long, equal ones follow one another.
    """
    before: Picture | None = None
    current: Picture | None = None
    count = 0
    for image in images:
        if current is not None and count < most and np.array_equal(image, current):
            count += 1
            continue
        if current is not None:
            yield current, before, count
        before, current, count = current, image.copy(), 1  # the caller may draw the next one into its array
    if current is not None:
        yield current, before, count
