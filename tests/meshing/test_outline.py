"""Outlines of pictures whose shape is known."""

import numpy as np
import pytest
import shapely

from akap_editor.errors import InputError
from akap_editor.meshing.outline import MIN_PART_AREA, Outline, outlines
from akap_editor.meshing.triangulate import triangulate


def rasterized(inside, width=120, height=100, samples=8):
    """Alpha of a shape: the share of each pixel that lies in it, by regular samples."""
    x = (np.arange(width * samples) + 0.5) / samples
    y = (np.arange(height * samples) + 0.5) / samples
    hits = inside(x[None, :], y[:, None]).reshape(height, samples, width, samples)
    return np.round(255 * hits.mean(axis=(1, 3))).astype(np.uint8)


def disc(x0, y0, radius):
    return lambda x, y: (x - x0) ** 2 + (y - y0) ** 2 < radius**2


def boxes(shape, *corners):
    """Opaque boxes (x0, y0, x1, y1) on a transparent picture of ``shape`` (h, w)."""
    alpha = np.zeros(shape, dtype=np.uint8)
    for x0, y0, x1, y1 in corners:
        alpha[y0:y1, x0:x1] = 255
    return alpha


def meets_itself(parts):
    """Whether a point occurs twice among all rings."""
    points = np.concatenate([ring for part in parts for ring in (part.outer, *part.holes)])
    return len(np.unique(points, axis=0)) < len(points)


@pytest.mark.parametrize("expand", [0.0, 2.0, 5.0])
def test_disc_to_a_fraction_of_a_pixel(expand):
    (part,) = outlines(rasterized(disc(61.3, 48.8, 30.0)), expand=expand, tolerance=0.1)
    away = np.abs(np.hypot(*(part.outer - [61.3, 48.8]).T) - 30.0 - expand)
    assert away.max() < 0.15
    assert part.holes == ()


@pytest.mark.parametrize("tolerance", [0.25, 0.5, 2.0])
def test_simplified_by_no_more_than_the_tolerance(tolerance):
    (exact,) = outlines(rasterized(disc(60, 50, 40.0)), expand=0, tolerance=0)
    (part,) = outlines(rasterized(disc(60, 50, 40.0)), expand=0, tolerance=tolerance)
    assert part.polygon.exterior.hausdorff_distance(exact.polygon.exterior) < tolerance + 0.05
    assert len(part.outer) < len(exact.outer) / 2


def test_box_lies_on_pixel_borders():
    (part,) = outlines(boxes((60, 80), (10, 20, 50, 45)), expand=0)
    box = shapely.box(10, 20, 50, 45)
    assert part.polygon.exterior.hausdorff_distance(box.exterior) < 0.5  # corners are cut by half a pixel
    assert part.polygon.bounds == (10, 20, 50, 45)


def test_soft_edge_is_where_alpha_crosses_the_threshold():
    ramp = np.tile(np.linspace(0, 255, 52).round().astype(np.uint8), (40, 1))  # 5 per pixel
    for threshold in (0.25, 0.5, 0.75):
        (part,) = outlines(ramp, threshold=threshold, expand=0)
        assert part.polygon.bounds[0] == pytest.approx(0.5 + 255 * threshold / 5, abs=0.02)


def test_holes_stay_and_shrink_when_the_outline_grows():
    alpha = rasterized(lambda x, y: disc(60, 50, 45)(x, y) & ~disc(60, 50, 20)(x, y))
    for expand in (0.0, 3.0):
        (part,) = outlines(alpha, expand=expand, tolerance=0.1)
        (hole,) = part.holes
        assert np.abs(np.hypot(*(hole - [60, 50]).T) - 20.0 + expand).max() < 0.15


def test_islands_largest_first_and_in_holes():
    alpha = boxes((100, 200), (10, 10, 90, 90), (120, 30, 180, 70))
    alpha[25:75, 25:75] = 0
    alpha[40:60, 40:60] = 255
    areas = [part.polygon.area for part in outlines(alpha, expand=0, tolerance=0)]
    assert areas == pytest.approx([80 * 80 - 50 * 50, 60 * 40 - 0.5, 20 * 20 - 0.5])  # four corners cut


def test_near_parts_join_when_the_outline_grows():
    alpha = boxes((40, 60), (5, 5, 25, 30), (28, 5, 50, 30))
    assert len(outlines(alpha, expand=0)) == 2
    assert len(outlines(alpha, expand=2)) == 1


def test_specks_are_dropped_and_pinholes_filled():
    alpha = boxes((60, 60), (10, 10, 50, 40), (55, 55, 57, 57))
    alpha[20:22, 20:22] = 0
    (part,) = outlines(alpha, expand=0, tolerance=0)
    assert part.polygon.area == 40 * 30 - 0.5  # four corners cut
    assert part.holes == ()


def test_clipped_to_the_frame():
    (part,) = outlines(boxes((50, 70), (0, 10, 30, 50)), expand=4)
    assert part.polygon.bounds == (0, 6, 34, 50)


@pytest.mark.parametrize(("height", "width"), [(1, 20), (4, 3), (50, 70)])
def test_opaque_picture_is_exactly_the_frame(height, width):
    (part,) = outlines(np.full((height, width), 255, dtype=np.uint8))
    assert part.polygon.equals(shapely.box(0, 0, width, height))
    assert len(part.outer) == 4


