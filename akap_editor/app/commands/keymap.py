"""Keys: their names, and the keys of commands that the user has changed."""

from collections.abc import Mapping
from functools import cache

from imgui_bundle import imgui

from ...words import mark, tr

Key = imgui.Key


class Modifier(int):
    """A modifier key; ``CTRL | Key.s`` is a chord.

    Python before 3.11.4 cannot combine members of ImGui's enumeration, whose values have several bits.
    """

    def __or__(self, other: int) -> "Modifier":
        return Modifier(int(self) | int(other))


CTRL, SHIFT, ALT = map(Modifier, (Key.mod_ctrl, Key.mod_shift, Key.mod_alt))
_MODIFIERS = {mark("Ctrl"): CTRL, mark("Alt"): ALT, mark("Shift"): SHIFT}
_KEY_NAMES = {
    "named_key_begin": mark("Tab"),  # another name of the same key
    "delete": mark("Del"),
    "equal": "=",
    "minus": "-",
    "left_bracket": "[",
    "right_bracket": "]",
    "comma": ",",
    "period": ".",
    "left_arrow": mark("Left"),
    "right_arrow": mark("Right"),
    "up_arrow": mark("Up"),
    "down_arrow": mark("Down"),
    "page_up": mark("PgUp"),
    "page_down": mark("PgDn"),
    "keypad_add": mark("Keypad +"),
    "keypad_subtract": mark("Keypad -"),
}
_NAMED_KEYS = (mark("Space"), mark("Enter"), mark("Backspace"), mark("Home"), mark("End"), mark("Insert"))
# The keys that a command may have: no modifiers, buttons of the mouse or keys that end a dialog.
_LAST_NAMED = int(Key.oem102)
_NO_COMMAND = ("left_ctrl", "left_shift", "left_alt", "left_super", "right_ctrl", "right_shift", "right_alt")
KEYS = tuple(
    int(key)
    for key in Key
    if int(Key.tab) <= int(key) <= _LAST_NAMED and key.name not in (*_NO_COMMAND, "right_super", "escape")
)


def _key_name(key: int) -> str:
    name = str(Key(key).name)
    if name in _KEY_NAMES:
        return _KEY_NAMES[name]
    name = name.removeprefix("_").replace("_", " ")
    return name.upper() if len(name) == 1 else name.capitalize()


_KEYS_BY_NAME = {_key_name(key): key for key in KEYS}
_IMGUI_KEYS = tuple(map(Key, KEYS))


@cache  # asked for dozens of times a frame
def _chord_parts(chord: int) -> tuple[str, ...]:
    """The names of a chord's modifiers and of its key, in English."""
    parts, chord = [], int(chord)
    for name, modifier in _MODIFIERS.items():
        if chord & int(modifier):
            parts.append(name)
            chord &= ~int(modifier)
    return *parts, _key_name(chord)


def chord_name(chord: int) -> str:
    """The name of a chord in English, e.g. "Ctrl+Shift+S", by which the preferences store it."""
    return "+".join(_chord_parts(chord))


def shown_chord(chord: int) -> str:
    """The name of a chord as keyboards of the user's language show it."""
    return "+".join(map(tr, _chord_parts(chord)))


def chord_named(name: str) -> int | None:
    """The chord of a name; None if there is none."""
    chord, rest = 0, name
    for modifier_name, modifier in _MODIFIERS.items():
        if rest.startswith(f"{modifier_name}+"):
            chord |= int(modifier)
            rest = rest.removeprefix(f"{modifier_name}+")
    key = _KEYS_BY_NAME.get(rest)
    return None if key is None else chord | key


def is_any_pressed() -> bool:
    """Whether a key of commands was pressed in this frame, or repeats, or a character was typed."""
    return bool(imgui.get_io().input_queue_characters) or any(map(imgui.is_key_pressed, _IMGUI_KEYS))


def pressed_chord() -> int | None:
    """The key that was pressed in this frame, with its modifiers; None if there is none."""
    io = imgui.get_io()
    held = ((io.key_ctrl, CTRL), (io.key_shift, SHIFT), (io.key_alt, ALT))
    modifiers = sum(int(modifier) for is_held, modifier in held if is_held)
    return next((modifiers | key for key in KEYS if imgui.is_key_pressed(Key(key), False)), None)


class Keymap:
    """The chords of commands that differ from those of the table, by label."""

    def __init__(self) -> None:
        self._changed: dict[str, tuple[int, ...]] = {}

    def chords(self, label: str, default: tuple[int, ...]) -> tuple[int, ...]:
        """The chords of a command; ``default`` itself unless they were changed."""
        return self._changed.get(label, default)

    def is_changed(self, label: str) -> bool:
        """Whether a command has other chords than in the table."""
        return label in self._changed

    def change(self, label: str, chords: tuple[int, ...], default: tuple[int, ...]) -> None:
        """Give a command other chords; those of the table are no change."""
        self._changed.pop(label, None)
        if tuple(map(int, chords)) != tuple(map(int, default)):
            self._changed[label] = tuple(map(int, chords))

    def reset(self) -> None:
        """Return to the chords of the table."""
        self._changed.clear()

    def to_json(self) -> dict[str, list[str]]:
        """The changed chords by their names, for the preferences."""
        return {label: [chord_name(chord) for chord in chords] for label, chords in self._changed.items()}

    def restore(self, stored: Mapping[str, object], table: Mapping[str, tuple[int, ...]]) -> None:
        """Take over what `to_json` returned; whatever makes no sense is ignored.

        table: the chords of all commands. One that another version of the table has given to a command goes
        to the command for which the user chose it.
        """
        self.reset()
        for label, names in stored.items():
            if isinstance(names, list):
                chords = [chord_named(name) for name in names if isinstance(name, str)]
                self._changed[label] = tuple(chord for chord in chords if chord is not None)
        chosen = {chord for label in self._changed if label in table for chord in self._changed[label]}
        for label, default in table.items():
            if label not in self._changed and chosen & set(map(int, default)):
                self._changed[label] = tuple(int(chord) for chord in default if int(chord) not in chosen)


KEYMAP = Keymap()  # of this program; the preferences store it
