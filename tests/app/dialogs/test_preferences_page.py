"""The page of preferences, where keys are changed."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.commands import registry
from akap_editor.app.commands.keymap import KEYMAP
from akap_editor.app.commands.shortcuts_page import groups
from akap_editor.app.dialogs.preferences_page import PreferencesPage

Key = imgui.Key


@pytest.fixture(autouse=True)
def keys_of_the_table():
    yield
    KEYMAP.reset()


@pytest.fixture
def page(pinned):
    """The page lists only the brush and the pin tool's command by their letters."""
    pinned.key(registry.PREFERENCES.chords[0])
    assert pinned.state.part(PreferencesPage).is_open
    return pinned


def change(ui, label, item, *chords):
    """Click an item in the row of a command, then press keys."""

    def act(hand):
        hand.item_input("//Preferences###dialog Preferences/##query")
        hand.key_chars_replace(label)
        hand.yield_(2)
        hand.item_click(f"//Preferences###dialog Preferences/**/###{item} {label}")
        hand.yield_(2)
        for chord in chords:
            hand.key_press(int(chord))
            hand.yield_(2)

    ui.do(act)


def close(ui):
    ui.dialog("Preferences", "Close")


def test_a_new_key_runs_the_command_and_the_old_one_does_not(page):
    change(page, "Stiffness Brush", "key 0 of", Key.f9)
    close(page)
    editor = page.editor
    page.key(Key.b)
    assert editor.chosen_tool is editor.pins_tool
    page.key(Key.f9)
    assert editor.chosen_tool is editor.brush_tool
    assert page.state.preferences.get("keys", {}) == {"Stiffness Brush": ["F9"]}
    assert registry.BRUSH_TOOL.key_name == "F9"
    shown = dict(groups(registry.MENUS, registry.COMMANDS))
    assert ("F9", "Stiffness Brush") in shown["Tools"]


@pytest.mark.parametrize("query", ["stiffness br", "starch"])
def test_typed_letters_find_a_command_at_once(page, query):
    """By its name, or by a word of another program."""
    listed = []

    def act(hand):
        hand.key_chars(query)
        hand.yield_(2)
        for command in (registry.BRUSH_TOOL, registry.PIN_TOOL):
            item = f"//Preferences###dialog Preferences/**/###key 0 of {command.label}"
            listed.append(hand.item_exists(item))

    page.do(act)
    assert listed == [True, False]
    page.key(Key.escape)
    assert not page.state.part(PreferencesPage).is_open


def test_a_key_of_another_command_is_taken_from_it(page):
    change(page, "Stiffness Brush", "key 1 of", Key.p)
    assert registry.PIN_TOOL.active_chords == ()
    close(page)
    page.key(Key.p)
    assert page.editor.chosen_tool is page.editor.brush_tool


def test_escape_keeps_the_old_key_and_then_closes(page):
    change(page, "Stiffness Brush", "key 0 of", Key.escape)
    assert page.state.part(PreferencesPage).is_open
    assert KEYMAP.to_json() == {}
    page.key(Key.escape)
    assert not page.state.part(PreferencesPage).is_open


def test_one_command_and_all_return_to_the_keys_of_the_table(page):
    change(page, "Stiffness Brush", "key 0 of", Key.f9)
    change(page, "Pin Tool", "key 0 of", Key.f7)
    change(page, "Stiffness Brush", "reset")
    assert KEYMAP.to_json() == {"Pin Tool": ["F7"]}
    page.dialog("Preferences", "Reset All Keys")
    assert KEYMAP.to_json() == {}
    assert page.state.preferences.get("keys", {"x": 1}) == {}


def test_stored_keys_are_those_of_the_next_run(page):
    change(page, "Stiffness Brush", "key 0 of", Key.f9)
    KEYMAP.reset()
    registry.restore_keys(page.state.preferences)
    assert registry.BRUSH_TOOL.key_name == "F9"
