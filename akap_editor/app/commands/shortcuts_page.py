"""The page of shortcuts: all keys, and what the mouse does."""

import re
from collections.abc import Sequence

from imgui_bundle import ImVec2, ImVec4, imgui

from ...words import mark, tr, tr_in
from .. import widgets
from ..app_state import AppState
from ..theme import ACTIVE, SECONDARY, TEXT, packed
from .command import Command, Key, Menu, commands_and_files

Line = tuple[str, str]  # keys or mouse, and what they do
Group = tuple[str, list[Line]]  # a title and its lines

_MOUSE: tuple[Line, ...] = (
    (mark("Click on the drawing"), mark("Add a pin")),
    (mark("Drag a pin"), mark("Bend the drawing")),
    (mark("Press and drag"), mark("Add a pin and bend")),
    (mark("Shift-click, drag a box"), mark("Select several pins")),
    (mark("Double-click a pin"), mark("Edit its values")),
    (mark("Right-click"), mark("Open the menu")),
    (mark("Alt-click a pin"), mark("Remove it")),
    (mark("Drag its ring"), mark("Rotate around it")),
    (mark("Shift-click, brush"), mark("Paint a straight line")),
    (mark("Arrows"), mark("Nudge; with Shift by 10")),
    (mark("C, arrows, Enter"), mark("Point without a mouse")),
    (mark("Middle-drag, Space-drag"), mark("Pan")),
    (mark("Wheel, Shift+wheel"), mark("Zoom, pan sideways")),
    (mark("Ctrl+Space, click, drag"), mark("Zoom; with Alt out")),
    (mark("Space, tapped"), mark("Play")),
    ("H", mark("Hide pins while held")),
    (mark("Esc"), mark("Cancel, then deselect")),
)
_FOCUS: tuple[Line, ...] = (
    (mark("F10, Alt+letter"), mark("Open a menu")),
    (mark("F6, Shift+F6"), mark("Next, previous panel")),
    (mark("Tab, arrows, Enter"), mark("Use the focused panel")),
)
_PLATE_MARGIN, _KEYS_GAP, _COLUMN_GAP = 5, 8, 16  # design points
_MAX_COLUMNS = 5
_TOOLS_INDEX = 3  # among the groups: there, all columns have about the same height
_SCROLL_LINES = {Key.up_arrow: -1, Key.down_arrow: 1, Key.page_up: -10, Key.page_down: 10}


def _menu_title(name: str) -> str:
    """The name of a menu without the letter that opens it, which some languages add in parentheses."""
    return re.sub(r"\(\w\)$", "", tr_in("menu", name))


def groups(menus: Sequence[Menu], commands: Sequence[Command]) -> list[Group]:
    """The groups of the page: mouse, one for each menu, and the commands that are in no menu."""
    listed = [(tr("Mouse"), [(tr(keys), tr(action)) for keys, action in _MOUSE])]
    in_menus: set[int] = set()
    for name, items in menus:
        listed_items = commands_and_files(items)
        with_keys = [item for item in listed_items if isinstance(item, Command) and item.active_chords]
        in_menus.update(map(id, with_keys))
        listed.append((_menu_title(name), [(command.key_name, command.name) for command in with_keys]))
    listed[-1][1].extend((tr(keys), tr(action)) for keys, action in _FOCUS)
    others = [command for command in commands if command.active_chords and id(command) not in in_menus]
    listed.insert(_TOOLS_INDEX, (tr("Tools"), [(command.key_name, command.name) for command in others]))
    return [(title, lines) for title, lines in listed if lines]


class ShortcutsPage:
    """Shows the page as a dialog; Esc, Enter or the key that opened it closes it."""

    def __init__(self) -> None:
        self.is_open = False
        self._groups: list[Group] = []
        self._command: Command | None = None

    def open(self, menus: Sequence[Menu], commands: Sequence[Command], command: Command) -> None:
        """Show the page. menus, commands: those that it lists; command: the one that shows it."""
        self.is_open, self._groups, self._command = True, groups(menus, commands), command

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        if not widgets.begin_dialog("Keyboard shortcuts"):
            return
        _draw_groups(self._groups, scale)
        is_closed = widgets.button(tr("Close"), primary=True) or widgets.cancel_pressed()
        is_key_pressed = self._command is not None and self._command.is_pressed()
        if is_closed or widgets.confirm_pressed() or is_key_pressed:
            self.is_open = False
            widgets.close_popup()
        imgui.end_popup()


