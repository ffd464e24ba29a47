"""Reads and writes pictures: RGBA, 8 bit, straight alpha."""

import struct
import warnings
import zlib
from collections.abc import Callable, Iterable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageCms, ImageOps, UnidentifiedImageError

from ..errors import InputError, file_errors, join_with_or
from ..geometry.validation import as_picture
from ..words import mark, tr
from .atomic import read_file, write_atomic

Picture = NDArray[np.uint8]

PICTURE_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "GIF", "TIFF")
ANIMATED_PICTURE_FORMATS = (
    "PNG",
    "WEBP",
    "GIF",
    "TIFF",
)  # of these a file may have several frames or pages
MAX_PIXELS = 100_000_000
_PNG_ROWS = 256  # compressed at once
STRIP_PIXELS = 2**21  # converted at once


def read_image(path: str | Path) -> Picture:
    """The picture in a PNG, JPEG, WebP, BMP, GIF or TIFF file, (h, w, 4) uint8, straight alpha.

    Of an animation (see `is_animation`) it is the first frame. 16-bit samples keep their high byte, CMYK
    becomes RGB, an EXIF orientation is applied, colors are converted to sRGB if the file has a
    profile that is not damaged.
    Raises FileError if the file is missing, unreadable, damaged, no picture, or has over `MAX_PIXELS`.
    """
    data = read_file(path, mark("a picture"))
    with file_errors("open", path):
        return decode_image(data)


def read_mask(path: str | Path) -> NDArray[np.uint8]:
    """A mask, (h, w) uint8: the alpha of a picture that has transparency, else its brightness.

    Raises FileError as `read_image` does.
    """
    image = read_image(path)
    if has_transparency(image):
        return image[..., 3].copy()
    return np.asarray(Image.fromarray(image[..., :3]).convert("L"))


def is_animation(path: str | Path) -> bool:
    """Whether a picture file has more than one frame or page."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with Image.open(path, formats=ANIMATED_PICTURE_FORMATS) as picture:
                return bool(getattr(picture, "is_animated", False))
    except Exception:  # Pillow reports damage with exceptions of many kinds
        return False


def decode_image(
    data: bytes, formats: tuple[str, ...] = PICTURE_FORMATS, size: tuple[int, int] | None = None
) -> Picture:
    """The picture in the bytes of a file in one of ``formats``, as `read_image` returns it.

    size: width and height that it must have, checked before anything is decoded. Raises InputError.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what Pillow warns of is either harmless or refused here
        try:
            picture = Image.open(BytesIO(data), formats=formats)
        except UnidentifiedImageError:
            kinds = join_with_or(formats)
            reason = tr(
                "the file is damaged or not a {kinds} picture; it begins with {begin!r}",
                kinds=kinds,
                begin=data[:8],
            )
            raise InputError(reason) from None
        except Image.DecompressionBombError as error:
            raise InputError(_too_large(tr("much more"))) from error
        except Exception as error:  # Pillow reports damage with exceptions of many kinds
            raise InputError(
                tr("the file is damaged or not a {names} picture", names=join_with_or(formats))
            ) from error
        if picture.width * picture.height > MAX_PIXELS:
            raise InputError(
                _too_large(tr("{width} x {height} pixels", width=picture.width, height=picture.height))
            )
        if size not in (None, picture.size):
            came = f"{picture.width} x {picture.height}"
            raise InputError(
                tr("expected {size} pixels, got {came}", size=" x ".join(map(str, size or ())), came=came)
            )
        if picture.mode == "F" or (picture.mode == "I" and picture.format != "PNG"):
            raise InputError(tr("expected samples of 8 or 16 bits, got 32 bits per sample"))
        try:
            return _rgba(picture, data)
        except Exception as error:
            raise InputError(
                tr("the {format} picture is damaged or incomplete", format=picture.format)
            ) from error


def _too_large(came: str) -> str:
    return tr(
        "expected a picture of at most {megapixels:g} megapixels, got {came}",
        megapixels=MAX_PIXELS / 1e6,
        came=came,
    )


