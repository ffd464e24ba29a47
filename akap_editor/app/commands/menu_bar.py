"""The menu bar, for mouse and keyboard: F10, or Alt and a letter of a menu's name, opens a menu."""

from collections.abc import Sequence
from string import ascii_lowercase

from imgui_bundle import imgui

from ...display_text import display_text
from ...words import tr_in
from .. import files, widgets
from ..app_state import AppState
from .command import ALT, CommandGroup, MenuItem, Submenu
from .registry import MENUS

_MAX_NAME_WIDTH = 24  # of a file, times the font size
_NAMES = [name for name, _ in MENUS]


def draw(state: AppState) -> None:
    """Draw the bar and the open menu."""
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    is_shown = imgui.begin_main_menu_bar()
    imgui.pop_style_var()
    if not is_shown:
        return
    requested = _requested_by_key()
    for name, items in MENUS:
        if imgui.begin_menu(tr_in("menu", name)):
            takes_arrows = [_draw_item(state, item) for item in items]
            if not any(takes_arrows) and imgui.is_window_focused():
                requested = _neighbor_by_key(name)
            imgui.end_menu()
    if requested:
        imgui.internal.nav_move_request_cancel()  # otherwise ImGui would leave the menus
        imgui.open_popup(tr_in("menu", requested))
        imgui.set_nav_cursor_visible(True)  # otherwise Enter would not run the first line
    imgui.end_main_menu_bar()


def _requested_by_key() -> str:
    """The name of the menu whose key was pressed; empty if there is none."""
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup) or imgui.get_io().want_text_input:
        return ""
    if imgui.is_key_pressed(imgui.Key.f10, False) and not imgui.get_io().key_shift:  # opens context menus
        return _NAMES[0]
    letters = access_letters([tr_in("menu", name) for name in _NAMES])
    for name, letter in zip(_NAMES, letters, strict=True):
        if letter and imgui.is_key_chord_pressed(ALT | imgui.Key[letter]):
            return name
    return ""


def access_letters(names: Sequence[str]) -> list[str]:
    """For each menu the letter that opens it with Alt: its first one that no menu before has; empty: none."""
    letters: list[str] = []
    for name in names:
        free = (each for each in name.lower() if each in ascii_lowercase and each not in letters)
        letters.append(next(free, ""))
    return letters


def _neighbor_by_key(name: str) -> str:
    """The menu to the left or right of an open one, if the arrow key was pressed; otherwise empty."""
    for key, step in ((imgui.Key.left_arrow, -1), (imgui.Key.right_arrow, 1)):
        if imgui.is_key_pressed(key):
            return _NAMES[(_NAMES.index(name) + step) % len(_NAMES)]
    return ""


def _draw_item(state: AppState, item: MenuItem) -> bool:
    """Draw a line of a menu; return whether it uses the arrow keys itself, to open or leave a submenu."""
    if item is None:
        imgui.separator()
    elif isinstance(item, Submenu):
        return _draw_submenu(state, item)
    elif isinstance(item, CommandGroup):
        return _draw_group(state, item)
    elif imgui.menu_item(item.text, item.key_name, item.is_checked(state), item.enabled(state))[0]:
        widgets.run(state, item)
    return False


def _draw_group(state: AppState, group: CommandGroup) -> bool:
    """Draw a submenu of commands; return whether it uses the arrow keys."""
    is_open = imgui.begin_menu(group.text)
    if is_open:
        for command in group.commands:
            _draw_item(state, command)
        imgui.end_menu()
    return is_open or imgui.is_item_focused()


def _draw_submenu(state: AppState, item: Submenu) -> bool:
    """Draw a submenu and its files; return whether it uses the arrow keys."""
    entries = item.files(state)
    is_open = imgui.begin_menu(item.text, bool(entries))
    if is_open:
        room = _MAX_NAME_WIDTH * imgui.get_font_size()
        for index, (name, path) in enumerate(entries):
            if imgui.menu_item_simple(f"{widgets.as_label(widgets.shortened(name, room))}###{index}"):
                files.open_path(state, path)
            widgets.show_tooltip(display_text(path))
        imgui.end_menu()
    return is_open or (bool(entries) and imgui.is_item_focused())
