"""What the mesh formats share: the texture, and the plane as others see it."""

import re

import numpy as np
from scipy.ndimage import maximum_filter
from scipy.spatial import cKDTree

from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats
from ..images import Picture, encode_png

REACH = 16  # pixels beyond what is visible that get a color: enough for four mip levels


def encode_texture(drawing: Drawing) -> bytes:
    """The picture as a PNG file whose invisible pixels have the color of what is visible near them."""
    return encode_png(bleed(drawing.image))


def bleed(image: Picture) -> Picture:
    """``image`` (h, w, 4) with the colors of its rim continued outwards; alpha, and what is visible, stay.

    Programs filter textures with straight alpha: whatever color lies next to the rim shines through.
    """
    visible = image[..., 3] > 0
    result = image.copy()
    if not visible.any():
        return result
    padded = np.pad(visible, 1)
    around = [padded[1:-1, :-2], padded[1:-1, 2:], padded[:-2, 1:-1], padded[2:, 1:-1]]
    rim = np.argwhere(visible & ~np.logical_and.reduce(around))
    hidden = np.argwhere(maximum_filter(visible, 2 * REACH + 1, mode="constant") & ~visible)
    _, nearest = cKDTree(rim).query(hidden)
    result[(*hidden.T, slice(3))] = image[(*rim[nearest].T, slice(3))]
    return result


def y_up(drawing: Drawing, points: Floats) -> Floats:
    """Drawing units as most programs count: pixels, y up, origin below the middle of the picture's frame."""
    width, height = drawing.size
    return np.array([-width / 2, height]) + points * [1.0, -1.0]


def companion(stem: str) -> str:
    """The beginning of the name of a file that another one names: some readers stop at a space."""
    return re.sub(r"\s+", "_", stem)
