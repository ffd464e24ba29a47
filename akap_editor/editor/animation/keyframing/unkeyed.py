"""Whether what is shown differs from what the keyframes hold."""

import numpy as np

from ...document.crossings import face_order
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.keyframes import Animation
from ...document.pin import pin_depths
from ..loose_motion import Crossed


def differs(drawing: Drawing, state: EditState, crossed: Crossed) -> bool:
    """Whether a state has another pose, other depths of pins or other limbs in front than a time."""
    if crossed.pins != state.pins or not np.array_equal(crossed.positions, state.positions):
        return True
    if np.array_equal(crossed.crossings, state.crossings):
        return False
    first, second = (
        face_order(drawing, state.pins, state.positions, each.crossings) for each in (state, crossed)
    )
    if first is None or second is None:
        return first is not second
    return not np.array_equal(first, second)


def is_keyed(animation: Animation, time: float, drawing: Drawing, state: EditState) -> bool:
    """Whether there is a keyframe at a time that already holds all that a new one of a state would."""
    return any(
        np.array_equal(each.positions, state.positions)
        and np.array_equal(each.crossings, state.crossings)
        and each.layers == drawing.layer_view
        and each.depths == pin_depths(state.pins)
        for each in animation.keyframes_at([time])
    )
