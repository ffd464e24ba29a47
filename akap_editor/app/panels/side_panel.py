"""The frame around the canvas: toolbar, side panel with its sections, and status bar."""

from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..commands import menu_bar
from ..commands.command import Command, has_drawing
from ..commands.registry import (
    BRUSH_TOOL,
    FIT,
    HAND_TOOL,
    JOINT_TOOL,
    PIN_TOOL,
    REDO,
    REMOVE_SELECTED,
    SHOW_MESH,
    UNDO,
    ZOOM_TOOL,
)
from ..dialogs.first_steps import FirstSteps
from ..options import bar
from ..theme import ACCENT, SECONDARY, TEXT, packed
from ..timeline import panel as timeline_panel
from . import bending, drawing, history, layers, measurements, mesh, pins, poses, view
from .rig import joints

_TOOLBAR: tuple[Command | None, ...] = (
    *(PIN_TOOL, HAND_TOOL, ZOOM_TOOL, BRUSH_TOOL, JOINT_TOOL),
    None,
    *(UNDO, REDO, REMOVE_SELECTED),
    None,
    *(FIT, SHOW_MESH),
)
_PANEL_WIDTH, _TOOLBAR_WIDTH, _BUTTON_SIZE = 268, 48, 36  # design points


@dataclass(frozen=True)
class Section:
    """A part of the side panel that can be folded.

    title: in English, also the name in the preferences; draw: draws the content, given the points per design
    point; shown: whether the section is listed; note: a short text at the right end of its title; opened:
    whether it is unfolded for a new user.
    """

    title: str
    draw: Callable[[AppState, float], None]
    shown: Callable[[AppState], bool] = has_drawing
    note: Callable[[AppState], str] = lambda _: ""
    opened: bool = True


# From top to bottom; each section is a module of this folder.
SECTIONS = (
    Section("Drawing", drawing.draw),
    Section("Layers", layers.draw, layers.is_shown, layers.layer_count),
    Section("Joints", joints.draw, layers.is_shown, joints.joint_count),
    Section("Pins", pins.draw, note=pins.pin_count),
    Section("Bending", bending.draw),
    Section("Mesh", mesh.draw),
    Section("Poses", poses.draw, note=poses.pose_count),
    Section("Measurements", measurements.draw),
    Section("History", history.draw, note=history.step_count),
    Section("View", view.draw),
)


def draw(state: AppState, scale: float) -> tuple[float, float, float, float]:
    """Draw the frame; return the canvas as (left, top, right, bottom) in points of the window.

    scale: points per design point.
    """
    menu_bar.draw(state)
    is_hidden = state.panels_are_hidden and state.document is not None
    if not is_hidden:
        _draw_status_bar(state, scale)
    timeline_panel.draw(state, scale, is_hidden)
    if not is_hidden:
        if state.document is not None:
            _draw_toolbar(state, scale)
        _draw_side_panel(state, scale)
        state.part(FirstSteps).draw(state, scale)
    viewport = imgui.get_main_viewport()
    left, top = viewport.work_pos.x, viewport.work_pos.y
    canvas = left, top, left + viewport.work_size.x, top + viewport.work_size.y
    bar.draw(state, canvas, scale)
    return canvas


def _draw_toolbar(state: AppState, scale: float) -> None:
    """Draw the buttons, smaller in a low window, so that all of them are visible."""
    separators = _TOOLBAR.count(None)
    gaps = 16 * scale + separators * 12 * scale
    room = (imgui.get_main_viewport().work_size.y - gaps) / (len(_TOOLBAR) - separators)
    size = min(_BUTTON_SIZE * scale, room - 4 * scale)
    padding = ImVec2((_TOOLBAR_WIDTH * scale - size) / 2, 8 * scale)
    if widgets.side_bar("Tools", imgui.Dir.left, _TOOLBAR_WIDTH * scale, padding):
        imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(4 * scale, 4 * scale))
        for command in _TOOLBAR:
            if command is None:
                _draw_separator(size, scale)
            else:
                _draw_button(state, command, size)
        imgui.pop_style_var()
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


def _draw_side_panel(state: AppState, scale: float) -> None:
    shown = [section for section in SECTIONS if section.shown(state)]
    if not shown:
        return
    padding = ImVec2(16 * scale, 6 * scale)
    if widgets.side_bar("Panel", imgui.Dir.right, _PANEL_WIDTH * scale, padding, scrolls=True):
        for section in shown:
            if _draw_heading(state, section):
                section.draw(state, scale)
                imgui.spacing()
    imgui.end()


def _draw_heading(state: AppState, section: Section) -> bool:
    """Draw the title of a section, a click on which folds it; return whether it is unfolded."""
    sections: dict[str, object] = state.preferences.get("sections", {})
    was_open = bool(sections.get(section.title, section.opened))
    imgui.spacing()
    imgui.separator()
    imgui.push_style_color(imgui.Col_.text, ImVec4(*SECONDARY))
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    is_clicked = imgui.selectable(f"{tr(section.title).upper()}###section {section.title}", False)[0]
    arrow = icons.ICON_FA_CHEVRON_DOWN if was_open else icons.ICON_FA_CHEVRON_RIGHT
    note = f"{section.note(state)}   {arrow}"
    right = imgui.get_content_region_avail().x + imgui.get_cursor_pos_x()
    imgui.same_line(right - imgui.calc_text_size(note).x)
    imgui.text(note)
    imgui.pop_font()
    imgui.pop_style_color()
    if is_clicked:
        state.preferences.put("sections", {**sections, section.title: not was_open})
    return was_open != is_clicked


def _draw_status_bar(state: AppState, scale: float) -> None:
    """Draw the notice or the hint of the tool, and the zoom."""
    height = imgui.get_frame_height() + 2 * scale
    if widgets.side_bar("Status", imgui.Dir.down, height, ImVec2(14 * scale, 1 * scale)):
        imgui.align_text_to_frame_padding()
        zoom = f"{state.editor.camera.zoom * 100:.0f} %" if state.document is not None else ""
        zoom_left = imgui.get_window_width() - imgui.calc_text_size(zoom).x - 16 * scale
        text = state.notice or (f"{state.task.title} ..." if state.task is not None else state.editor.hint)
        shortened = widgets.shortened(text, zoom_left - 30 * scale)
        imgui.text_colored(ImVec4(*(ACCENT if state.notice else TEXT)), shortened)
        widgets.show_tooltip(text if shortened != text else "")
        if zoom:
            imgui.same_line(zoom_left)
            imgui.text_colored(ImVec4(*SECONDARY), zoom)
    imgui.end()
