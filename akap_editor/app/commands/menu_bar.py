"""The menu bar, by mouse and by keys: F10, or Alt and a menu's first letter, opens one."""

from imgui_bundle import imgui

from .. import files, widgets
from ..app_state import AppState
from .command import Command, Submenu
from .registry import MENUS

_LONGEST = 24  # times the font's size: what is shown of a file's name
_NAMES = [name for name, _ in MENUS]


def draw(state: AppState) -> None:
    """The bar, and the menu that is open."""
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    shown = imgui.begin_main_menu_bar()
    imgui.pop_style_var()
    if not shown:
        return
    wanted = _pressed()
    for name, items in MENUS:
        if imgui.begin_menu(name):
            in_submenu = [_item(state, item) for item in items]
            if not any(in_submenu) and imgui.is_window_focused():
                wanted = _neighbor(name)
            imgui.end_menu()
    if wanted:
        imgui.internal.nav_move_request_cancel()  # else ImGui would leave the menus
        imgui.open_popup(wanted)
        imgui.set_nav_cursor_visible(True)  # else Enter would not take the first line
    imgui.end_main_menu_bar()


def _pressed() -> str:
    """The menu whose key was pressed, or nothing."""
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup) or imgui.get_io().want_text_input:
        return ""
    if imgui.is_key_pressed(imgui.Key.f10, False) and not imgui.get_io().key_shift:  # for another menu
        return _NAMES[0]
    for name in _NAMES:
        if imgui.is_key_chord_pressed(int(imgui.Key.mod_alt | imgui.Key[name[0].lower()])):
            return name
    return ""


def _neighbor(name: str) -> str:
    """The menu beside an open one, if an arrow key asks for it."""
    for key, step in ((imgui.Key.left_arrow, -1), (imgui.Key.right_arrow, 1)):
        if imgui.is_key_pressed(key):
            return _NAMES[(_NAMES.index(name) + step) % len(_NAMES)]
    return ""


def _item(state: AppState, item: Command | Submenu | None) -> bool:
    """One line of a menu; whether arrow keys belong to it, as it leads or has led to a menu of its own."""
    if item is None:
        imgui.separator()
    elif isinstance(item, Submenu):
        return _submenu(state, item)
    else:
        checked = item.checked(state) if item.checked is not None else False
        if imgui.menu_item(item.label, item.key_name, checked, item.enabled(state))[0]:
            widgets.run(state, item)
    return False


def _submenu(state: AppState, item: Submenu) -> bool:
    entries = item.files(state)
    is_open = imgui.begin_menu(item.label, bool(entries))
    if is_open:
        room = _LONGEST * imgui.get_font_size()
        for index, (name, path) in enumerate(entries):
            if imgui.menu_item_simple(f"{widgets.shortened(name, room)}###{index}"):
                files.open_path(state, path)
            widgets.show_tooltip(str(path))
        imgui.end_menu()
    return is_open or (bool(entries) and imgui.is_item_focused())
