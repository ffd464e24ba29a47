"""The commands that align and distribute the selected pins."""

from functools import partial

from ....editor import pin_arrangement
from ....editor.pin_arrangement import Alignment
from ....words import mark
from ...app_state import AppState
from ..command import Command


def _has_several(count: int, state: AppState) -> bool:
    return len(state.editor.selection) >= count


def _align(alignment: Alignment, state: AppState) -> None:
    pin_arrangement.align_pins(state.editor, alignment)


def _distribute(axis: int, state: AppState) -> None:
    pin_arrangement.distribute_pins(state.editor, axis)


ALIGN_PINS = tuple(
    Command(label, partial(_align, alignment), enabled=partial(_has_several, 2))
    for label, alignment in (
        (mark("Align Left"), Alignment(0, "low")),
        (mark("Align Horizontal Centers"), Alignment(0, "middle")),
        (mark("Align Right"), Alignment(0, "high")),
        (mark("Align Top"), Alignment(1, "low")),
        (mark("Align Vertical Centers"), Alignment(1, "middle")),
        (mark("Align Bottom"), Alignment(1, "high")),
    )
)
DISTRIBUTE_PINS = tuple(
    Command(label, partial(_distribute, axis), enabled=partial(_has_several, 3))
    for label, axis in ((mark("Distribute Horizontally"), 0), (mark("Distribute Vertically"), 1))
)
