"""The command palette: which entries match, in which order, and how it is used."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.commands.command import CTRL, SHIFT, Key
from akap_editor.app.commands.palette import Entry, Palette, entries, match, ranked
from akap_editor.app.commands.registry import COMMANDS, PALETTE_ITEMS
from akap_editor.app.commands.synonyms import SYNONYMS


def order(query, *labels):
    return [entry.label for entry, _ in ranked(query, [Entry(label, print) for label in labels])]


@pytest.mark.parametrize(
    ("query", "best", "other"),
    [
        ("sa", "Save As", "Deselect All"),
        ("undo", "Undo", "Round Corners Down"),
        ("sm", "Show Mesh", "Dismiss Message"),
        ("fit", "Fit in Window", "Find It"),
        ("save", "Save", "Save Recording"),
        ("exp", "Export PNG", "Select All Pins"),
    ],
)
def test_the_better_fit_comes_first(query, best, other):
    assert order(query, other, best)[0] == best
    assert order(query.upper(), best, other)[0] == best


@pytest.mark.parametrize("query", ["xq", "pans", "saves"])
def test_letters_that_are_not_there_in_order_do_not_fit(query):
    assert match(query, "Snap") is None


def test_the_places_are_those_of_the_letters():
    label = "Remove Selected Pins"
    score, places = match("rem pins", label)
    assert "".join(label[place] for place in places).lower() == "rempins"
    assert places == (0, 1, 2, 16, 17, 18, 19)
    assert list(places) == sorted(set(places))
    assert score > match("rvlpis", label)[0]


@pytest.mark.parametrize(
    ("query", "expected"),
    [
        ("smooth", "Remember Rest Shape"),
        ("puppet", "Pin Tool"),
        ("warp", "Pin Tool"),
        ("export gif", "Export Animation"),
        ("gif", "Export Animation"),
        ("hotkeys", "Keyboard Shortcuts"),
        ("wireframe", "Show Mesh"),
        ("png", "Export"),
        ("select none", "Deselect"),
        ("magn", "Zoom Tool"),
    ],
)
def test_words_of_other_programs_find_commands(pinned, query, expected):
    found = [entry.label for entry, _ in ranked(query, entries(pinned.state, PALETTE_ITEMS))]
    assert expected in found[:3]


def test_every_synonym_is_that_of_a_command():
    assert set(SYNONYMS) <= {command.name for command in COMMANDS}


@pytest.mark.parametrize("query", ["", "o", "cat", "op", "show", "a"])
def test_commands_come_before_drawings(pinned, query):
    listed = [entry for entry, _ in ranked(query, entries(pinned.state, PALETTE_ITEMS)) if entry.enabled]
    kinds = [entry.is_file for entry in listed]
    assert kinds == sorted(kinds)
    assert listed


def test_without_a_query_all_is_listed_in_the_order_of_the_menus(pinned):
    found = entries(pinned.state, PALETTE_ITEMS)
    listed = [entry for entry, _ in ranked(" ", found)]
    assert len(listed) == len(found)
    commands = [entry for entry in found if entry.enabled and not entry.is_file]
    assert [entry for entry in listed if entry.enabled][: len(commands)] == commands
    states = [entry.enabled for entry in listed]
    assert states == sorted(states, reverse=True), "what makes no sense now comes last"


def test_every_command_is_in_the_palette_with_its_key(pinned):
    found = {entry.label: entry for entry in entries(pinned.state, PALETTE_ITEMS)}
    for command in COMMANDS:
        assert found[command.label.rstrip(".")].key == command.key_name
    assert "Open Bundled Drawing: Cat" in found


def type_into_palette(ui, chord, text, *keys):
    def act(hand):
        hand.key_press(int(chord))
        hand.yield_(3)
        hand.key_chars(text)
        hand.yield_(2)
        for key in keys:
            hand.key_press(int(key))
            hand.yield_(2)

    ui.do(act)


@pytest.mark.parametrize("chord", [CTRL | Key.k, Key.f3])
def test_a_command_is_found_and_run(pinned, chord):
    type_into_palette(pinned, chord, "shmesh", Key.enter)
    assert not pinned.state.part(Palette).is_open
    assert pinned.state.view.show_mesh
    pinned.key(SHIFT | Key.m)
    assert not pinned.state.view.show_mesh, "the keys are the canvas' again"


def test_arrows_choose_another_line(pinned):
    lines = [entry.label for entry, _ in ranked("sel", entries(pinned.state, PALETTE_ITEMS))]
    pinned.editor.select({2})
    assert lines.index("Select All Pins") == 0
    lines = [entry.label for entry, _ in ranked("sel", entries(pinned.state, PALETTE_ITEMS))]
    wanted = lines.index("Remove Selected Pins")
    assert 0 < wanted < len(lines) - 1
    keys = (Key.up_arrow, *[Key.down_arrow] * (wanted + 1), Key.up_arrow)
    type_into_palette(pinned, CTRL | Key.k, "sel", *keys, Key.enter)
    assert [pin.id for pin in pinned.pins] == [1, 3]


def test_escape_and_a_click_beside_it_close_it_and_run_nothing(pinned):
    before = pinned.document
    type_into_palette(pinned, Key.f3, "reset", Key.escape)
    assert not pinned.state.part(Palette).is_open

    def click_beside(hand):
        hand.key_press(Key.f3)
        hand.yield_(3)
        hand.mouse_move_to_pos(imgui.ImVec2(*pinned.empty_point))
        hand.mouse_click(0)

    pinned.do(click_beside)
    assert not pinned.state.part(Palette).is_open
    assert pinned.document is before


def test_what_makes_no_sense_now_is_listed_but_not_run(pinned):
    still_open = []

    def act(hand):
        hand.key_press(Key.f3)
        hand.yield_(3)
        hand.key_chars("reset pose")
        hand.yield_(2)
        hand.key_press(Key.enter)
        hand.yield_(2)
        still_open.append(pinned.state.part(Palette).is_open)

    pinned.do(act)
    assert still_open == [True]
    assert pinned.session.history.depth == 0


def test_no_query_breaks_it(pinned):
    for query in ("zzzz", "\\", "%s", "ÄÖ", "a" * 300, " ", "##"):
        type_into_palette(pinned, Key.f3, query, Key.down_arrow, Key.page_down, Key.page_up, Key.escape)
        assert not pinned.state.part(Palette).is_open
        assert not pinned.state.error


def test_a_drawing_is_opened_by_its_name(pinned):
    type_into_palette(pinned, Key.f3, "bundled bar", Key.enter)
    pinned.settle()
    assert pinned.document.drawing.name == "bar"
