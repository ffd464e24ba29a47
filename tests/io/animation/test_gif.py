"""GIF files, as several readers see them."""

import numpy as np
import pytest

from akap_editor.io.animation.coverage import opaque_pixels
from akap_editor.io.animation.formats import write_animation
from akap_editor.io.images import read_image
from tests.support.animations import gif_images, played


def disc(step, side=24):
    """A red disc with a soft rim that moves to the right over a transparent picture."""
    y, x = np.mgrid[:side, :side]
    image = np.zeros((side, side, 4), np.uint8)
    image[..., :3] = [200, 10, 60]
    image[..., 3] = np.clip((7 - np.hypot(x - 8 - step, y - 12)) * 128, 0, 255)
    return image


EMPTY = np.zeros((24, 24, 4), np.uint8)
CHECKERS = np.full((24, 24, 4), 255, np.uint8)
CHECKERS[::2, 1::2, :3] = CHECKERS[1::2, ::2, :3] = (0, 120, 0)
HOLES = np.where(CHECKERS[..., 1:2] == 255, CHECKERS, EMPTY)
BLACK = np.where(np.arange(4) == 3, CHECKERS, EMPTY)
PIXEL = np.where((np.mgrid[:24, :24] == 17).all(0)[..., None], CHECKERS, EMPTY)


def expected(frame):
    """What a GIF shows of a frame of few colors."""
    return np.where(opaque_pixels(frame)[..., None], frame | np.uint8([0, 0, 0, 255]), np.uint8(0))


def assert_same_looks(came, frame):
    wanted = expected(frame)
    np.testing.assert_array_equal(came[..., 3], wanted[..., 3])
    visible = wanted[..., 3] > 0
    np.testing.assert_array_equal(came[visible], wanted[visible])


@pytest.mark.parametrize(
    "frames",
    [
        pytest.param([*map(disc, range(5)), EMPTY, *map(disc, range(6, 12))], id="empty in the middle"),
        pytest.param([EMPTY, disc(0), disc(1)], id="empty at first"),
        pytest.param([disc(0), disc(1), EMPTY], id="empty at last"),
        pytest.param([disc(0), EMPTY, EMPTY, EMPTY, disc(0)], id="empty for long"),
        pytest.param([EMPTY, disc(3)] * 6, id="blinks"),
        pytest.param([EMPTY] * 4, id="always empty"),
        pytest.param([EMPTY], id="one empty frame"),
        pytest.param([disc(0)] * 5, id="always equal"),
        pytest.param([disc(2), disc(2), disc(5), disc(5)], id="equal in pairs"),
        pytest.param([CHECKERS, np.roll(CHECKERS, 1, axis=0), CHECKERS], id="always opaque"),
        pytest.param([CHECKERS, HOLES, CHECKERS, HOLES, EMPTY, HOLES], id="holes open and close"),
        pytest.param([disc(0), BLACK, disc(1), HOLES], id="black is not transparent"),
        pytest.param([BLACK, PIXEL, BLACK, EMPTY, PIXEL], id="a pixel"),
        pytest.param([disc(0)[:1, :1], disc(0)[12:13, 9:10], disc(0)[:1, :1]], id="of one pixel"),
    ],
)
def test_every_reader_sees_every_frame(tmp_path, frames):
    write_animation(tmp_path / "a.gif", frames, fps=25)
    assert len(gif_images((tmp_path / "a.gif").read_bytes())) == len(frames)
    av = pytest.importorskip("av")
    with av.open(str(tmp_path / "a.gif")) as container:
        decoded = [frame.to_ndarray(format="rgba") for frame in container.decode(video=0)]
    assert len(decoded) == len(frames)
    for came, frame in zip(decoded, frames, strict=True):
        assert_same_looks(came, frame)
    if len(frames) > 1:
        for (came, duration), frame in zip(played(tmp_path / "a.gif"), frames, strict=True):
            assert duration == 40
            assert_same_looks(came, frame)
    else:
        assert_same_looks(read_image(tmp_path / "a.gif"), frames[0])


def test_frames_of_random_pixels_are_seen_as_they_are(tmp_path):
    """Pixels that appear, vanish, change and stay, in rectangles of all kinds."""
    rng = np.random.default_rng(5)
    colors = np.uint8([[0, 0, 0, 0], [0, 0, 0, 255], [255, 255, 255, 255], [7, 90, 200, 255]])
    frame, frames = EMPTY, []
    for _ in range(60):
        top, left, height, width = rng.integers(0, 20, 4)
        frame = frame.copy()
        part = frame[top : top + height, left : left + width]
        part[...] = np.where(rng.random(part.shape[:2])[..., None] < 0.5, part, colors[rng.integers(4)])
        frames.append(frame)
    write_animation(tmp_path / "a.gif", frames, fps=10)
    for (came, _), wanted in zip(played(tmp_path / "a.gif"), frames, strict=True):
        assert_same_looks(came, wanted)


def test_only_what_changes_is_stored(tmp_path):
    frames = [CHECKERS.copy() for _ in range(3)]
    frames[1][5:8, 10:12, :3] = 9
    frames[2][:, :, :3] = frames[1][:, :, :3]
    frames[2][20, 3, :3] = 9
    write_animation(tmp_path / "a.gif", frames, fps=10)
    images = gif_images((tmp_path / "a.gif").read_bytes())
    assert images == [(0, 0, 24, 24), (10, 5, 2, 3), (3, 20, 1, 1)]


def test_sixty_fps_leaves_out_each_sixth_frame(tmp_path):
    frames = [disc(step, side=40) for step in range(24)]
    write_animation(tmp_path / "a.gif", frames, fps=60)
    shown = played(tmp_path / "a.gif")
    assert [duration for _, duration in shown] == [20] * 20
    kept = [frame for number, frame in enumerate(frames) if number % 6 != 1]
    for (came, _), frame in zip(shown, kept, strict=True):
        assert_same_looks(came, frame)


def test_colors_do_not_flicker(tmp_path):
    """A part that stands still keeps its colors while all else changes, with far too many colors."""
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
    assert error.mean() < 25  # 255 colors for a cube of 256**3: cells with a side of about 40
