"""Pictures and animations as files: RGBA, 8 bit, straight alpha."""

import struct
import warnings
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from io import BytesIO
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps, UnidentifiedImageError
from scipy.spatial import cKDTree

from ..errors import InputError
from .atomic import read_file, write_atomic

Picture = NDArray[np.uint8]

FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "GIF")
MAX_PIXELS = 100_000_000
MAX_ANIMATION_PIXELS = 1_000_000_000

_GIF_MAX_FPS = 50
_GIF_TRANSPARENT = 255
_PALETTE_SAMPLES = 2**22


def read_image(path: str | Path) -> Picture:
    """The picture in a PNG, JPEG, WebP, BMP or GIF file (its first frame), (h, w, 4) uint8, straight alpha.

    16-bit samples keep their high byte, an EXIF orientation is applied, colour profiles are ignored.
    Raises InputError where the file is missing, unreadable, damaged, no picture, or has over `MAX_PIXELS`.
    """
    data = read_file(path, "a picture")
    try:
        return decode_image(data)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error.__cause__


def decode_image(data: bytes, formats: tuple[str, ...] = FORMATS) -> Picture:
    """As `read_image`, from the bytes of a file in one of ``formats``. Raises InputError."""
    too_large = f"expected a picture of at most {MAX_PIXELS / 1e6:g} megapixels, got"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what Pillow warns of is either harmless or refused here
        try:
            picture = Image.open(BytesIO(data), formats=formats)
        except UnidentifiedImageError:
            came = f"a damaged file or one of another kind (it begins with {data[:8]!r})"
            raise InputError(f"expected a {_either(formats)} picture, got {came}") from None
        except Image.DecompressionBombError as error:
            raise InputError(f"{too_large} a much larger one") from error
        except Exception as error:  # Pillow meets damage with exceptions of many kinds
            raise InputError(f"expected a {_either(formats)} picture, got a damaged one") from error
        if picture.width * picture.height > MAX_PIXELS:
            raise InputError(f"{too_large} {picture.width} x {picture.height} pixels")
        try:
            return _rgba(picture, bit_depth=data[24] if picture.format == "PNG" else 8)
        except Exception as error:
            kind = picture.format
            raise InputError(f"expected a whole {kind} picture, got a damaged or truncated one") from error


def _either(names: Sequence[str]) -> str:
    return " or ".join(filter(None, [", ".join(names[:-1]), names[-1]]))


def _rgba(picture: Image.Image, bit_depth: int) -> Picture:
    """The pixels, (h, w, 4) uint8. A transparent colour is compared here: Pillow forgets to scale it."""
    transparent = None if picture.mode == "P" else picture.info.pop("transparency", None)
    ImageOps.exif_transpose(picture, in_place=True)
    if picture.mode.startswith("I"):  # 16-bit grey, which convert() would clip to 255
        samples = np.asarray(picture).astype(np.uint16)[..., None]
        high = (samples >> 8).astype(np.uint8)
        image = np.concatenate([high, high, high, np.full_like(high, 255)], axis=2)
    else:
        image = np.array(picture if picture.mode == "RGBA" else picture.convert("RGBA"))
        samples = image[..., :3]
        if transparent is not None and bit_depth == 16:
            transparent = np.asarray(transparent) >> 8
        elif transparent is not None and bit_depth < 8:
            transparent = min(transparent * 255 // (2**bit_depth - 1), 255)
    if transparent is not None:
        image[(samples == np.asarray(transparent)).all(axis=2), 3] = 0
    return image


def has_transparency(image: Picture) -> bool:
    """Whether any pixel of a picture (h, w, 4) is not opaque, i.e. whether there is something to cut out."""
    return bool((image[..., 3] < 255).any())


def encode_png(image: Picture) -> bytes:
    """The bytes of a PNG file of ``image``, (h, w, 4) uint8, straight alpha, lossless even where invisible.

    One filter (each row minus the one above) and zlib's run-length strategy: for cartoons as small as the
    usual search through filters, and a third of the time. Raises InputError on another shape or dtype.
    """
    _check_picture(image, "image")
    height, width = image.shape[:2]
    rows = np.empty((height, 1 + 4 * width), dtype=np.uint8)
    rows[:, 0] = 2  # filter type "up"
    flat = image.reshape(height, -1)
    rows[0, 1:] = flat[0]
    np.subtract(flat[1:], flat[:-1], out=rows[1:, 1:])
    packer = zlib.compressobj(level=1, strategy=zlib.Z_RLE)
    pixels = packer.compress(rows.data) + packer.flush()
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)  # 8 bit, RGBA, not interlaced
    chunks = [(b"IHDR", header), (b"IDAT", pixels), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_png_chunk(kind, content) for kind, content in chunks)


