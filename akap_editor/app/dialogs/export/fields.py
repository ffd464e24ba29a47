"""Widgets that the export dialogs share: the list of formats, number fields, the background color."""

from collections.abc import Sequence
from typing import Protocol, TypeVar

from imgui_bundle import ImVec2, ImVec4, imgui

from ....editor.framing import Color
from ....words import tr
from ... import widgets
from ...theme import SECONDARY

LABEL_WIDTH = 104  # design points


class FileFormat(Protocol):
    """A row of a table of formats."""

    @property
    def label(self) -> str:
        """The name on the screen."""

    @property
    def suffix(self) -> str:
        """The ending of file names, with its dot; empty for a folder."""


F = TypeVar("F", bound=FileFormat)


def format_list(formats: Sequence[F], chosen: F, width: float, height: float) -> F:
    """Draw a list of formats with their file name endings; return the chosen one. Sizes in points."""
    imgui.begin_child("##formats", ImVec2(width, height), imgui.ChildFlags_.borders | widgets.NAV_FLATTENED)
    flags = imgui.SelectableFlags_.no_auto_close_popups
    for each in formats:
        right = imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x
        if imgui.selectable(tr(each.label), each is chosen, flags)[0]:
            chosen = each
        ending = each.suffix or tr("folder")
        imgui.same_line(right - imgui.calc_text_size(ending).x)
        imgui.text_colored(ImVec4(*SECONDARY), ending)
    imgui.end_child()
    return chosen


def number_field(
    label: str,
    value: float,
    limits: tuple[float, float],
    text_format: str,
    speed: float,
    width: float,
    scale: float,
    tooltip: str = "",
) -> float:
    """Draw a labeled number field that is dragged or typed into; return its value.

    limits: lowest and highest value; text_format: as for printf; speed: change per point of a drag; width: of
    the field in design points; tooltip: follows the hint how to use the field.
    """
    widgets.label(label, LABEL_WIDTH * scale)
    imgui.set_next_item_width(width * scale)
    clamp = imgui.SliderFlags_.always_clamp
    name = f"##{label}"
    _, value = widgets.number_in_language(
        name, text_format, lambda: imgui.drag_float(name, value, speed, *limits, text_format, clamp)
    )
    widgets.show_tooltip(f"{tr('Drag, or double-click to type.')} {tooltip}".strip())
    return float(value)


def preset_buttons(labels: Sequence[str], scale: float) -> int | None:
    """Draw small buttons to the right of a number field; return the index of the pressed one, or None."""
    pressed = None
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(7 * scale, imgui.get_style().frame_padding.y))
    for index, label in enumerate(labels):
        imgui.same_line(0, 5 * scale)
        if imgui.button(label):
            pressed = index
    imgui.pop_style_var()
    return pressed


def background_field(
    is_opaque: bool, color: Color, must_be_opaque: bool, tooltip: str, scale: float
) -> tuple[bool, Color]:
    """Draw the switch for an opaque background and its color; return both.

    must_be_opaque: the format has no transparency, so the switch is on and disabled; the returned setting
    is then the one that was given, and takes effect again with another format.
    """
    widgets.switch_label(tr("Background"), LABEL_WIDTH * scale)
    imgui.begin_disabled(must_be_opaque)
    clicked, shown = widgets.switch(tr("Color"), is_opaque or must_be_opaque, tooltip)
    imgui.end_disabled()
    if shown:
        imgui.same_line(0, 10 * scale)
        color = widgets.color("##background", color)
    return (shown if clicked else is_opaque), color
