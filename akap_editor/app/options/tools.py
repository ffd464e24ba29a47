"""What the options bar offers while no pin is selected: the commands of the current tool."""

from collections.abc import Sequence

from ...words import tr
from ..app_state import AppState
from ..commands.edit.mirror import DRAW_AXIS, FLIP_POSE, MIRROR_PINS
from ..commands.registry import RESET_POSE, SUGGEST_PINS
from ..commands.view import ACTUAL_SIZE, FIT, ZOOM_IN, ZOOM_OUT
from ..panels.rig.joints import ACCEPT_JOINTS, PROPOSE_JOINTS
from .items import Item, command_button, text


def items(state: AppState) -> Sequence[Item]:
    """The items for the chosen tool."""
    editor = state.editor
    if editor.chosen_tool is editor.hand_tool:
        return (command_button(FIT), command_button(ACTUAL_SIZE))
    if editor.chosen_tool is editor.zoom_tool:
        return tuple(map(command_button, (ZOOM_IN, ZOOM_OUT, FIT, ACTUAL_SIZE)))
    if editor.chosen_tool is editor.joint_tool:
        if state.document is not None and state.document.drawing.layers:
            return (command_button(PROPOSE_JOINTS), command_button(ACCEPT_JOINTS))
        return (text("no layers", tr("Joints hold layers together. This drawing has none.")),)
    return tuple(map(command_button, (SUGGEST_PINS, MIRROR_PINS, DRAW_AXIS, FLIP_POSE, RESET_POSE)))
