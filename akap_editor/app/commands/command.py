"""Commands and submenus: what menus, toolbar, keyboard and palette run."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui

from ...words import tr
from ..app_state import AppState
from .keymap import ALT, CTRL, KEYMAP, SHIFT, Key, chord_name, shown_chord

__all__ = ["ALT", "CTRL", "SHIFT", "Command", "CommandGroup", "Key", "Menu", "Submenu", "chord_name"]

CONTEXT_MENU_KEYS = (SHIFT | Key.f10, Key.menu)
_NAVIGATION_KEYS = frozenset(
    int(key)
    for key in (
        *(Key.left_arrow, Key.right_arrow, Key.up_arrow, Key.down_arrow),
        *(Key.page_up, Key.page_down, Key.home, Key.end, Key.enter, Key.keypad_enter),
        *(Key.f10, Key.menu, Key.tab),
    )
)


def always(_: AppState) -> bool:
    """Enable a command at any time."""
    return True


def has_drawing(state: AppState) -> bool:
    """Whether a drawing is open."""
    return state.document is not None


@dataclass(frozen=True)
class Command:
    """Something that the user can run.

    label: in English, which also identifies it, "..." at its end if it opens a dialog; chords: keys, the
    first one is shown; icon: in the toolbar; enabled: whether it can be run now; checked: for a switch,
    whether it is on; typed: a character that runs it, too, wherever a keyboard has it; repeats: whether it
    runs repeatedly while its key is held; missing: a sentence (`mark`) for the status bar if its key is
    pressed while it cannot be run.
    """

    label: str
    run: Callable[[AppState], None]
    chords: tuple[int, ...] = ()
    icon: str = ""
    enabled: Callable[[AppState], bool] = always
    checked: Callable[[AppState], bool] | None = None
    typed: str = ""
    repeats: bool = False
    missing: str = ""

    @property
    def text(self) -> str:
        """The label in the user's language."""
        return tr(self.label)

    @property
    def name(self) -> str:
        """The label in the user's language, without the dots."""
        return self.text.rstrip(".…")

    @property
    def key_name(self) -> str:
        """The first key in words, e.g. "Ctrl+Shift+S", in the user's language; empty if there is none."""
        if self.typed and not KEYMAP.is_changed(self.label):
            return self.typed
        return shown_chord(self.active_chords[0]) if self.active_chords else ""

    @property
    def active_chords(self) -> tuple[int, ...]:
        """Its keys: those that the user has chosen, or else ``chords``."""
        return KEYMAP.chords(self.label, self.chords)

    def is_checked(self, state: AppState) -> bool:
        """Whether it is a switch that is on."""
        return self.checked is not None and self.checked(state)

    def is_pressed(self) -> bool:
        """Whether one of its keys was pressed in this frame."""
        is_typed = self.typed and not KEYMAP.is_changed(self.label)
        if is_typed and ord(self.typed) in imgui.get_io().input_queue_characters:
            return True
        return any(_is_chord_pressed(int(chord), self.repeats) for chord in self.active_chords)


@dataclass(frozen=True)
class Submenu:
    """A menu of files to open. label: in English; files: returns the name and the path of each."""

    label: str
    files: Callable[[AppState], list[tuple[str, Path]]]

    @property
    def text(self) -> str:
        """The label in the user's language."""
        return tr(self.label)


@dataclass(frozen=True)
class CommandGroup:
    """A submenu of commands. label: in English; commands: None is a separator."""

    label: str
    commands: tuple[Command | None, ...]

    @property
    def text(self) -> str:
        """The label in the user's language."""
        return tr(self.label)


MenuItem = Command | Submenu | CommandGroup | None  # None: a separator
Menu = tuple[str, tuple[MenuItem, ...]]  # its name and its lines


def commands_and_files(items: Iterable[MenuItem]) -> Iterator[Command | Submenu]:
    """The lines of a menu without separators, groups replaced by their commands."""
    for item in items:
        if isinstance(item, CommandGroup):
            yield from (command for command in item.commands if command is not None)
        elif item is not None:
            yield item


def context_menu_pressed() -> bool:
    """Whether a key was pressed that opens the context menu of the focused item."""
    return any(imgui.is_key_chord_pressed(int(chord)) for chord in CONTEXT_MENU_KEYS)


def _is_chord_pressed(chord: int, repeats: bool) -> bool:
    """Whether a chord was pressed in this frame, except for keys that are moving the focus in a panel."""
    if chord & ~int(Key.mod_mask_) in _NAVIGATION_KEYS and imgui.get_io().nav_visible:
        return False
    flags = imgui.InputFlags_.repeat if repeats else imgui.InputFlags_.none
    return imgui.internal.is_key_chord_pressed(chord, int(flags))
