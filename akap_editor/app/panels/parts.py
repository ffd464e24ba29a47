"""Building blocks of the side panel: titles that fold sections, and lists of a fixed height."""

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...words import tr
from ..app_state import AppState
from ..theme import SECONDARY, WELL
from ..widgets import NAV_FLATTENED

_TITLE_SIZE = 0.86  # of the font, relative to that of other text

# -- titles --------------------------------------------------------------------------------------------------


def draw_heading(state: AppState, title: str, note: str, opened: bool, is_first: bool) -> bool:
    """Draw the title of a section, a click on which folds it; return whether it is unfolded.

    title: in English; note: a short text at the right end; opened: whether it is unfolded for a new user;
    is_first: whether no other section is above it.
    """
    imgui.spacing()
    if not is_first:
        imgui.separator()
    imgui.push_font(None, imgui.get_style().font_size_base * _TITLE_SIZE)
    is_open = _draw_fold(state, title, f"{tr(title).upper()}###section {title}", note, opened)
    imgui.pop_font()
    return is_open


def draw_advanced(state: AppState, name: str) -> bool:
    """Draw the title *Advanced*, folded for a new user; return whether what is under it is to be drawn.

    name: of this part in the preferences.
    """
    return _draw_fold(state, name, f"{tr('Advanced')}###Advanced", "", False)


def _draw_fold(state: AppState, name: str, label: str, note: str, opened: bool) -> bool:
    """Draw a title with an arrow at the right end, and fold or unfold on a click; return whether it is open.

    name: in the preferences; label: ImGui's; opened: for a new user.
    """
    sections: dict[str, object] = state.preferences.get("sections", {})
    was_open = bool(sections.get(name, opened))
    imgui.push_style_color(imgui.Col_.text, ImVec4(*SECONDARY))
    is_clicked = imgui.selectable(label, False)[0]
    arrow = icons.ICON_FA_CHEVRON_DOWN if was_open else icons.ICON_FA_CHEVRON_RIGHT
    text = f"{note}   {arrow}" if note else arrow
    right = imgui.get_content_region_avail().x + imgui.get_cursor_pos_x()
    imgui.same_line(right - imgui.calc_text_size(text).x)
    imgui.text(text)
    imgui.pop_style_color()
    if is_clicked:
        state.preferences.put("sections", {**sections, name: not was_open})
    return was_open != is_clicked


# -- lists ---------------------------------------------------------------------------------------------------


def begin_list(name: str, rows: int) -> None:
    """Begin a list that is always as high as ``rows``, so that nothing below it moves when it changes.

    `end_list` must follow.
    """
    begin_well(name, rows * imgui.get_text_line_height_with_spacing())
    # the highlight of a row extends by half of the space between rows, above the first one, too
    imgui.set_cursor_pos_y(0.5 * imgui.get_style().item_spacing.y)


def end_list() -> None:
    """End a list; scrolled to its end it shows whole rows, as everywhere else."""
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - 0.5 * imgui.get_style().item_spacing.y)
    imgui.dummy(ImVec2(0, 0))
    imgui.end_child()


def begin_well(name: str, height: float) -> None:
    """Begin a darker area, in which lists are; `imgui.end_child` must follow. height: in points."""
    imgui.push_style_color(imgui.Col_.child_bg, ImVec4(*WELL))
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(well_padding(), 0))
    imgui.begin_child(name, ImVec2(0, height), NAV_FLATTENED | imgui.ChildFlags_.always_use_window_padding)
    imgui.pop_style_var()
    imgui.pop_style_color()


def well_padding() -> float:
    """The room at the left and right of what is in a well, points."""
    return float(round(0.5 * imgui.get_font_size()))  # whole, or else the first row is beside the others


def draw_highlight(height: float) -> None:
    """Draw the background of a selected row, which begins at the cursor. height: of its items in points."""
    corner, half = imgui.get_cursor_screen_pos(), 0.5 * imgui.get_style().item_spacing.y
    left, width = imgui.get_window_pos().x, imgui.get_window_size().x
    low, high = ImVec2(left, corner.y - half), ImVec2(left + width, corner.y + height + half)
    imgui.get_window_draw_list().add_rect_filled(low, high, imgui.get_color_u32(imgui.Col_.header))


def scroll_to_row(index: int, most: int) -> None:
    """Scroll to the last row that was drawn, unless it is visible or the pointer is over the list."""
    top = imgui.get_window_pos().y
    bottom = top + imgui.get_window_size().y
    is_visible = top <= imgui.get_item_rect_min().y and imgui.get_item_rect_max().y <= bottom
    if not is_visible and not imgui.is_window_hovered():
        first = max(index - most // 2, 0)
        imgui.set_scroll_y(first * imgui.get_text_line_height_with_spacing())
