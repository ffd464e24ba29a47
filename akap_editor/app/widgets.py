"""Small pieces that panels and dialogs are made of. They hold nothing themselves."""

import re
from bisect import bisect_left

from imgui_bundle import ImVec2, ImVec4, imgui

from ..editor.document.settings import Settings
from ..render.overlays import Rgba
from .app_state import AppState
from .commands.command import Command
from .theme import ACCENT, ACCENT_ACTIVE, ACCENT_HOVER, DARK, QUIET, STRONG_LINE, TEXT, packed

_BAR = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_docking
)
FULL = -imgui.FLT_MIN  # a width: all the room there is
_NUMBER = 3.2  # times the font's size: least room for the number beside a slider, so that they end alike
NAV_FLATTENED = (
    imgui.ChildFlags_.nav_flattened
)  # of a child window: keys walk in and out as if there were none
_DIALOG = imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_saved_settings


def run(state: AppState, command: Command) -> None:
    """Run a command; what goes wrong becomes a message."""
    state.notice = ""
    state.run_reporting_errors(lambda: command.run(state))


def change(state: AppState, settings: Settings) -> None:
    """Change how the drawing bends; what goes wrong becomes a message."""
    state.notice = ""
    state.run_reporting_errors(lambda: state.change_settings(settings))


def switch(label: str, on: bool, tooltip: str = "") -> tuple[bool, bool]:
    """A check box of the height of its text; whether it was clicked, and whether it is on."""
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0.18, 0.18) * imgui.get_font_size())
    imgui.push_style_var(imgui.StyleVar_.frame_border_size, 1.0)
    imgui.push_style_color(imgui.Col_.border, ImVec4(*(ACCENT if on else STRONG_LINE)))
    clicked, on = imgui.checkbox(label, on)
    imgui.pop_style_color()
    imgui.pop_style_var(2)
    show_tooltip(tooltip)
    return clicked, on


def radio(label: str, on: bool) -> bool:
    """A round button for one of several choices; whether it was clicked."""
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0.18, 0.18) * imgui.get_font_size())
    imgui.push_style_var(imgui.StyleVar_.frame_border_size, 1.0)
    imgui.push_style_color(imgui.Col_.border, ImVec4(*(ACCENT if on else STRONG_LINE)))
    imgui.push_style_color(imgui.Col_.check_mark, ImVec4(*ACCENT))
    clicked = imgui.radio_button(label, on)
    imgui.pop_style_color(2)
    imgui.pop_style_var(2)
    return bool(clicked)


def row(label: str, value: str, tooltip: str = "") -> None:
    """A quiet label on the left, its value on the right."""
    right = imgui.get_content_region_avail().x + imgui.get_cursor_pos_x()
    imgui.text_colored(ImVec4(*QUIET), label)
    show_tooltip(tooltip)
    imgui.same_line()
    shown = shortened(value, right - imgui.get_cursor_pos_x())
    imgui.set_cursor_pos_x(right - imgui.calc_text_size(shown).x)
    imgui.text_unformatted(shown)
    show_tooltip(value if shown != value else "")


def slider(
    name: str,
    value: float,
    limits: tuple[float, float],
    form: str,
    flags: int = 0,
    tooltip: str = "",
    word: str = "",
) -> tuple[bool, float, bool]:
    """A slider with its number beside it; whether it was moved, its value, and whether it was let go changed.

    word: in place of the number. ImGui writes the number where the knob is.
    """
    em = imgui.get_font_size()
    room = max(imgui.calc_text_size(form % limits[1]).x, _NUMBER * em) + 0.6 * em
    imgui.set_next_item_width(-room)
    typing = imgui.internal.temp_input_is_active(imgui.get_id(name))
    imgui.push_style_color(imgui.Col_.text, ImVec4(*TEXT) if typing else ImVec4(0, 0, 0, 0))
    moved, value = imgui.slider_float(name, value, *limits, form, imgui.SliderFlags_.always_clamp | flags)
    imgui.pop_style_color()
    released = imgui.is_item_deactivated_after_edit()
    show_tooltip(tooltip)
    text, corner = word or form % value, imgui.get_item_rect_max()
    at = ImVec2(corner.x + room - imgui.calc_text_size(text).x, imgui.get_item_rect_min().y)
    at.y += imgui.get_style().frame_padding.y
    imgui.get_window_draw_list().add_text(at, packed(TEXT), text)  # no item: the slider stays the last one
    return bool(moved), float(value), bool(released)


