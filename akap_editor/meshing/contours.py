"""Iso-lines of a picture by marching squares (Lorensen and Cline 1987, in the plane), sub-pixel exact.

A library would visit the whole grid; of 5000 × 5000 pixels only some 50,000 lie on an outline.
"""

import numpy as np
from numpy.typing import NDArray

from ..geometry.validation import Floats, Ints

MARGIN = 1 / 64  # pixels between a crossing and the sample centers around it, so that lines never meet


def contours(samples: NDArray[np.uint8], level: float) -> list[Floats]:
    """The lines at which samples (h, w) uint8 exceed ``level`` in [0, 255), as closed rings (p, 2) float64.

    Units are pixels, with sample centers at half-integers; outside the picture all samples are 0. Samples
    above the level lie on the same side of all rings: outer rings have a positive signed area (y down), holes
    a negative one. Diagonal neighbors above the level are connected, so that lines one pixel wide hold
    together. Rings neither cross nor touch themselves or one another. The first point is not repeated at the
    end.
    """
    inside = samples > int(level)
    rows, columns = np.flatnonzero(inside.any(axis=1)), np.flatnonzero(inside.any(axis=0))
    if not len(rows):
        return []
    top, left = max(int(rows[0]) - 1, 0), max(int(columns[0]) - 1, 0)
    crop = np.s_[top : rows[-1] + 2, left : columns[-1] + 2]
    values, inside = np.pad(samples[crop], 1), np.pad(inside[crop], 1)
    points, successors = _crossings(values, inside, level)
    points += [left - 0.5, top - 0.5]  # the padded crop starts one sample left of and above the crop
    return [points[ring] for ring in _cycles(successors)]


def _crossings(values: NDArray[np.uint8], inside: NDArray[np.bool_], level: float) -> tuple[Floats, Ints]:
    """The points where lines cross the grid, (q, 2) in samples, and the next one on the line of each, (q,).

    A line keeps the inside on the same hand. After a crossing it turns to the outer side if the sample ahead
    there is inside; otherwise it continues straight if the sample ahead on the inner side is inside;
    otherwise it turns to the inner side.
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

    # The samples on both sides of each crossing, and the direction of the line as a step in the flat array.
    is_forward = flat[starts]
    inner, outer = np.where(is_forward, (starts, starts + steps), (starts + steps, starts))
    rotated = np.repeat([width, -1], [len(across), len(down)])
    direction = np.where(is_forward, rotated, -rotated)
    inner_ahead, outer_ahead = inner + direction, outer + direction
    to_outer, straight = flat[outer_ahead], flat[inner_ahead]
    # The next crossing lies between these two samples.
    one = np.where(to_outer, outer, np.where(straight, inner_ahead, inner))
    two = np.where(to_outer | straight, outer_ahead, inner_ahead)
    lower, is_down = np.minimum(one, two), np.abs(one - two) == width
    successors = np.where(is_down, len(across) + np.searchsorted(down, lower), np.searchsorted(across, lower))
    return points, successors


def _cycles(successors: Ints) -> list[Ints]:
    """The cycles of a permutation, each as indices in order."""
    after = successors.tolist()
    visited = bytearray(len(after))
    cycles = []
    for start in range(len(after)):
        if not visited[start]:
            cycle, index = [], start
            while not visited[index]:
                visited[index] = 1
                cycle.append(index)
                index = after[index]
            cycles.append(np.array(cycle))
    return cycles
