"""Names of keys, and the keys of commands that the user has changed."""

import pytest

from akap_editor.app.commands import keymap
from akap_editor.app.commands.keymap import ALT, CTRL, KEYS, SHIFT, Key, Keymap, chord_name, chord_named
from akap_editor.app.commands.registry import COMMANDS


def test_every_key_of_a_command_has_a_name_that_names_it_again():
    for command in COMMANDS:
        for chord in command.chords:
            assert chord_named(chord_name(chord)) == int(chord), chord_name(chord)


@pytest.mark.parametrize("modifiers", [0, CTRL, SHIFT | ALT, CTRL | SHIFT | ALT])
def test_all_keys_have_different_names(modifiers):
    names = [chord_name(int(modifiers) | key) for key in KEYS]
    assert len(set(names)) == len(KEYS) > 90
    assert [chord_named(name) for name in names] == [int(modifiers) | key for key in KEYS]


@pytest.mark.parametrize(
    "name", ["", "Ctrl+", "Shift", "Ctrl+Ctrl+A", "Hyper+A", "AA", "Left ctrl", "Escape"]
)
def test_no_chord_has_another_name(name):
    assert chord_named(name) is None


def test_changes_are_stored_by_name_and_come_back():
    changed = Keymap()
    default = (int(CTRL | Key.s),)
    changed.change("Save", (int(CTRL | Key.w), int(Key.f5)), default)
    changed.change("Quit", (), (int(CTRL | Key.q),))
    changed.change("Open...", default, default)
    assert changed.to_json() == {"Save": ["Ctrl+W", "F5"], "Quit": []}
    again = Keymap()
    again.restore(changed.to_json(), {})
    assert again.chords("Save", default) == (int(CTRL | Key.w), int(Key.f5))
    assert again.chords("Quit", default) == ()
    assert again.chords("Open...", default) is default
    again.reset()
    assert again.chords("Save", default) is default


@pytest.mark.parametrize(
    ("stored", "chords"),
    [({"Save": 3}, None), ({"Save": [3, "Ctrl+", "F5"]}, (int(Key.f5),)), ({"x": ["A"]}, None)],
)
def test_what_makes_no_sense_is_ignored(stored, chords):
    changed, default = Keymap(), (int(CTRL | Key.s),)
    changed.restore(stored, {"Save": default})
    assert changed.chords("Save", default) == (default if chords is None else chords)


def test_a_chord_that_a_newer_table_gives_to_another_command_stays_where_the_user_put_it():
    restored = Keymap()
    table = {"Save": (int(CTRL | Key.s),), "Reload": (int(CTRL | Key.r), int(Key.f5)), "Quit": (int(Key.f5),)}
    restored.restore({"Save": ["Ctrl+R"], "Gone": ["F5"]}, table)
    chords = {label: restored.chords(label, default) for label, default in table.items()}
    assert chords == {"Save": (int(CTRL | Key.r),), "Reload": (int(Key.f5),), "Quit": (int(Key.f5),)}


def test_the_keymap_of_the_program_is_the_table_s(ui):
    assert keymap.KEYMAP.to_json() == {}
