import struct
import warnings
import zlib
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from akap_editor.errors import InputError
from akap_editor.io import images
from akap_editor.io.images import (
    MAX_PIXELS,
    decode_image,
    encode_png,
    has_transparency,
    read_image,
    write_animation,
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


@pytest.mark.parametrize("kind", ["WEBP", "BMP", "GIF"])
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
    "empty": (b"", r"expected a PNG, JPEG, WEBP, BMP or GIF picture, got .*begins with b''"),
    "text": (b"hello world", r"expected a PNG, .* picture, got .*begins with b'hello wo'"),
    "pdf": (b"%PDF-1.7\n", r"expected a PNG, .*begins with b'%PDF-1.7'"),
    "header only": (GOOD[:20], r"expected a PNG, .* picture, got a damaged"),
    "truncated pixels": (
        encode_png(np.random.default_rng(0).integers(0, 256, (50, 50, 4), dtype=np.uint8))[:2000],
        "expected a whole PNG picture, got a damaged or truncated one",
    ),
    "wrong checksum": (GOOD[:30] + b"\0" + GOOD[31:], "expected a PNG, .* picture, got a damaged"),
    "one pixel too many": (BOMB, "expected a picture of at most 100 megapixels, got 10001 x 10000 pixels"),
    "a huge bomb": (png((2**30, 2**30), 8, RGBA, []), "expected a picture of at most 100 megapixels, got"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_pictures_give_one_sentence(tmp_path, kind):
    data, message = BAD[kind]
    path = tmp_path / "cat.png"
    path.write_bytes(data)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=rf"^.*cat\.png: {message}") as caught:
            read_image(path)
    assert "\n" not in str(caught.value)


def test_bomb_is_refused_before_it_is_decoded(monkeypatch):
    monkeypatch.setattr(images, "_rgba", lambda *_: pytest.fail("decoded"))
    with pytest.raises(InputError, match="megapixels"):
        decode_image(BOMB)
    assert MAX_PIXELS == 100_000_000


def test_missing_files_and_folders_are_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.png: expected a picture, but there is no such file"):
        read_image(tmp_path / "none.png")
    with pytest.raises(InputError, match="expected a picture, got a folder"):
        read_image(tmp_path)


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "BMP", "GIF"])
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


# Animations


def disc(step: int, side: int = 24) -> np.ndarray:
    """A red disc with a soft rim that moves to the right over a transparent picture."""
    y, x = np.mgrid[:side, :side]
    distance = np.hypot(x - 8 - step, y - 12)
    image = np.zeros((side, side, 4), np.uint8)
    image[..., :3] = [200, 10, 60]
    image[..., 3] = np.clip((7 - distance) * 128, 0, 255)
    return image


def played(path) -> list[tuple[np.ndarray, float]]:
    """What a player shows: frames (h, w, 4) and for how many ms."""
    with Image.open(path) as file:
        assert file.info["loop"] == 0
        shown = []
        for number in range(file.n_frames):
            file.seek(number)
            file.load()
            shown.append((np.array(file.convert("RGBA")), file.info["duration"]))
        return shown


def thresholded(image: np.ndarray) -> np.ndarray:
    result = image.copy()
    result[..., 3] = np.where(image[..., 3] >= 128, 255, 0)
    return result


def assert_same_looks(came: np.ndarray, expected: np.ndarray) -> None:
    assert (came[..., 3] == expected[..., 3]).all()
    visible = expected[..., 3] > 0
    assert (came[visible] == expected[visible]).all()


@pytest.mark.parametrize("suffix", [".webp", ".WebP", ".png", ".apng", ".gif"])
def test_animation_shows_the_frames(tmp_path, suffix):
    frames = [disc(step) for step in range(6)]
    write_animation(tmp_path / f"a{suffix}", iter(frames), fps=25)
    shown = played(tmp_path / f"a{suffix}")
    assert [duration for _, duration in shown] == [40] * 6
    for (came, _), frame in zip(shown, frames, strict=True):
        assert_same_looks(came, thresholded(frame) if suffix == ".gif" else frame)


def test_frames_may_share_one_array(tmp_path):
    def reuse():
        canvas = np.empty((24, 24, 4), np.uint8)
        for step in range(3):
            canvas[...] = disc(step)
            yield canvas

    write_animation(tmp_path / "a.webp", reuse(), fps=10)
    for step, (came, _) in enumerate(played(tmp_path / "a.webp")):
        assert_same_looks(came, disc(step))


@pytest.mark.parametrize("suffix", [".webp", ".png", ".gif"])
def test_one_frame_is_a_picture(tmp_path, suffix):
    write_animation(tmp_path / f"a{suffix}", [disc(0)], fps=25)
    assert_same_looks(
        read_image(tmp_path / f"a{suffix}"), thresholded(disc(0)) if suffix == ".gif" else disc(0)
    )


def test_frame_rates():
    assert images._durations(4, 60, unit=1) == [17, 16, 17, 17]
    assert images._durations(6, 30, unit=10) == [30, 40, 30, 30, 40, 30]
    for fps in (0.1, 7, 23.976, 29.97, 47, 50):
        durations = images._durations(300, fps, unit=10)
        assert min(durations) >= 20
        assert abs(sum(durations) - 300_000 / fps) <= 5


