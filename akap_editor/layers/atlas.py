"""Packs the pictures of layers into one texture."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..geometry.validation import freeze

MIP_MARGIN = 8  # transparent pixels around each picture: it is not mixed with others in small mip levels


def pack(
    pictures: Sequence[NDArray[np.uint8]], margin: float
) -> tuple[NDArray[np.uint8], list[tuple[int, int]]]:
    """One picture (h, w, 4) uint8 that holds all pictures, and the top left corner of each in it, (x, y).

    margin: pixels by which meshes reach beyond the pictures; they are transparent. The pictures are placed on
    shelves, the highest ones first (Coffman et al., "Performance bounds for level-oriented two-dimensional
    packing algorithms", 1980).
    """
    border = math.ceil(margin) + MIP_MARGIN
    sizes = [(p.shape[1] + 2 * border, p.shape[0] + 2 * border) for p in pictures]
    area = sum(width * height for width, height in sizes)
    shelf_width = max(math.isqrt(area) + 1, *(width for width, _ in sizes))
    corners = [(0, 0)] * len(pictures)
    left = top = shelf_height = right = 0
    for number in sorted(range(len(pictures)), key=lambda k: -sizes[k][1]):
        width, height = sizes[number]
        if left + width > shelf_width:
            left, top, shelf_height = 0, top + shelf_height, 0
        corners[number] = left + border, top + border
        left, shelf_height = left + width, max(shelf_height, height)
        right = max(right, left)
    texture = np.zeros((top + shelf_height, right, 4), np.uint8)
    for picture, (x, y) in zip(pictures, corners, strict=True):
        texture[y : y + picture.shape[0], x : x + picture.shape[1]] = picture
    return freeze(texture), corners
