"""Drawings: the mesh covers the visible picture, arrays are copied, and bad pictures are refused."""

import numpy as np
import pytest

from akap_editor.editor.document.drawing import Drawing, apply_mask, make_drawing
from akap_editor.errors import InputError
from tests.support.pictures import bar_picture


def test_a_drawing_covers_its_picture(image, drawing):
    assert drawing.size == (120, 80)
    assert drawing.mesh.vertices.min() >= 0
    assert (drawing.mesh.vertices <= drawing.size).all()
    assert len(drawing.mesh.vertices) == pytest.approx(150, rel=0.1)
    visible = np.argwhere(image[..., 3] > 127)[:, ::-1] + 0.5
    assert all(drawing.mesh.find(pixel) is not None for pixel in visible[::37])


def test_uv_are_vertices_as_shares_of_the_picture(drawing):
    assert drawing.uv.dtype == np.float32
    np.testing.assert_allclose(drawing.uv * drawing.size, drawing.mesh.vertices, atol=1e-4)


@pytest.mark.parametrize(
    "bad",
    [
        np.zeros((4, 4), np.uint8),
        np.zeros((4, 4, 3), np.uint8),
        np.zeros((4, 4, 4), np.float32),
        np.zeros((0, 4, 4), np.uint8),
    ],
)
def test_a_picture_is_rgba_bytes(drawing, bad):
    with pytest.raises(InputError, match="image"):
        Drawing(bad, drawing.mesh, drawing.uv)
    with pytest.raises(InputError, match="image"):
        make_drawing(bad)


def test_a_transparent_picture_is_no_drawing():
    with pytest.raises(InputError, match="transparent"):
        make_drawing(np.zeros((20, 20, 4), np.uint8))


def test_uv_must_be_one_finite_pair_a_vertex(drawing):
    not_finite = drawing.uv.copy()
    not_finite[3] = np.nan
    for uv in (drawing.uv[:-1], drawing.uv[:, :1], not_finite):
        with pytest.raises(InputError, match="uv"):
            Drawing(drawing.image, drawing.mesh, uv)


def test_a_drawing_copies_the_picture(image):
    argument = image.copy()
    drawing = make_drawing(argument, vertices=60)
    argument[:] = 7
    np.testing.assert_array_equal(drawing.image, image)


def test_a_drawing_is_opaque_if_all_of_its_picture_is(image, drawing):
    assert not drawing.is_opaque
    opaque = image.copy()
    opaque[..., 3] = 255
    assert make_drawing(opaque, vertices=60).is_opaque


def test_a_mask_multiplies_the_alpha(image):
    mask = np.full(image.shape[:2], 128, dtype=np.uint8)
    mask[:, :60] = 0
    masked = apply_mask(image, mask)
    np.testing.assert_array_equal(masked[..., :3], image[..., :3])
    assert not masked[:, :60, 3].any()
    assert set(np.unique(masked[:, 60:, 3])) == {0, 128}


@pytest.mark.parametrize(
    ("mask", "message"),
    [
        (np.zeros((80, 119), np.uint8), "the size of the picture, 120 x 80 pixels, got 119 x 80"),
        (np.zeros((80, 120)), r"mask: expected shape \(h, w\) uint8, got \(80, 120\) float64"),
        (np.zeros((80, 120, 1), np.uint8), r"mask: expected shape \(h, w\) uint8"),
    ],
)
def test_a_mask_is_a_gray_picture_of_the_same_size(image, mask, message):
    with pytest.raises(InputError, match=message):
        make_drawing(image, mask)


@pytest.mark.parametrize("opacity", [255, 120, 40, 10])
def test_a_faint_picture_is_cut_out_at_a_lower_threshold(opacity):
    picture = bar_picture()
    picture[..., 3] = picture[..., 3].astype(int) * opacity // 255
    drawing = make_drawing(picture, vertices=200)
    assert 0 < drawing.meshing.threshold <= 0.5
    assert (drawing.meshing.threshold < 0.5) == (opacity < 128)
    whole = make_drawing(bar_picture(), vertices=200)
    assert drawing.mesh.rest_areas.sum() == pytest.approx(whole.mesh.rest_areas.sum(), rel=0.05)
    if opacity < 128:
        with pytest.raises(InputError, match="transparent"):
            make_drawing(picture, vertices=200, threshold=0.5)


def test_a_faint_mask_lowers_the_threshold():
    picture = bar_picture()
    drawing = make_drawing(picture, np.full(picture.shape[:2], 60, np.uint8), vertices=200)
    assert drawing.meshing.threshold < 60 / 255