@pytest.mark.parametrize("value", [0, 127])
def test_transparent_picture_is_refused(value):
    with pytest.raises(
        InputError, match=r"fully transparent: .* none of its 7×5 pixels is more than 50% opaque"
    ):
        outlines(np.full((5, 7), value, dtype=np.uint8))


@pytest.mark.parametrize("shape", [(1, 1), (3, 3), (2, 5)])
def test_picture_too_small_is_refused(shape):
    with pytest.raises(
        InputError, match=f"too small .* at least {MIN_PART_AREA:g} square pixels, got {shape[1]}×"
    ):
        outlines(np.full(shape, 255, dtype=np.uint8))


@pytest.mark.parametrize(
    ("alpha", "sentence"),
    [
        (np.zeros((4, 4, 4), np.uint8), r"alpha: expected shape \(h, w\) uint8, got \(4, 4, 4\) uint8"),
        (np.ones((4, 4)), r"alpha: expected shape \(h, w\) uint8, got \(4, 4\) float64"),
        (np.zeros((0, 4), np.uint8), r"alpha: expected shape \(h, w\) uint8, got \(0, 4\) uint8"),
    ],
)
def test_what_is_not_alpha_is_refused(alpha, sentence):
    with pytest.raises(InputError, match=sentence):
        outlines(alpha)


@pytest.mark.parametrize(
    ("setting", "value"),
    [("threshold", 0.0), ("threshold", 1.0), ("expand", -1.0), ("expand", np.nan), ("tolerance", -0.5)],
)
def test_settings_out_of_range_are_refused(setting, value):
    with pytest.raises(InputError, match=f"{setting}: expected .*, got {value:g}"):
        outlines(np.full((20, 20), 255, dtype=np.uint8), **{setting: value})


PINCHED = {
    "two squares at a corner": boxes((60, 60), (10, 10, 30, 30), (30, 30, 50, 50)),
    "hole touching the outside": boxes((60, 60), (10, 10, 50, 50))
    - boxes((60, 60), (10, 10, 20, 20), (20, 20, 40, 40)),
    "two holes at a corner": boxes((60, 60), (5, 5, 55, 55))
    - boxes((60, 60), (15, 15, 30, 30), (30, 30, 45, 45)),
    "ring touching a square": boxes((60, 60), (5, 5, 35, 35), (35, 35, 55, 55))
    - boxes((60, 60), (12, 12, 28, 28)),
    "checkerboard": np.kron(np.indices((6, 6)).sum(axis=0) % 2, np.full((9, 9), 255)).astype(np.uint8),
}


@pytest.mark.parametrize("threshold", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("expand", [0.0, 0.5, 2.0])
@pytest.mark.parametrize("case", PINCHED)
def test_parts_that_touch_in_a_point_come_out_apart_or_joined(case, expand, threshold):
    parts = outlines(PINCHED[case], threshold, expand)
    assert not meets_itself(parts)
    mesh = triangulate(parts, 150)
    assert len(set(mesh.component)) == len(parts)
    found = shapely.union_all([part.polygon for part in parts])
    assert mesh.rest_areas.sum() == pytest.approx(found.area, rel=1e-9)
    rows, columns = np.nonzero(PINCHED[case])
    pixels = shapely.union_all(shapely.box(columns, rows, columns + 1, rows + 1))
    assert found.contains(pixels.buffer(-1.5))
    assert pixels.buffer(expand + 1.0).contains(found)


@pytest.mark.parametrize("seed", range(6))
def test_no_noise_makes_outlines_that_touch(seed):
    """Levels at the threshold, so that the iso-line runs through pixel centers and rings meet all over."""
    alpha = np.random.default_rng(seed).choice([0, 51, 255], (24, 24)).astype(np.uint8)
    parts = outlines(alpha, threshold=0.2, expand=0)
    assert not meets_itself(parts)
    assert all(part.polygon.is_valid for part in parts)
    assert triangulate(parts, 500).component.max() == len(parts) - 1


def test_outline_is_checked_and_read_only():
    part = Outline([[0, 0], [4, 0], [0, 4]], ([[1, 1], [1, 2], [2, 1]],))
    assert part.outer.dtype == np.float64
    assert not part.outer.flags.writeable
    assert not part.holes[0].flags.writeable
    assert part.polygon.area == 7.5


@pytest.mark.parametrize(
    ("outer", "holes", "sentence"),
    [
        ([[0, 0], [1, 0]], (), "outer: expected at least 3 points, got 2"),
        ([], (), "outer: expected at least 3 points, got 0"),
        ([[0, 0], [1, 0], [0, np.nan]], (), "outer: expected finite numbers"),
        ([[0, 0], [9, 0], [0, 9]], ([[1, 1]],), "holes: expected at least 3 points, got 1"),
        ([[0, 0], [9, 0], [0, 9]], ([[1, 1, 1]],), r"holes: expected shape \(n, 2\)"),
    ],
)
def test_bad_outline_is_refused(outer, holes, sentence):
    with pytest.raises(InputError, match=sentence):
        Outline(outer, holes)
