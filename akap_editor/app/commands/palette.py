"""The command palette: finds commands and files by a few of their letters."""

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import ImVec2, imgui

from ...words import mark, tr
from .. import files, widgets
from ..app_state import AppState
from ..theme import ACCENT, SECONDARY, TEXT, packed
from .command import Command, Submenu
from .synonyms import has_synonym

_NAME = "##palette"
_FLAGS = imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_saved_settings
_WIDTH, _ROWS = 500, 10  # design points; lines that are visible at once
_HINT = mark("Type a few letters of a command")
_SELECTION_STEPS = {
    imgui.Key.up_arrow: -1,
    imgui.Key.down_arrow: 1,
    imgui.Key.page_up: -_ROWS,
    imgui.Key.page_down: _ROWS,
}

# Scores of a letter of the query in a label, and the cost of a letter of the label.
_MATCH, _WORD_START, _CONSECUTIVE, _LENGTH_COST = 1.0, 1.5, 1.7, 0.02


@dataclass(frozen=True)
class Entry:
    """A line of the palette.

    key: of its command; enabled: whether it can be run now; is_file: whether it opens a file;
    english: its label in English, by which it is found, too.
    """

    label: str
    run: Callable[[AppState], None]
    key: str = ""
    enabled: bool = True
    is_file: bool = False
    english: str = ""


Match = tuple[Entry, tuple[int, ...]]  # an entry, and the indices of the query's letters in its label


def entries(state: AppState, items: Iterable[Command | Submenu]) -> list[Entry]:
    """An entry for each command and for each file of a submenu; one per label."""
    listed = []
    for item in items:
        if isinstance(item, Submenu):
            for name, path in item.files(state):
                listed.append(Entry(f"{item.text}: {name}", _opens(path), is_file=True))
        else:
            listed.append(
                Entry(item.name, item.run, item.key_name, item.enabled(state), english=item.label.rstrip("."))
            )
    return list({entry.label: entry for entry in listed}.values())


def _opens(path: Path) -> Callable[[AppState], None]:
    return lambda state: files.open_path(state, path)


def match(query: str, label: str) -> tuple[float, tuple[int, ...]] | None:
    """The score of a label and the indices of the query's letters in it; None if it does not match.

    The letters must occur in this order; case and spaces are ignored. Starts of words and consecutive letters
    score higher, so that "sa" prefers "Save As" to "Deselect All". Dynamic programming, letter by letter,
    finds the indices with the highest score.
    """
    letters, text = query.replace(" ", "").lower(), label.lower()
    best: list[tuple[float, tuple[int, ...]]] = [(0.0, ())]  # for each index of the letter before
    for letter in letters:
        candidates = []
        for index in (index for index, other in enumerate(text) if other == letter):
            score = _MATCH + (_WORD_START if index == 0 or not text[index - 1].isalnum() else 0.0)
            earlier = [
                (total + (_CONSECUTIVE if indices and index == indices[-1] + 1 else 0.0), indices)
                for total, indices in best
                if not indices or indices[-1] < index
            ]
            if earlier:
                total, indices = max(earlier)
                candidates.append((total + score, (*indices, index)))
        if not candidates:
            return None
        best = candidates
    total, indices = max(best)
    return total - _LENGTH_COST * len(text), indices


def ranked(query: str, candidates: list[Entry]) -> list[Match]:
    """The entries that match: commands before files, by their labels before by synonyms, disabled ones last.

    A label in which the query is a word or the beginning of one also ranks before a synonym; one in which the
    letters are only scattered comes after it.
    """
    found = []
    for entry in candidates:
        result = match(query, entry.label)
        is_synonym = has_synonym(query, entry.label, entry.english)
        if result is None and not is_synonym:
            continue
        score, letters = result or (0.0, ())
        is_together = re.search(rf"\b{re.escape(query.strip())}", entry.label, re.IGNORECASE) is not None
        kind = 0 if is_together else 1 if is_synonym else 2
        found.append(((not entry.enabled, entry.is_file, kind, -score), entry, letters))
    if query.strip():
        found.sort(key=lambda each: each[0])
    else:
        found.sort(key=lambda each: each[0][:2])
    return [(entry, letters) for _, entry, letters in found]


