"""A plain background made transparent: flood fill from the border, with a soft rim."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label
from scipy.spatial import cKDTree

from ..errors import InputError
from ..geometry.validation import Floats, as_number, as_picture

DEFAULT_TOLERANCE = 0.125

_COARSE = 5  # bits by which a color is shortened to find the one that most of the border has
_NEAR = 3.0  # pixels from the rim to pixels that are no mixtures
_AROUND = np.array([(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1)])


def background_color(image: NDArray[np.uint8]) -> Floats:
    """The color (3,), 0 to 255, that most of the border of a picture (h, w, 4) has.

    Raises InputError where the border is transparent, or the picture is no RGBA picture.
    """
    image = as_picture(image, "image")
    border = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
    colors = border[border[:, 3] > 0, :3]
    if not len(colors):
        raise InputError("background: expected a border that can be seen, got a transparent one")
    coarse = (colors >> _COARSE).astype(np.int32) @ [1 << 16, 1 << 8, 1]
    values, counts = np.unique(coarse, return_counts=True)
    color = np.median(colors[coarse == values[np.argmax(counts)]], axis=0)
    return np.median(colors[np.abs(colors - color).max(axis=1) <= 1 << _COARSE], axis=0)


def remove_background(image: NDArray[np.uint8], tolerance: float = DEFAULT_TOLERANCE) -> NDArray[np.uint8]:
    """The picture (h, w, 4) uint8, straight alpha, with the plain background around the drawing transparent.

    Background is what is joined to the border by pixels that differ from `background_color` by at most
    ``tolerance`` in each channel, as a share of the full range, 0 to 1; what has that color within the
    drawing stays. A pixel on the rim is a mixture of background and of the drawing a little farther in: it
    gets the drawing's color, and the share of it as alpha. Raises InputError as `background_color` does, and
    on a tolerance out of range.
    """
    as_number(tolerance, "tolerance", 0, 1)
    back = background_color(image)
    alike = np.ones(image.shape[:2], dtype=bool)
    for channel, level in enumerate(back):
        low, high = np.clip([np.ceil(level - 255 * tolerance), np.floor(level + 255 * tolerance)], 0, 255)
        values = image[..., channel]
        alike &= (values >= np.uint8(low)) & (values <= np.uint8(high))
    outside = _from_border(alike | (image[..., 3] == 0))
    result = image.copy()
    result[..., 3] *= ~outside
    _soften(result, image, outside, back)
    return result


def _from_border(free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """What can be reached from the border by steps to the four neighbors."""
    labels, count = label(free)
    reached = np.zeros(count + 1, dtype=bool)
    for line in (labels[0], labels[-1], labels[:, 0], labels[:, -1]):
        reached[line] = True
    reached[0] = False
    return reached[labels]


def _soften(
    result: NDArray[np.uint8], image: NDArray[np.uint8], outside: NDArray[np.bool_], back: Floats
) -> None:
    """Give the pixels on both sides of the rim their share of the drawing as alpha."""
    near_outside, near_drawing = _grown(outside), _grown(~outside)
    rim = near_outside & near_drawing & (image[..., 3] > 0)
    places = np.argwhere(rim)
    if not len(places):
        return
    colors = image[rim][:, :3].astype(np.float64)
    behind = np.tile(back, (len(places), 1))  # where the background is plain to the eye only, what is near
    _take_nearest(behind, image, places, _grown(_grown(near_drawing)) & ~near_drawing)
    pure = _strongest_neighbors(image, places, back)
    _take_nearest(pure, image, places, _grown(_grown(near_outside)) & ~near_outside)
    way = pure - behind
    size = (way**2).sum(axis=1)
    share = np.divide(((colors - behind) * way).sum(axis=1), size, out=np.ones_like(size), where=size > 0)
    share = np.clip(share, 0, 1)
    mixed = share < 1
    colors[mixed] = pure[mixed]
    result[rim, :3] = np.rint(colors)
    result[rim, 3] = np.rint(share * image[rim, 3])


def _grown(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask and the eight neighbors of what is in it."""
    rows = mask.copy()
    rows[1:] |= mask[:-1]
    rows[:-1] |= mask[1:]
    result = rows.copy()
    result[:, 1:] |= rows[:, :-1]
    result[:, :-1] |= rows[:, 1:]
    return result


def _strongest_neighbors(image: NDArray[np.uint8], places: NDArray[np.int64], back: Floats) -> Floats:
    """The color (p, 3), at or beside each of ``places`` (p, 2), that differs most from the background.

    In a line so thin that every pixel is on the rim, it is that of the drawing.
    """
    height, width = image.shape[:2]
    best = np.tile(back, (len(places), 1))
    for step in _AROUND:
        at = np.clip(places + step, 0, [height - 1, width - 1])
        other = image[tuple(at.T)][:, :3].astype(np.float64)
        farther = np.abs(other - back).sum(axis=1) > np.abs(best - back).sum(axis=1)
        best[farther] = other[farther]
    return best


def _take_nearest(
    colors: Floats, image: NDArray[np.uint8], places: NDArray[np.int64], among: NDArray[np.bool_]
) -> None:
    """Replace ``colors`` (p, 3) by those of the nearest pixels ``among`` some, where there are any near."""
    pixels = np.argwhere(among & (image[..., 3] > 0))
    if len(pixels):
        distance, nearest = cKDTree(pixels).query(places, distance_upper_bound=_NEAR)
        near = np.isfinite(distance)
        colors[near] = image[tuple(pixels[nearest[near]].T)][:, :3]
