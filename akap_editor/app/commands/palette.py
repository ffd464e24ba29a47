"""The command palette: every command and bundled drawing, found by a few of its letters."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import ImVec2, imgui

from .. import files, widgets
from ..app_state import AppState
from ..theme import ACCENT, QUIET, TEXT, packed
from .command import Command, Submenu

_NAME = "##palette"
_FLAGS = imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_saved_settings
_WIDTH, _ROWS = 500, 10
_HINT = "Type a few letters of a command"
_STEPS = {
    imgui.Key.up_arrow: -1,
    imgui.Key.down_arrow: 1,
    imgui.Key.page_up: -_ROWS,
    imgui.Key.page_down: _ROWS,
}

# What a letter of the query is worth in a label.
_MATCH, _WORD_START, _IN_A_ROW, _SKIPPED = 1.0, 1.5, 1.7, 0.02


@dataclass(frozen=True)
class Entry:
    """One line of the palette: what it is called, how it is run, its key, whether that makes sense now."""

    label: str
    run: Callable[[AppState], None]
    key: str = ""
    enabled: bool = True


Found = tuple[Entry, tuple[int, ...]]


def entries(state: AppState, items: Iterable[Command | Submenu]) -> list[Entry]:
    """An entry for each command and each file of a submenu; only the last one of a label."""
    found = []
    for item in items:
        if isinstance(item, Submenu):
            for name, path in item.files(state):
                found.append(Entry(f"{item.label}: {name}", _opens(path)))
        else:
            found.append(_entry(item, state))
    return list({entry.label: entry for entry in found}.values())


def _opens(path: Path) -> Callable[[AppState], None]:
    return lambda state: files.open_path(state, path)


def _entry(command: Command, state: AppState) -> Entry:
    return Entry(command.label.rstrip("."), command.run, command.key_name, command.enabled(state))


def match(query: str, label: str) -> tuple[float, tuple[int, ...]] | None:
    """How well a label fits, and the places of the query's letters in it; None where they are not all there.

    The letters must come in order, case and spaces aside. Starts of words and letters in a row count more, so
    "sa" prefers "Save As" to "Deselect All". The best of all ways to place them is found, letter by letter.
    """
    letters, text = query.replace(" ", "").lower(), label.lower()
    best: list[tuple[float, tuple[int, ...]]] = [(0.0, ())]  # of the letters so far, by the last one's place
    for letter in letters:
        ways = []
        for place in (index for index, other in enumerate(text) if other == letter):
            worth = _MATCH + (_WORD_START if place == 0 or not text[place - 1].isalnum() else 0.0)
            earlier = [
                (score + (_IN_A_ROW if places and place == places[-1] + 1 else 0.0), places)
                for score, places in best
                if not places or places[-1] < place
            ]
            if earlier:
                score, places = max(earlier)
                ways.append((score + worth, (*places, place)))
        if not ways:
            return None
        best = ways
    score, places = max(best)
    return score - _SKIPPED * len(text), places


def ranked(query: str, found: list[Entry]) -> list[Found]:
    """The entries that fit, the best first, disabled ones last; with the places of the query's letters."""
    fitting = [(match(query, entry.label), entry) for entry in found]
    scored = [(fit[0], fit[1], entry) for fit, entry in fitting if fit is not None]
    if query.strip():
        scored.sort(key=lambda each: -each[0])
    scored.sort(key=lambda each: not each[2].enabled)
    return [(entry, places) for _, places, entry in scored]


class Palette:
    """The window's palette: what is typed, and which line is selected."""

    def __init__(self) -> None:
        self.is_open = False
        self.query = ""
        self._items: Sequence[Command | Submenu] = ()
        self._selected = 0
        self._is_new = False  # in its first frame, the key that opened it may still be pressed

    def open(self, items: Sequence[Command | Submenu], query: str = "") -> None:
        """Show the palette. items: all that it lists, in this order; query: the letters in its field."""
        self.is_open = self._is_new = True
        self.query, self._items, self._selected = query, items, 0

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame, if it is open. scale: points per design point."""
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
        is_changed, self.query = imgui.input_text_with_hint("##query", _HINT, self.query)
        found = ranked(self.query, entries(state, self._items))
        steps = [step for key, step in _STEPS.items() if imgui.is_key_pressed(key)]
        selected = 0 if is_changed else self._selected + sum(steps)
        self._selected = max(0, min(selected, len(found) - 1))
        entry = _list(found, self._selected, is_new or is_changed or bool(steps), scale)
        if found and widgets.enter_key_pressed() and not is_new:
            entry = found[self._selected][0]
        return entry if entry is not None and entry.enabled else None


def _begin(is_new: bool, scale: float) -> bool:
    """A box in the upper half of the window; False where a click beside it has closed it."""
    if is_new:
        imgui.open_popup(_NAME)
    viewport = imgui.get_main_viewport()
    top = viewport.work_pos.y + 0.12 * viewport.work_size.y
    imgui.set_next_window_pos(ImVec2(viewport.get_center().x, top), imgui.Cond_.always, ImVec2(0.5, 0))
    imgui.set_next_window_size(ImVec2(min(_WIDTH * scale, viewport.work_size.x), 0))
    return bool(imgui.begin_popup(_NAME, _FLAGS))


def _list(found: list[Found], chosen: int, scroll: bool, scale: float) -> Entry | None:
    """The lines; the one that was clicked, if any."""
    clicked = None
    line = imgui.get_text_line_height_with_spacing()
    imgui.begin_child("##found", ImVec2(0, _ROWS * line), 0, imgui.WindowFlags_.no_nav)
    imgui.set_cursor_pos_y(imgui.get_style().item_spacing.y / 2)  # room for the light around the first line
    if not found:
        widgets.secondary_text("No command has these letters in this order.")
    for index, (entry, places) in enumerate(found):
        at, room = imgui.get_cursor_screen_pos(), imgui.get_content_region_avail().x
        flags = 0 if entry.enabled else imgui.SelectableFlags_.disabled
        if imgui.selectable(f"##{entry.label}", index == chosen, flags)[0]:
            clicked = entry
        if index == chosen and scroll:
            imgui.set_scroll_here_y(0.5)
        _text(ImVec2(at.x + 6 * scale, at.y), entry, places)
        width = imgui.calc_text_size(entry.key).x
        draw = imgui.get_window_draw_list()
        draw.add_text(ImVec2(at.x + room - width - 8 * scale, at.y), packed(QUIET), entry.key)
    imgui.end_child()
    return clicked


def _text(at: ImVec2, entry: Entry, places: tuple[int, ...]) -> None:
    """A label, the letters that were asked for in the accent color."""
    draw, x = imgui.get_window_draw_list(), at.x
    plain = TEXT if entry.enabled else QUIET
    for index, letter in enumerate(entry.label):
        draw.add_text(ImVec2(x, at.y), packed(ACCENT if index in places else plain), letter)
        x = at.x + imgui.calc_text_size(entry.label[: index + 1]).x
