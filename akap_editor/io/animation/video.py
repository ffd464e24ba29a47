"""Writes videos: MP4 and WebM, with FFmpeg inside the package av.

Both writers take frames (h, w, 4) uint8, straight alpha, all of one size, which are read once, in order; only
the compressed video is held in memory. Frames of odd size get one more column or row, which repeats the last
one. fps: frames per second;
write: writes the encoded file. They return a few words on the result, and raise InputError for bad frames, if
the file cannot be written, or if av is not installed.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from io import BytesIO
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import FileError, InputError
from ...words import tr
from ..atomic import Write
from ..images import Picture
from .frames import checked_frames


@dataclass(frozen=True)
class _Codec:
    """How FFmpeg encodes a kind of video."""

    container: str
    codec: str
    pixel_format: str
    options: dict[str, str]
    has_transparency: bool


# Quality is high, for flat areas and sharp edges.
_MP4 = _Codec("mp4", "libx264", "yuv420p", {"crf": "16", "preset": "medium"}, False)
_VP9_OPTIONS = {"crf": "18", "b": "0", "deadline": "good", "cpu-used": "4"}
_WEBM = _Codec("webm", "libvpx-vp9", "yuva420p", _VP9_OPTIONS, True)
_WHITE = 255  # behind transparent areas if the format has no transparency
_BT709 = 1


def write_mp4(path: Path, frames: Iterable[Picture], fps: float, _: int, write: Write) -> str:
    """Write an MP4 (H.264), in which transparent areas are white."""
    return _write(path, frames, fps, write, _MP4)


def write_webm(path: Path, frames: Iterable[Picture], fps: float, _: int, write: Write) -> str:
    """Write a WebM (VP9), which keeps transparency."""
    return _write(path, frames, fps, write, _WEBM)


def require_av() -> Any:
    """The package av. Raises InputError if it is not installed."""
    try:
        import av
    except ImportError as error:
        raise InputError(
            tr("videos need the package av, which is not installed: pip install 'akap-editor[video]'")
        ) from error
    return av


def _write(path: Path, frames: Iterable[Picture], fps: float, write: Write, codec: _Codec) -> str:
    av = require_av()
    try:
        data = _encode(av, codec, frames, fps)
    except (av.error.FFmpegError, OSError) as error:
        raise FileError("export", path, tr("the encoder says {error!r}", error=str(error))) from error
    write(path, data)
    return tr("at {fps:g} frames per second", fps=fps)


def _encode(av: Any, codec: _Codec, frames: Iterable[Picture], fps: float) -> bytes:
    images = checked_frames(frames)
    first = next(images)
    buffer = BytesIO()
    with av.open(buffer, "w", format=codec.container) as container:
        rate = Fraction(fps).limit_denominator(1001)
        stream = container.add_stream(codec.codec, rate=rate, options=codec.options)
        height, width = first.shape[:2]
        stream.width, stream.height = width + width % 2, height + height % 2
        stream.pix_fmt = codec.pixel_format
        context = stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = _BT709
        if codec.has_transparency:
            stream.metadata["alpha_mode"] = "1"
        for number, image in enumerate(chain([first], images)):
            frame = av.VideoFrame.from_ndarray(_prepared(image, codec.has_transparency), format="rgba")
            frame.pts = number
            frame.time_base = 1 / rate
            frame = frame.reformat(format=codec.pixel_format, dst_colorspace="ITU709")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
    return buffer.getvalue()


def _prepared(image: Picture, has_transparency: bool) -> Picture:
    """A frame of even size, without invisible colors that would bleed into visible pixels."""

    image = np.pad(image, ((0, image.shape[0] % 2), (0, image.shape[1] % 2), (0, 0)), mode="edge")
    if not has_transparency:
        alpha = image[..., 3:].astype(np.uint16)
        image[..., :3] = (image[..., :3] * alpha + _WHITE * (255 - alpha) + 127) // 255
        image[..., 3] = 255
    elif image[..., 3].any():
        image[..., :3] = _extended_colors(image)
    return image


def _extended_colors(image: Picture) -> Picture:
    """Colors (h, w, 3) in which invisible pixels have that of the nearest visible one in their row.

    Rows without one repeat the nearest row that has some. Compression mixes the colors of neighbors.
    """
    visible = image[..., 3] > 0
    columns = np.arange(image.shape[1], dtype=np.int32)
    left = np.maximum.accumulate(np.where(visible, columns, -1), axis=1)
    far = 2 * image.shape[1]
    right = np.minimum.accumulate(np.where(visible, columns, far)[:, ::-1], axis=1)[:, ::-1]
    takes_right = (left < 0) | (right - columns < columns - left)
    nearest = np.where(takes_right & (right < far), right, np.maximum(left, 0))
    pixels = np.ascontiguousarray(image).view(np.uint32)  # one number each, which is faster to gather
    colors = pixels.ravel()[nearest + image.shape[1] * np.arange(len(image))[:, None]]
    rows = np.flatnonzero(visible.any(axis=1))
    after = np.searchsorted(rows, np.arange(len(image))).clip(0, len(rows) - 1)
    before = (after - 1).clip(0)
    number = np.arange(len(image))
    is_before = np.abs(rows[before] - number) < np.abs(rows[after] - number)
    colors = colors[rows[np.where(is_before, before, after)]]
    return np.asarray(colors.view(np.uint8).reshape(image.shape)[..., :3])