def test_gif_of_sixty_fps_leaves_out_each_sixth_frame(tmp_path):
    frames = [disc(step, side=40) for step in range(24)]
    write_animation(tmp_path / "a.gif", frames, fps=60)
    shown = played(tmp_path / "a.gif")
    assert [duration for _, duration in shown] == [20] * 20
    kept = [frame for number, frame in enumerate(frames) if number % 6 != 1]
    for (came, _), frame in zip(shown, kept, strict=True):
        assert_same_looks(came, thresholded(frame))


def test_gif_colours_do_not_flicker(tmp_path):
    """A part that stands still keeps its colours while all else changes, with far too many colours."""
    rng = np.random.default_rng(0)
    still = rng.integers(0, 256, (32, 32, 4), dtype=np.uint8)
    still[..., 3] = 255
    frames = [still.copy() for _ in range(5)]
    for frame in frames:
        frame[16:, :, :3] = rng.integers(0, 256, (16, 32, 3))
    write_animation(tmp_path / "a.gif", frames, fps=10)
    first, *others = [came for came, _ in played(tmp_path / "a.gif")]
    assert len(others) == 4
    for other in others:
        assert (other[:16] == first[:16]).all()
        assert (other[16:] != first[16:]).any()
    error = np.abs(first[..., :3].astype(int) - still[..., :3])[:16]
    assert error.mean() < 25  # 255 colours for a cube of 256**3: cells with a side of about 40


def test_gif_black_is_not_transparent(tmp_path):
    frame = np.zeros((4, 4, 4), np.uint8)
    frame[:2, :, 3] = 255
    write_animation(tmp_path / "a.gif", [frame, frame[::-1]], fps=10)
    (first, _), (second, _) = played(tmp_path / "a.gif")
    assert_same_looks(first, frame)
    assert_same_looks(second, frame[::-1])


def test_gif_of_nothing_is_transparent(tmp_path):
    write_animation(tmp_path / "a.gif", [np.zeros((4, 4, 4), np.uint8)], fps=10)
    assert (read_image(tmp_path / "a.gif")[..., 3] == 0).all()


def test_still_frames_keep_their_time(tmp_path):
    for suffix in (".gif", ".webp", ".png"):
        write_animation(tmp_path / f"a{suffix}", [disc(0), disc(0), disc(3)], fps=10)
        durations = [duration for _, duration in played(tmp_path / f"a{suffix}")]
        assert durations in ([200, 100], [100, 100, 100])


@pytest.mark.parametrize(
    ("name", "frames", "fps", "message"),
    [
        (
            "a.mp4",
            [disc(0)],
            10,
            r"a\.mp4: expected a name that ends in \.gif, \.webp, \.png or \.apng, got \.mp4",
        ),
        ("a", [disc(0)], 10, "expected a name that ends in .*, got none"),
        ("a.gif", [], 10, "frames: expected at least one frame, got none"),
        ("a.gif", [disc(0), disc(0, 25)], 10, "frame 1: expected 24 x 24 pixels as in frame 0, got 25 x 25"),
        ("a.gif", [disc(0)[..., :3]], 10, r"frame 0: expected shape \(h, w, 4\) uint8, got \(24, 24, 3\)"),
        ("a.gif", [disc(0)], 0, "fps: expected a number from 0.1 to 1000, got 0"),
        ("a.gif", [disc(0)], float("nan"), "fps: expected a number from 0.1 to 1000, got nan"),
        ("a.gif", [disc(0)], 1001, "fps: expected"),
        (
            "a.webp",
            [np.zeros((1, 16384, 4), np.uint8)],
            10,
            "webp: expected at most 16383 pixels a side, got 16384 x 1",
        ),
        ("missing/a.gif", [disc(0)], 10, "cannot write .*: no such file or directory"),
    ],
)
def test_bad_animations_give_one_sentence(tmp_path, name, frames, fps, message):
    with pytest.raises(InputError, match=message):
        write_animation(tmp_path / name, frames, fps)
    assert list(tmp_path.iterdir()) == []


def test_animation_too_large_for_memory_is_refused_while_it_comes(tmp_path, monkeypatch):
    monkeypatch.setattr(images, "MAX_ANIMATION_PIXELS", 3 * 24 * 24)
    drawn = []

    def endless():
        while True:
            drawn.append(disc(len(drawn)))
            yield drawn[-1]

    with pytest.raises(InputError, match="frames: expected at most 3 frames of 24 x 24 pixels, got more"):
        write_animation(tmp_path / "a.gif", endless(), fps=10)
    assert len(drawn) == 4


def test_failure_of_a_frame_keeps_the_old_animation(tmp_path):
    def broken():
        yield disc(0)
        raise RuntimeError("no graphics card")

    (tmp_path / "a.gif").write_bytes(b"old")
    with pytest.raises(RuntimeError, match="no graphics card"):
        write_animation(tmp_path / "a.gif", broken(), fps=10)
    assert (tmp_path / "a.gif").read_bytes() == b"old"


def test_still_for_longer_than_a_gif_can_say(tmp_path):
    with pytest.raises(InputError, match=r"cannot write .*a\.gif: the encoder says"):
        write_animation(tmp_path / "a.gif", [disc(0)] * 70 + [disc(1)], fps=0.1)
    assert list(tmp_path.iterdir()) == []
