"""Tool bar, side panel and status bar; they show the workspace and hold nothing themselves."""

from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from .. import widgets
from ..app_state import AppState
from ..commands import menu_bar as menus
from ..commands import registry as commands
from ..commands.command import Command
from ..dialogs.first_steps import FirstSteps
from ..theme import ACCENT, QUIET, TEXT, packed
from ..timeline import panel as timeline_panel
from . import basic_sections as sections
from . import history as history_panel
from . import mesh as mesh_panel
from . import numbers_panel
from . import pose as pose_panel
from . import stiffness_brush as brush_panel

_TOOLS: tuple[Command | None, ...] = (
    commands.PIN_TOOL,
    commands.HAND_TOOL,
    commands.BRUSH_TOOL,
    None,
    commands.UNDO,
    commands.REDO,
    commands.REMOVE,
    None,
    commands.FIT,
    commands.SHOW_MESH,
)


@dataclass(frozen=True)
class Section:
    """A part of the side panel that can be folded.

    title: as shown, and the name under which preferences remember whether it is open; draw: its content,
    given the points of the window per point of the design; shown: whether it is there at all; note: a short
    text at the right end of its title; opened: whether it is open for a new user.
    """

    title: str
    draw: Callable[[AppState, float], None]
    shown: Callable[[AppState], bool] = commands.has_drawing
    note: Callable[[AppState], str] = lambda _: ""
    opened: bool = True


# From top to bottom. Each section's function lives in a module of its own or in `sections`; see `widgets`.
SECTIONS = (
    Section("Stiffness brush", brush_panel.draw, shown=brush_panel.is_at_hand),
    Section("Drawing", sections.drawing),
    Section("Pins", sections.pins, note=sections.pin_count),
    Section("Bending", sections.bending),
    Section("Mesh", mesh_panel.draw),
    Section("Poses", pose_panel.draw, note=pose_panel.pose_count),
    Section("Numbers", numbers_panel.draw),
    Section("History", history_panel.draw, note=history_panel.step_count),
    Section("View", sections.view),
)


def draw(state: AppState, scale: float) -> tuple[float, float, float, float]:
    """Draw the frame around the canvas; returns the canvas as (left, top, right, bottom) in window points."""
    menus.draw(state)
    _status_bar(state, scale)
    timeline_panel.draw(state, scale)
    if state.document is not None:
        _tool_bar(state, scale)
    _side_panel(state, scale)
    state.part(FirstSteps).draw(state, scale)
    viewport = imgui.get_main_viewport()
    left, top = viewport.work_pos.x, viewport.work_pos.y
    return left, top, left + viewport.work_size.x, top + viewport.work_size.y


def _tool_bar(state: AppState, scale: float) -> None:
    gaps = 16 * scale + _TOOLS.count(None) * 12 * scale
    room = (imgui.get_main_viewport().work_size.y - gaps) / (len(_TOOLS) - _TOOLS.count(None))
    size = min(36 * scale, room - 4 * scale)  # in a low window, too, all of them are seen
    if widgets.side_bar("Tools", imgui.Dir.left, 48 * scale, ImVec2(24 * scale - size / 2, 8 * scale)):
        imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(4 * scale, 4 * scale))
        for command in _TOOLS:
            if command is None:
                imgui.dummy(ImVec2(size, 1 * scale))
                at = imgui.get_cursor_screen_pos()
                imgui.get_window_draw_list().add_line(
                    ImVec2(at.x + 6 * scale, at.y),
                    ImVec2(at.x + size - 6 * scale, at.y),
                    packed((1, 1, 1, 0.12)),
                )
                imgui.dummy(ImVec2(size, 3 * scale))
            else:
                _tool_button(state, command, size)
        imgui.pop_style_var()
    imgui.end()


def _tool_button(state: AppState, command: Command, size: float) -> None:
    on = command.checked is not None and command.checked(state)
    imgui.push_style_color(imgui.Col_.button, ImVec4(*ACCENT[:3], 0.18) if on else ImVec4(0, 0, 0, 0))
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(ACCENT if on else (0.91, 0.91, 0.925, 1.0))))
    imgui.begin_disabled(not command.enabled(state))
    if imgui.button(f"{command.icon}##{command.label}", ImVec2(size, size)):
        widgets.run(state, command)
    imgui.end_disabled()
    imgui.pop_style_color(2)
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal | imgui.HoveredFlags_.allow_when_disabled):
        imgui.set_tooltip(command.label.rstrip(".") + (f"  ({command.key_name})" if command.chords else ""))


def _side_panel(state: AppState, scale: float) -> None:
    padding = ImVec2(16 * scale, 6 * scale)
    shown = [section for section in SECTIONS if section.shown(state)]
    if not shown:
        return
    if widgets.side_bar("Panel", imgui.Dir.right, 268 * scale, padding, scrolls=True):
        for section in shown:
            if _heading(state, section):
                section.draw(state, scale)
                imgui.spacing()
    imgui.end()


def _heading(state: AppState, section: Section) -> bool:
    """The title line, a click on which folds the section; whether it is open."""
    remembered: dict[str, object] = state.preferences.get("sections", {})
    was_open = bool(remembered.get(section.title, section.opened))
    imgui.spacing()
    imgui.separator()
    imgui.push_style_color(imgui.Col_.text, ImVec4(*QUIET))
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    clicked = imgui.selectable(f"{section.title.upper()}###section {section.title}", False)[0]
    arrow = icons.ICON_FA_CHEVRON_DOWN if was_open else icons.ICON_FA_CHEVRON_RIGHT
    note = f"{section.note(state)}   {arrow}"
    imgui.same_line(
        imgui.get_content_region_avail().x - imgui.calc_text_size(note).x + imgui.get_cursor_pos_x()
    )
    imgui.text(note)
    imgui.pop_font()
    imgui.pop_style_color()
    if clicked:
        state.preferences.put("sections", {**remembered, section.title: not was_open})
    return was_open != clicked


def _status_bar(state: AppState, scale: float) -> None:
    height = imgui.get_frame_height() + 2 * scale
    if widgets.side_bar("Status", imgui.Dir.down, height, ImVec2(14 * scale, 1 * scale)):
        imgui.align_text_to_frame_padding()
        facts = f"{state.editor.camera.zoom * 100:.0f} %" if state.document is not None else ""
        right = imgui.get_window_width() - imgui.calc_text_size(facts).x - 16 * scale
        text = state.notice or state.editor.hint
        shown = widgets.shortened(text, right - 30 * scale)
        imgui.text_colored(ImVec4(*(ACCENT if state.notice else TEXT)), shown)
        widgets.show_tooltip(text if shown != text else "")
        if facts:
            imgui.same_line(right)
            imgui.text_colored(ImVec4(*QUIET), facts)
    imgui.end()
