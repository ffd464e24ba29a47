"""All keys and what the mouse does, on one page."""

from collections.abc import Sequence

from imgui_bundle import ImVec2, ImVec4, imgui

from .. import widgets
from ..app_state import AppState
from ..theme import ACTIVE, QUIET, TEXT, packed
from .command import Command, Key, Menu

_MOUSE = (
    ("Click on the drawing", "add a pin"),
    ("Drag a pin", "bend the drawing"),
    ("Press and drag", "add a pin and bend"),
    ("Shift-click, drag a box", "select several pins"),
    ("Double-click a pin", "its numbers"),
    ("Right-click a pin", "its menu"),
    ("Alt-click a pin", "remove it"),
    ("Alt-drag its ring", "turn the drawing there"),
    ("Arrows", "nudge; with Shift by 10"),
    ("C, arrows, Enter", "point without a mouse"),
    ("Middle-drag, Space-drag", "move the canvas"),
    ("Wheel", "zoom at the pointer"),
    ("H", "hide pins while held"),
    ("Esc", "back to before the drag"),
)
_MENUS = (
    ("F10, Alt+letter", "open a menu"),
    ("F6, Shift+F6", "to another panel"),
    ("Tab, arrows, Enter", "walk and use a panel"),
)
Group = tuple[str, list[tuple[str, str]]]  # a title and its lines: keys, and what they do
_COLUMN, _KEYS = 302, 158  # widths in design points
_MOST_COLUMNS = 4
_TOOLS_AT = 3  # among the groups: there the columns are of about one height
_LINES = {Key.up_arrow: -1, Key.down_arrow: 1, Key.page_up: -10, Key.page_down: 10}  # that keys scroll


def groups(menus: Sequence[Menu], commands: Sequence[Command]) -> list[Group]:
    """Titles, each with its lines: keys, and what they do. commands: those of the menus and others."""
    found = [("Mouse", list(_MOUSE))]
    in_menus: set[int] = set()
    for name, items in menus:
        listed = [item for item in items if isinstance(item, Command) and item.chords]
        in_menus.update(map(id, listed))
        found.append((name, [_line(command) for command in listed]))
    tools = [command for command in commands if command.chords and id(command) not in in_menus]
    found[-1][1].extend(_MENUS)
    found.insert(_TOOLS_AT, ("Tools", [_line(command) for command in tools]))
    return [(title, lines) for title, lines in found if lines]


def _line(command: Command) -> tuple[str, str]:
    return command.key_name, command.label.rstrip(".")


class ShortcutsPage:
    """The page as a dialog; Esc, Enter or the key that opened it closes it."""

    def __init__(self) -> None:
        self.is_open = False
        self._groups: list[Group] = []
        self._command: Command | None = None

    def open(self, menus: Sequence[Menu], commands: Sequence[Command], command: Command) -> None:
        """Show the page. menus, commands: those that it lists; command: the one that shows it."""
        self.is_open, self._groups, self._command = True, groups(menus, commands), command

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        if not widgets.begin_dialog("Keys and mouse"):
            return
        _draw_groups(self._groups, scale)
        is_closed = widgets.button("Close", primary=True) or widgets.cancel_pressed()
        is_key_pressed = self._command is not None and self._command.is_pressed()
        if is_closed or widgets.confirm_pressed() or is_key_pressed:
            self.is_open = False
            widgets.close_popup()
        imgui.end_popup()


def _draw_groups(groups: list[Group], scale: float) -> None:
    """Draw all groups in as many columns as the window has room for; keys scroll them."""
    room = imgui.get_main_viewport().size  # ImGui makes no dialog larger
    count = max(1, min(_MOST_COLUMNS, int((room.x - 40 * scale) / (_COLUMN * scale))))
    columns = columns_of(groups, count)
    lines = max(sum(len(lines) + 2 for _, lines in column) for column in columns)
    height = min(lines * imgui.get_text_line_height_with_spacing(), room.y - 140 * scale)
    width = len(columns) * _COLUMN * scale + imgui.get_style().scrollbar_size
    imgui.begin_child("##all", ImVec2(width, height), 0, imgui.WindowFlags_.no_nav_inputs)
    scrolled = sum(lines for key, lines in _LINES.items() if imgui.is_key_pressed(key))
    if scrolled:
        imgui.set_scroll_y(imgui.get_scroll_y() + scrolled * imgui.get_text_line_height_with_spacing())
    if imgui.begin_table("##columns", len(columns)):
        imgui.table_next_row()
        for column in columns:
            imgui.table_next_column()
            for title, rows in column:
                _group(title, rows, scale)
        imgui.end_table()
    imgui.end_child()


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


def _group(title: str, rows: list[tuple[str, str]], scale: float) -> None:
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    imgui.text_colored(ImVec4(*QUIET), title.upper())
    imgui.pop_font()
    left = imgui.get_cursor_pos_x()
    for keys, what in rows:
        _caps(keys, scale)
        imgui.same_line()
        imgui.set_cursor_pos_x(left + _KEYS * scale)
        imgui.text(what)
    imgui.dummy(ImVec2(0, 0.4 * imgui.get_font_size()))


def _caps(keys: str, scale: float) -> None:
    """Keys on a small plate."""
    at, size = imgui.get_cursor_screen_pos(), imgui.calc_text_size(keys)
    draw, rim = imgui.get_window_draw_list(), 5 * scale
    end = ImVec2(at.x + size.x + 2 * rim, at.y + size.y + 1 * scale)
    draw.add_rect_filled(ImVec2(at.x, at.y - 1 * scale), end, packed(ACTIVE, 0.6), 4 * scale)
    draw.add_text(ImVec2(at.x + rim, at.y), packed(TEXT), keys)
    imgui.dummy(ImVec2(size.x + 2 * rim, size.y))
