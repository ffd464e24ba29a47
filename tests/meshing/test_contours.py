"""Iso-lines of pictures: laws of marching squares."""

import numpy as np
import pytest
import shapely
from scipy.ndimage import gaussian_filter, label

from akap_editor.meshing.contours import MARGIN, contours


def random_picture(seed: int, sigma: float) -> np.ndarray:
    """(41, 57) uint8, smooth or noisy, that reaches its border."""
    field = gaussian_filter(np.random.default_rng(seed).normal(size=(41, 57)), sigma)
    return np.rint(np.clip(127 + 100 * field / field.std(), 0, 255)).astype(np.uint8)


PICTURES = {f"{sigma:g}, {seed}": random_picture(seed, sigma) for sigma in (0.01, 1, 3) for seed in range(3)}


def areas(rings):
    return [np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2 for x, y in (ring.T for ring in rings)]


@pytest.mark.parametrize("level", [0.0, 51.0, 127.5, 254.9])
@pytest.mark.parametrize("case", PICTURES)
def test_rings_are_simple_and_apart_and_as_many_as_the_pixels_have_borders(case, level):
    samples = PICTURES[case]
    rings = contours(samples, level)
    lines = [shapely.LinearRing(ring) for ring in rings]
    assert all(line.is_simple for line in lines)
    tree = shapely.STRtree(lines)
    assert tree.query(lines, predicate="intersects").shape[1] == len(lines)  # each with itself alone
    inside = np.pad(samples > level, 1)
    _, parts = label(inside, np.ones((3, 3)))
    _, gaps = label(~inside)
    assert sum(area > 0 for area in areas(rings)) == parts
    assert sum(area < 0 for area in areas(rings)) == gaps - 1


@pytest.mark.parametrize("case", PICTURES)
def test_points_lie_between_two_pixels_where_the_picture_has_the_level(case):
    samples = PICTURES[case]
    padded = np.pad(samples, 2).astype(float)
    for point in np.concatenate(contours(samples, 100.5)):
        x, y = point + 1.5  # as index of the padded samples
        near = (int(np.floor(y)), int(np.floor(x)))
        far = (int(np.ceil(y)), int(np.ceil(x)))
        assert (x == near[1]) != (y == near[0])
        share = (x - near[1]) + (y - near[0])
        value = padded[near] + share * (padded[far] - padded[near])
        reach = MARGIN * abs(padded[far] - padded[near])
        assert abs(value - 100.5) <= reach + 1e-9


def test_every_pixel_is_on_its_side():
    samples = PICTURES["1, 0"]
    rings = contours(samples, 127.5)
    x, y = np.meshgrid(np.arange(57) + 0.5, np.arange(41) + 0.5)
    crossed = np.zeros(samples.shape, dtype=int)
    for ring in rings:
        crossed += shapely.contains_xy(shapely.Polygon(ring), x, y)
    np.testing.assert_array_equal(crossed % 2 == 1, samples > 127.5)


def test_diagonal_neighbors_are_connected():
    samples = np.where(np.eye(6, dtype=bool), 255, 0).astype(np.uint8)
    for picture in (samples, samples[:, ::-1]):
        (ring,) = contours(picture, 200.0)
        assert areas([ring])[0] > 0


def test_moved_picture_has_moved_contours():
    samples = PICTURES["3, 1"]
    moved = np.zeros((70, 90), dtype=np.uint8)
    moved[11 : 11 + 41, 5 : 5 + 57] = samples
    for ring, other in zip(contours(samples, 90.0), contours(moved, 90.0), strict=True):
        np.testing.assert_allclose(ring + np.array([5, 11]), other, atol=1e-12)


def test_nothing_above_the_level_has_no_contours():
    assert contours(np.full((5, 4), 100, dtype=np.uint8), 100.0) == []
