"""Writes animated pictures: WebP and APNG.

All writers take frames (h, w, 4) uint8, straight alpha, all of one size, which are read once, in order, and
held in memory until the file is written; fps: frames per second; plays: how often they are shown, 0 for
forever; write: writes the encoded file. Equal frames in a row may be stored as one. They return a few words
on the result, and raise InputError for bad frames, or if the file cannot be written.
"""

from collections.abc import Callable, Iterable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

from ...errors import FileError
from ...progress import announce
from ...words import tr
from ..atomic import Write
from ..images import Picture
from .frames import ENCODING, collect_frames, frame_durations

_MAX_WEBP_SIDE, _MAX_APNG_SIDE = 16383, 2**31 - 1


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

    def encode(images: list[Picture]) -> bytes:
        durations = frame_durations(len(images), fps, unit=1)
        # a medium effort: 4/5 of the size that the fastest gives, in half the time of the thorough ones
        options = {"quality": 50, "method": 2, "loop": plays, "duration": durations, "lossless": True}
        if quality is not None:
            options |= {"quality": quality, "method": 4, "lossless": False, "alpha_quality": 100}
        pictures = (_announced_picture(image, k / len(images)) for k, image in enumerate(images))
        return _save_all(pictures, BytesIO(), "WEBP", options)

    return _write(path, frames, fps, write, _MAX_WEBP_SIDE, encode)


def write_apng(path: Path, frames: Iterable[Picture], fps: float, plays: int, write: Write) -> str:
    """Write an APNG, which keeps everything that is visible."""

    def encode(images: list[Picture]) -> bytes:
        options = {"duration": 1000 / fps, "loop": plays}
        return _save_all(map(Image.fromarray, images), _AnnouncedFile(len(images)), "PNG", options)

    return _write(path, frames, fps, write, _MAX_APNG_SIDE, encode)


def _write(
    path: Path,
    frames: Iterable[Picture],
    fps: float,
    write: Write,
    max_side: int,
    encode: Callable[[list[Picture]], bytes],
) -> str:
    images = collect_frames(frames, max_side, path.suffix.lower())
    try:
        data = encode(images)
    except (OSError, OverflowError, RuntimeError, ValueError) as error:
        raise FileError("export", path, tr("the encoder says {error!r}", error=str(error))) from error
    write(path, data)
    return tr("at {fps:g} frames per second", fps=fps)


def _save_all(
    pictures: Iterable[Image.Image], buffer: BytesIO, kind: str, options: Mapping[str, object]
) -> bytes:
    first, *others = pictures
    first.save(buffer, kind, save_all=True, append_images=others, **options)
    return buffer.getvalue()


def _announced_picture(image: Picture, share: float) -> Image.Image:
    """A picture that announces its encoding to a WebP: Pillow seeks its only frame before."""
    picture = Image.fromarray(image)
    stages = iter([share])  # at the end, Pillow returns to where it began

    def seek(frame: int) -> None:
        for stage in stages:
            announce(stage, ENCODING)

    picture.seek = seek  # type: ignore[method-assign]
    return picture


class _AnnouncedFile(BytesIO):
    """A file in the memory that announces each frame of an APNG: Pillow reads all of them before."""

    def __init__(self, count: int) -> None:
        super().__init__()
        self._count, self._written = count, 0

    def write(self, data: Any) -> int:
        if bytes(data[4:8]) == b"fcTL":  # the header of the chunk before each frame
            announce(self._written / self._count, ENCODING)
            self._written += 1
        return super().write(data)
