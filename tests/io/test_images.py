import struct
import warnings
import zlib
from io import BytesIO

import numpy as np
import pytest
from PIL import Image, ImageCms

from akap_editor.editor.document.drawing import make_drawing
from akap_editor.errors import InputError
from akap_editor.io import images
from akap_editor.io.images import (
    MAX_PIXELS,
    decode_image,
    encode_png,
    has_transparency,
    read_image,
    write_png,
)

GREY, RGB, PALETTE, GREY_ALPHA, RGBA = 0, 2, 3, 4, 6


def chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def png(size, depth: int, color: int, rows: list[bytes], *extra: tuple[bytes, bytes]) -> bytes:
    """A PNG of any kind, from its packed rows and the chunks that go before them."""
    header = struct.pack(">IIBBBBB", *size, depth, color, 0, 0, 0)
    pixels = zlib.compress(b"".join(b"\0" + row for row in rows))
    chunks = [(b"IHDR", header), *extra, (b"IDAT", pixels), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*one) for one in chunks)


def shorts(*values: int) -> bytes:
    return struct.pack(f">{len(values)}H", *values)


def grey(*levels: int) -> list[list[int]]:
    return [[level, level, level, 255] for level in levels]


PNGS = {
    "grey 1": (png((3, 1), 1, GREY, [b"\x40"]), grey(0, 255, 0)),
    "grey 2": (png((4, 1), 2, GREY, [b"\x1b"]), grey(0, 85, 170, 255)),
    "grey 4": (png((3, 1), 4, GREY, [b"\x0f\x80"]), grey(0, 255, 136)),
    "grey 8": (png((3, 1), 8, GREY, [b"\x00\x7f\xff"]), grey(0, 127, 255)),
    "grey 16": (png((4, 1), 16, GREY, [shorts(0, 255, 0x7F80, 65535)]), grey(0, 0, 127, 255)),
    "grey 1, one transparent": (
        png((2, 1), 1, GREY, [b"\x40"], (b"tRNS", shorts(1))),
        [[0, 0, 0, 255], [255, 255, 255, 0]],
    ),
    "grey 2, one transparent": (
        png((4, 1), 2, GREY, [b"\x1b"], (b"tRNS", shorts(2))),
        [[0, 0, 0, 255], [85, 85, 85, 255], [170, 170, 170, 0], [255, 255, 255, 255]],
    ),
    "grey 4, one transparent": (
        png((2, 1), 4, GREY, [b"\x0f"], (b"tRNS", shorts(15))),
        [[0, 0, 0, 255], [255, 255, 255, 0]],
    ),
    "grey 8, one transparent": (
        png((2, 1), 8, GREY, [b"\x07\x08"], (b"tRNS", shorts(7))),
        [[7, 7, 7, 0], [8, 8, 8, 255]],
    ),
    "grey 16, one transparent": (
        png((2, 1), 16, GREY, [shorts(0x1234, 0x1235)], (b"tRNS", shorts(0x1235))),
        [[0x12, 0x12, 0x12, 255], [0x12, 0x12, 0x12, 0]],
    ),
    "grey alpha 8": (png((2, 1), 8, GREY_ALPHA, [b"\x07\x00\x08\x80"]), [[7, 7, 7, 0], [8, 8, 8, 128]]),
    "grey alpha 16": (
        png((2, 1), 16, GREY_ALPHA, [shorts(0x0700, 0, 0x08FF, 0x80FF)]),
        [[7, 7, 7, 0], [8, 8, 8, 128]],
    ),
    "rgb 8": (png((2, 1), 8, RGB, [bytes([1, 2, 3, 4, 5, 6])]), [[1, 2, 3, 255], [4, 5, 6, 255]]),
    "rgb 8, one transparent": (
        png((2, 1), 8, RGB, [bytes([1, 2, 3, 1, 2, 4])], (b"tRNS", shorts(1, 2, 4))),
        [[1, 2, 3, 255], [1, 2, 4, 0]],
    ),
    "rgb 16": (
        png((2, 1), 16, RGB, [shorts(0, 0x0180, 0x02FF, 0xFF00, 0xFFFF, 0x8000)]),
        [[0, 1, 2, 255], [255, 255, 128, 255]],
    ),
    "rgb 16, one transparent": (
        png(
            (2, 1),
            16,
            RGB,
            [shorts(0x0102, 0x0304, 0x0506, 0, 0, 0)],
            (b"tRNS", shorts(0x0102, 0x0304, 0x0506)),
        ),
        [[1, 3, 5, 0], [0, 0, 0, 255]],
    ),
    "rgb 16, one transparent, others alike": (
        png((3, 1), 16, RGB, [shorts(1, 2, 3, 1, 2, 4, 257, 2, 3)], (b"tRNS", shorts(1, 2, 3))),
        [[0, 0, 0, 0], [0, 0, 0, 255], [1, 0, 0, 255]],
    ),
    "rgba 8": (png((2, 1), 8, RGBA, [bytes([1, 2, 3, 0, 4, 5, 6, 77])]), [[1, 2, 3, 0], [4, 5, 6, 77]]),
    "rgba 16": (png((1, 1), 16, RGBA, [shorts(0x01FF, 0x0200, 0x0380, 0xFF00)]), [[1, 2, 3, 255]]),
    "palette 8": (
        png((2, 1), 8, PALETTE, [b"\x01\x00"], (b"PLTE", bytes([1, 2, 3, 4, 5, 6]))),
        [[4, 5, 6, 255], [1, 2, 3, 255]],
    ),
    "palette 2 with alpha": (
        png((3, 1), 2, PALETTE, [b"\x18"], (b"PLTE", bytes(range(1, 10))), (b"tRNS", b"\x80\x00")),
        [[1, 2, 3, 128], [4, 5, 6, 0], [7, 8, 9, 255]],
    ),
}


