"""Packs the pictures of layers into one texture."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..geometry.validation import freeze
from .layered_picture import Layer, LayeredPicture

MIP_MARGIN = 8  # transparent pixels around each picture: it is not mixed with others in small mip levels


def pack(
    pictures: Sequence[NDArray[np.uint8]],
    margin: float,
    release: Callable[[int, NDArray[np.uint8]], None] | None = None,
) -> tuple[NDArray[np.uint8], list[tuple[int, int]]]:
    """One picture (h, w, 4) uint8 that holds all pictures, and the top left corner of each in it, (x, y).

    margin: pixels by which meshes reach beyond the pictures; they are transparent; release: called after each
    copy with the picture's index and its read-only view in the result, so that the caller can drop the
    picture before the next copy; then the pixels are hardly ever in memory twice. The pictures are placed on
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
    for number in reversed(
        range(len(corners))
    ):  # what was allocated last is at the end of the heap, which shrinks
        x, y = corners[number]
        height, width = pictures[number].shape[:2]
        view = texture[y : y + height, x : x + width]
        view[...] = pictures[number]
        if release is not None:
            view.flags.writeable = False
            release(number, view)
    return freeze(texture), corners


def pack_shared(
    layered: LayeredPicture, movable: Sequence[Layer], margin: float
) -> tuple[NDArray[np.uint8], list[tuple[int, int]]]:
    """Pack the pictures of the movable layers, see `pack`; the layers then refer to views in the texture.

    So do the layers of ``layered`` that have the same pictures.
    """
    pictures = [layer.picture for layer in movable]
    owners = [
        [each for each in (*layered.layers, *movable) if each.picture is picture] for picture in pictures
    ]

    def release(number: int, view: NDArray[np.uint8]) -> None:
        pictures[number] = view
        for layer in owners[number]:
            layer.share(view)

    return pack(pictures, margin, release)
