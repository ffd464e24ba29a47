"""No ink is lost where pixels are either opaque or transparent."""

import numpy as np
import pytest
from PIL import Image, ImageDraw
from scipy import ndimage

from akap_editor.io.animation.coverage import VISIBLE, opaque_pixels
from tests.support.cartoons import cartoon_paths

SQUARE = np.ones((3, 3))
OVERSAMPLING = 16


def covered(shape, width=60, height=48):
    """The picture (h, w, 4) of a shape that ``shape`` draws, with alpha in proportion to its coverage.

    shape: draws with a pen whose coordinates are 1 / `OVERSAMPLING` pixels.
    """
    large = Image.new("L", (width * OVERSAMPLING, height * OVERSAMPLING))
    shape(ImageDraw.Draw(large))
    alpha = np.array(large, dtype=float)
    alpha = alpha.reshape(height, OVERSAMPLING, width, OVERSAMPLING).mean(axis=(1, 3))
    picture = np.zeros((height, width, 4), np.uint8)
    picture[..., 3] = np.rint(alpha)
    return picture


def pieces(mask):
    """The number of connected pieces."""
    return ndimage.label(mask, SQUARE)[1]


@pytest.mark.parametrize("width", [1, 2, 4, 8, 14])
@pytest.mark.parametrize("degrees", [0, 3, 11, 26, 45, 63, 88, 90, 120, 171])
def test_a_line_thinner_than_a_pixel_is_one_piece_as_long_as_it_was(width, degrees):
    middle, half = np.array([30.3, 24.6]) * OVERSAMPLING, 20 * OVERSAMPLING
    way = half * np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    picture = covered(lambda pen: pen.line([*(middle - way), *(middle + way)], fill=255, width=width))
    shown = opaque_pixels(picture)
    assert pieces(shown) == 1
    y, x = np.nonzero(shown)
    assert np.hypot(np.ptp(x), np.ptp(y)) == pytest.approx(40, abs=2.5)
    assert shown.sum() <= 2 * 41, "at most two pixels wide"
    assert (picture[shown][:, 3] > 0).all(), "only where there is ink"


@pytest.mark.parametrize("width", [2, 5, 12])
def test_a_ring_thinner_than_a_pixel_stays_closed(width):
    box = [8 * OVERSAMPLING, 5 * OVERSAMPLING, 47 * OVERSAMPLING, 42 * OVERSAMPLING]
    shown = opaque_pixels(covered(lambda pen: pen.ellipse(box, outline=255, width=width)))
    assert pieces(shown) == 1
    assert ndimage.label(~shown)[1] == 2, "inside and outside are apart"


@pytest.mark.parametrize("share", [0.03, 0.1, 0.25, 0.4, 0.49])
@pytest.mark.parametrize("side", [3, 5, 9, 24])
def test_a_faint_part_shows_as_many_pixels_as_its_alpha_says(share, side):
    picture = np.zeros((32, 32, 4), np.uint8)
    picture[4 : 4 + side, 3 : 3 + side, 3] = round(255 * share)
    shown = opaque_pixels(picture)
    assert shown.any()
    assert not shown[picture[..., 3] == 0].any()
    if side == 24:
        assert shown.sum() / side**2 == pytest.approx(share, abs=0.02)


def test_a_shadow_reaches_the_part_that_casts_it():
    picture = np.zeros((40, 40, 4), np.uint8)
    picture[20:, :, 3] = 100
    picture[:20, :, 3] = 255
    shown = opaque_pixels(picture)
    assert shown[:20].all()
    assert shown[20:22].mean() == pytest.approx(100 / 255, abs=0.1)


@pytest.mark.parametrize("softness", [1, 2, 4])
def test_a_soft_rim_is_cut_at_half(softness):
    y, x = np.mgrid[:48, :48]
    picture = np.zeros((48, 48, 4), np.uint8)
    picture[..., 3] = np.clip(128 + (15 - np.hypot(x - 23.5, y - 23.5)) * 255 / softness, 0, 255)
    np.testing.assert_array_equal(opaque_pixels(picture), picture[..., 3] >= 128)


@pytest.mark.parametrize(
    ("alphas", "shown"),
    [
        ([[0, 0, 0], [0, 40, 0], [0, 0, 0]], 1),
        ([[0, 0, 0], [0, VISIBLE, 0], [0, 0, 0]], 1),
        ([[0, 0, 0], [0, VISIBLE - 1, 0], [0, 0, 0]], 0),
        ([[30, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 30]], 2),
        ([[50, 50], [50, 50]], 1),
        ([[127]], 1),
        ([[128]], 1),
        ([[0]], 0),
    ],
)
def test_of_the_smallest_speck_a_pixel_stays(alphas, shown):
    picture = np.zeros((*np.shape(alphas), 4), np.uint8)
    picture[..., 3] = alphas
    came = opaque_pixels(picture)
    assert came.sum() >= shown
    assert came.any() == (shown > 0)
    assert pieces(came) == shown


@pytest.mark.parametrize("path", cartoon_paths("noto/*.png", "gophers/*.png", "drawings/*texture.png"))
@pytest.mark.parametrize("size", [40, 110, 300])
def test_of_real_cartoons_no_piece_is_lost_at_any_size(path, size):
    with Image.open(path) as file:
        cartoon = file.convert("RGBa")
        cartoon.thumbnail((size, size), Image.Resampling.BOX)
        picture = np.array(cartoon.convert("RGBA"))
    shown = opaque_pixels(picture)
    labels, count = ndimage.label(picture[..., 3] >= VISIBLE, SQUARE)
    assert set(np.unique(labels[shown])) == set(range(1, count + 1))
    assert not shown[picture[..., 3] < VISIBLE].any()
    assert shown[picture[..., 3] >= 128].all()