def _png_chunk(kind: bytes, content: bytes) -> bytes:
    checksum = zlib.crc32(content, zlib.crc32(kind))
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)


def write_png(path: str | Path, image: Picture) -> None:
    """Write ``image``, (h, w, 4) uint8, straight alpha, to a PNG file. On InputError the old file is kept."""
    write_atomic(path, encode_png(image))


def animation_suffix(path: str | Path) -> str:
    """The ending of a name that `write_animation` knows, in lower case. Raises InputError on another."""
    suffix = Path(path).suffix.lower()
    if suffix not in _ENCODERS:
        raise InputError(
            f"{path}: expected a name that ends in {_either(list(_ENCODERS))}, got {suffix or 'none'}"
        )
    return suffix


def write_animation(path: str | Path, frames: Iterable[Picture], fps: float) -> None:
    """Write an animation that loops for ever; the name decides on GIF, WebP (.webp) or APNG (.png, .apng).

    frames: each (h, w, 4) uint8, straight alpha, all of one size; read once, in order, and held in memory
    until the file is written. Still frames in a row may be stored as one. WebP and APNG keep all that is
    visible. GIF has 255 colours, the same for all frames; alpha of 50 % and more becomes opaque, less becomes
    transparent. GIF counts time in units of 10 ms, so one frame may be shown 10 ms longer than the next, but
    sums do not drift. Players show at most 50 fps of a GIF; above that frames are left out, so that the speed
    is right (of 60 fps, each sixth).
    Raises InputError on another name, frame or rate (0.1 to 1000 fps), or where the file cannot be written.
    """
    suffix = animation_suffix(path)
    if not 0.1 <= fps <= 1000:
        raise InputError(f"fps: expected a number from 0.1 to 1000, got {fps}")
    encode, max_side = _ENCODERS[suffix]
    images = _collect(frames, max_side, suffix)
    try:
        data = encode(images, fps)
    except (OSError, OverflowError, RuntimeError, ValueError) as error:
        raise InputError(f"cannot write {path}: the encoder says {str(error)!r}") from error
    write_atomic(path, data)


def _check_picture(image: Picture, name: str) -> None:
    if image.ndim != 3 or image.shape[2] != 4 or image.dtype != np.uint8 or not image.size:
        raise InputError(f"{name}: expected shape (h, w, 4) uint8, got {image.shape} {image.dtype}")


def _collect(frames: Iterable[Picture], max_side: int, suffix: str) -> list[Picture]:
    images: list[Picture] = []
    pixels = 0
    for number, frame in enumerate(frames):
        _check_picture(frame, f"frame {number}")
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
    first.save(buffer, kind, save_all=True, append_images=others, loop=0, **options)
    return buffer.getvalue()


def _durations(count: int, fps: float, unit: int) -> list[int]:
    """How long each frame is shown, in ms: multiples of ``unit`` ms whose sums never drift from the rate."""
    ticks = [round(1000 / unit * number / fps) for number in range(count + 1)]
    return [unit * (end - start) for start, end in pairwise(ticks)]


def _encode_apng(images: list[Picture], fps: float) -> bytes:
    return _save_all(map(Image.fromarray, images), "PNG", duration=1000 / fps)


def _encode_webp(images: list[Picture], fps: float) -> bytes:
    durations = _durations(len(images), fps, unit=1)
    # a medium effort: 4/5 of the size that the fastest gives, in half the time of the thorough ones
    effort = {"quality": 50, "method": 2}
    return _save_all(map(Image.fromarray, images), "WEBP", duration=durations, lossless=True, **effort)


def _encode_gif(images: list[Picture], fps: float) -> bytes:
    slots = [int(number * min(1.0, _GIF_MAX_FPS / fps)) for number in range(len(images))]
    kept = [image for image, slot, last in zip(images, slots, [-1, *slots], strict=False) if slot != last]
    durations = _durations(len(kept), min(fps, _GIF_MAX_FPS), unit=10)
    look = {"disposal": 2, "transparency": _GIF_TRANSPARENT, "optimize": False}
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


_ENCODERS: dict[str, tuple[Callable[[list[Picture], float], bytes], int]] = {
    ".gif": (_encode_gif, 65535),
    ".webp": (_encode_webp, 16383),
    ".png": (_encode_apng, 2**31 - 1),
    ".apng": (_encode_apng, 2**31 - 1),
}