def _draw_groups(groups: list[Group], scale: float) -> None:
    """Draw all groups in as many columns as the window has room for; keys scroll them."""
    room = imgui.get_main_viewport().size  # ImGui makes no dialog larger
    columns, widths = _fitting_columns(groups, room.x - 40 * scale - imgui.get_style().scrollbar_size, scale)
    line_count = max(sum(len(lines) + 2 for _, lines in column) for column in columns)
    height = min(line_count * imgui.get_text_line_height_with_spacing(), room.y - 140 * scale)
    width = sum(map(sum, widths)) - _COLUMN_GAP / 2 * scale + imgui.get_style().scrollbar_size
    imgui.begin_child("##all", ImVec2(width, height), 0, imgui.WindowFlags_.no_nav_inputs)
    scrolled_lines = sum(count for key, count in _SCROLL_LINES.items() if imgui.is_key_pressed(key))
    if scrolled_lines:
        scrolled = scrolled_lines * imgui.get_text_line_height_with_spacing()
        imgui.set_scroll_y(imgui.get_scroll_y() + scrolled)
    imgui.push_style_var(imgui.StyleVar_.cell_padding, ImVec2(0, 0))
    if imgui.begin_table("##columns", len(columns)):
        for number, (keys_width, actions_width) in enumerate(widths):
            flags = imgui.TableColumnFlags_.width_fixed
            imgui.table_setup_column(f"##{number}", flags, keys_width + actions_width)
        imgui.table_next_row()
        for column, (keys_width, _) in zip(columns, widths, strict=True):
            imgui.table_next_column()
            for title, lines in column:
                _draw_group(title, lines, keys_width, scale)
        imgui.end_table()
    imgui.pop_style_var()
    imgui.end_child()


def _fitting_columns(
    groups: list[Group], room: float, scale: float
) -> tuple[list[list[Group]], list[tuple[float, float]]]:
    """As many columns as have room, and for each the widths of its keys and of what they do; points."""
    for count in range(_MAX_COLUMNS, 0, -1):
        columns = columns_of(groups, count)
        widths = [_column_width(column, scale) for column in columns]
        if sum(map(sum, widths)) - _COLUMN_GAP / 2 * scale <= room:
            break
    return columns, widths


def _column_width(column: list[Group], scale: float) -> tuple[float, float]:
    lines = [line for _, lines in column for line in lines]
    keys, actions = (max(imgui.calc_text_size(line[place]).x for line in lines) for place in (0, 1))
    return keys + (2 * _PLATE_MARGIN + _KEYS_GAP) * scale, actions + _COLUMN_GAP * scale


def columns_of(groups: list[Group], count: int) -> list[list[Group]]:
    """The groups in order, in at most ``count`` columns, the tallest of which is as short as possible."""
    heights = [len(lines) + 2 for _, lines in groups]
    for limit in range(max(heights), sum(heights) + 1):
        columns: list[list[Group]] = [[]]
        column_height = 0
        for group, height in zip(groups, heights, strict=True):
            if column_height + height > limit:
                columns.append([])
                column_height = 0
            columns[-1].append(group)
            column_height += height
        if len(columns) <= count:
            return columns
    return [groups]


def _draw_group(title: str, lines: list[Line], keys_width: float, scale: float) -> None:
    """Draw a title and its lines. keys_width: in points; scale: points per design point."""
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    imgui.text_colored(ImVec4(*SECONDARY), title.upper())
    imgui.pop_font()
    left = imgui.get_cursor_pos_x()
    for keys, action in lines:
        _draw_keys(keys, scale)
        imgui.same_line()
        imgui.set_cursor_pos_x(left + keys_width)
        imgui.text(action)
    imgui.dummy(ImVec2(0, 0.4 * imgui.get_font_size()))


def _draw_keys(keys: str, scale: float) -> None:
    """Draw the name of keys on a plate."""
    corner, size = imgui.get_cursor_screen_pos(), imgui.calc_text_size(keys)
    draw, margin = imgui.get_window_draw_list(), _PLATE_MARGIN * scale
    low = ImVec2(corner.x, corner.y - 1 * scale)
    high = ImVec2(corner.x + size.x + 2 * margin, corner.y + size.y + 1 * scale)
    draw.add_rect_filled(low, high, packed(ACTIVE, 0.6), 4 * scale)
    draw.add_text(ImVec2(corner.x + margin, corner.y), packed(TEXT), keys)
    imgui.dummy(ImVec2(size.x + 2 * margin, size.y))
