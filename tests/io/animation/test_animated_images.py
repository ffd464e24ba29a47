import numpy as np
import pytest
from PIL import Image

from akap_editor.errors import InputError
from akap_editor.io.animation import frames as animation_frames
from akap_editor.io.animation.formats import write_animation
from akap_editor.io.animation.frames import frame_durations
from akap_editor.io.images import read_image
from tests.support.animations import played


def disc(step: int, side: int = 24) -> np.ndarray:
    """A red disc with a soft rim that moves to the right over a transparent picture."""
    y, x = np.mgrid[:side, :side]
    distance = np.hypot(x - 8 - step, y - 12)
    image = np.zeros((side, side, 4), np.uint8)
    image[..., :3] = [200, 10, 60]
    image[..., 3] = np.clip((7 - distance) * 128, 0, 255)
    return image


def thresholded(image: np.ndarray) -> np.ndarray:
    result = image.copy()
    result[..., 3] = np.where(image[..., 3] >= 128, 255, 0)
    return result


def assert_same_looks(came: np.ndarray, expected: np.ndarray) -> None:
    assert (came[..., 3] == expected[..., 3]).all()
    visible = expected[..., 3] > 0
    assert (came[visible] == expected[visible]).all()


@pytest.mark.parametrize("suffix", [".webp", ".WebP", ".apng", ".APNG", ".gif"])
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


@pytest.mark.parametrize("suffix", [".webp", ".apng", ".gif"])
def test_one_frame_is_a_picture(tmp_path, suffix):
    write_animation(tmp_path / f"a{suffix}", [disc(0)], fps=25)
    assert_same_looks(
        read_image(tmp_path / f"a{suffix}"), thresholded(disc(0)) if suffix == ".gif" else disc(0)
    )


def test_frame_rates():
    assert frame_durations(4, 60, unit=1) == [17, 16, 17, 17]
    assert frame_durations(6, 30, unit=10) == [30, 40, 30, 30, 40, 30]
    for fps in (0.1, 7, 23.976, 29.97, 47, 50):
        durations = frame_durations(300, fps, unit=10)
        assert min(durations) >= 20
        assert abs(sum(durations) - 300_000 / fps) <= 5


def test_still_frames_keep_their_time(tmp_path):
    for suffix in (".gif", ".webp", ".apng"):
        write_animation(tmp_path / f"a{suffix}", [disc(0), disc(0), disc(3)], fps=10)
        durations = [duration for _, duration in played(tmp_path / f"a{suffix}")]
        assert durations in ([200, 100], [100, 100, 100])


@pytest.mark.parametrize(
    ("name", "frames", "fps", "message"),
    [
        ("a.gif", [], 10, "frames: expected at least one frame, got none"),
        ("a.gif", [disc(0), disc(0, 25)], 10, "frame 1: expected 24 x 24 pixels as in frame 0, got 25 x 25"),
        ("a.gif", [disc(0)[..., :3]], 10, r"frame 0: expected shape \(h, w, 4\) uint8, got \(24, 24, 3\)"),
        (
            "a.webp",
            [np.zeros((1, 16384, 4), np.uint8)],
            10,
            "webp: expected at most 16383 pixels a side, got 16384 x 1",
        ),
        ("missing/a.gif", [disc(0)], 10, "Couldn't save “.*”. No such file or directory"),
    ],
)
def test_bad_animations_give_one_sentence(tmp_path, name, frames, fps, message):
    with pytest.raises(InputError, match=message):
        write_animation(tmp_path / name, frames, fps)
    assert list(tmp_path.iterdir()) == []


def test_animation_too_large_for_memory_is_refused_while_it_comes(tmp_path, monkeypatch):
    monkeypatch.setattr(animation_frames, "MAX_ANIMATION_PIXELS", 3 * 24 * 24)
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


def test_a_still_is_shown_for_as_long_as_asked(tmp_path):
    """A GIF counts at most 655 s for a frame."""
    write_animation(tmp_path / "a.gif", [disc(0)] * 70 + [disc(1)], fps=0.1)
    assert sum(duration for _, duration in played(tmp_path / "a.gif")) == 710_000


@pytest.mark.parametrize(("plays", "gif"), [(0, 0), (1, None), (2, 1), (5, 4)])
def test_how_often_it_is_shown(tmp_path, plays, gif):
    """A GIF counts how often it is shown again, the others how often it is shown."""
    for suffix, count in ((".gif", gif), (".webp", plays), (".apng", plays)):
        write_animation(tmp_path / f"a{suffix}", [disc(0), disc(5)], 10, plays)
        with Image.open(tmp_path / f"a{suffix}") as opened:
            assert opened.info.get("loop") == count


@pytest.mark.parametrize("quality", [1, 60, 100])
def test_a_lossy_webp_is_near_the_frames_and_keeps_alpha(tmp_path, quality):
    frames = [disc(step, side=64) for step in range(4)]
    write_animation(tmp_path / "a.webp", frames, 10, quality=quality)
    for (came, _), frame in zip(played(tmp_path / "a.webp"), frames, strict=True):
        np.testing.assert_array_equal(came[..., 3], frame[..., 3])
        visible = frame[..., 3] == 255
        assert np.abs(came[visible][:, :3].astype(int) - frame[visible][:, :3]).mean() < 20


def test_a_lossy_webp_of_many_colors_is_smaller(tmp_path):
    y, x = np.mgrid[:96, :96]
    noise = np.random.default_rng(0).integers(0, 20, (96, 96, 4))
    frame = (np.stack([x + y, 2 * y, 255 - x, 255 + 0 * x], axis=-1) + noise).clip(0, 255).astype(np.uint8)
    sizes = []
    for quality in (10, 80, None):
        write_animation(tmp_path / "a.webp", [frame, frame[::-1]], 10, quality=quality)
        sizes.append((tmp_path / "a.webp").stat().st_size)
    assert sizes == sorted(sizes)
    assert sizes[1] < 0.6 * sizes[2]


@pytest.mark.parametrize(
    ("name", "quality", "message"),
    [
        ("a.gif", 50, "quality: expected a WebP, got GIF"),
        ("a.webp", 0, "quality: expected a number from 1 to 100, got 0"),
        ("a.webp", 101, "quality: expected a number from 1 to 100, got 101"),
    ],
)
def test_a_quality_that_makes_no_sense_is_refused(tmp_path, name, quality, message):
    with pytest.raises(InputError, match=message):
        write_animation(tmp_path / name, [disc(0)], 10, quality=quality)
    assert list(tmp_path.iterdir()) == []