@pytest.mark.parametrize("kind", PNGS)
def test_png_of_every_kind(tmp_path, kind):
    data, expected = PNGS[kind]
    (tmp_path / "a.png").write_bytes(data)
    image = read_image(tmp_path / "a.png")
    assert image.shape == (1, len(expected), 4)
    assert image.dtype == np.uint8
    assert image[0].tolist() == expected


@pytest.mark.parametrize("kind", ["WEBP", "BMP", "GIF", "TIFF"])
def test_other_lossless_formats(kind):
    pixels = np.array(
        [[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [9, 9, 9]], [[1, 2, 3], [0, 0, 0]]], np.uint8
    )
    buffer = BytesIO()
    Image.fromarray(pixels).save(buffer, kind, **({"lossless": True} if kind == "WEBP" else {}))
    image = decode_image(buffer.getvalue())
    assert (image[..., :3] == pixels).all()
    assert (image[..., 3] == 255).all()


@pytest.mark.parametrize("orientation", range(1, 9))
def test_jpeg_stands_as_its_exif_says(orientation):
    upright = np.zeros((16, 32, 3), np.uint8)
    upright[:8, :16] = [255, 0, 0]  # only the top left corner is red
    exif = Image.Exif()
    exif[0x0112] = orientation
    undo = {5: Image.Transpose.TRANSPOSE, 6: Image.Transpose.ROTATE_90, 7: Image.Transpose.TRANSVERSE}
    undo |= {2: Image.Transpose.FLIP_LEFT_RIGHT, 3: Image.Transpose.ROTATE_180}
    undo |= {4: Image.Transpose.FLIP_TOP_BOTTOM, 8: Image.Transpose.ROTATE_270}
    stored = Image.fromarray(upright)
    if orientation > 1:
        stored = stored.transpose(undo[orientation])
    buffer = BytesIO()
    stored.save(buffer, "JPEG", quality=95, subsampling=0, exif=exif)
    image = decode_image(buffer.getvalue())
    assert image.shape == (16, 32, 4)
    assert np.abs(image[..., :3].astype(int) - upright).max() <= 4
    assert (image[..., 3] == 255).all()


def test_jpeg_in_cmyk():
    buffer = BytesIO()
    Image.new("CMYK", (16, 16), (0, 255, 255, 0)).save(buffer, "JPEG", quality=95)
    image = decode_image(buffer.getvalue())
    assert np.abs(image.reshape(-1, 4).astype(int) - [255, 0, 0, 255]).max() <= 4


