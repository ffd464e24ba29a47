"""Videos as files: MP4 and WebM, by FFmpeg inside the package av."""

from collections.abc import Iterable
from fractions import Fraction
from io import BytesIO
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt

from ...errors import InputError
from ..atomic import Write, write_atomic
from ..images import Picture, check_picture

# By ending: container, codec, pixel format, options. Quality is high, for flat areas and sharp rims.
_KINDS: dict[str, tuple[str, str, str, dict[str, str]]] = {
    ".mp4": ("mp4", "libx264", "yuv420p", {"crf": "16", "preset": "medium"}),
    ".webm": ("webm", "libvpx-vp9", "yuva420p", {"crf": "18", "b": "0", "deadline": "good", "cpu-used": "4"}),
}
VIDEO_SUFFIXES = tuple(_KINDS)
_PAPER = 255  # grey value behind what is transparent where the format has no transparency
_BT709 = 1


def write_video(path: str | Path, frames: Iterable[Picture], fps: float, write: Write = write_atomic) -> None:
    """Write frames, each (h, w, 4) uint8, straight alpha, all of one size, to a .mp4 or .webm file.

    WebM (VP9) keeps transparency; in MP4 (H.264) transparent areas become white. Frames get one more column
    or row where their size is odd. Read once, in order; only the compressed video is held in memory.
    write: does it when all is encoded.
    Raises InputError on bad frames or names, where the file cannot be written, or where av is not installed.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in _KINDS:
        raise InputError(
            f"{path}: expected a name that ends in {' or '.join(_KINDS)}, got {suffix or 'none'}"
        )
    av = require_av()
    try:
        data = _encode(av, suffix, frames, fps)
    except (av.error.FFmpegError, OSError) as error:
        raise InputError(f"cannot write {path}: the encoder says {str(error)!r}") from error
    write(path, data)


def require_av() -> Any:
    """The package av. Raises InputError where it is not installed."""
    try:
        import av
    except ImportError as error:
        raise InputError(
            "videos need the package av, which is not installed: pip install 'akap-editor[video]'"
        ) from error
    return av


def _encode(av: Any, suffix: str, frames: Iterable[Picture], fps: float) -> bytes:
    container_name, codec, pixel_format, options = _KINDS[suffix]
    every = iter(frames)
    first = next(every, None)
    if first is None:
        raise InputError("frames: expected at least one frame, got none")
    check_picture(first, "frame 0")
    buffer = BytesIO()
    with av.open(buffer, "w", format=container_name) as container:
        rate = Fraction(fps).limit_denominator(1001)
        stream = container.add_stream(codec, rate=rate, options=options)
        height, width = first.shape[:2]
        stream.width, stream.height, stream.pix_fmt = width + width % 2, height + height % 2, pixel_format
        context = stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = _BT709
        if suffix == ".webm":
            stream.metadata["alpha_mode"] = "1"
        for number, image in enumerate(chain([first], every)):
            check_picture(image, f"frame {number}")
            if image.shape != first.shape:
                came = f"{image.shape[1]} x {image.shape[0]}"
                raise InputError(
                    f"frame {number}: expected {width} x {height} pixels as in frame 0, got {came}"
                )
            frame = av.VideoFrame.from_ndarray(_prepared(image, suffix), format="rgba")
            frame.pts = number
            frame.time_base = 1 / rate
            frame = frame.reformat(format=pixel_format, dst_colorspace="ITU709")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
    return buffer.getvalue()


def _prepared(image: Picture, suffix: str) -> Picture:
    """A frame of even size, without colours that would bleed into what is seen."""
    image = np.pad(image, ((0, image.shape[0] % 2), (0, image.shape[1] % 2), (0, 0)))
    if suffix == ".mp4":
        alpha = image[..., 3:].astype(np.uint16)
        image[..., :3] = (image[..., :3] * alpha + _PAPER * (255 - alpha) + 127) // 255
        image[..., 3] = 255
    elif image[..., 3].any():
        # compression mixes colours of neighbours, so what is invisible takes those of the nearest visible
        nearest = distance_transform_edt(image[..., 3] == 0, return_distances=False, return_indices=True)
        image[..., :3] = image[..., :3][tuple(nearest)]
    return image
