"""Titles of parts of the side panel that can be folded; the preferences keep which are unfolded."""

from imgui_bundle import ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...words import tr
from ..app_state import AppState
from ..theme import SECONDARY


def draw_heading(state: AppState, title: str, note: str, opened: bool) -> bool:
    """Draw the title of a section, a click on which folds it; return whether it is unfolded.

    title: in English; note: a short text at the right end; opened: whether it is unfolded for a new user.
    """
    was_open = _is_open(state, title, opened)
    imgui.spacing()
    imgui.separator()
    imgui.push_style_color(imgui.Col_.text, ImVec4(*SECONDARY))
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    is_clicked = imgui.selectable(f"{tr(title).upper()}###section {title}", False)[0]
    arrow = icons.ICON_FA_CHEVRON_DOWN if was_open else icons.ICON_FA_CHEVRON_RIGHT
    text = f"{note}   {arrow}"
    right = imgui.get_content_region_avail().x + imgui.get_cursor_pos_x()
    imgui.same_line(right - imgui.calc_text_size(text).x)
    imgui.text(text)
    imgui.pop_font()
    imgui.pop_style_color()
    if is_clicked:
        _store(state, title, not was_open)
    return was_open != is_clicked


def draw_advanced(state: AppState, name: str) -> bool:
    """Draw the title *Advanced*, folded for a new user; return whether what is under it is to be drawn.

    name: of this part in the preferences.
    """
    was_open = _is_open(state, name, False)
    imgui.set_next_item_open(was_open)
    flags = imgui.TreeNodeFlags_.span_avail_width | imgui.TreeNodeFlags_.no_tree_push_on_open
    is_open = bool(imgui.tree_node_ex(f"{tr('Advanced')}###Advanced", flags))
    if is_open != was_open:
        _store(state, name, is_open)
    return is_open


def _is_open(state: AppState, name: str, opened: bool) -> bool:
    sections: dict[str, object] = state.preferences.get("sections", {})
    return bool(sections.get(name, opened))


def _store(state: AppState, name: str, is_open: bool) -> None:
    sections: dict[str, object] = state.preferences.get("sections", {})
    state.preferences.put("sections", {**sections, name: is_open})
