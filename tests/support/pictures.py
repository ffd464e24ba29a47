"""Small pictures with a transparent background, (h, w, 4) uint8 with straight alpha."""

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]


def figure_picture(scale: int = 1, soft: bool = False) -> Picture:
    """A head with a long neck, of 120 × 80 pixels times ``scale``; the corners are empty.

    soft: whether alpha falls off gradually at the edges.
    """
    y, x = (np.mgrid[0 : 80 * scale, 0 : 120 * scale] + 0.5) / scale
    head = 1 - np.hypot((x - 35) / 25, (y - 40) / 30)
    neck = np.minimum(14 - abs(y - 40), np.minimum(x - 30, 112 - x)) / 15
    inside = np.maximum(head, neck)
    return colored(np.clip(30 * inside, 0, 1) if soft else inside > 0, (90, 140, 200))


def bar_picture() -> Picture:
    """An orange bar of 90 × 60 pixels with soft edges."""
    y, x = np.mgrid[0:60, 0:90] + 0.5
    return colored(np.clip(np.minimum(20 - abs(y - 30), 36 - abs(x - 45)), 0, 1), (250, 130, 20))


def colored(alpha: np.ndarray, color: tuple[int, int, int]) -> Picture:
    """Return a picture of one color with this alpha, from 0 to 1; it is black where alpha is 0."""
    picture = np.zeros((*alpha.shape, 4), dtype=np.uint8)
    picture[..., 3] = np.rint(255 * alpha)
    picture[alpha > 0, :3] = color
    return picture
