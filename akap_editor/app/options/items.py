"""The items of the options bar: buttons and labeled fields that look alike."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from imgui_bundle import ImVec4, imgui

from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..commands.command import Command
from ..theme import ACCENT, SECONDARY

FIELD_WIDTH = 5.2  # times the font size


@dataclass(frozen=True)
class Item:
    """A part of the bar that is kept together. name: unique among the items that are shown together."""

    name: str
    draw: Callable[[AppState], None]


def command_button(command: Command, label: str = "") -> Item:
    """A button that runs a command. label: in English, by default that of the command."""

    def draw(state: AppState) -> None:
        is_on = command.is_checked(state)
        if is_on:
            imgui.push_style_color(imgui.Col_.text, ImVec4(*ACCENT))
        imgui.begin_disabled(not command.enabled(state))
        shown = tr(label) if label else command.name
        shown = f"{command.icon}  {shown}" if command.icon else shown
        if imgui.button(f"{shown}###{command.label}"):
            widgets.run(state, command)
        imgui.end_disabled()
        if is_on:
            imgui.pop_style_color()
        key = f"  ({command.key_name})" if command.key_name else ""
        widgets.show_tooltip(f"{command.name}{key}" if key or label else "")

    return Item(command.label, draw)


def text(name: str, content: str) -> Item:
    """A text in the secondary color."""
    return Item(name, partial(_draw_text, content))


def _draw_text(content: str, state: AppState) -> None:
    imgui.text_colored(ImVec4(*SECONDARY), content)


def draw_label(label: str, tooltip: str = "") -> None:
    """Draw the label of the field that is drawn next."""
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*SECONDARY), label)
    widgets.show_tooltip(tooltip)
    imgui.same_line(0, 0.5 * imgui.get_font_size())
