"""Removes a plain background by flood fill from the border, with soft edges."""

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..geometry.validation import Floats, as_number, as_picture
from ..words import tr

DEFAULT_TOLERANCE = 0.125

_DROPPED_BITS = 5  # of each color channel, to find the color that most of the border has
_MAX_DISTANCE = 3.0  # pixels from an edge pixel to the nearest pixel that is no mixture
_NEIGHBORHOOD = np.array([(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1)])


def background_color(image: NDArray[np.uint8]) -> Floats:
    """The most frequent color (3,), 0 to 255, on the border of a picture (h, w, 4) uint8.

    Raises InputError if the border is transparent, or for another shape or dtype.
    """
    image = as_picture(image, "image")
    border = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
    colors = border[border[:, 3] > 0, :3]
    if not len(colors):
        raise InputError(tr("background: expected a border that can be seen, got a transparent one"))
    coarse = (colors >> _DROPPED_BITS).astype(np.int32) @ [1 << 16, 1 << 8, 1]
    values, counts = np.unique(coarse, return_counts=True)
    color = np.median(colors[coarse == values[np.argmax(counts)]], axis=0)
    return np.median(colors[np.abs(colors - color).max(axis=1) <= 1 << _DROPPED_BITS], axis=0)


def remove_background(image: NDArray[np.uint8], tolerance: float = DEFAULT_TOLERANCE) -> NDArray[np.uint8]:
    """The picture (h, w, 4) uint8, straight alpha, with its plain background made transparent.

    Background are the pixels that are connected to the border through pixels that differ from
    `background_color` by at most ``tolerance`` in each channel, a share of the full range from 0 to 1. Pixels
    of that color inside the drawing stay. A pixel on the edge mixes background and drawing: it gets the color
    of the drawing next to it, and the drawing's share as alpha. Raises InputError as `background_color` does,
    or for a tolerance out of range.
    """
    as_number(tolerance, "tolerance", 0, 1)
    background = background_color(image)
    similar = np.ones(image.shape[:2], dtype=bool)
    for channel, level in enumerate(background):
        low, high = np.clip([np.ceil(level - 255 * tolerance), np.floor(level + 255 * tolerance)], 0, 255)
        values = image[..., channel]
        similar &= (values >= np.uint8(low)) & (values <= np.uint8(high))
    outside = _connected_to_border(similar | (image[..., 3] == 0))
    result = image.copy()
    result[..., 3] *= ~outside
    _soften_edges(result, image, outside, background)
    return result


def _connected_to_border(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The pixels of a mask (h, w) that are 4-connected to the border within the mask."""
    from scipy.ndimage import label

    labels, count = label(mask)
    on_border = np.zeros(count + 1, dtype=bool)
    for line in (labels[0], labels[-1], labels[:, 0], labels[:, -1]):
        on_border[line] = True
    on_border[0] = False
    return on_border[labels]


def _soften_edges(
    result: NDArray[np.uint8], image: NDArray[np.uint8], outside: NDArray[np.bool_], background: Floats
) -> None:
    """Set color and alpha of the pixels on both sides of the edge, in place in ``result`` (h, w, 4)."""
    near_outside, near_drawing = _dilate(outside), _dilate(~outside)
    edge = near_outside & near_drawing & (image[..., 3] > 0)
    pixels = np.argwhere(edge)
    if not len(pixels):
        return
    colors = image[edge][:, :3].astype(np.float64)
    behind = np.tile(background, (len(pixels), 1))
    # A background that only looks plain varies: take it from nearby pixels.
    _take_nearest(behind, image, pixels, _dilate(_dilate(near_drawing)) & ~near_drawing)
    pure = _most_different_neighbors(image, pixels, background)
    _take_nearest(pure, image, pixels, _dilate(_dilate(near_outside)) & ~near_outside)
    contrast = pure - behind
    square = (contrast**2).sum(axis=1)
    projection = ((colors - behind) * contrast).sum(axis=1)
    share = np.divide(projection, square, out=np.ones_like(square), where=square > 0)
    share = np.clip(share, 0, 1)
    mixed = share < 1
    colors[mixed] = pure[mixed]
    result[edge, :3] = np.rint(colors)
    result[edge, 3] = np.rint(share * image[edge, 3])


def _dilate(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask (h, w) and the eight neighbors of its pixels."""
    rows = mask.copy()
    rows[1:] |= mask[:-1]
    rows[:-1] |= mask[1:]
    result = rows.copy()
    result[:, 1:] |= rows[:, :-1]
    result[:, :-1] |= rows[:, 1:]
    return result


def _most_different_neighbors(
    image: NDArray[np.uint8], pixels: NDArray[np.int64], background: Floats
) -> Floats:
    """The color (p, 3), at or next to each of ``pixels`` (p, 2), that differs most from the background.

    On a line so thin that all its pixels are on the edge, that is the color of the drawing.
    """
    height, width = image.shape[:2]
    best = np.tile(background, (len(pixels), 1))
    for step in _NEIGHBORHOOD:
        neighbors = np.clip(pixels + step, 0, [height - 1, width - 1])
        colors = image[tuple(neighbors.T)][:, :3].astype(np.float64)
        better = np.abs(colors - background).sum(axis=1) > np.abs(best - background).sum(axis=1)
        best[better] = colors[better]
    return best


def _take_nearest(
    colors: Floats, image: NDArray[np.uint8], pixels: NDArray[np.int64], mask: NDArray[np.bool_]
) -> None:
    """Replace ``colors`` (p, 3) of ``pixels`` (p, 2) by those of the nearest visible pixels of a mask.

    A color stays if no such pixel is within `_MAX_DISTANCE`.
    """
    from scipy.spatial import cKDTree

    candidates = np.argwhere(mask & (image[..., 3] > 0))
    if len(candidates):
        distance, nearest = cKDTree(candidates).query(pixels, distance_upper_bound=_MAX_DISTANCE)
        near = np.isfinite(distance)
        colors[near] = image[tuple(candidates[nearest[near]].T)][:, :3]
