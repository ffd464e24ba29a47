"""The shapes of the mouse pointer over the canvas; systems have no cursors to grab and to rotate."""

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.tools.base import Cursor
from ..theme import DARK, packed

_SYSTEM: dict[Cursor, imgui.MouseCursor_] = {
    "hand": imgui.MouseCursor_.hand,
    "hidden": imgui.MouseCursor_.none,
}
_DRAWN: dict[Cursor, str] = {
    "grab": icons.ICON_FA_HAND_BACK_FIST,
    "rotate": icons.ICON_FA_ROTATE,
    "pan": icons.ICON_FA_HAND,
    "panning": icons.ICON_FA_HAND_BACK_FIST,
    "zoom": icons.ICON_FA_MAGNIFYING_GLASS,
}
_SIZE = 1.2  # times the font size
_RIM = 1.5  # design points, as the sizes of the cross
_CROSS_GAP, _CROSS_ARM = 3.0, 9.0  # where its arms begin and end


def show_cursor(cursor: Cursor, scale: float) -> None:
    """Give the mouse pointer a shape for this frame. scale: points per design point."""
    if cursor in _DRAWN:
        imgui.set_mouse_cursor(imgui.MouseCursor_.none)
        _draw_icon(_DRAWN[cursor], scale)
    elif cursor == "cross":
        imgui.set_mouse_cursor(imgui.MouseCursor_.none)
        _draw_cross(scale)
    elif cursor in _SYSTEM:
        imgui.set_mouse_cursor(_SYSTEM[cursor])


def _draw_cross(scale: float) -> None:
    """Draw four arms around the pointer, white with a dark rim; between them the drawing is seen."""
    draw, pointer = imgui.get_foreground_draw_list(), imgui.get_mouse_pos()
    x, y, gap, arm = pointer.x, pointer.y, _CROSS_GAP * scale, _CROSS_ARM * scale
    for color, width, more in (
        (packed(DARK, 0.8), 3.5 * scale, scale),
        (packed((1, 1, 1, 1)), 1.5 * scale, 0),
    ):
        for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1)):
            start = ImVec2(x + dx * (gap - more), y + dy * (gap - more))
            end = ImVec2(x + dx * (arm + more), y + dy * (arm + more))
            draw.add_line(start, end, color, width)


def _draw_icon(icon: str, scale: float) -> None:
    """Draw an icon with its center at the pointer, white with a dark rim."""
    imgui.push_font(None, imgui.get_style().font_size_base * _SIZE)
    draw, pointer, size, rim = (
        imgui.get_foreground_draw_list(),
        imgui.get_mouse_pos(),
        imgui.calc_text_size(icon),
        _RIM * scale,
    )
    x, y = pointer.x - size.x / 2, pointer.y - size.y / 2
    for dx, dy in ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, 1), (-1, 1), (1, -1)):
        draw.add_text(ImVec2(x + dx * rim, y + dy * rim), packed(DARK), icon)
    draw.add_text(ImVec2(x, y), packed((1.0, 1.0, 1.0, 1.0)), icon)
    imgui.pop_font()
