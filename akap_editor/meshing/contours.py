"""Iso-lines of a picture by marching squares (Lorensen and Cline 1987, in the plane), to a part of a pixel.

A library would sample the whole grid; of 5000×5000 pixels only some 50,000 lie at an outline.
"""

import numpy as np
from numpy.typing import NDArray

from ..geometry.validation import Floats, Ints

MARGIN = 1 / 64  # share of a pixel that a crossing keeps from both centers, so that lines never meet


def contours(samples: NDArray[np.uint8], level: float) -> list[Floats]:
    """The lines at which samples (h, w) uint8 exceed ``level`` in [0, 255), as closed rings (p, 2) float64.

    Units are pixels, centers of samples at half-integers; beyond the border all is 0. What exceeds the level
    lies to the same side of all rings: outer ones have a positive signed area (y down), holes a negative one.
    Diagonal neighbours that exceed the level are connected, so lines of one pixel do not fall apart. Rings
    neither cross nor touch themselves or one another. The first point is not repeated at the end.
    """
    inside = samples > int(level)
    rows, columns = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    if not len(rows):
        return []
    top, left = max(int(rows[0]) - 1, 0), max(int(columns[0]) - 1, 0)
    crop = np.s_[top : rows[-1] + 2, left : columns[-1] + 2]
    values, inside = np.pad(samples[crop], 1), np.pad(inside[crop], 1)
    points, following = _crossings(values, inside, level)
    points += [left - 0.5, top - 0.5]  # sample (0, 0) of the padded crop is left of and above the first one
    return [points[ring] for ring in _cycles(following)]


def _crossings(values: NDArray[np.uint8], inside: NDArray[np.bool_], level: float) -> tuple[Floats, Ints]:
    """Where lines cross the grid, (n, 2) in samples, and for each crossing the next one on its line, (n,).

    Lines keep the inside on the same hand: past a crossing, a line turns towards the outer side if the far
    sample there is inside, else goes straight on if the far sample on the inner side is inside, else turns
    to the inner side.
    """
    width = inside.shape[1]
    flat, grid = inside.ravel(), values.ravel()
    across = np.flatnonzero(flat[:-1] != flat[1:])  # between a sample and the one to its right
    down = np.flatnonzero(flat[:-width] != flat[width:])  # between a sample and the one below
    starts = np.concatenate([across, down])
    steps = np.repeat([1, width], [len(across), len(down)])
    low, high = grid[starts].astype(np.float64), grid[starts + steps].astype(np.float64)
    share = np.clip((level - low) / (high - low), MARGIN, 1 - MARGIN)
    y, x = np.divmod(starts, width)
    points = np.stack([x, y], axis=1).astype(np.float64)
    points[np.arange(len(starts)), np.repeat([0, 1], [len(across), len(down)])] += share

    # Samples on the inner and outer side of each crossing, and the way ahead as a step in the flat array.
    forward = flat[starts]
    inner, outer = np.where(forward, (starts, starts + steps), (starts + steps, starts))
    turned = np.repeat([width, -1], [len(across), len(down)])
    ahead = np.where(forward, turned, -turned)
    far_inner, far_outer = inner + ahead, outer + ahead
    to_outer, straight = flat[far_outer], flat[far_inner]
    # The next crossing lies between these two samples.
    one = np.where(to_outer, outer, np.where(straight, far_inner, inner))
    two = np.where(to_outer | straight, far_outer, far_inner)
    lower, is_down = np.minimum(one, two), np.abs(one - two) == width
    following = np.where(is_down, len(across) + np.searchsorted(down, lower), np.searchsorted(across, lower))
    return points, following


def _cycles(following: Ints) -> list[Ints]:
    """The cycles of a permutation, each as indices in order."""
    after = following.tolist()
    seen = bytearray(len(after))
    cycles = []
    for start in range(len(after)):
        if not seen[start]:
            cycle, at = [], start
            while not seen[at]:
                seen[at] = 1
                cycle.append(at)
                at = after[at]
            cycles.append(np.array(cycle))
    return cycles
