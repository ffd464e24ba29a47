"""Palettes of animations."""

import numpy as np
import pytest

from akap_editor.io.animation.palette import ColorCounts, NearestColors, find_palette, packed_colors

HIDDEN = 255


def shaded(seed=0, side=64):
    """A frame (h, w, 4) of many colors: two gradients and a few pixels of red."""
    y, x = np.mgrid[:side, :side] / side
    image = np.full((side, side, 4), 255, np.uint8)
    image[..., 0], image[..., 1], image[..., 2] = 60 + 90 * x, 120 + 100 * y, 200 - 80 * x * y
    image[..., :3] += np.random.default_rng(seed).integers(0, 8, (side, side, 3), dtype=np.uint8)
    image[3:5, 4:7, :3] = (250, 10, 20)
    return image


def all_of(image):
    return np.ones(image.shape[:2], bool)


def palette_of(images, masks, size):
    counts = ColorCounts()
    for image, mask in zip(images, masks, strict=True):
        counts.add(packed_colors(image, mask))
    return find_palette(counts, size)


def indices_of(image, palette):
    return NearestColors(palette, HIDDEN).indices(packed_colors(image, all_of(image)))


def error(image, palette):
    return ((palette[indices_of(image, palette)].astype(float) - image[..., :3]) ** 2).mean()


def test_few_colors_are_kept_as_they_are():
    image = shaded()
    image[..., :3] &= 0xE0
    palette = palette_of([image], [all_of(image)], 255)
    assert error(image, palette) == 0
    assert len(palette) == len(np.unique(image[..., :3].reshape(-1, 3), axis=0))


def test_only_colors_that_are_shown_count():
    image = shaded()
    mask = np.zeros(image.shape[:2], bool)
    mask[3:5, 4:7] = True
    np.testing.assert_array_equal(palette_of([image], [mask], 255), [[250, 10, 20]])
    np.testing.assert_array_equal(palette_of([image], [mask & False], 255), [[0, 0, 0]])


def test_pixels_that_are_not_shown_have_an_index_of_their_own():
    image = shaded()
    mask = image[..., 0] > 100
    palette = palette_of([image], [mask], 16)
    indices = NearestColors(palette, HIDDEN).indices(packed_colors(image, mask))
    np.testing.assert_array_equal(indices == HIDDEN, ~mask)


@pytest.mark.parametrize("size", [2, 16, 255])
def test_each_color_is_the_mean_of_its_pixels(size):
    """So k-means has converged, but for rounding and its last small steps."""
    image = shaded()
    palette = palette_of([image], [all_of(image)], size)
    assert len(palette) <= size
    indices = indices_of(image, palette)
    means = [image[indices == number][:, :3].mean(axis=0) for number in range(len(palette))]
    assert np.abs(np.array(means) - palette).mean() < 2


def test_the_palette_is_better_than_median_cut():
    from PIL import Image

    image = shaded()
    cut = Image.fromarray(image[..., :3]).quantize(255, Image.Quantize.MEDIANCUT)
    median_cut = np.array(cut.getpalette(), np.uint8).reshape(-1, 3)[:255]
    assert error(image, palette_of([image], [all_of(image)], 255)) < 0.7 * error(image, median_cut)


def test_a_rare_color_keeps_its_place():
    image = shaded()
    palette = palette_of([image], [all_of(image)], 255)
    assert np.abs(palette.astype(int) - (250, 10, 20)).sum(axis=1).min() <= 3


def test_one_palette_serves_all_frames():
    frames = [shaded(seed) for seed in range(3)]
    frames[2][..., 0] = 255 - frames[2][..., 0]
    palette = palette_of(frames, [all_of(frame) for frame in frames], 255)
    assert max(error(frame, palette) for frame in frames) < 12


def test_very_many_colors_are_merged_first():
    rng = np.random.default_rng(0)
    image = rng.integers(0, 256, (300, 300, 4), dtype=np.uint8)
    palette = palette_of([image], [all_of(image)], 255)
    assert 250 <= len(palette) <= 255
    assert error(image, palette) < 255**2 / 12 / 255 ** (2 / 3) * 1.1, "that of 255 equal cubes, plus 10 %"
