"""What a command is: a name, what it does and when, and its keys."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui

from ..app_state import AppState

CTRL, SHIFT = imgui.Key.mod_ctrl, imgui.Key.mod_shift
Key = imgui.Key
MENU_KEYS = (SHIFT | Key.f10, Key.menu)
_WALKING = frozenset(
    int(key)
    for key in (
        *(Key.left_arrow, Key.right_arrow, Key.up_arrow, Key.down_arrow),
        *(Key.page_up, Key.page_down, Key.home, Key.end, Key.enter, Key.keypad_enter),
        *(Key.f10, Key.menu),
    )
)


def always(_: AppState) -> bool:
    """Of a command that can be given at any time."""
    return True


def has_drawing(state: AppState) -> bool:
    """Whether there is something to work on."""
    return state.document is not None


@dataclass(frozen=True)
class Command:
    """label: as in menus; chords: keys, the first one is shown; checked: of a switch, whether it is on.

    typed: a character in place of a key, since where it is on the keyboard differs between countries;
    repeats: whether it is run again and again while its key is held.
    """

    label: str
    run: Callable[[AppState], None]
    chords: tuple[int, ...] = ()
    icon: str = ""
    enabled: Callable[[AppState], bool] = always
    checked: Callable[[AppState], bool] | None = None
    typed: str = ""
    repeats: bool = False

    @property
    def key_name(self) -> str:
        """The first key in words, e.g. "Ctrl+Shift+S"."""
        return self.typed or (chord_name(self.chords[0]) if self.chords else "")

    def is_pressed(self) -> bool:
        """Whether one of its keys was pressed in this frame."""
        if self.typed and ord(self.typed) in imgui.get_io().input_queue_characters:
            return True
        return any(_is_pressed(int(chord), self.repeats) for chord in self.chords)


def _is_pressed(chord: int, repeats: bool) -> bool:
    """Keys that walk through a panel are left to it while one does that."""
    if chord & ~int(Key.mod_mask_) in _WALKING and imgui.get_io().nav_visible:
        return False
    flags = imgui.InputFlags_.repeat if repeats else imgui.InputFlags_.none
    return imgui.internal.is_key_chord_pressed(chord, int(flags))


def menu_key() -> bool:
    """Whether the menu is asked for by keys of what these have walked to."""
    return any(imgui.is_key_chord_pressed(int(chord)) for chord in MENU_KEYS)


@dataclass(frozen=True)
class Submenu:
    """A menu of files to open; files: what each is called, and its path."""

    label: str
    files: Callable[[AppState], list[tuple[str, Path]]]


Menu = tuple[str, tuple[Command | Submenu | None, ...]]  # its name and its lines; None: a separator

_KEY_NAMES = {
    "_0": "0",
    "_1": "1",
    "delete": "Del",
    "equal": "+",
    "minus": "-",
    "left_bracket": "[",
    "right_bracket": "]",
    "comma": ",",
    "period": ".",
    "left_arrow": "Left",
    "right_arrow": "Right",
    "up_arrow": "Up",
    "down_arrow": "Down",
    "page_up": "PgUp",
    "page_down": "PgDn",
}


def chord_name(chord: int) -> str:
    """A key chord as it is printed on the keys."""
    parts = []
    for mod, name in ((CTRL, "Ctrl"), (SHIFT, "Shift")):
        if chord & int(mod):
            parts.append(name)
            chord &= ~int(mod)
    name = str(Key(chord).name)
    return "+".join([*parts, _KEY_NAMES.get(name, name.upper() if len(name) == 1 else name.capitalize())])