class Palette:
    """Knows what is typed and which line is selected."""

    def __init__(self) -> None:
        self.is_open = False
        self.query = ""
        self._items: Sequence[Command | Submenu] = ()
        self._selected = 0
        self._is_new = False  # in its first frame, the key that opened it may still be pressed

    def open(self, items: Sequence[Command | Submenu], query: str = "") -> None:
        """Show the palette. items: what it lists, in this order; query: the letters in its field."""
        self.is_open = self._is_new = True
        self.query, self._items, self._selected = query, items, 0

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame if it is open. scale: points per design point."""
        if not self.is_open:
            return
        is_new, self._is_new = self._is_new, False
        if not _begin(is_new, scale):
            self.is_open = False
            return
        entry = self._draw_content(state, is_new, scale)
        if entry is not None or (widgets.cancel_pressed() and not is_new):
            widgets.close_popup()
            self.is_open = False
        imgui.end_popup()
        if entry is not None:
            state.notice = ""
            state.run_reporting_errors(lambda: entry.run(state))

    def _draw_content(self, state: AppState, is_new: bool, scale: float) -> Entry | None:
        """Draw field and list; return the enabled entry that was chosen, if any."""
        if is_new:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(-1)
        is_changed, self.query = imgui.input_text_with_hint("##query", tr(_HINT), self.query)
        matches = ranked(self.query, entries(state, self._items))
        steps = [step for key, step in _SELECTION_STEPS.items() if imgui.is_key_pressed(key)]
        selected = 0 if is_changed else self._selected + sum(steps)
        self._selected = max(0, min(selected, len(matches) - 1))
        entry = _draw_list(matches, self._selected, is_new or is_changed or bool(steps), scale)
        if matches and widgets.enter_key_pressed() and not is_new:
            entry = matches[self._selected][0]
        return entry if entry is not None and entry.enabled else None


def _begin(is_new: bool, scale: float) -> bool:
    """Begin a popup in the upper half of the window; False after a click outside has closed it."""
    if is_new:
        imgui.open_popup(_NAME)
    viewport = imgui.get_main_viewport()
    top = viewport.work_pos.y + 0.12 * viewport.work_size.y
    imgui.set_next_window_pos(ImVec2(viewport.get_center().x, top), imgui.Cond_.always, ImVec2(0.5, 0))
    imgui.set_next_window_size(ImVec2(min(_WIDTH * scale, viewport.work_size.x), 0))
    return bool(imgui.begin_popup(_NAME, _FLAGS))


def _draw_list(matches: list[Match], selected: int, scrolls: bool, scale: float) -> Entry | None:
    """Draw the lines; return the one that was clicked, if any. scrolls: to the selected line."""
    clicked = None
    height = _ROWS * imgui.get_text_line_height_with_spacing()
    imgui.begin_child("##found", ImVec2(0, height), 0, imgui.WindowFlags_.no_nav)
    imgui.set_cursor_pos_y(imgui.get_style().item_spacing.y / 2)  # room for the highlight of the first line
    if not matches:
        widgets.secondary_text(tr("No command is called like that."))
    for index, (entry, letters) in enumerate(matches):
        corner, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
        flags = 0 if entry.enabled else imgui.SelectableFlags_.disabled
        if imgui.selectable(f"##{entry.label}", index == selected, flags)[0]:
            clicked = entry
        if index == selected and scrolls:
            imgui.set_scroll_here_y(0.5)
        _draw_label(ImVec2(corner.x + 6 * scale, corner.y), entry, letters)
        width = imgui.calc_text_size(entry.key).x
        key_corner = ImVec2(corner.x + room - width - 8 * scale, corner.y)
        imgui.get_window_draw_list().add_text(key_corner, packed(SECONDARY), entry.key)
    imgui.end_child()
    return clicked


def _draw_label(corner: ImVec2, entry: Entry, letters: tuple[int, ...]) -> None:
    """Draw a label with the letters at these indices in the accent color."""
    draw, x = imgui.get_window_draw_list(), corner.x
    color = TEXT if entry.enabled else SECONDARY
    for index, letter in enumerate(entry.label):
        draw.add_text(ImVec2(x, corner.y), packed(ACCENT if index in letters else color), letter)
        x = corner.x + imgui.calc_text_size(entry.label[: index + 1]).x
