"""Textures that hold several pictures."""

import numpy as np
import pytest

from akap_editor.layers.atlas import MIP_MARGIN, pack

RNG = np.random.default_rng(5)
SETS = {
    "one": [(5, 3)],
    "equal": [(9, 9)] * 7,
    "mixed": [tuple(RNG.integers(1, 60, 2).tolist()) for _ in range(25)],
    "long": [(1, 300), (300, 1), (20, 20)],
}


@pytest.mark.parametrize("sizes", SETS.values(), ids=SETS)
def test_pictures_come_back_with_transparent_pixels_around_them(sizes):
    pictures = [RNG.integers(1, 255, (h, w, 4), dtype=np.uint8) for w, h in sizes]
    views = {}
    texture, corners = pack(pictures, 2.5, views.__setitem__)
    border = 3 + MIP_MARGIN
    taken = np.zeros(texture.shape[:2], int)
    for number, (picture, (x, y)) in enumerate(zip(pictures, corners, strict=True)):
        h, w = picture.shape[:2]
        assert (texture[y : y + h, x : x + w] == picture).all()
        assert (views[number] == picture).all()
        assert np.shares_memory(views[number], texture)
        assert not views[number].flags.writeable
        assert min(x, y) >= border
        taken[y - border : y + h + border, x - border : x + w + border] += 1
    assert taken.max() == 1
    assert (texture[..., 3] > 0).sum() == sum(w * h for w, h in sizes)
    assert taken.size < 2 * taken.sum() + 200 * 400
