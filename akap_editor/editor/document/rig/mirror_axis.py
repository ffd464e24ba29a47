"""Finds the axis across which a drawing resembles itself."""

import math

import numpy as np
from numpy.typing import NDArray

from ....geometry.validation import Floats
from ....layers.drawing_layer import flat_picture
from ..drawing import Drawing
from .mirror import Mirror

_SAMPLES_PER_SIDE = 48  # of the grid of points by which an axis is found
_ANGLES, _OFFSETS = 90, 25  # axes that are tried: directions in half a turn, and parallels of each
_OFFSET_SHARE = 0.12  # of the drawing's length, on both sides of its center
_UPRIGHT_BONUS = 0.02  # of the score, for an upright axis: that of most figures


def find_mirror(drawing: Drawing) -> Mirror:
    """The axis across which the picture resembles itself most, by its shape and its colors.

    Points of a grid are reflected across axes of all directions near the center of the drawing, and compared
    with the picture there; the axis with the best mean is taken, an upright one where others are as good.
    """
    points, colors, image, step = _grid(drawing)
    if not len(points):
        return Mirror(drawing.size[0] / 2, drawing.size[1] / 2, math.pi / 2)
    center = points.mean(axis=0)
    length = math.sqrt(len(points)) * step
    best = (-math.inf, 0.0, 0.0)
    for number in range(_ANGLES):
        angle = math.pi * number / _ANGLES
        normal = np.array([-math.sin(angle), math.cos(angle)])
        upright = _UPRIGHT_BONUS if number == _ANGLES // 2 else 0.0
        heights = (points - center) @ normal
        for offset in np.linspace(-_OFFSET_SHARE, _OFFSET_SHARE, _OFFSETS) * length:
            mirrored = points - 2 * (heights - offset)[:, None] * normal
            score = _likeness(mirrored, colors, image) + upright
            if score > best[0] + 1e-9:
                best = (score, angle, float(offset))
    _, angle, offset = best
    x, y = center + offset * np.array([-math.sin(angle), math.cos(angle)])
    return Mirror(round(float(x), 2), round(float(y), 2), angle)


def _grid(drawing: Drawing) -> tuple[Floats, Floats, NDArray[np.uint8], float]:
    """Opaque points (k, 2) of a grid over the picture, colors (k, 3), the picture, the step."""
    image = (
        flat_picture(drawing.layers, drawing.layer_order, drawing.size) if drawing.layers else drawing.image
    )
    height, width = image.shape[:2]
    step = max(width, height) / _SAMPLES_PER_SIDE
    x, y = np.meshgrid(np.arange(step / 2, width, step), np.arange(step / 2, height, step))
    points = np.column_stack([x.ravel(), y.ravel()])
    samples = image[points[:, 1].astype(int), points[:, 0].astype(int)]
    opaque = samples[:, 3] > 127
    return points[opaque], samples[opaque, :3] / 255.0, image, step


def _likeness(points: Floats, colors: Floats, image: NDArray[np.uint8]) -> float:
    """How well the picture at points (k, 2) fits colors (k, 3): 1 wholly, 0 if nothing is there."""
    height, width = image.shape[:2]
    columns, rows = points[:, 0].astype(int), points[:, 1].astype(int)
    is_inside = (points[:, 0] >= 0) & (points[:, 1] >= 0) & (columns < width) & (rows < height)
    there = image[np.where(is_inside, rows, 0), np.where(is_inside, columns, 0)]
    is_opaque = is_inside & (there[:, 3] > 127)
    difference = np.abs(there[:, :3] / 255.0 - colors).mean(axis=1)
    return float(np.where(is_opaque, 1.0 - 0.5 * difference, 0.0).mean())