def _rgba(picture: Image.Image, data: bytes) -> Picture:
    """The pixels (h, w, 4) uint8 in sRGB. A transparent color is compared here, in full: Pillow does not."""
    transparent = None if picture.mode == "P" else picture.info.pop("transparency", None)
    bit_depth = data[24] if picture.format == "PNG" else 8
    low_bytes = (
        _low_bytes(data) if transparent is not None and (bit_depth, picture.mode) == (16, "RGB") else None
    )
    to_srgb = _srgb_conversion(picture)
    ImageOps.exif_transpose(picture, in_place=True)
    width, height = picture.size
    image = np.empty((height, width, 4), dtype=np.uint8)
    rows = max(1, STRIP_PIXELS // width)
    for top in range(0, height, rows):  # a large picture in several copies would fill the memory
        box = 0, top, width, min(top + rows, height)
        low = None if low_bytes is None else np.asarray(low_bytes.crop(box))
        image[top : top + rows] = _rgba_strip(picture.crop(box), transparent, bit_depth, low, to_srgb)
    return image


def _low_bytes(data: bytes) -> Image.Image:
    """The low bytes of the samples of a PNG file in RGB with 16 bits; Pillow keeps the high ones."""
    picture = Image.open(BytesIO(data), formats=("PNG",))
    picture.info.pop("transparency", None)
    # Samples are big-endian. Read as little-endian ones, their low bytes are taken for the high ones.
    picture.tile = [tile._replace(args="RGB;16L") for tile in picture.tile]
    ImageOps.exif_transpose(picture, in_place=True)
    return picture


def _srgb_conversion(picture: Image.Image) -> Callable[[Image.Image], Image.Image] | None:
    """A function that converts the colors of a strip to sRGB; None without a profile that says how."""
    profile = picture.info.pop("icc_profile", None)
    if not profile:
        return None
    try:
        source = ImageCms.getOpenProfile(BytesIO(profile))
        if "srgb" in ImageCms.getProfileDescription(source).lower():
            return None
        space = source.profile.xcolor_space.strip()
        has_alpha = picture.mode in ("RGBA", "LA", "PA") or "transparency" in picture.info
        if space == "CMYK" and picture.mode == "CMYK":
            modes = "CMYK", "RGB"
        elif space == "GRAY" and picture.mode in ("1", "L", "LA", "I", "I;16", "I;16B", "P", "PA"):
            modes = "L", "RGB"
        elif space == "RGB" and picture.mode in ("RGB", "RGBA", "P", "PA", "YCbCr"):
            modes = "RGB", "RGB"
        else:  # one that does not belong to this picture
            return None
        transform = ImageCms.buildTransform(source, ImageCms.createProfile("sRGB"), *modes)
    except Exception:  # a damaged profile is no reason to refuse a picture
        return None

    def convert(strip: Image.Image) -> Image.Image:
        colors = ImageCms.applyTransform(strip.convert(modes[0]), transform)
        assert colors is not None
        if has_alpha:
            colors.putalpha(strip.convert("RGBA").getchannel("A"))
        return colors

    return convert


def _rgba_strip(
    picture: Image.Image,
    transparent: Any,
    bit_depth: int,
    low_bytes: Picture | None,
    to_srgb: Callable[[Image.Image], Image.Image] | None,
) -> Picture:
    """A strip of a picture, (h, w, 4) uint8; low_bytes: (h, w, 3) of samples of 16 bits, if known."""
    if picture.mode.startswith("I"):  # 16-bit gray, which convert() would clip to 255
        samples: NDArray[Any] = np.asarray(picture).astype(np.uint16)[..., None]
        picture = Image.fromarray((samples[..., 0] >> 8).astype(np.uint8))
    else:
        samples = np.array(picture.convert("RGBA"))[..., :3] if transparent is not None else np.empty(0)
        if low_bytes is not None:
            samples = samples.astype(np.uint16) << 8 | low_bytes
        elif transparent is not None and bit_depth < 8:
            transparent = min(transparent * 255 // (2**bit_depth - 1), 255)
    colors = picture if to_srgb is None else to_srgb(picture)
    image = np.array(colors if colors.mode == "RGBA" else colors.convert("RGBA"))
    if transparent is not None:
        image[(samples == np.asarray(transparent)).all(axis=2), 3] = 0
    return image


def has_transparency(image: Picture) -> bool:
    """Whether any pixel of a picture (h, w, 4) is not opaque, so that it can be cut out."""
    return bool((image[..., 3] < 255).any())


def encode_png(image: Picture, is_repetitive: bool = False) -> bytes:
    """The bytes of a PNG file of ``image``, (h, w, 4) uint8, straight alpha, lossless even where invisible.

    is_repetitive: whether to look for parts that are equal, which takes longer. Raises InputError on another
    shape or dtype.
    """
    image = as_picture(image, "image")
    return encode_png_bands(image.shape[1::-1], [image], is_repetitive)


def encode_png_bands(size: tuple[int, ...], bands: Iterable[Picture], is_repetitive: bool = False) -> bytes:
    """As `encode_png`, of a picture that comes in bands (h, w, 4) uint8 from top to bottom.

    size: width and height of the whole.
    """
    pixels = png_chunk(b"IDAT", png_pixels(bands, is_repetitive))
    return b"".join([png_header(size), pixels, png_chunk(b"IEND", b"")])


def png_header(size: tuple[int, ...]) -> bytes:
    """The signature of PNG files, and the chunk that says the width and height of a picture."""
    header = struct.pack(">IIBBBBB", *size, 8, 6, 0, 0, 0)  # 8 bit, RGBA, not interlaced
    return b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", header)


def png_pixels(bands: Iterable[Picture], is_repetitive: bool = False) -> bytes:
    """The compressed pixels of bands (h, w, 4) uint8 of a picture, from top to bottom, for a PNG file.

    One filter (each row minus the one above) and zlib's run-length strategy: for cartoons as small as the
    usual search through filters but for 4 %, in a fifth of the time. is_repetitive: see `encode_png`.
    """
    packer = zlib.compressobj(6) if is_repetitive else zlib.compressobj(1, strategy=zlib.Z_RLE)
    packed: list[bytes] = []
    above: Picture | int = 0
    for band in bands:
        for start in range(0, len(band), _PNG_ROWS):
            flat = band[start : start + _PNG_ROWS].reshape(-1, 4 * band.shape[1])
            rows = np.empty((len(flat), 1 + flat.shape[1]), dtype=np.uint8)
            rows[:, 0] = 2  # filter type "up"
            np.subtract(flat[0], above, out=rows[0, 1:])
            np.subtract(flat[1:], flat[:-1], out=rows[1:, 1:])
            packed.append(packer.compress(rows.data))
            above = flat[-1]
    return b"".join([*packed, packer.flush()])


def png_chunk(kind: bytes, content: bytes) -> bytes:
    """A chunk of a PNG file; kind: four letters."""
    checksum = zlib.crc32(content, zlib.crc32(kind))
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)


def write_png(path: str | Path, image: Picture) -> None:
    """Write ``image``, (h, w, 4) uint8, straight alpha, to a PNG file, see `write_atomic`."""
    write_atomic(path, encode_png(image))
