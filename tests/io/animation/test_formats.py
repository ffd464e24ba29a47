"""The table of animation formats, read by the command line and the window."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.animation.formats import ANIMATION_FORMATS, animation_format, write_animation
from akap_editor.io.images import read_image
from akap_editor.progress import Cancelled, listening


def dot(step, height=20, width=30):
    """A dot that moves, with margins that are always empty."""
    image = np.zeros((height, width, 4), dtype=np.uint8)
    image[5 + step, 10 + step] = (200, 10 * step, 0, 255)
    return image


@pytest.mark.parametrize(
    ("name", "sheet", "label"),
    [
        ("a.png", False, "Picture"),
        ("a.PNG", True, "Sprite sheet"),
        ("a.gif", False, "GIF"),
        ("a.apng", False, "APNG"),
        ("a.WebP", False, "WebP"),
        ("a.mp4", False, "MP4"),
        ("a.webm", False, "WebM"),
        ("a.html", False, "Web page"),
        ("frames", False, "Pictures"),
    ],
)
def test_the_ending_decides(name, sheet, label):
    assert animation_format(name, sheet).label == label


def test_a_folder_that_exists_is_one_whatever_its_name(tmp_path):
    (tmp_path / "walk.gif").mkdir()
    assert animation_format(tmp_path / "walk.gif").label == "Pictures"


def test_each_row_says_what_its_files_can_do():
    by_label = {each.label: each for each in ANIMATION_FORMATS}
    assert {label for label, each in by_label.items() if each.repeats} == {"WebP", "GIF", "APNG", "Web page"}
    assert {label for label, each in by_label.items() if each.is_video} == {"MP4", "WebM"}
    assert {label for label, each in by_label.items() if not each.has_transparency} == {"MP4"}


def test_a_sheet_is_a_png():
    with pytest.raises(InputError, match=r"a sheet's name to end in \.png, got \.gif"):
        animation_format("a.gif", sheet=True)


@pytest.mark.parametrize("name", ["a.avi", "a.jpg"])
def test_another_ending_is_refused_with_those_that_there_are(name):
    message = rf"“{name}”\. Expected a name that ends in \.apng, .* got .{name[2:]}"
    with pytest.raises(InputError, match=message):
        animation_format(name)


def test_a_picture_is_the_last_frame(tmp_path):
    assert write_animation(tmp_path / "a.png", iter([dot(0), dot(3)]), 10) == "30 x 20 pixels"
    np.testing.assert_array_equal(read_image(tmp_path / "a.png"), dot(3))


@pytest.mark.parametrize("fps", [0, float("nan"), 1001])
def test_a_rate_out_of_range_is_refused(tmp_path, fps):
    with pytest.raises(InputError, match=f"fps: expected a number from 0.1 to 1000, got {fps}"):
        write_animation(tmp_path / "a.gif", [dot(0)], fps)
    assert list(tmp_path.iterdir()) == []


def test_a_number_of_plays_out_of_range_is_refused(tmp_path):
    with pytest.raises(InputError, match="plays: expected a number from 0 to 65535, got -1"):
        write_animation(tmp_path / "a.gif", [dot(0)], 10, plays=-1)


@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_encoding_after_the_last_frame_announces_how_far_it_is(tmp_path, suffix):
    heard, drawn = [], []

    def shots():
        for step in range(6):
            drawn.append(step)
            yield dot(step)

    with listening(lambda share, _: heard.append((share, len(drawn)))):
        write_animation(tmp_path / f"a{suffix}", shots(), 10)
    shares = [share for share, count in heard if count == 6]
    assert len(shares) >= 6
    assert shares == sorted(shares)
    assert 0 <= shares[0] < 0.2
    assert 0.6 < shares[-1] <= 1


def test_encoding_ends_where_it_is_cancelled(tmp_path):
    def cancel(share, _):
        if share > 0.3:
            raise Cancelled

    with listening(cancel), pytest.raises(Cancelled):
        write_animation(tmp_path / "a.webp", map(dot, range(6)), 10)
    assert list(tmp_path.iterdir()) == []