@pytest.mark.parametrize("orientation", [1, 3, 6])
def test_tiff_stands_as_its_tag_says(orientation):
    """Once, not twice: Pillow turns some TIFF files by itself."""
    upright = np.zeros((4, 8, 3), np.uint8)
    upright[:2, :4] = [255, 0, 0]
    undo = {1: 0, 3: 2, 6: 1}
    stored = np.rot90(upright, undo[orientation])
    buffer = BytesIO()
    Image.fromarray(np.ascontiguousarray(stored)).save(buffer, "TIFF", tiffinfo={274: orientation})
    image = decode_image(buffer.getvalue())
    assert image[..., :3].tolist() == upright.tolist()


def saved_tiff(pixels, mode=None, **options):
    buffer = BytesIO()
    Image.fromarray(pixels, mode).save(buffer, "TIFF", **options)
    return buffer.getvalue()


@pytest.mark.parametrize("compression", [None, "tiff_lzw", "tiff_deflate", "packbits"])
def test_tiff_compressions_and_alpha(compression):
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 4), dtype=np.uint8)
    assert decode_image(saved_tiff(pixels, compression=compression)).tolist() == pixels.tolist()


def test_tiff_of_other_samples():
    deep = np.array([[0, 255, 0x7F80, 65535]], dtype=np.uint16)
    assert decode_image(saved_tiff(deep))[0].tolist() == grey(0, 0, 127, 255)
    buffer = BytesIO()
    Image.new("CMYK", (2, 1), (0, 255, 255, 0)).save(buffer, "TIFF")
    assert decode_image(buffer.getvalue())[0].tolist() == [[255, 0, 0, 255]] * 2
    with pytest.raises(InputError, match="expected samples of 8 or 16 bits, got 32 bits per sample"):
        decode_image(saved_tiff(deep.astype(np.float32)))
    with pytest.raises(InputError, match="expected samples of 8 or 16 bits, got 32 bits per sample"):
        decode_image(saved_tiff(deep.astype(np.int32)))


def test_an_animation_is_told_from_a_picture_and_gives_its_first_frame(tmp_path):
    frames = [Image.new("RGB", (4, 3), color) for color in ("red", "lime", "blue")]
    for name in ("a.gif", "a.webp", "a.png", "a.tiff"):
        options = {"lossless": True} if name == "a.webp" else {}
        frames[0].save(tmp_path / name, save_all=True, append_images=frames[1:], **options)
        assert images.is_animation(tmp_path / name)
        assert read_image(tmp_path / name)[0, 0].tolist() == [255, 0, 0, 255]
        frames[0].save(tmp_path / f"still-{name}", **options)
        assert not images.is_animation(tmp_path / f"still-{name}")
    (tmp_path / "text.gif").write_text("GIF89a and nothing else")
    assert not images.is_animation(tmp_path / "text.gif")
    assert not images.is_animation(tmp_path / "none.gif")


def test_mask_is_brightness_or_alpha(tmp_path):
    shown = np.array([[0, 100, 255]], dtype=np.uint8)
    Image.fromarray(shown).save(tmp_path / "grey.png")
    assert images.read_mask(tmp_path / "grey.png").tolist() == shown.tolist()
    Image.fromarray(np.dstack([shown * 0, shown * 0, shown * 0, shown])).save(tmp_path / "alpha.png")
    assert images.read_mask(tmp_path / "alpha.png").tolist() == shown.tolist()
    Image.fromarray(shown > 127).save(tmp_path / "bits.png")
    assert images.read_mask(tmp_path / "bits.png").tolist() == [[0, 0, 255]]


def test_mask_of_a_drawing(shared_data):
    """Photographed paper: only what the mask shows is cut out."""
    image = read_image(shared_data / "drawings" / "char1-texture.png")
    shown = images.read_mask(shared_data / "drawings" / "char1-mask.png")
    drawing = make_drawing(image, shown, vertices=300)
    assert drawing.image[..., 3].tolist() == shown.tolist()
    assert drawing.mesh.rest_areas.sum() == pytest.approx((shown > 127).sum(), rel=0.08)


def test_mask_of_another_size_is_refused():
    with pytest.raises(InputError, match="mask: expected the size of the picture, 3 x 2 pixels, got 2 x 2"):
        make_drawing(np.zeros((2, 3, 4), np.uint8), np.zeros((2, 2), np.uint8))
    with pytest.raises(InputError, match=r"mask: expected shape \(h, w\) uint8, got \(2, 3, 4\) uint8"):
        make_drawing(np.zeros((2, 3, 4), np.uint8), np.zeros((2, 3, 4), np.uint8))