def shortened(text: str, width: float, end: bool = False) -> str:
    """A text that is too long for ``width`` points with an ellipsis for its rest, or for its beginning.

    end: whether it is the end that matters, as of a path.
    """
    if imgui.calc_text_size(text).x <= width:
        return text
    fits = bisect_left(
        range(1, len(text)), True, key=lambda count: imgui.calc_text_size(_cut(text, count, end)).x > width
    )
    return _cut(text, fits, end)


def _cut(text: str, count: int, end: bool) -> str:
    return f"…{text[len(text) - count :]}" if end else f"{text[:count].rstrip()}…"


def begin_list(name: str, count: int, most: int) -> None:
    """As high as its rows, or as ``most`` of them, to be scrolled; `imgui.end_child` must follow."""
    height = min(count, most) * imgui.get_text_line_height_with_spacing()
    imgui.begin_child(name, ImVec2(0, height), NAV_FLATTENED)
    # what marks a row reaches half the space between rows beyond its text, above the first one, too
    imgui.set_cursor_pos_y(0.5 * imgui.get_style().item_spacing.y)


def scroll_to_row(index: int, most: int) -> None:
    """Scroll the list to the row that was drawn last, if it is cut off and nobody is looking at others."""
    top = imgui.get_window_pos().y
    bottom = top + imgui.get_window_size().y
    seen = top <= imgui.get_item_rect_min().y and imgui.get_item_rect_max().y <= bottom
    if not seen and not imgui.is_window_hovered():
        above = max(index - most // 2, 0)  # so that the first row is whole
        imgui.set_scroll_y(above * imgui.get_text_line_height_with_spacing())


def secondary_text(text: str) -> None:
    """A quiet sentence, wrapped at the panel's edge."""
    imgui.push_text_wrap_pos(0.0)
    imgui.text_colored(ImVec4(*QUIET), text)
    imgui.pop_text_wrap_pos()


def wrapped(text: str, width: float) -> str:
    """A text in lines of at most ``width`` points, broken between words and between the parts of a path.

    ImGui would also break after a point, and so within cat.akap. What is still too long is left to it.
    """
    lines = [""]
    for piece in re.split(r"(?<=[/\\ \n])", text):
        if lines[-1].endswith("\n") or imgui.calc_text_size((lines[-1] + piece).rstrip()).x > width:
            lines.append("")
        lines[-1] += piece
    return "\n".join(line.strip() for line in lines if line)


def paragraph(text: str, width: float, color: Rgba = TEXT) -> None:
    """A text in lines of at most ``width`` points."""
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width)
    imgui.text_colored(ImVec4(*color), wrapped(text, width))
    imgui.pop_text_wrap_pos()


def show_tooltip(tooltip: str) -> None:
    """Show a text, if there is any, while the pointer rests on the item before, also on a disabled one."""
    flags = imgui.HoveredFlags_.delay_normal | imgui.HoveredFlags_.allow_when_disabled
    if tooltip and imgui.is_item_hovered(flags):
        imgui.begin_tooltip()
        paragraph(tooltip, imgui.get_font_size() * 22)
        imgui.end_tooltip()


def tooltip_due() -> float:
    """Seconds until the pointer has rested long enough on what has a tooltip; 0 where none is to come."""
    context, delay = imgui.get_current_context(), imgui.get_style().hover_delay_normal
    if context.hover_item_delay_id == 0 or context.hover_item_delay_timer >= delay:
        return 0.0
    return float(delay - context.hover_item_delay_timer) + 0.01


