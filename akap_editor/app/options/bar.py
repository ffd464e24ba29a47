"""The options bar above the canvas: what the selection offers, or else the current tool."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...words import tr
from .. import widgets
from ..app_state import AppState
from . import pins, stiffness_brush, suggested_pins, tools
from .items import Item

_MARGIN, _GAP = 10, 14  # design points: around the content, and between two items
_FLOATING = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.always_auto_resize
    | imgui.WindowFlags_.no_focus_on_appearing
)
_MORE = "more options"


@dataclass(frozen=True)
class Options:
    """What the bar offers in a situation. shown: whether it is this one; items: from left to right."""

    shown: Callable[[AppState], bool]
    items: Callable[[AppState], Sequence[Item]]


# The first one that is shown is drawn.
OPTIONS = (
    Options(suggested_pins.is_shown, suggested_pins.items),
    Options(stiffness_brush.is_shown, stiffness_brush.items),
    Options(pins.is_shown, pins.items),
    Options(lambda _: True, tools.items),
)


class OptionsBar:
    """Draws items in a line; those that have no room are in a popup at its right end.

    It remembers how wide an item was when it was drawn last.
    """

    def __init__(self) -> None:
        self._widths: dict[tuple[str, float], float] = {}

    def draw(self, state: AppState, items: Sequence[Item], scale: float) -> None:
        """Draw the items in the current window. scale: points per design point."""
        gap, more = _GAP * scale, 2.4 * imgui.get_font_size()
        room = imgui.get_content_region_avail().x
        count = self._fitting(items, room, gap)
        if count < len(items):
            count = self._fitting(items, room - more - gap, gap)
        for number, item in enumerate(items[:count]):
            if number:
                imgui.same_line(0, gap)
            self._draw_item(state, item)
        if count < len(items):
            if count:
                imgui.same_line(0, gap)
            self._draw_more(state, items[count:], more)

    def _fitting(self, items: Sequence[Item], room: float, gap: float) -> int:
        """How many of the items have room; of a width that is not known yet it is assumed."""
        used = 0.0
        for number, item in enumerate(items):
            used += self._widths.get((item.name, imgui.get_font_size()), 0.0) + (gap if number else 0.0)
            if used > room:
                return number
        return len(items)

    def _draw_item(self, state: AppState, item: Item) -> None:
        imgui.begin_group()
        imgui.align_text_to_frame_padding()
        item.draw(state)
        imgui.end_group()
        width = imgui.get_item_rect_size().x
        self._widths[item.name, imgui.get_font_size()] = width

    def _draw_more(self, state: AppState, items: Sequence[Item], width: float) -> None:
        if imgui.button(f"{icons.ICON_FA_ELLIPSIS}###more", ImVec2(width, 0)):
            imgui.open_popup(_MORE)
        widgets.show_tooltip(tr("More options"))
        corner = ImVec2(imgui.get_item_rect_min().x, imgui.get_item_rect_max().y)
        imgui.set_next_window_pos(corner)
        if imgui.begin_popup(_MORE):
            for item in items:
                self._draw_item(state, item)
            imgui.end_popup()


def draw(state: AppState, scale: float) -> None:
    """Draw the bar at the top of the room for the canvas. scale: points per design point."""
    padding = ImVec2(_MARGIN * scale, 4 * scale)
    height = imgui.get_frame_height() + 2 * padding.y
    if widgets.side_bar("Options", imgui.Dir.up, height, padding):
        state.part(OptionsBar).draw(state, _current(state).items(state), scale)
    imgui.end()


def draw_over_canvas(state: AppState, canvas: tuple[float, float, float, float], scale: float) -> None:
    """Draw what cannot wait until the bar is shown again over the top of the canvas.

    canvas: (left, top, right, bottom) in points; scale: points per design point.
    """
    if not suggested_pins.is_shown(state):
        return
    left, top, *_ = canvas
    imgui.set_next_window_pos(ImVec2(left + _MARGIN * scale, top + _MARGIN * scale))
    imgui.set_next_window_bg_alpha(0.92)
    if imgui.begin("Options", None, _FLOATING)[0]:
        for number, item in enumerate(suggested_pins.items(state)):
            if number:
                imgui.same_line(0, _GAP * scale)
            item.draw(state)
    imgui.end()


def _current(state: AppState) -> Options:
    return next(options for options in OPTIONS if options.shown(state))
