"""The page of preferences: the language, and the keys of all commands, which can be changed."""

from collections.abc import Sequence

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ... import words
from ...words import mark, tr
from .. import theme, widgets
from ..app_state import AppState
from ..commands.command import Command
from ..commands.keymap import KEYMAP, pressed_chord, shown_chord
from ..commands.synonyms import has_synonym
from ..theme import ACCENT, SECONDARY

_WIDTH, _HEIGHT = 620, 380  # of the list, at most, in design points
_OTHER_HEIGHT = 240  # of everything around the list, in design points
_NAME_WIDTH = 270  # design points
_HINT = mark("Type a few letters of a command")
_LANGUAGES = ("", *words.LANGUAGES)  # the first one: the system's


class PreferencesPage:
    """Lists commands with their keys. A click on a key, or on the plus, waits for the new one."""

    def __init__(self) -> None:
        self.is_open = False
        self._commands: Sequence[Command] = ()
        self._query, self._note = "", ""
        self._awaited: tuple[Command, int] | None = None  # a command, and the index of the key to replace

    def open(self, commands: Sequence[Command]) -> None:
        """Show the page. commands: those that it lists."""
        self.is_open, self._commands = True, sorted(commands, key=lambda command: command.name)
        self._query = self._note = ""
        self._awaited = None

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        if not widgets.begin_dialog("Preferences"):
            return
        was_awaiting, size = self._awaited is not None, _list_size(scale)
        self._read_key(state)
        self._draw_language(state)
        imgui.set_next_item_width(size.x)
        imgui.begin_disabled(was_awaiting)
        if imgui.is_window_appearing():
            imgui.set_keyboard_focus_here()
        _, self._query = imgui.input_text_with_hint("##query", tr(_HINT), self._query)
        imgui.end_disabled()
        imgui.begin_child("##keys", size, widgets.NAV_FLATTENED)
        for command in self._commands:
            is_named = self._query.lower() in command.name.lower()
            if is_named or has_synonym(self._query, command.name, command.label):
                self._draw_command(state, command, scale)
        imgui.end_child()
        waiting = tr("Press the new key, or Esc to keep the old one")
        note = waiting if self._awaited is not None else self._note
        imgui.text_colored(ImVec4(*ACCENT), widgets.shortened(note, size.x))
        is_closed = widgets.button(tr("Close"), primary=True) or widgets.cancel_pressed()
        imgui.same_line()
        if widgets.button(tr("Reset All Keys")) and not was_awaiting:
            KEYMAP.reset()
            self._store(state, tr("All commands have their first keys again"))
        if is_closed and not was_awaiting:
            self.is_open = False
            widgets.close_popup()
        imgui.end_popup()

    def _draw_language(self, state: AppState) -> None:
        """Draw the choice of the language, which takes effect at once."""
        widgets.label(tr("Language"), 10 * imgui.get_font_size())
        imgui.set_next_item_width(widgets.FULL)
        own = words.LANGUAGES[words.system_language()]
        labels = [tr("System ({language})", language=own), *words.LANGUAGES.values()]
        chosen = state.preferences.language
        index = _LANGUAGES.index(chosen) if chosen in _LANGUAGES else 0
        is_changed, index = widgets.combo("##language", index, labels)
        if is_changed:
            state.preferences.language = _LANGUAGES[index]
            state.save_preferences()
            words.use_language(_LANGUAGES[index])
            self.open(self._commands)  # in the order of their new names
            # its signs may have other shapes in another language
            state.run_after_frame(lambda: theme.load_fonts(theme.system_fonts()))

    def _draw_command(self, state: AppState, command: Command, scale: float) -> None:
        """Draw the name of a command, a button for each of its keys, and one that adds a key."""
        is_changed = KEYMAP.is_changed(command.label)
        imgui.align_text_to_frame_padding()
        name = widgets.shortened(command.name, (_NAME_WIDTH - 10) * scale)
        imgui.text_colored(ImVec4(*(ACCENT if is_changed else SECONDARY)), name)
        imgui.same_line(_NAME_WIDTH * scale)
        chords = command.active_chords
        for index, chord in enumerate(chords):
            label = "..." if self._awaited == (command, index) else shown_chord(chord)
            if imgui.button(f"{label}###key {index} of {command.label}"):
                self._awaited = command, index
            widgets.show_tooltip(tr("Click for another key, right-click to remove this one"))
            if imgui.is_item_clicked(imgui.MouseButton_.right):
                self._change(state, command, (*chords[:index], *chords[index + 1 :]))
            imgui.same_line(0, 4 * scale)
        label = "..." if self._awaited == (command, len(chords)) else "+"
        if imgui.button(f"{label}###key {len(chords)} of {command.label}"):
            self._awaited = command, len(chords)
        widgets.show_tooltip(tr("Add a key"))
        if is_changed:
            imgui.same_line(0, 4 * scale)
            if imgui.button(f"{icons.ICON_FA_ARROW_ROTATE_LEFT}###reset {command.label}"):
                self._change(state, command, command.chords)
            widgets.show_tooltip(tr("The first keys of this command"))

    def _read_key(self, state: AppState) -> None:
        """Take the pressed key for the command that waits for one; Esc ends the wait."""
        if self._awaited is None:
            return
        if imgui.is_key_pressed(imgui.Key.escape, False):
            self._awaited = None
            return
        chord = pressed_chord()
        if chord is None:
            return
        (command, index), self._awaited = self._awaited, None
        chords = list(command.active_chords)
        chords[index : index + 1] = [chord]
        self._change(state, command, tuple(dict.fromkeys(map(int, chords))))

    def _change(self, state: AppState, command: Command, chords: tuple[int, ...]) -> None:
        """Give a command its keys; a command that had one of them loses it, and the page says so."""
        taken = []
        for other in self._commands:
            kept = tuple(chord for chord in other.active_chords if int(chord) not in set(map(int, chords)))
            if other is not command and len(kept) < len(other.active_chords):
                KEYMAP.change(other.label, kept, other.chords)
                taken.append(other.name)
        KEYMAP.change(command.label, chords, command.chords)
        self._store(state, tr("Taken from {commands}", commands=", ".join(taken)) if taken else "")

    def _store(self, state: AppState, note: str) -> None:
        self._note = note
        state.preferences.put("keys", KEYMAP.to_json())
        state.save_preferences()


def _list_size(scale: float) -> ImVec2:
    """The size of the list, points: of whole rows that have room. scale: points per design point."""
    room, row = imgui.get_main_viewport().size, imgui.get_frame_height_with_spacing()
    width = min(_WIDTH * scale, room.x - 4 * imgui.get_style().window_padding.x)
    height = min(_HEIGHT * scale, room.y - _OTHER_HEIGHT * scale)
    return ImVec2(width, max(1, height // row) * row - imgui.get_style().item_spacing.y)
