"""What the options bar offers while no pin is selected: the commands of the current tool."""

from collections.abc import Sequence

from ...editor.tools.knife import cuts_of
from ...meshing.slits import Cut
from ...words import tr, tr_plural
from ..app_state import AppState
from ..commands.command import Command
from ..commands.edit.mirror import DRAW_AXIS, FLIP_POSE, MIRROR_PINS
from ..commands.registry import RESET_POSE, SUGGEST_PINS
from ..commands.view import ACTUAL_SIZE, FIT, ZOOM_IN, ZOOM_OUT
from ..panels.rig.joints import ACCEPT_JOINTS, PROPOSE_JOINTS
from .items import Item, command_button, text


def _cuts(state: AppState) -> tuple[Cut, ...]:
    return () if state.document is None else cuts_of(state.document.drawing)


def _cut_count(state: AppState) -> str:
    return tr_plural("{count} cut", "{count} cuts", len(_cuts(state)))


REMOVE_CUTS = Command(
    "Remove All Cuts",
    lambda state: state.editor.knife_tool.remove_all(),
    enabled=lambda state: bool(_cuts(state)),
)


def items(state: AppState) -> Sequence[Item]:
    """The items for the chosen tool."""
    editor = state.editor
    if editor.chosen_tool is editor.hand_tool:
        return (command_button(FIT), command_button(ACTUAL_SIZE))
    if editor.chosen_tool is editor.zoom_tool:
        return tuple(map(command_button, (ZOOM_IN, ZOOM_OUT, FIT, ACTUAL_SIZE)))
    if editor.chosen_tool is editor.knife_tool:
        if state.document is not None and state.document.drawing.layers:
            return (text("no cuts", tr("The knife cuts flat drawings; layers come apart already")),)
        return (text("cuts", _cut_count(state)), command_button(REMOVE_CUTS))
    if editor.chosen_tool is editor.joint_tool:
        if state.document is not None and state.document.drawing.layers:
            return (command_button(PROPOSE_JOINTS), command_button(ACCEPT_JOINTS))
        return (text("no layers", tr("Joints hold layers together. This drawing has none.")),)
    return tuple(map(command_button, (SUGGEST_PINS, MIRROR_PINS, DRAW_AXIS, FLIP_POSE, RESET_POSE)))
