"""What a command is: a name, what it does and when, and its keys."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui

from .workspace import Workspace

CTRL, SHIFT = imgui.Key.mod_ctrl, imgui.Key.mod_shift
Key = imgui.Key


def always(_: Workspace) -> bool:
    """Of a command that can be given at any time."""
    return True


@dataclass(frozen=True)
class Command:
    """label: as in menus; chords: keys, the first one is shown; checked: of a switch, whether it is on.

    typed: a character in place of a key, since where it is on the keyboard differs between countries.
    """

    label: str
    run: Callable[[Workspace], None]
    chords: tuple[int, ...] = ()
    icon: str = ""
    enabled: Callable[[Workspace], bool] = always
    checked: Callable[[Workspace], bool] | None = None
    typed: str = ""

    @property
    def key_name(self) -> str:
        """The first key in words, e.g. "Ctrl+Shift+S"."""
        return self.typed or (chord_name(self.chords[0]) if self.chords else "")

    def is_pressed(self) -> bool:
        """Whether one of its keys was pressed in this frame."""
        if self.typed and ord(self.typed) in imgui.get_io().input_queue_characters:
            return True
        return any(imgui.is_key_chord_pressed(int(chord)) for chord in self.chords)


@dataclass(frozen=True)
class Submenu:
    """A menu of files to open; files: what each is called, and its path."""

    label: str
    files: Callable[[Workspace], list[tuple[str, Path]]]


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
