"""Finds the palette of an animation and the nearest palette color of every pixel."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...geometry.validation import Floats, Ints
from ..images import Picture

_MAX_BINS = 2**15  # colors that k-means sees; more are merged to bins of equal leading bits
_ITERATIONS = 12  # of k-means: then it changes the error by less than 1 %

HIDDEN = 2**24  # instead of a packed color: of a pixel that is not shown


class ColorCounts:
    """Counts how often each color is shown in the frames of an animation."""

    def __init__(self) -> None:
        self._counts = np.zeros(HIDDEN + 1, dtype=np.int64)

    def add(self, colors: Ints) -> None:
        """Count the packed colors (h, w) of a frame, see `packed_colors`."""
        flat = colors.ravel()
        starts = np.flatnonzero(np.diff(flat, prepend=-1))  # of runs of one color: four times fewer
        np.add.at(self._counts, flat[starts].astype(np.intp), np.diff(starts, append=len(flat)))

    def shown(self) -> tuple[Ints, Ints]:
        """The packed colors (c,) that are shown, and how often each is."""
        colors = np.flatnonzero(self._counts[:HIDDEN])
        return colors, self._counts[colors]


def find_palette(counts: ColorCounts, size: int) -> Picture:
    """At most ``size`` colors (c, 3) for the pixels of all frames: with a palette each, colors would flicker.

    Few colors are kept as they are. Otherwise the cluster with the largest squared error is halved across its
    longest axis until there are ``size`` of them, and k-means refines their means (Lloyd 1982). Returns black
    if nothing is shown.
    """
    colors, numbers = counts.shown()
    if not len(colors):
        return np.zeros((1, 3), dtype=np.uint8)
    if len(colors) <= size:
        return _unpack(colors)
    points, weights = _bins(colors, numbers)
    return _refined(points, weights, _halved(points, weights, size))


class NearestColors:
    """Gives pixels the nearest color of a palette (c, 3); not dithered, because its noise would flicker.

    hidden: index of pixels that are not shown.
    """

    def __init__(self, palette: Picture, hidden: int) -> None:
        self._tree = cKDTree(palette)
        self._table = np.full(HIDDEN + 1, -1, dtype=np.int16)  # index of each color, filled in as they appear
        self._table[HIDDEN] = hidden

    def indices(self, colors: Ints) -> Picture:
        """The palette indices (h, w) uint8 of packed colors (h, w), see `packed_colors`."""
        found = self._table[colors]
        if found.min() < 0:
            missing = np.unique(colors[found < 0])
            self._table[missing] = self._tree.query(_unpack(missing))[1]
            found = self._table[colors]
        return found.astype(np.uint8)


def packed_colors(image: Picture, mask: NDArray[np.bool_]) -> Ints:
    """A number (h, w) int32 for each color of a picture (h, w, 4); `HIDDEN` outside of the mask (h, w)."""
    return np.where(mask, _pack(image[..., :3]), np.int32(HIDDEN))


def _bins(colors: Ints, counts: Ints) -> tuple[Floats, Floats]:
    """Points (q, 3) and weights (q,) for k-means: the colors, or the means of bins if there are very many."""
    unpacked, weights = _unpack(colors), counts.astype(np.float64)
    points, members = unpacked.astype(np.float64), np.arange(len(colors))
    for dropped_bits in (1, 2, 3):
        if members.max() < _MAX_BINS:
            break
        members = np.unique(_pack(unpacked >> dropped_bits), return_inverse=True)[1]
    return _means(points, weights, members)


def _means(points: Floats, weights: Floats, members: Ints) -> tuple[Floats, Floats]:
    """Weighted means (k, 3) and sums of weights (k,) of clusters, without the empty ones."""
    sums: Floats = np.bincount(members, weights).astype(np.float64)
    kept = sums > 0
    total = np.stack([np.bincount(members, weights * channel) for channel in points.T], axis=1)
    return total[kept] / sums[kept, None], sums[kept]


def _halved(points: Floats, weights: Floats, size: int) -> Floats:
    """Means (k, 3) of ``size`` clusters; the one with the largest squared error is halved first."""
    clusters = [np.arange(len(points))]
    errors = [np.inf]
    while len(clusters) < size:
        worst = int(np.argmax(errors))
        members = clusters[worst]
        if errors[worst] <= 0:
            break
        offsets = points[members] - np.average(points[members], axis=0, weights=weights[members])
        covariance = (weights[members, None] * offsets).T @ offsets
        axis = np.linalg.eigh(covariance)[1][:, -1]
        is_low = offsets @ axis < 0
        halves = [members[is_low], members[~is_low]]
        clusters[worst : worst + 1] = halves
        errors[worst : worst + 1] = [_squared_error(points[half], weights[half]) for half in halves]
    means = [np.average(points[each], axis=0, weights=weights[each]) for each in clusters]
    return np.array(means)


def _squared_error(points: Floats, weights: Floats) -> float:
    """The weighted sum of squared distances from the mean."""
    if len(points) < 2:
        return 0.0
    offsets = points - np.average(points, axis=0, weights=weights)
    return float(weights @ (offsets**2).sum(axis=1))


def _refined(points: Floats, weights: Floats, means: Floats) -> Picture:
    """The means (k, 3) after some iterations of k-means, rounded to colors."""
    for _ in range(_ITERATIONS):
        members = cKDTree(means).query(points)[1]
        means, _ = _means(points, weights, members)
    return np.unique(np.rint(means).astype(np.uint8), axis=0)


def _pack(colors: NDArray[np.integer[Any]]) -> NDArray[np.int32]:
    """One number for each color of an array (..., 3)."""
    red, green, blue = np.moveaxis(colors.astype(np.int32), -1, 0)
    return red << 16 | green << 8 | blue


def _unpack(packed: Ints) -> Picture:
    """The colors (..., 3) of packed numbers."""
    return np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=-1).astype(np.uint8)
