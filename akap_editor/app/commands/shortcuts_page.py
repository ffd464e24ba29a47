"""All keys and what the mouse does, on one page."""

from imgui_bundle import ImVec2, ImVec4, imgui

from .. import widgets
from ..app_state import AppState
from ..theme import ACTIVE, QUIET, TEXT, packed
from .command import Command, Key
from .registry import COMMANDS, KEYS, MENUS

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
_COLUMN, _KEYS = 302, 158  # widths in design points
_MOST_COLUMNS = 4
_TOOLS_AT = 3  # among the groups: there the columns are of about one height
_LINES = {Key.up_arrow: -1, Key.down_arrow: 1, Key.page_up: -10, Key.page_down: 10}  # that keys scroll


def groups() -> list[tuple[str, list[tuple[str, str]]]]:
    """Titles, each with its lines: keys, and what they do."""
    found = [("Mouse", list(_MOUSE))]
    in_menus: set[int] = set()
    for name, items in MENUS:
        listed = [item for item in items if isinstance(item, Command) and item.chords]
        in_menus.update(map(id, listed))
        found.append((name, [_line(command) for command in listed]))
    tools = [command for command in COMMANDS if command.chords and id(command) not in in_menus]
    found[-1][1].extend(_MENUS)
    found.insert(_TOOLS_AT, ("Tools", [_line(command) for command in tools]))
    return [(title, lines) for title, lines in found if lines]


def _line(command: Command) -> tuple[str, str]:
    return command.key_name, command.label.rstrip(".")


def draw(state: AppState, scale: float) -> None:
    """The page as a dialog; ?, Esc or Enter closes it."""
    if not widgets.begin_dialog("Keys and mouse"):
        return
    room = imgui.get_main_viewport().size  # ImGui makes no dialog larger
    count = max(1, min(_MOST_COLUMNS, int((room.x - 40 * scale) / (_COLUMN * scale))))
    columns = _columns(groups(), count)
    lines = max(sum(len(lines) + 2 for _, lines in column) for column in columns)
    height = min(lines * imgui.get_text_line_height_with_spacing(), room.y - 140 * scale)
    width = len(columns) * _COLUMN * scale + imgui.get_style().scrollbar_size
    imgui.begin_child("##all", ImVec2(width, height), 0, imgui.WindowFlags_.no_nav_inputs)
    by = sum(lines for key, lines in _LINES.items() if imgui.is_key_pressed(key))
    if by:
        imgui.set_scroll_y(imgui.get_scroll_y() + by * imgui.get_text_line_height_with_spacing())
    if imgui.begin_table("##columns", len(columns)):
        imgui.table_next_row()
        for column in columns:
            imgui.table_next_column()
            for title, rows in column:
                _group(title, rows, scale)
        imgui.end_table()
    imgui.end_child()
    done = widgets.button("Close", primary=True)
    if done or widgets.cancel_pressed() or widgets.confirm_pressed() or KEYS.is_pressed():
        widgets.close(state, "keys", False)
    imgui.end_popup()


def _columns(
    parts: list[tuple[str, list[tuple[str, str]]]], count: int
) -> list[list[tuple[str, list[tuple[str, str]]]]]:
    """The groups in order, cut where the tallest of ``count`` columns becomes least tall."""
    heights = [len(lines) + 2 for _, lines in parts]
    for limit in range(max(heights), sum(heights) + 1):
        columns: list[list[tuple[str, list[tuple[str, str]]]]] = [[]]
        used = 0
        for part, height in zip(parts, heights, strict=True):
            if used + height > limit:
                columns.append([])
                used = 0
            columns[-1].append(part)
            used += height
        if len(columns) <= count:
            return columns
    return [parts]


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
