"""The bar over the top of the canvas, which stays where it is; it shows the options of the current tool."""

from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import ImVec2, imgui

from ..app_state import AppState
from . import stiffness_brush, suggested_pins

_MARGIN = 10  # design points between the canvas and the bar
_WIDE = 48  # times the font size: a canvas that shows the options in one line
_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.always_auto_resize
    | imgui.WindowFlags_.no_focus_on_appearing
)


@dataclass(frozen=True)
class Options:
    """What the bar shows for a tool.

    window: name of ImGui's window; shown: whether the tool is the current one; draw: draws the content, given
    whether there is room for one line, and the points per design point.
    """

    window: str
    shown: Callable[[AppState], bool]
    draw: Callable[[AppState, bool, float], None]


OPTIONS = (
    Options("Suggested Pins", suggested_pins.is_shown, suggested_pins.draw),
    Options("Brush", stiffness_brush.is_shown, stiffness_brush.draw),
)


def draw(state: AppState, canvas: tuple[float, float, float, float], scale: float) -> None:
    """Draw the bar, if the current tool has options.

    canvas: (left, top, right, bottom) in points; scale: points per design point.
    """
    options = next((options for options in OPTIONS if options.shown(state)), None)
    if options is None or state.document is None:
        return
    left, top, right, _ = canvas
    imgui.set_next_window_pos(ImVec2(left + _MARGIN * scale, top + _MARGIN * scale))
    imgui.set_next_window_bg_alpha(0.92)
    if imgui.begin(options.window, None, _FLAGS)[0]:
        options.draw(state, right - left > _WIDE * imgui.get_font_size(), scale)
    imgui.end()
