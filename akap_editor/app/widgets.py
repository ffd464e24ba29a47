"""Widgets that panels and dialogs share; they hold no state themselves."""

import re
from bisect import bisect_left
from collections.abc import Callable, Sequence

from imgui_bundle import ImVec2, ImVec4, imgui

from ..editor.document.settings import Settings
from ..render.overlays import Rgba
from ..words import number_text, tr
from .app_state import AppState
from .commands.command import Command
from .theme import ACCENT, ACCENT_ACTIVE, ACCENT_HOVER, DARK, SECONDARY, STRONG_LINE, TEXT, packed

FULL = -imgui.FLT_MIN  # a width: all the available room
NAV_FLATTENED = imgui.ChildFlags_.nav_flattened  # keys move into a child window and out of it
_BAR = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_scrollbar
    | imgui.WindowFlags_.no_scroll_with_mouse
)
_DIALOG = imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_saved_settings
_PRINTF_NUMBER = re.compile(r"%(\+?(?:\.\d+)?[dfg])")
_MIN_NUMBER_WIDTH = 3.2  # beside a slider, times the font size, so that sliders have the same width
_SWITCH_PADDING = 0.18  # times the font size
_TOOLTIP_WIDTH = 22  # times the font size
_TITLE_WIDTH = 26  # of a dialog, at most, times the font size
_LABEL_GAP = 0.9  # between a column of labels and their fields, times the font size


def run(state: AppState, command: Command) -> None:
    """Run a command; an error becomes a message."""
    state.notice = ""
    state.run_reporting_errors(lambda: command.run(state))


def change_settings(state: AppState, settings: Settings) -> None:
    """Change method and parameters; an error becomes a message."""
    state.notice = ""
    state.run_reporting_errors(lambda: state.change_settings(settings))


# -- items --------------------------------------------------------------------------------------------------


def _push_switch_style(is_on: bool) -> None:
    """Make check boxes and radio buttons as high as their text; imgui.pop_style_var(2) must follow."""
    padding = _SWITCH_PADDING * imgui.get_font_size()
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(padding, padding))
    imgui.push_style_var(imgui.StyleVar_.frame_border_size, 1.0)
    imgui.push_style_color(imgui.Col_.border, ImVec4(*(ACCENT if is_on else STRONG_LINE)))


def switch(label: str, is_on: bool, tooltip: str = "") -> tuple[bool, bool]:
    """Draw a check box; return whether it was clicked, and whether it is on."""
    _push_switch_style(is_on)
    is_clicked, is_on = imgui.checkbox(label, is_on)
    imgui.pop_style_color()
    imgui.pop_style_var(2)
    show_tooltip(tooltip)
    return is_clicked, is_on


def icon_switch(icon: str, name: str, is_on: bool, tooltip: str, width: float) -> bool:
    """Draw an icon that is a switch, as high as a line of text; return whether it was clicked.

    width: times the font size.
    """
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(TEXT if is_on else SECONDARY)))
    imgui.push_style_color(imgui.Col_.button, ImVec4(0, 0, 0, 0))
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0, 0))
    size = ImVec2(width * imgui.get_font_size(), imgui.get_text_line_height())
    is_clicked = imgui.button(f"{icon}###{name}", size)
    imgui.pop_style_var()
    imgui.pop_style_color(2)
    show_tooltip(tooltip)
    return bool(is_clicked)


def switch_offset() -> float:
    """How much lower than other fields a switch must be drawn to be in line with them; points."""
    return float(imgui.get_style().frame_padding.y - _SWITCH_PADDING * imgui.get_font_size())


def radio(label: str, is_on: bool) -> bool:
    """Draw a radio button; return whether it was clicked."""
    _push_switch_style(is_on)
    imgui.push_style_color(imgui.Col_.check_mark, ImVec4(*ACCENT))
    is_clicked = imgui.radio_button(label, is_on)
    imgui.pop_style_color(2)
    imgui.pop_style_var(2)
    return bool(is_clicked)


def row(label: str, value: str, tooltip: str = "") -> None:
    """Draw a label at the left and its value at the right; a value that is too long is shortened."""
    right = imgui.get_content_region_avail().x + imgui.get_cursor_pos_x()
    imgui.text_colored(ImVec4(*SECONDARY), label)
    show_tooltip(tooltip)
    imgui.same_line()
    text = shortened(value, right - imgui.get_cursor_pos_x())
    imgui.set_cursor_pos_x(right - imgui.calc_text_size(text).x)
    imgui.text_unformatted(text)
    show_tooltip(value if text != value else "")