def test_has_transparency():
    image = np.full((2, 2, 4), 255, np.uint8)
    assert not has_transparency(image)
    image[1, 1, 3] = 254
    assert has_transparency(image)


@pytest.mark.parametrize("size", [(1, 1), (1, 9), (9, 1), (6, 8)])
def test_png_round_trip_is_exact(tmp_path, size):
    image = np.random.default_rng(0).integers(0, 256, (*size, 4), dtype=np.uint8)
    write_png(tmp_path / "a.png", image)
    assert (read_image(tmp_path / "a.png") == image).all()
    with Image.open(tmp_path / "a.png") as picture:
        picture.verify()


def test_png_of_a_view_is_exact(picture):
    view = picture[::-1, ::2]
    assert (decode_image(encode_png(view)) == view).all()


@pytest.mark.parametrize(
    "image", [np.zeros((2, 2, 3), np.uint8), np.zeros((2, 2, 4)), np.zeros((0, 2, 4), np.uint8)]
)
def test_only_rgba_is_written(tmp_path, image):
    with pytest.raises(InputError, match=r"^image: expected shape \(h, w, 4\) uint8, got \("):
        write_png(tmp_path / "a.png", image)
    assert not (tmp_path / "a.png").exists()


GOOD = PNGS["rgba 8"][0]
BOMB = png((10_001, 10_000), 8, RGBA, [])
BAD = {
    "empty": (
        b"",
        r"The file is damaged or not a PNG, JPEG, WEBP, BMP, GIF or TIFF picture; it begins with b''",
    ),
    "text": (b"hello world", r"The file is damaged or not a PNG, .* picture; it begins with b'hello wo'"),
    "pdf": (b"%PDF-1.7\n", r"The file is damaged or not a PNG, .*begins with b'%PDF-1.7'"),
    "header only": (GOOD[:20], r"The file is damaged or not a PNG, .* picture"),
    "truncated pixels": (
        encode_png(np.random.default_rng(0).integers(0, 256, (50, 50, 4), dtype=np.uint8))[:2000],
        "The PNG picture is damaged or incomplete",
    ),
    "wrong checksum": (GOOD[:30] + b"\0" + GOOD[31:], "The file is damaged or not a PNG, .* picture"),
    "one pixel too many": (BOMB, "Expected a picture of at most 100 megapixels, got 10001 x 10000 pixels"),
    "a huge bomb": (png((2**30, 2**30), 8, RGBA, []), "Expected a picture of at most 100 megapixels, got"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_pictures_give_one_sentence(tmp_path, kind):
    data, message = BAD[kind]
    path = tmp_path / "cat.png"
    path.write_bytes(data)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=rf"^Couldn't open “.*cat\.png”\. {message}") as caught:
            read_image(path)
    assert "\n" not in str(caught.value)


def test_bomb_is_refused_before_it_is_decoded(monkeypatch):
    monkeypatch.setattr(images, "_rgba", lambda *_: pytest.fail("decoded"))
    with pytest.raises(InputError, match="megapixels"):
        decode_image(BOMB)
    assert MAX_PIXELS == 100_000_000


def test_missing_files_and_folders_are_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.png”\. There is no such file"):
        read_image(tmp_path / "none.png")
    with pytest.raises(InputError, match="Expected a picture, got a folder"):
        read_image(tmp_path)


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "BMP", "GIF", "TIFF"])
def test_damaged_pictures_never_leak_other_errors(kind):
    rng = np.random.default_rng(3)
    pixels = rng.integers(0, 256, (12, 9, 3), dtype=np.uint8)
    exif = Image.Exif()
    exif[0x0112] = 6
    buffer = BytesIO()
    Image.fromarray(pixels).save(buffer, kind, **({} if kind in ("BMP", "GIF") else {"exif": exif}))
    good = np.frombuffer(buffer.getvalue(), np.uint8)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(400):
            data = good.copy()
            places = rng.integers(0, len(data), rng.integers(1, 5))
            data[places] = rng.integers(0, 256, len(places))
            data = data[: rng.integers(len(data)) if rng.random() < 0.3 else None]
            try:
                image = decode_image(data.tobytes())
            except InputError:
                continue
            assert image.ndim == 3
            assert image.dtype == np.uint8


