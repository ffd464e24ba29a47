"""The texture's rim, and the plane with y up."""

import numpy as np

from akap_editor.io.export.texture import BLEED_PIXELS, bleed, companion_stem, y_up


def test_bleeding_changes_only_hidden_colors(bent):
    image = bent.drawing.image
    result = bleed(image)
    visible = image[..., 3] > 0
    np.testing.assert_array_equal(result[visible], image[visible])
    np.testing.assert_array_equal(result[..., 3], image[..., 3])


def test_each_hidden_pixel_has_the_color_of_a_nearest_visible_one():
    rng = np.random.default_rng(3)
    image = rng.integers(1, 256, (24, 31, 4), dtype=np.uint8)
    image[..., 3] = np.where(rng.random((24, 31)) < 0.06, 255, 0)
    result = bleed(image)
    y, x = np.nonzero(image[..., 3])
    for row, column in np.argwhere(image[..., 3] == 0):
        away = (y - row) ** 2 + (x - column) ** 2
        assert away.min() <= BLEED_PIXELS**2
        nearest = [image[y[i], x[i], :3].tolist() for i in np.flatnonzero(away == away.min())]
        assert result[row, column, :3].tolist() in nearest


def test_a_filtered_rim_keeps_its_color():
    """Straight alpha halved as programs do: the mean of four colors, whatever their alpha."""
    image = np.zeros((64, 64, 4), dtype=np.uint8)
    image[21:43, 21:43] = (250, 130, 20, 255)
    for _ in range(4):
        image = bleed(image)[:, :, :]
        small = image.reshape(len(image) // 2, 2, len(image) // 2, 2, 4).mean(axis=(1, 3)).astype(np.uint8)
        assert (small[small[..., 3] > 0][:, :3] == [250, 130, 20]).all()
        image = small


def test_what_is_far_away_stays(bent):
    image = np.zeros((100, 100, 4), dtype=np.uint8)
    image[50, 50] = (9, 9, 9, 255)
    result = bleed(image)
    side = 2 * BLEED_PIXELS + 1
    assert (result[..., 0] == 9).sum() == side**2
    assert not bleed(np.zeros((4, 4, 4), dtype=np.uint8)).any()


def test_y_up_is_a_reflection_about_the_foot_of_the_frame(bent):
    width, height = bent.drawing.size
    corners = np.array([[0.0, 0.0], [width, height], [width / 2, height]])
    np.testing.assert_array_equal(y_up(bent.drawing, corners), [[-width / 2, height], [width / 2, 0], [0, 0]])


def test_names_that_others_can_read():
    assert companion_stem("my  old\tcat") == "my_old_cat"
    assert companion_stem("Bär") == "Bär"