def slider(
    name: str,
    value: float,
    limits: tuple[float, float],
    text_format: str,
    flags: int = 0,
    tooltip: str = "",
    word: str = "",
    width: float = 0.0,
) -> tuple[bool, float, bool]:
    """Draw a slider with its number beside it.

    Returns whether it was moved, its value, and whether it was released after a change. text_format: of the
    number, as for printf; word: is shown instead of the number; width: of both in points, by default all the
    available room. ImGui itself would write the number over the knob, so it is drawn in a transparent color
    there.
    """
    font_size = imgui.get_font_size()
    number_width = max(imgui.calc_text_size(text_format % limits[1]).x, _MIN_NUMBER_WIDTH * font_size)
    room = number_width + 0.6 * font_size
    imgui.set_next_item_width(width - room)
    is_typing = imgui.internal.temp_input_is_active(imgui.get_id(name))
    imgui.push_style_color(imgui.Col_.text, ImVec4(*TEXT) if is_typing else ImVec4(0, 0, 0, 0))
    clamp = imgui.SliderFlags_.always_clamp
    is_moved, value = imgui.slider_float(name, value, *limits, text_format, clamp | flags)
    imgui.pop_style_color()
    is_released = imgui.is_item_deactivated_after_edit()
    show_tooltip(tooltip)
    text, right = word or number_with_unit(value, text_format), imgui.get_item_rect_max().x + room
    top = imgui.get_item_rect_min().y + imgui.get_style().frame_padding.y
    corner = ImVec2(right - imgui.calc_text_size(text).x, top)
    draw = imgui.get_window_draw_list()
    draw.add_text(corner, packed(TEXT), text)  # no item: the slider stays the last one
    return bool(is_moved), float(value), bool(is_released)


def number_with_unit(value: float, text_format: str) -> str:
    """A number as the current language writes it. text_format: as for printf, as in "%.1f px"."""
    text = _PRINTF_NUMBER.sub(lambda found: number_text(value, found[1]), text_format)
    return text.replace("%%", "%")


def number_in_language(
    name: str, text_format: str, draw: Callable[[], tuple[bool, float]]
) -> tuple[bool, float]:
    """Draw a field or slider of ImGui with its number as the current language writes it.

    draw: draws the item, of this name and with this printf format, and returns whether it changed, and its
    value. ImGui writes a point, so its number is transparent and this one is drawn over it. While a number is
    typed, ImGui's own text is shown, and ImGui takes a comma for a point.
    """
    is_own = number_with_unit(0.5, text_format) == text_format % 0.5
    if is_own or imgui.internal.temp_input_is_active(imgui.get_id(name)):
        return draw()
    imgui.push_style_color(imgui.Col_.text, ImVec4(0, 0, 0, 0))
    is_changed, value = draw()
    imgui.pop_style_color()
    text = number_with_unit(value, text_format)
    low, high, size = imgui.get_item_rect_min(), imgui.get_item_rect_max(), imgui.calc_text_size(text)
    corner = ImVec2((low.x + high.x - size.x) / 2, (low.y + high.y - size.y) / 2)
    imgui.get_window_draw_list().add_text(corner, imgui.get_color_u32(imgui.Col_.text), text)
    return is_changed, value


def combo(name: str, index: int, labels: Sequence[str]) -> tuple[bool, int]:
    """Draw a list that opens; return whether another entry was chosen, and its index.

    index: of the chosen entry, -1 for none. Its label is shortened to the room.
    """
    chosen, current = index, labels[index] if 0 <= index < len(labels) else ""
    room = imgui.calc_item_width() - imgui.get_frame_height() - 2 * imgui.get_style().frame_padding.x
    if imgui.begin_combo(name, shortened(current, room), imgui.ComboFlags_.height_largest):
        for number, label in enumerate(labels):
            imgui.push_id(number)
            if imgui.selectable(label, number == index)[0]:
                chosen = number
            if number == index:
                imgui.set_item_default_focus()
            imgui.pop_id()
        imgui.end_combo()
    return chosen != index, chosen


def color(name: str, value: tuple[float, float, float]) -> tuple[float, float, float]:
    """Draw a field that opens a color picker; return the color."""
    flags = imgui.ColorEditFlags_.no_inputs | imgui.ColorEditFlags_.no_label
    _, (red, green, blue) = imgui.color_edit3(name, list(value), flags)
    return red, green, blue


