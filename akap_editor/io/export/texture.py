"""Shared by the mesh formats: the texture, coordinates with y up, names of additional files."""

import re

import numpy as np

from ...display_text import display_text
from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats
from ..images import Picture, encode_png

BLEED_PIXELS = 16  # around visible pixels: enough for four mip levels


def encode_texture(drawing: Drawing) -> bytes:
    """The bytes of a PNG file with the drawing's picture, see `bleed`."""
    return encode_png(bleed(drawing.image))


def bleed(image: Picture) -> Picture:
    """``image`` (h, w, 4) with invisible pixels near visible ones in the color of the nearest visible pixel.

    Alpha and visible pixels stay as they are. Renderers filter textures with straight alpha, so that the
    color of invisible neighbors shows at edges.
    """
    from scipy.ndimage import maximum_filter
    from scipy.spatial import cKDTree

    visible = image[..., 3] > 0
    result = image.copy()
    if not visible.any():
        return result
    padded = np.pad(visible, 1)
    neighbors = [padded[1:-1, :-2], padded[1:-1, 2:], padded[:-2, 1:-1], padded[2:, 1:-1]]
    edge = np.argwhere(visible & ~np.logical_and.reduce(neighbors))
    hidden = np.argwhere(maximum_filter(visible, 2 * BLEED_PIXELS + 1, mode="constant") & ~visible)
    _, nearest = cKDTree(edge).query(hidden)
    result[(*hidden.T, slice(3))] = image[(*edge[nearest].T, slice(3))]
    return result


def y_up(drawing: Drawing, points: Floats) -> Floats:
    """Points (n, 2) as most programs expect them: pixels, y up, origin at the middle of the lower edge."""
    width, height = drawing.size
    return np.array([-width / 2, height]) + points * [1.0, -1.0]


def level_height(drawing: Drawing) -> float:
    """The distance in z, in pixels, from one level of faces to the next, see `stacked`."""
    return max(drawing.size) / 1000


def texture_name(stem: str) -> str:
    """The name of the texture beside an exported file."""
    return f"{companion_stem(stem)}-texture.png"


def companion_stem(stem: str) -> str:
    """The stem for a file that the exported file names.

    It is text, and without spaces or signs at which some readers stop.
    """
    return re.sub(r"[#\\]+", "_", display_text(re.sub(r"\s+", "_", stem)))