@pytest.mark.parametrize("mode", ["RGBA", "RGB", "P", "L", "LA", "1", "I;16"])
def test_converting_in_strips_changes_nothing(mode, monkeypatch):
    samples = np.random.default_rng(3).integers(0, 256, (23, 11, 4), dtype=np.uint8)
    picture = Image.fromarray(samples)
    if mode == "I;16":
        picture = Image.fromarray(samples[..., :2].copy().view(np.uint16)[..., 0])
    elif mode == "P":
        picture = picture.convert("RGB").quantize(16)
    else:
        picture = picture.convert(mode)
    buffer = BytesIO()
    picture.save(buffer, "PNG", transparency=5 if mode in ("P", "L") else None)
    whole = decode_image(buffer.getvalue())
    monkeypatch.setattr(images, "STRIP_PIXELS", 40)
    assert (decode_image(buffer.getvalue()) == whole).all()


def linear_profile(space: bytes = b"RGB ") -> bytes:
    """An ICC profile with the primaries of sRGB and a gamma of 1, or of gray with a gamma of 1."""

    def fixed(*values: float) -> bytes:
        return struct.pack(f">{len(values)}i", *(round(65536 * value) for value in values))

    curve = b"curv" + bytes(4) + struct.pack(">I", 0)
    white = b"XYZ " + bytes(4) + fixed(0.9642, 1, 0.8249)
    text = b"linear\0"
    tags = {b"wtpt": white, b"desc": b"desc" + bytes(4) + struct.pack(">I", len(text)) + text + bytes(78)}
    if space == b"RGB ":
        primaries = (0.4361, 0.2225, 0.0139), (0.3851, 0.7169, 0.0971), (0.1431, 0.0606, 0.7141)
        for letter, primary in zip((b"r", b"g", b"b"), primaries, strict=True):
            tags |= {letter + b"XYZ": b"XYZ " + bytes(4) + fixed(*primary), letter + b"TRC": curve}
    else:
        tags[b"kTRC"] = curve
    place, table, content = 128 + 4 + 12 * len(tags), b"", b""
    for name, value in tags.items():
        padded = value + bytes(-len(value) % 4)
        table += name + struct.pack(">II", place + len(content), len(value))
        content += padded
    body = struct.pack(">I", len(tags)) + table + content
    head = struct.pack(">I4sI", 128 + len(body), bytes(4), 0x02400000) + b"mntr" + space + b"XYZ "
    head += bytes(12) + b"acsp" + bytes(28) + fixed(0.9642, 1, 0.8249)
    return head.ljust(128, b"\0") + body


LEVELS = [0, 54, 128, 255]  # of linear light; in sRGB 0, 127, 188, 255


@pytest.mark.parametrize(
    ("mode", "profile"),
    [("RGB", b"RGB "), ("RGBA", b"RGB "), ("P", b"RGB "), ("L", b"GRAY"), ("LA", b"GRAY"), ("I;16", b"GRAY")],
)
def test_colors_with_a_profile_are_converted_to_srgb(mode, profile):
    picture = Image.fromarray(np.array([LEVELS], np.uint8))
    if mode == "I;16":
        picture = Image.fromarray(np.array([LEVELS], np.uint16) * 257)
    picture = picture if mode == "I;16" else picture.convert(mode)
    if mode in ("RGBA", "LA"):
        picture.putalpha(Image.fromarray(np.array([[0, 7, 99, 255]], np.uint8)))
    buffer = BytesIO()
    picture.save(buffer, "PNG", icc_profile=linear_profile(profile))
    image = decode_image(buffer.getvalue())
    assert np.abs(image[0, :, :3].astype(int) - np.array([[0], [127], [188], [255]])).max() <= 2
    assert image[0, :, 3].tolist() == ([0, 7, 99, 255] if mode in ("RGBA", "LA") else [255] * 4)


@pytest.mark.parametrize(
    "profile", ["srgb", b"", b"damaged", linear_profile(b"GRAY"), linear_profile()[:200]]
)
def test_a_profile_of_srgb_or_one_that_is_no_use_changes_nothing(profile):
    if profile == "srgb":
        profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    pixels = np.random.default_rng(2).integers(0, 256, (5, 6, 4), dtype=np.uint8)
    buffer = BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG", icc_profile=profile)
    assert decode_image(buffer.getvalue()).tolist() == pixels.tolist()
