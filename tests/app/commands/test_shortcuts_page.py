"""The page of shortcuts."""

from imgui_bundle import imgui  # isort: skip
from akap_editor.app.commands.registry import COMMANDS, MENUS
from akap_editor.app.commands.shortcuts_page import ShortcutsPage, columns_of, groups


def test_the_page_lists_every_key():
    lines = [line for _, lines in groups(MENUS, COMMANDS) for line in lines]
    for command in COMMANDS:
        if command.key_name:
            assert (command.key_name, command.label.rstrip(".")) in lines
    titles = [title for title, _ in groups(MENUS, COMMANDS)]
    assert len(set(titles)) == len(titles)


def test_columns_keep_the_order_and_balance():
    parts = [(str(size), [("", "")] * size) for size in (10, 6, 7, 13, 4, 2)]
    columns = columns_of(parts, 3)
    assert [part for column in columns for part in column] == parts
    assert len(columns) == 3
    heights = [sum(len(lines) + 2 for _, lines in column) for column in columns]
    assert max(heights) < 0.5 * sum(heights)
    assert columns_of(parts, 1) == [parts]


def test_a_question_mark_shows_it_wherever_that_is_on_the_keyboard(ui):
    imgui.get_io().add_input_character(ord("?"))
    ui.settle()
    assert ui.state.part(ShortcutsPage).is_open
    imgui.get_io().add_input_character(ord("?"))
    ui.settle()
    assert not ui.state.part(ShortcutsPage).is_open
