"""Curved faces that are cut along a seam: they cover the same area, and are drawn as without the seam."""

import numpy as np
import pytest
from scipy.ndimage import binary_dilation

from akap_editor.editor.document.drawing import Drawing
from akap_editor.geometry.mesh import signed_areas
from akap_editor.overlap.seams import CutMesh, cut_along_seams
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.render.refined_cut import refined_cut
from akap_editor.render.refinement import refinement
from tests.overlap.test_overlaps import ROPE, rolled_up
from tests.overlap.test_seams import POSE, with_seam

MARGIN = 4.0  # pixels around the picture of the pose


@pytest.fixture(scope="module")
def cut() -> CutMesh:
    made = cut_along_seams(ROPE, with_seam(rolled_up()), np.arange(len(ROPE.faces)))
    assert made is not None
    return made


@pytest.fixture(scope="module")
def striped() -> Drawing:
    """The rope with stripes, opaque."""
    low, high = ROPE.vertices.min(axis=0), ROPE.vertices.max(axis=0)
    width, height = (int(side) for side in high - low)
    image = np.full((height, width, 4), 255, np.uint8)
    image[..., 0] = (np.arange(width) // 12 % 2 * 200)[None]
    image[..., 1] = (np.arange(height) // 12 % 2 * 200)[:, None]
    return Drawing(image, ROPE, ((ROPE.vertices - low) / (high - low)).astype(np.float32))


@pytest.mark.parametrize("parts", [2, 3, 4])
def test_the_small_faces_of_a_face_cover_it_and_follow_the_refinement(cut: CutMesh, parts: int) -> None:
    refined = refinement(ROPE, parts)
    made = refined_cut(ROPE, refined, cut)
    flat = made.values(refined.linear @ POSE)
    own = signed_areas(flat, made.faces)
    assert own.min() > -1e-9, "none is turned over"
    owner = np.repeat(np.arange(len(cut.faces)), np.diff(made.starts))
    np.testing.assert_allclose(
        np.bincount(owner, own, len(cut.faces)), signed_areas(cut.values(POSE), cut.faces), rtol=1e-6
    )
    curved = made.values(refined.smooth @ POSE)
    whole = np.bincount(
        np.repeat(np.arange(len(ROPE.faces)), parts**2),
        signed_areas(refined.smooth @ POSE, refined.faces.reshape(-1, 3)),
    )
    sums = np.bincount(cut.sources[owner], signed_areas(curved, made.faces), len(ROPE.faces))
    np.testing.assert_allclose(sums, whole, rtol=1e-6)


def test_away_from_the_seam_it_is_drawn_as_without_a_seam(ctx, cut: CutMesh, striped: Drawing) -> None:
    (left, top), (right, bottom) = POSE.min(axis=0) - MARGIN, POSE.max(axis=0) + MARGIN
    box = int(left), int(top), int(right), int(bottom)
    drawn = []
    for order, is_smooth in ((cut, True), (cut.order, True), (cut, False)):
        with OffscreenRenderer(ctx, is_smooth=is_smooth) as renderer:
            drawn.append(renderer.render(striped, POSE, box, 1.0, None, order))
    cut_smooth, smooth, cut_flat = drawn
    # Which sheet is in front differs between the two orders only in the region of the ragged seam.
    with OffscreenRenderer(ctx, is_smooth=False) as renderer:
        flat = renderer.render(striped, POSE, box, 1.0, None, cut.order)
    region = binary_dilation((flat != cut_flat).any(axis=2), iterations=6)
    assert 0 < region.mean() < 0.2
    away = ~region
    assert (np.abs(cut_smooth.astype(int) - smooth).max(axis=2)[away] <= 2).all()
    assert (np.abs(cut_flat.astype(int) - smooth).max(axis=2)[away] > 50).sum() > 100, "bends are flat else"
    assert (cut_smooth[..., 3][region & (smooth[..., 3] == 255)] == 255).mean() > 0.999, "no gaps"