def button(label: str, primary: bool = False) -> bool:
    """Draw a button of a dialog; return whether it was pressed. primary: the one that Enter presses."""
    width = max(imgui.calc_text_size(label, True).x + 2.5 * imgui.get_font_size(), 6 * imgui.get_font_size())
    if primary:
        imgui.push_style_color(imgui.Col_.button, ImVec4(*ACCENT))
        imgui.push_style_color(imgui.Col_.button_hovered, ImVec4(*ACCENT_HOVER))
        imgui.push_style_color(imgui.Col_.button_active, ImVec4(*ACCENT_ACTIVE))
        imgui.push_style_color(imgui.Col_.text, ImVec4(*DARK))
    is_pressed = bool(imgui.button(label, ImVec2(width, 0)))
    if primary:
        imgui.pop_style_color(4)
    return is_pressed


# -- text ---------------------------------------------------------------------------------------------------


def as_label(text: str) -> str:
    """A text as a label of ImGui, which shows all of it; in a label ImGui hides what follows ##."""
    return re.sub("#(?=#)", "#\u200b", text)


def secondary_text(text: str) -> None:
    """Draw a text in the secondary color, wrapped at the edge of the window."""
    imgui.push_text_wrap_pos(0.0)
    imgui.text_colored(ImVec4(*SECONDARY), text)
    imgui.pop_text_wrap_pos()


def paragraph(text: str, width: float, color: Rgba = TEXT) -> None:
    """Draw a text in lines of at most ``width`` points."""
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width)
    imgui.text_colored(ImVec4(*color), wrapped(text, width))
    imgui.pop_text_wrap_pos()


def wrapped(text: str, width: float) -> str:
    """A text in lines of at most ``width`` points, broken between words and between the parts of a path.

    ImGui would also break after a dot, as in "cat.akap". A single part that is too long is left to ImGui.
    """
    lines = [""]
    for piece in re.split(r"(?<=[/\\ \n])", text):
        if lines[-1].endswith("\n") or imgui.calc_text_size((lines[-1] + piece).rstrip()).x > width:
            lines.append("")
        lines[-1] += piece
    return "\n".join(line.strip() for line in lines if line)


def shortened(text: str, width: float, keeps_end: bool = False) -> str:
    """A text with an ellipsis instead of its end, or of its beginning, if it is longer than ``width`` points.

    keeps_end: for a path, whose end matters most.
    """
    if imgui.calc_text_size(text).x <= width:
        return text

    def cut(count: int) -> str:
        return f"…{text[len(text) - count :]}" if keeps_end else f"{text[:count].rstrip()}…"

    def is_too_long(count: int) -> bool:
        return bool(imgui.calc_text_size(cut(count)).x > width)

    return cut(bisect_left(range(1, len(text)), True, key=is_too_long))


# -- tooltips -----------------------------------------------------------------------------------------------


def show_tooltip(text: str) -> None:
    """Show a text, unless it is empty, while the pointer rests on the last item, also if it is disabled."""
    flags = imgui.HoveredFlags_.delay_normal | imgui.HoveredFlags_.allow_when_disabled
    if text and imgui.is_item_hovered(flags):
        _place_tooltip()
        imgui.begin_tooltip()
        paragraph(text, imgui.get_font_size() * _TOOLTIP_WIDTH)
        imgui.end_tooltip()


def _place_tooltip() -> None:
    """Place the next tooltip beside the side bar of the last item, so that it covers no other item."""
    window, viewport = imgui.internal.get_current_window_read().root_window, imgui.get_main_viewport()
    low, gap = imgui.get_item_rect_min(), 0.4 * imgui.get_font_size()
    match window.name:
        case "Tools":
            imgui.set_next_window_pos(ImVec2(window.pos.x + window.size.x + gap, low.y))
        case "Options":
            x = min(low.x, viewport.pos.x + viewport.size.x - _TOOLTIP_WIDTH * imgui.get_font_size())
            imgui.set_next_window_pos(ImVec2(max(x, 0.0), window.pos.y + window.size.y + gap))
        case "Panel" | "Tabs":
            imgui.set_next_window_pos(ImVec2(window.pos.x - gap, low.y), imgui.Cond_.always, ImVec2(1, 0))
        case "Timeline":
            x = min(low.x, viewport.pos.x + viewport.size.x - _TOOLTIP_WIDTH * imgui.get_font_size())
            imgui.set_next_window_pos(ImVec2(x, window.pos.y - gap), imgui.Cond_.always, ImVec2(0, 1))


