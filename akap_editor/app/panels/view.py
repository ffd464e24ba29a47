"""The View section: what is shown besides the drawing."""

from imgui_bundle import imgui

from ...words import mark, number_text, tr
from .. import widgets
from ..app_state import AppState
from ..canvas.checkerboard import BOARD_LABELS
from ..canvas.view_options import DISTORTION_RANGES
from ..commands.registry import (
    OVERLAYS,
    SHOW_CHECKERBOARD,
    SHOW_MESH,
    SHOW_PINS,
    SHOW_REFERENCE,
)
from ..commands.view import SHOW_MOTION_PATHS

_SWITCHES = tuple(
    command
    for command in (SHOW_MESH, SHOW_PINS, SHOW_CHECKERBOARD, *OVERLAYS, SHOW_REFERENCE)
    if command is not SHOW_MOTION_PATHS  # it is in the tab Animate
)
_LABELS = {  # of switches, by the labels of their commands
    "Show Mesh": mark("Mesh"),
    "Show Pins": mark("Pins"),
    "Show Checkerboard": mark("Checkerboard"),
    "Show Vector Field": mark("Vector field"),
    "Show Area Distortion": mark("Area distortion"),
    "Show Angle Distortion": mark("Angle distortion"),
    "Show Rest Pose": mark("Rest pose"),
    "Show Pin Trails": mark("Pin trails"),
    "Show Reference Picture": mark("Reference picture"),
}


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    for command in _SWITCHES:
        if not command.enabled(state):
            continue
        label, tooltip = tr(_LABELS[command.label]), tr("Key: {key}", key=command.key_name)
        if widgets.switch(label, command.is_checked(state), tooltip)[0]:
            widgets.run(state, command)
    has_scale = state.view.distortion_measure is not None
    column = widgets.label_column(tr("Board"), *([tr("Scale ends at")] if has_scale else []))
    if state.view.show_checkerboard:
        widgets.label(tr("Board"), column)
        imgui.set_next_item_width(widgets.FULL)
        names = list(BOARD_LABELS)
        _, index = widgets.combo(
            "##board", names.index(state.view.board), [tr(label) for label in BOARD_LABELS.values()]
        )
        state.view.board = names[index]
        widgets.show_tooltip(
            tr("Shade of the checkerboard. Automatic: so that the rim of the drawing is seen.")
        )
    if has_scale:
        widgets.label(tr("Scale ends at"), column)
        imgui.set_next_item_width(widgets.FULL)
        ends = [f"× {number_text(limit, 'g')}" for limit in DISTORTION_RANGES]
        _, state.view.distortion_range = widgets.combo("##range", state.view.distortion_range, ends)
        widgets.show_tooltip(
            tr("Change of area or shape at the ends of the color scale. Shift+R selects the next one.")
        )
