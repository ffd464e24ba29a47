"""Framing: which rectangle of the drawing plane an exported image shows, and its size in pixels."""

from collections.abc import Sequence
from math import ceil, floor, isfinite
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError
from ..geometry.validation import Floats, as_points
from ..words import tr

if TYPE_CHECKING:
    from .document.drawing import Drawing

Box = tuple[int, int, int, int]  # x0, y0, x1, y1 in whole drawing units
Color = tuple[float, float, float]  # red, green, blue from 0 to 1

MAX_SIZE = 8192  # pixels a side
CROPS = ("none", "frame", "pose")
_ROUNDING = 1e-6  # pixels: rounding noise must not add a row


def frame_box(drawing: "Drawing", poses: Sequence[ArrayLike]) -> Box:
    """The smallest box around the picture's rectangle and all ``poses``, (n, 2) each.

    Raises InputError on a bad pose.
    """
    rectangle = np.array([(0, 0), drawing.size], dtype=np.float64)
    count = len(drawing.mesh.vertices)
    return _bounding_box([rectangle, *(as_points(pose, "poses", count) for pose in poses)])


def union_of_boxes(boxes: Sequence[Box]) -> Box:
    """The smallest box around all ``boxes``, at least one."""
    x0, y0 = np.min(boxes, axis=0)[:2].tolist()
    x1, y1 = np.max(boxes, axis=0)[2:].tolist()
    return x0, y0, x1, y1


def crop_box(drawing: "Drawing", pose: ArrayLike, crop: str) -> Box:
    """The box that an export of ``pose`` (n, 2) shows.

    crop: "none" for the picture's rectangle and the whole pose, "frame" for the picture's rectangle alone,
    which may cut the pose off, "pose" for the mesh in the pose. Raises InputError on any other or a bad pose.
    """
    if crop not in CROPS:
        raise InputError(tr("crop: expected one of {names}, got {crop!r}", names=", ".join(CROPS), crop=crop))
    if crop == "frame":
        return (0, 0, *drawing.size)
    if crop == "pose":
        return _bounding_box([as_points(pose, "pose", len(drawing.mesh.vertices))])
    return frame_box(drawing, [pose])


def output_size(box: Box, scale: float) -> tuple[int, int]:
    """Width and height in pixels of an image of ``box`` at ``scale`` pixels per drawing unit, rounded up.

    Raises InputError on an empty box, a scale that is not positive, or more than `MAX_SIZE` pixels a side.
    """
    x0, y0, x1, y1 = box
    if not (isfinite(scale) and scale > 0):
        raise InputError(tr("scale: expected a positive number, got {scale:g}", scale=scale))
    if not (x0 < x1 and y0 < y1):
        raise InputError(tr("box: expected x0 < x1 and y0 < y1, got {box}", box=box))
    width, height = (x1 - x0) * scale, (y1 - y0) * scale
    if max(width, height) > MAX_SIZE + _ROUNDING:
        raise InputError(
            tr(
                "picture size: expected at most {most}×{most} pixels, got {width:.0f}×{height:.0f}; "
                "choose a smaller scale",
                most=MAX_SIZE,
                width=width,
                height=height,
            )
        )
    return max(1, ceil(width - _ROUNDING)), max(1, ceil(height - _ROUNDING))


def fitted_box(box: Box, longest_side: int, is_even: bool = False) -> tuple[Box, float]:
    """The box that is shown, and its scale, of pictures with at most ``longest_side`` pixels a side.

    They are never enlarged. is_even: extend the box on the right and at the bottom, so that width and height
    in pixels are even. Raises InputError as `output_size`.
    """
    x0, y0, x1, y1 = box
    limit = longest_side - longest_side % 2 if is_even else longest_side
    scale = min(1.0, limit / max(x1 - x0, y1 - y0))
    width, height = output_size(box, scale)
    while is_even and width % 2:
        x1 += 1
        width, _ = output_size((x0, y0, x1, y1), scale)
    while is_even and height % 2:
        y1 += 1
        _, height = output_size((x0, y0, x1, y1), scale)
    return (x0, y0, x1, y1), scale


def _bounding_box(points: Sequence[Floats]) -> Box:
    low = np.min([each.min(axis=0) for each in points], axis=0)
    high = np.max([each.max(axis=0) for each in points], axis=0)
    return (
        floor(low[0] + _ROUNDING),
        floor(low[1] + _ROUNDING),
        ceil(high[0] - _ROUNDING),
        ceil(high[1] - _ROUNDING),
    )
