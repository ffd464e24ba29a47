import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.animation.formats import write_animation

av = pytest.importorskip("av", reason="the extra [video] is not installed")


def disc(step, height=48, width=64):
    """A red disc with a hard rim that moves to the right; nothing elsewhere."""
    y, x = np.mgrid[0:height, 0:width] + 0.5
    image = np.zeros((height, width, 4), dtype=np.uint8)
    image[np.hypot(x - 20 - 4 * step, y - height / 2) < 12] = (220, 40, 30, 255)
    return image


def decoded(path, codec=None):
    """All frames as (h, w, 4), and the stream's rate."""
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        rate = float(stream.average_rate)
        if codec is None:
            return [frame.to_ndarray(format="rgba") for frame in container.decode(stream)], rate
        decoder = av.CodecContext.create(codec, "r")
        frames = [frame for packet in container.demux(stream) for frame in decoder.decode(packet)]
        return [frame.to_ndarray(format="rgba") for frame in frames], rate


def error(a, b):
    return abs(a.astype(int) - b.astype(int)).mean()


@pytest.mark.parametrize("fps", [24.0, 29.97, 60.0])
def test_mp4_shows_the_frames_on_white(tmp_path, fps):
    frames = [disc(step) for step in range(6)]
    write_animation(tmp_path / "a.mp4", iter(frames), fps)
    came, rate = decoded(tmp_path / "a.mp4")
    assert rate == pytest.approx(fps, rel=1e-3)
    assert len(came) == 6
    for frame, image in zip(came, frames, strict=True):
        white = np.where(image[..., 3:] > 0, image, 255)
        assert error(frame[..., :3], white[..., :3]) < 4
        assert error(frame[22:26, 0:4, :3], white[22:26, 0:4, :3]) < 4


def test_webm_keeps_transparency_and_the_colour_at_the_rim(tmp_path):
    frames = [disc(step) for step in range(6)]
    write_animation(tmp_path / "a.webm", frames, 30)
    came, rate = decoded(tmp_path / "a.webm", "libvpx-vp9")
    assert (rate, len(came)) == (30.0, 6)
    for frame, image in zip(came, frames, strict=True):
        assert error(frame[..., 3], image[..., 3]) < 3
        inside = image[..., 3] == 255
        assert np.abs(frame[inside][:, :3].astype(int) - (220, 40, 30)).max() < 40, "also at the rim"


def stripes(height, width):
    """A picture whose last row and column differ from those before, and from each other."""
    image = np.full((height, width, 4), (40, 90, 200, 255), dtype=np.uint8)
    image[-9:], image[:, -9:] = (210, 60, 60, 255), (60, 180, 60, 255)
    return image


@pytest.mark.parametrize("suffix", ["mp4", "webm"])
@pytest.mark.parametrize("shape", [(47, 63), (48, 63), (47, 64), (48, 64), (1, 1), (1, 5)])
def test_the_row_and_column_added_to_odd_sizes_continue_the_picture(tmp_path, suffix, shape):
    image, (height, width) = stripes(*shape), shape
    write_animation(tmp_path / f"a.{suffix}", [image], 10)
    (came, *_), _ = decoded(tmp_path / f"a.{suffix}", "libvpx-vp9" if suffix == "webm" else None)
    wanted = np.pad(image, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
    assert came.shape == wanted.shape
    assert error(came, wanted) < 6
    assert error(came[-1], wanted[-1]) < 12
    assert error(came[:, -1], wanted[:, -1]) < 12


@pytest.mark.parametrize(("suffix", "background"), [("mp4", 255), ("webm", 0)])
def test_the_row_and_column_added_to_odd_sizes_continue_the_background(tmp_path, suffix, background):
    write_animation(tmp_path / f"a.{suffix}", [disc(0, 47, 63)], 10)
    (came, *_), _ = decoded(tmp_path / f"a.{suffix}", "libvpx-vp9" if suffix == "webm" else None)
    assert came.shape == (48, 64, 4)
    assert np.abs(came[-1, :, 3].astype(int) - background).max() < 4
    assert np.abs(came[:, -1, 3].astype(int) - background).max() < 4
    if suffix == "mp4":
        assert came[-1].min() > 250


@pytest.mark.parametrize(
    ("name", "frames", "message"),
    [
        ("a.mp4", [], "at least one frame"),
        ("a.mp4", [disc(0), disc(0, 48, 60)], "frame 1: expected 64 x 48 pixels as in frame 0, got 60 x 48"),
        ("a.webm", [disc(0)[..., :3]], "frame 0: expected shape"),
        ("no/such/folder/a.mp4", [disc(0)], "Couldn't save “.*a.mp4”"),
    ],
)
def test_bad_videos_give_one_sentence(tmp_path, name, frames, message):
    with pytest.raises(InputError, match=message):
        write_animation(tmp_path / name, frames, 10)
    assert list(tmp_path.iterdir()) == []


def test_without_the_extra_its_name_is_told(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "av", None)
    with pytest.raises(InputError, match=r"akap-editor\[video\]"):
        write_animation(tmp_path / "a.mp4", [disc(0)], 10)
