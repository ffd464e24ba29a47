"""The side panel: the tabs Pose, Animate and Mesh, each with its sections."""

from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import ImVec2, ImVec4, imgui

from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..commands.command import has_drawing
from ..frame import layout
from ..theme import ACCENT, SECONDARY, TEXT, packed
from . import animate, bending, history, layers, measurements, mesh, parts, pins, poses, view
from .rig import joints

_TAB_LABELS: dict[layout.Tab, str] = {
    "Pose": mark("Pose"),
    "Animate": mark("Animate"),
    "Mesh": mark("Mesh"),
}
_TAB_HEIGHT, _BORDER, _MARGIN = 36, 5, 14  # design points; the margins are beside the content
_FLAGS = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
)


@dataclass(frozen=True)
class Section:
    """A part of a tab that can be folded.

    title: in English, also the name in the preferences; draw: draws the content, given the points per design
    point; tab: the one that it is in; shown: whether the section is listed; note: a short text at the right
    end of its title; opened: whether it is unfolded for a new user.
    """

    title: str
    draw: Callable[[AppState, float], None]
    tab: layout.Tab
    shown: Callable[[AppState], bool] = has_drawing
    note: Callable[[AppState], str] = lambda _: ""
    opened: bool = True


# From top to bottom; each section is in a module of this folder.
SECTIONS = (
    Section("Pins", pins.draw, "Pose", note=pins.pin_count),
    Section("Poses", poses.draw, "Pose", note=poses.pose_count),
    Section("Layers", layers.draw, "Pose", layers.is_shown, layers.layer_count),
    Section("Joints", joints.draw, "Pose", layers.is_shown, joints.joint_count),
    Section("Bending", bending.draw, "Pose"),
    Section("History", history.draw, "Pose", note=history.step_count, opened=False),
    Section("Keyframes", animate.draw_keyframes, "Animate", note=animate.keyframe_count),
    Section("Onion skin", animate.draw_onion_skin, "Animate", opened=False),
    Section("Playback", animate.draw_playback, "Animate"),
    Section("Mesh", mesh.draw, "Mesh"),
    Section("View", view.draw, "Mesh"),
    Section("Drawing", mesh.draw_drawing, "Mesh", opened=False),
    Section("Measurements", measurements.draw, "Mesh", opened=False),
)


def draw(state: AppState, scale: float) -> None:
    """Draw the panel. scale: points per design point."""
    room = imgui.get_main_viewport().size.x
    width = layout.side_panel_width(state, scale, room)
    no_front = imgui.WindowFlags_.no_bring_to_front_on_focus
    if widgets.side_bar("Tabs", imgui.Dir.right, width, ImVec2(0, 0), flags=no_front):
        _draw_border(state, scale)
        _draw_tabs(state, scale)
    corner, size = imgui.get_window_pos(), imgui.get_window_size()
    imgui.end()
    left, top = _BORDER * scale, _TAB_HEIGHT * scale
    imgui.set_next_window_pos(ImVec2(corner.x + left, corner.y + top))
    imgui.set_next_window_size(ImVec2(size.x - left, max(size.y - top, 1.0)))
    # One width with and without a scroll bar, which fits beside it: heights depend on it, so that otherwise
    # the bar comes and goes where it changes whether it is needed.
    imgui.set_next_window_content_size(ImVec2(size.x - left - 2 * _MARGIN * scale, 0))
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(_MARGIN * scale, 2 * scale))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    is_drawn = imgui.begin("Panel", None, _FLAGS)[0]
    imgui.pop_style_var(3)
    if is_drawn:
        _draw_sections(state, scale)
    imgui.end()


def _draw_sections(state: AppState, scale: float) -> None:
    current = layout.current_tab(state)
    shown = [section for section in SECTIONS if section.tab == current and section.shown(state)]
    for section in shown:
        note, is_first = section.note(state), section is shown[0]
        if parts.draw_heading(state, section.title, note, section.opened, is_first):
            section.draw(state, scale)
            imgui.spacing()


def _draw_border(state: AppState, scale: float) -> None:
    """Draw the left border: a drag resizes the panel, a double click resets its width."""
    corner, size = imgui.get_window_pos(), imgui.get_window_size()
    imgui.set_cursor_pos(ImVec2(0, 0))
    imgui.invisible_button("border", ImVec2(_BORDER * scale, size.y))
    if imgui.is_item_hovered() or imgui.is_item_active():
        imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        end = ImVec2(corner.x + 2 * scale, corner.y + size.y)
        imgui.get_window_draw_list().add_rect_filled(corner, end, packed(ACCENT))
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(0):
        layout.reset_side_panel_width(state)
    elif imgui.is_item_active() and imgui.is_mouse_dragging(0):
        right = corner.x + size.x
        layout.resize_side_panel(state, right - imgui.get_mouse_pos().x + _BORDER * scale / 2, scale)


def _draw_tabs(state: AppState, scale: float) -> None:
    """Draw a button for each tab; the current one is underlined."""
    left, height = _BORDER * scale, _TAB_HEIGHT * scale
    width = (imgui.get_window_width() - left) / len(layout.TABS)
    draw, corner = imgui.get_window_draw_list(), imgui.get_window_pos()
    current = layout.current_tab(state)
    imgui.push_style_color(imgui.Col_.button, ImVec4(0, 0, 0, 0))
    imgui.push_style_var(imgui.StyleVar_.frame_rounding, 0.0)
    for number, name in enumerate(layout.TABS):
        imgui.set_cursor_pos(ImVec2(left + number * width, 0))
        imgui.push_style_color(imgui.Col_.text, ImVec4(*(TEXT if name == current else SECONDARY)))
        if imgui.button(f"{tr(_TAB_LABELS[name])}###tab {name}", ImVec2(width, height)):
            layout.show_tab(state, name)
        imgui.pop_style_color()
        if name == current:
            low = ImVec2(corner.x + left + number * width, corner.y + height - 2 * scale)
            draw.add_rect_filled(low, ImVec2(low.x + width, corner.y + height), packed(ACCENT))
    imgui.pop_style_var()
    imgui.pop_style_color()
