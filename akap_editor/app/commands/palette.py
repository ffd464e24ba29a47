"""The command palette: every command and bundled drawing, found by a few of its letters."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import ImVec2, imgui

from .. import files, widgets
from ..app_state import AppState
from ..theme import ACCENT, QUIET, TEXT, packed
from .command import Command, Submenu
from .registry import COMMANDS, MENUS

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


def entries(state: AppState) -> list[Entry]:
    """All that can be run, in the order of the menus."""
    found = []
    for item in (*(item for _, items in MENUS for item in items), *COMMANDS):
        if isinstance(item, Submenu):
            for name, path in item.files(state):
                found.append(Entry(f"{item.label}: {name}", _opens(path)))
        elif item is not None:
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


def draw(state: AppState, scale: float) -> None:
    """One frame of the palette, if it is open."""
    palette = state.palette
    if palette is None:
        return
    is_new = not palette.shown  # the key that opened it may be pressed still
    palette.shown = True
    if not _begin(is_new, scale):
        state.palette = None
        return
    if is_new:
        imgui.set_keyboard_focus_here()
    imgui.set_next_item_width(-1)
    changed, palette.query = imgui.input_text_with_hint("##query", _HINT, palette.query)
    found = ranked(palette.query, entries(state))
    steps = [step for key, step in _STEPS.items() if imgui.is_key_pressed(key)]
    chosen = 0 if changed else palette.chosen + sum(steps)
    palette.chosen = max(0, min(chosen, len(found) - 1))
    picked = _list(found, palette.chosen, is_new or changed or bool(steps), scale)
    if found and widgets.enter_key_pressed() and not is_new:
        picked = found[palette.chosen][0]
    if picked is not None and not picked.enabled:
        picked = None
    if picked is not None or (widgets.cancel_pressed() and not is_new):
        widgets.close_popup()
        state.palette = None
    imgui.end_popup()
    if picked is not None:
        run = picked.run
        state.notice = ""
        state.run_reporting_errors(lambda: run(state))


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
