"""Runs of faces that are drawn with one opacity and one blend mode.

With premultiplied colors c and opacities a of source s and backdrop b (W3C, Compositing and Blending 1):
normal is c_s + (1 - a_s) c_b, screen c_s + (1 - c_s) c_b, add c_s + c_b, and multiply, in two passes,
(1 - (a_s - c_s)) c_b + (1 - a_b) c_s. Where a translucent layer is added to what it makes too bright,
the sum is cut off after the layer's opacity counts, not before.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import moderngl
import numpy as np

from ..geometry.validation import Ints
from ..layers.drawing_layer import DrawingLayer

BlendFunc = Any  # moderngl's type knows only two of the four numbers that it takes

OVER: BlendFunc = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA


@dataclass(frozen=True)
class BlendPass:
    """One pass of a blend mode. func: of colors, or of colors and alpha; inverted: draw a − c, not c."""

    func: BlendFunc
    inverted: bool = False


BLEND_PASSES: dict[str, tuple[BlendPass, ...]] = {
    "normal": (BlendPass(OVER),),
    "screen": (
        BlendPass((moderngl.ONE, moderngl.ONE_MINUS_SRC_COLOR, moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)),
    ),
    "add": (BlendPass((moderngl.ONE, moderngl.ONE, moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)),),
    "multiply": (
        BlendPass((moderngl.ZERO, moderngl.ONE_MINUS_SRC_COLOR, moderngl.ZERO, moderngl.ONE), inverted=True),
        BlendPass((moderngl.ONE_MINUS_DST_ALPHA, moderngl.ONE)),
    ),
}


@dataclass(frozen=True)
class LayerRun:
    """Faces one after the other in drawing order: the first one, their number, and how they are drawn."""

    first: int
    count: int
    opacity: float
    blend: str


def layer_runs(drawn_layers: Ints, layers: Sequence[DrawingLayer]) -> tuple[LayerRun, ...]:
    """The runs of faces, where ``drawn_layers`` (q,) are their layers from back to front.

    Without layers, all faces are one run.
    """
    if not layers:
        return (LayerRun(0, len(drawn_layers), 1.0, "normal"),)
    starts = np.flatnonzero(np.diff(drawn_layers, prepend=-1)).tolist()
    runs: list[LayerRun] = []
    for start, end in pairwise([*starts, len(drawn_layers)]):
        layer = layers[drawn_layers[start]]
        last = runs[-1] if runs else None
        if last is not None and (last.opacity, last.blend) == (layer.opacity, layer.blend):
            runs[-1] = LayerRun(last.first, last.count + end - start, last.opacity, last.blend)
        else:
            runs.append(LayerRun(start, end - start, layer.opacity, layer.blend))
    return tuple(runs)
