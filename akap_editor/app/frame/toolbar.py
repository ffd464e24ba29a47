"""The toolbar at the left of the canvas: tools, history and view."""

from imgui_bundle import ImVec2, ImVec4, imgui

from .. import widgets
from ..app_state import AppState
from ..commands.command import Command
from ..commands.registry import (
    BRUSH_TOOL,
    FIT,
    HAND_TOOL,
    JOINT_TOOL,
    KNIFE_TOOL,
    PIN_TOOL,
    REDO,
    REMOVE_SELECTED,
    SHOW_MESH,
    UNDO,
    ZOOM_TOOL,
)
from ..theme import ACCENT, TEXT, packed

TOOLBAR: tuple[Command | None, ...] = (
    *(PIN_TOOL, HAND_TOOL, ZOOM_TOOL, BRUSH_TOOL, JOINT_TOOL, KNIFE_TOOL),
    None,
    *(UNDO, REDO, REMOVE_SELECTED),
    None,
    *(FIT, SHOW_MESH),
)
_WIDTH, _BUTTON_SIZE, _MIN_BUTTON_SIZE, _GAP = 48, 36, 20, 4  # design points


def draw(state: AppState, scale: float) -> None:
    """Draw the buttons, smaller in a low window, in two columns in a very low one, so that all are visible.

    scale: points per design point.
    """
    separators, gap = TOOLBAR.count(None), _GAP * scale
    commands = [command for command in TOOLBAR if command is not None]
    height = imgui.get_main_viewport().work_size.y - 16 * scale
    size = min(_BUTTON_SIZE * scale, (height - separators * 3 * gap) / len(commands) - gap)
    has_one_column = size >= _MIN_BUTTON_SIZE * scale
    if not has_one_column:
        gap, height = gap / 2, height + 8 * scale
        size = min(_MIN_BUTTON_SIZE * scale, height / ((len(commands) + 1) // 2) - gap)
    columns, top = (1, 8 * scale) if has_one_column else (2, 4 * scale)
    padding = ImVec2((_WIDTH * scale - columns * (size + gap) + gap) / 2, top)
    if widgets.side_bar("Tools", imgui.Dir.left, _WIDTH * scale, padding):
        imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(gap, gap))
        imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0, 0))  # or else it covers small icons
        for number, command in enumerate(TOOLBAR if has_one_column else commands):
            if not has_one_column and number % 2:
                imgui.same_line()
            if command is None:
                _draw_separator(size, scale)
            else:
                _draw_button(state, command, size)
        imgui.pop_style_var(2)
    imgui.end()


def _draw_separator(width: float, scale: float) -> None:
    imgui.dummy(ImVec2(width, 1 * scale))
    corner = imgui.get_cursor_screen_pos()
    start, end = ImVec2(corner.x + 6 * scale, corner.y), ImVec2(corner.x + width - 6 * scale, corner.y)
    imgui.get_window_draw_list().add_line(start, end, packed((1, 1, 1, 0.12)))
    imgui.dummy(ImVec2(width, 3 * scale))


def _draw_button(state: AppState, command: Command, size: float) -> None:
    """Draw the toolbar button of a command, in the accent color for a switch that is on."""
    is_on = command.is_checked(state)
    imgui.push_style_color(imgui.Col_.button, ImVec4(*ACCENT[:3], 0.18) if is_on else ImVec4(0, 0, 0, 0))
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(ACCENT if is_on else TEXT)))
    imgui.begin_disabled(not command.enabled(state))
    if imgui.button(f"{command.icon}##{command.label}", ImVec2(size, size)):
        widgets.run(state, command)
    imgui.end_disabled()
    imgui.pop_style_color(2)
    widgets.show_tooltip(command.name + (f"  ({command.key_name})" if command.active_chords else ""))
