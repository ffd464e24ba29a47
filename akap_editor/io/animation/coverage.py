"""Decides which pixels of a frame are opaque, for formats that know no half-transparent ones."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...geometry.validation import Floats, Ints
from ..images import Picture
from .frames import bounding_box

OPAQUE = 128  # alpha from which a pixel is opaque whatever is around it
VISIBLE = 6  # alpha from which a pixel counts as ink; less is rounding and the tail of a blur
_RIM = 4  # pixels: a slope of alpha that ends this near to opaque pixels is their soft rim
_CREST_CURVATURE = 0.4  # of the alpha: a line is a crest at least this sharp, in units of 1 / pixel²
_CREST_OFFSET = (
    0.7  # pixels from the middle of a pixel to the crest in it; over 0.5, so that lines have no gaps
)

_SQUARE = np.ones((3, 3), dtype=bool)
Mask = NDArray[np.bool_]


def opaque_pixels(image: Picture) -> Mask:
    """The pixels (h, w) of a frame (h, w, 4) uint8 that are shown when alpha is either 0 or 255.

    Those of at least half coverage are. Ink that would vanish is kept: of a line narrower than a pixel its
    crest, one pixel wide and without gaps; of a wide faint part as many pixels as its alpha says, in an
    ordered pattern; and of anything else at least the pixel of the highest alpha. Soft rims of opaque parts
    are cut at half.
    """
    visible = image[..., 3] >= VISIBLE
    shown = image[..., 3] >= OPAQUE
    if (visible != shown).any():
        left, top, right, bottom = bounding_box(visible)
        box = slice(max(top - 1, 0), bottom + 1), slice(max(left - 1, 0), right + 1)
        pattern = _pattern(image.shape[:2])[box]
        shown[box] = _opaque_pixels(image[..., 3][box], pattern)
    return shown


def _opaque_pixels(alpha: Picture, pattern: Floats) -> Mask:
    """The pixels (h, w) shown of coverages (h, w) uint8; pattern: (h, w) thresholds of wide faint parts."""
    opaque = alpha >= OPAQUE
    faint = (alpha >= VISIBLE) & ~opaque
    wide = _wide_faint_parts(opaque, faint)
    shown = opaque | (wide & (alpha > pattern))
    shown |= _lines(alpha, faint & ~wide, opaque | wide)
    return shown | _peaks_of_the_rest(alpha, shown)


def _wide_faint_parts(opaque: Mask, faint: Mask) -> Mask:
    """Faint pixels of parts that are 3 or more pixels wide and reach beyond the rim of opaque parts."""
    wide = _dilated(~_dilated(~faint, outside=True))
    if not wide.any():
        return wide
    rim = opaque
    for _ in range(_RIM):
        rim = _dilated(rim)
    beyond = wide & ~rim
    if not beyond.any():
        return beyond
    return np.asarray(ndimage.binary_dilation(beyond, _SQUARE, iterations=_RIM, mask=wide) | beyond)


def _dilated(mask: Mask, outside: bool = False) -> Mask:
    """The pixels (h, w) of a mask and all 8 neighbors of each; many times faster than scipy.ndimage.

    outside: whether pixels outside of the picture are of the mask.
    """
    padded = np.pad(mask, 1, constant_values=outside)
    rows = padded[:-2] | padded[1:-1] | padded[2:]
    return np.asarray(rows[:, :-2] | rows[:, 1:-1] | rows[:, 2:])


def _pattern(shape: tuple[int, ...]) -> Floats:
    """Thresholds of alpha (h, w) in Bayer's order, which spreads any share of pixels evenly.

    The pattern stays where it is from frame to frame, so that parts at rest do not flicker.
    """
    order = np.zeros((1, 1))
    for _ in range(3):
        order = np.block([[4 * order, 4 * order + 2], [4 * order + 3, 4 * order + 1]])
    height, width = shape
    tiled = np.tile(order, (-(-height // 8), -(-width // 8)))
    return np.asarray((tiled[:height, :width] + 0.5) / 64 * 255)


def _lines(alpha: Picture, where: Mask, parts: Mask) -> Mask:
    """Crests of thin lines, which lead away from other ``parts`` or from one to the next.

    Bumps on the rim of a part do neither.
    """
    crests = _crests(alpha, where)
    labels, count = ndimage.label(crests, _SQUARE)
    is_line = np.zeros(count + 1, dtype=bool)
    is_line[labels[crests & ~_dilated(parts)]] = True
    is_line[labels[crests & (_neighbor_runs(parts | crests) > 1)]] = True
    is_line[0] = False
    return np.asarray(is_line[labels])


def _neighbor_runs(mask: Mask) -> Ints:
    """The number of runs (h, w) of ``mask`` around each pixel, among its 8 neighbors in circular order."""
    padded = np.pad(mask, 1)
    height, width = mask.shape
    ring = [(0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0)]
    neighbors = np.stack([padded[y : y + height, x : x + width] for y, x in ring])
    return np.asarray((neighbors & ~np.roll(neighbors, 1, axis=0)).sum(axis=0))


def _crests(alpha: Picture, where: Mask) -> Mask:
    """Of the pixels ``where``, those that the crest of a thin line crosses.

    The alpha around a pixel is taken for a quadratic function; a crest is where its derivative vanishes
    across the direction of its strongest curvature (Steger, “An Unbiased Detector of Curvilinear
    Structures”, PAMI 1998, without his smoothing).
    """
    crests = np.zeros_like(where)
    y, x = np.nonzero(where)
    a = np.pad(alpha.astype(np.float64), 1)

    def at(dy: int, dx: int) -> Floats:
        return np.asarray(a[y + 1 + dy, x + 1 + dx])

    center = at(0, 0)
    gx, gy = (at(0, 1) - at(0, -1)) / 2, (at(1, 0) - at(-1, 0)) / 2
    hxx, hyy = at(0, 1) - 2 * center + at(0, -1), at(1, 0) - 2 * center + at(-1, 0)
    hxy = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / 4
    lowest = (hxx + hyy) / 2 - np.hypot((hxx - hyy) / 2, hxy)
    angle = 0.5 * np.arctan2(2 * hxy, hxx - hyy) + np.pi / 2  # of the eigenvector of the lowest eigenvalue
    nx, ny = np.cos(angle), np.sin(angle)
    is_sharp = -lowest >= _CREST_CURVATURE * center
    offset = (gx * nx + gy * ny) / np.where(is_sharp, -lowest, 1.0)
    reach = np.maximum(np.abs(nx), np.abs(ny))  # of the pixel along the direction across
    is_near = np.abs(offset) * reach <= _CREST_OFFSET
    crests[y, x] = is_sharp & is_near
    return crests


def _peaks_of_the_rest(alpha: Picture, shown: Mask) -> Mask:
    """The pixel of the highest alpha of each connected piece of ink of which nothing is shown."""
    labels, count = ndimage.label(alpha >= VISIBLE, _SQUARE)
    lost = np.ones(count + 1, dtype=bool)
    lost[0] = False
    lost[np.unique(labels[shown])] = False
    peaks = np.zeros_like(shown)
    numbers = np.flatnonzero(lost)
    if len(numbers):
        y, x = np.transpose(ndimage.maximum_position(alpha, labels, numbers))
        peaks[y, x] = True
    return peaks