def tooltip_due() -> float:
    """Seconds until the next tooltip appears; 0 if there is none to come."""
    context, delay = imgui.get_current_context(), imgui.get_style().hover_delay_normal
    if context.hover_item_delay_id == 0 or context.hover_item_delay_timer >= delay:
        return 0.0
    return float(delay - context.hover_item_delay_timer) + 0.01


# -- side bars and dialogs ----------------------------------------------------------------------------------


def side_bar(name: str, side: imgui.Dir, size: float, padding: ImVec2, flags: int = 0) -> bool:
    """Begin a panel at a side of the room that is left for the canvas; `imgui.end` must follow.

    size: width or height in points; flags: of ImGui, in addition. Returns whether its content is to be drawn.
    """
    imgui.push_style_var(imgui.StyleVar_.window_padding, padding)
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    is_shown = imgui.internal.begin_viewport_side_bar(
        name, imgui.get_main_viewport(), side, size, _BAR | flags
    )
    imgui.pop_style_var(3)
    return bool(is_shown)


def begin_dialog(title: str) -> bool:
    """Begin a dialog in the middle of the window, which dims everything else.

    title: in English, which also identifies it; it is shown in the user's language.
    Returns whether it is shown; if it is, `imgui.end_popup` must follow.
    """
    name = f"{shortened(tr(title), _TITLE_WIDTH * imgui.get_font_size())}###dialog {title}"
    if not imgui.is_popup_open(name):
        imgui.open_popup(name)
    viewport = imgui.get_main_viewport()
    imgui.set_next_window_pos(viewport.get_center(), imgui.Cond_.always, ImVec2(0.5, 0.5))
    room, viewport.work_size = viewport.work_size, viewport.size  # or else ImGui limits it to the canvas
    style, font_size = imgui.get_style(), imgui.get_font_size()
    # aligns the title with the content; in whole points, or else a gap is seen below the title
    padding = style.window_padding.x, (round(font_size + 3.2 * style.frame_padding.y) - font_size) / 2
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(*padding))
    is_shown = imgui.begin_popup_modal(name, None, _DIALOG)[0]
    imgui.pop_style_var()
    viewport.work_size = room
    return bool(is_shown)


def popup_is_open() -> bool:
    """Whether any menu, popup or dialog is open."""
    return bool(imgui.is_popup_open("", imgui.PopupFlags_.any_popup))


def label_column(*labels: str) -> float:
    """Where fields begin, points, so that the longest of the labels before them has room."""
    widest = max(imgui.calc_text_size(label).x for label in labels)
    return float(imgui.get_cursor_start_pos().x + widest + _LABEL_GAP * imgui.get_font_size())


def label(text: str, width: float, tooltip: str = "") -> None:
    """Draw the label of the field that is drawn next, which begins at ``width`` points.

    It begins further to the right if the label is longer.
    """
    start = imgui.get_cursor_pos_x()
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*SECONDARY), text)
    end = start + imgui.get_item_rect_size().x + 0.5 * imgui.get_font_size()
    show_tooltip(tooltip)
    imgui.same_line(max(width, end))
    imgui.align_text_to_frame_padding()


def switch_label(text: str, width: float) -> None:
    """Draw the label of the switch that is drawn next, which begins at ``width`` points."""
    label(text, width)
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + switch_offset())


def confirm_pressed() -> bool:
    """Whether Enter was pressed, except to press the button that has the keyboard focus."""
    io = imgui.get_io()
    presses_button = io.nav_visible and imgui.is_any_item_focused() and not io.want_text_input
    return not presses_button and enter_key_pressed()


def enter_key_pressed() -> bool:
    """Whether one of the two Enter keys was pressed."""
    keys = (imgui.Key.enter, imgui.Key.keypad_enter)
    return any(imgui.is_key_pressed(key, False) for key in keys)


def cancel_pressed() -> bool:
    """Whether Escape was pressed."""
    return bool(imgui.is_key_pressed(imgui.Key.escape, False))


def close_popup() -> None:
    """Close the popup or dialog and give the keyboard focus to the canvas."""
    imgui.close_current_popup()
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)
