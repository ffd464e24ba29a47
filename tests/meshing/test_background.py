"""Removal of plain backgrounds."""

import numpy as np
import pytest
from PIL import Image

from akap_editor.errors import InputError
from akap_editor.meshing.background import background_color, remove_background

WHITE, RED, BLUE = (255, 255, 255), (200, 30, 40), (20, 40, 160)


def on(back, layers):
    """Shapes of one color each, as shares (h, w) of coverage, over a background; (h, w, 4), opaque."""
    image = np.zeros((*layers[0][1].shape, 3)) + back
    for color, share in layers:
        image = share[..., None] * np.array(color) + (1 - share[..., None]) * image
    return np.dstack([np.rint(image), np.full(image.shape[:2], 255.0)]).astype(np.uint8)


def disc(size=64, radius=22.0, inner=0.0):
    """Coverage of each pixel by a disc or ring, with a soft rim."""
    y, x = np.mgrid[:size, :size] + 0.5
    distance = np.hypot(x - size / 2, y - size / 2)
    return np.clip(radius + 0.5 - distance, 0, 1) * np.clip(distance - inner + 0.5, 0, 1)


@pytest.mark.parametrize("back", [WHITE, (0, 0, 0), (90, 160, 200)])
@pytest.mark.parametrize("tolerance", [0.02, 0.125, 0.3])
def test_a_soft_rim_gets_its_alpha_and_the_color_of_the_drawing(back, tolerance):
    share = disc()
    result = remove_background(on(back, [(RED, share)]), tolerance)
    assert np.abs(result[..., 3] / 255.0 - share).max() < 0.02
    visible = result[..., 3] > 0
    assert np.abs(result[visible, :3].astype(int) - RED).max() <= 1


def test_over_its_own_background_the_picture_comes_back():
    image = on(WHITE, [(RED, disc()), (BLUE, disc(radius=12.0))])
    result = remove_background(image).astype(float)
    alpha = result[..., 3:] / 255
    assert np.abs(alpha * result[..., :3] + (1 - alpha) * WHITE - image[..., :3]).max() <= 2


def test_what_the_drawing_encloses_stays():
    """A hole in a ring, and white eyes, are not joined to the border."""
    result = remove_background(on(WHITE, [(RED, disc(inner=10.0))]))
    assert result[32, 32].tolist() == [255, 255, 255, 255]
    assert result[0, 0, 3] == result[63, 63, 3] == 0


def test_a_greater_tolerance_takes_more():
    shade = np.linspace(255, 150, 64)
    image = np.dstack([*[np.tile(shade, (64, 1))] * 3, np.full((64, 64), 255.0)]).astype(np.uint8)
    image[20:44, 20:44, :3] = BLUE
    taken = [(remove_background(image, tolerance)[..., 3] == 0).sum() for tolerance in (0.05, 0.1, 0.3, 0.5)]
    assert taken == sorted(set(taken))
    assert (remove_background(image, 0.5)[..., 3] > 8).sum() == 24 * 24


def test_background_of_a_noisy_picture():
    rng = np.random.default_rng(5)
    image = on((225, 222, 216), [(BLUE, disc())]).astype(int)
    image[..., :3] += rng.integers(-8, 9, image[..., :3].shape)
    image = np.clip(image, 0, 255).astype(np.uint8)
    assert np.abs(background_color(image) - (225, 222, 216)).max() <= 2
    alpha = remove_background(image)[..., 3]
    share = disc()
    assert (alpha[share == 0] < 30).all()
    assert (alpha[share == 1] > 225).all()


def test_a_drawing_that_touches_the_border_is_not_the_background():
    image = on(WHITE, [(RED, disc())])
    image[40:, 20:44, :3] = RED
    result = remove_background(image)
    assert result[63, 30].tolist() == [*RED, 255]
    assert result[63, 5, 3] == 0


def test_a_line_of_one_pixel_stays():
    image = on(WHITE, [(RED, np.zeros((20, 20)))])
    image[10, 3:17, :3] = RED
    result = remove_background(image)
    assert result[10, 4:16].tolist() == [[*RED, 255]] * 12
    assert (result[[8, 12], :, 3] == 0).all()


def test_transparent_pixels_stay_transparent_and_the_argument_as_it_was():
    image = on(WHITE, [(RED, disc())])
    image[:10, :, 3] = 0
    image[12, 30:34, 3] = 128
    before = image.copy()
    result = remove_background(image)
    assert (result[..., 3] <= image[..., 3]).all()
    assert image.tolist() == before.tolist()


@pytest.mark.parametrize(
    ("image", "tolerance", "sentence"),
    [
        (np.zeros((4, 4, 3), np.uint8), 0.1, r"image: expected shape \(h, w, 4\) uint8, got \(4, 4, 3\)"),
        (np.zeros((4, 4, 4), np.uint8), 0.1, "background: expected a border that can be seen, got a transp"),
        (np.ones((4, 4, 4), np.uint8), 1.5, "tolerance: expected a number from 0 to 1, got 1.5"),
        (np.ones((4, 4, 4), np.uint8), None, "tolerance: expected a number from 0 to 1, got None"),
    ],
)
def test_bad_arguments_are_refused(image, tolerance, sentence):
    with pytest.raises(InputError, match=sentence):
        remove_background(image, tolerance)


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (2, 2)])
def test_tiny_pictures(size):
    assert not remove_background(np.full((*size, 4), 255, np.uint8))[..., 3].any()


def test_cat_on_white_is_cut_out_as_it_was(shared_data):
    cat = Image.open(shared_data / "noto" / "cat.png").convert("RGBA")
    paper = Image.new("RGBA", cat.size, (255, 255, 255, 255))
    paper.alpha_composite(cat)
    alpha = np.asarray(cat)[..., 3].astype(int)
    found = remove_background(np.asarray(paper))[..., 3].astype(int)
    assert np.abs(found - alpha).max() < 128
    assert np.abs(found - alpha).mean() < 0.01