def side_bar(name: str, side: imgui.Dir, size: float, padding: ImVec2, scrolls: bool = False) -> bool:
    """Take ``size`` points from a side of the room left for the canvas; `imgui.end` must follow."""
    fixed = imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_scroll_with_mouse
    imgui.push_style_var(imgui.StyleVar_.window_padding, padding)
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    shown = imgui.internal.begin_viewport_side_bar(
        name, imgui.get_main_viewport(), side, size, _BAR | (0 if scrolls else fixed)
    )
    imgui.pop_style_var(3)
    return bool(shown)


# -- dialogs ------------------------------------------------------------------------------------------------


def begin_dialog(title: str) -> bool:
    """A dialog in the middle of the window, the rest dimmed; if it is shown, `imgui.end_popup` ends it."""
    name = f"{title}###dialog {title}"
    if not imgui.is_popup_open(name):
        imgui.open_popup(name)
    viewport = imgui.get_main_viewport()
    imgui.set_next_window_pos(viewport.get_center(), imgui.Cond_.always, ImVec2(0.5, 0.5))
    room, viewport.work_size = viewport.work_size, viewport.size  # else no dialog is larger than the canvas
    padding = imgui.get_style().window_padding.x, 1.6 * imgui.get_style().frame_padding.y
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(*padding))  # the title above the content
    shown = imgui.begin_popup_modal(name, None, _DIALOG)[0]
    imgui.pop_style_var()
    viewport.work_size = room
    return bool(shown)


def label(text: str, width: float) -> None:
    """What stands before a field of a dialog, which begins at ``width``."""
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*QUIET), text)
    imgui.same_line(width)
    imgui.align_text_to_frame_padding()


def switch_label(text: str, width: float) -> None:
    """Before a switch, which is lower than other fields."""
    label(text, width)
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + switch_offset())


def switch_offset() -> float:
    """By how much a switch is lower than other fields, above and below."""
    return float(imgui.get_style().frame_padding.y - 0.18 * imgui.get_font_size())


def color(name: str, value: tuple[float, float, float]) -> tuple[float, float, float]:
    """A small field that opens a chooser of colors; the one that is chosen."""
    flags = imgui.ColorEditFlags_.no_inputs | imgui.ColorEditFlags_.no_label
    _, (red, green, blue) = imgui.color_edit3(name, list(value), flags)
    return red, green, blue


def button(label: str, primary: bool = False) -> bool:
    """A button of a dialog; primary: what Enter does."""
    width = max(imgui.calc_text_size(label).x + 2.5 * imgui.get_font_size(), 6 * imgui.get_font_size())
    if primary:
        imgui.push_style_color(imgui.Col_.button, ImVec4(*ACCENT))
        imgui.push_style_color(imgui.Col_.button_hovered, ImVec4(*ACCENT_HOVER))
        imgui.push_style_color(imgui.Col_.button_active, ImVec4(*ACCENT_ACTIVE))
        imgui.push_style_color(imgui.Col_.text, ImVec4(*DARK))
    pressed = bool(imgui.button(label, ImVec2(width, 0)))
    if primary:
        imgui.pop_style_color(4)
    return pressed


def cancel_pressed() -> bool:
    """Whether Escape was pressed."""
    return bool(imgui.is_key_pressed(imgui.Key.escape, False))


def confirm_pressed() -> bool:
    """Whether an Enter key was pressed, and not to use the button that the keyboard is at."""
    io = imgui.get_io()
    at_item = io.nav_visible and imgui.is_any_item_focused() and not io.want_text_input
    return not at_item and enter_key_pressed()


def enter_key_pressed() -> bool:
    """Whether one of the Enter keys was pressed."""
    keys = (imgui.Key.enter, imgui.Key.keypad_enter)
    return any(imgui.is_key_pressed(key, False) for key in keys)


def close_popup() -> None:
    """Close the popup; keys belong to the canvas again."""
    imgui.close_current_popup()
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)
