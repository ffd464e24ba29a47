"""The start page, the first steps, and the page of keys."""

from imgui_bundle import imgui  # isort: skip
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from akap_editor import cli
from akap_editor.app import files
from akap_editor.app.commands.command import CTRL, Key
from akap_editor.app.commands.registry import COMMANDS, MENUS
from akap_editor.app.commands.shortcuts_page import ShortcutsPage, columns_of, groups
from akap_editor.app.dialogs.first_steps import STEPS, FirstSteps
from akap_editor.app.preferences import Preferences
from akap_editor.errors import InputError
from akap_editor.io.images import read_image, write_png
from akap_editor.resources import bundled_drawings

START = "//Start/"


@pytest.fixture
def closed(ui):
    """The window with nothing open."""
    ui.key(CTRL | Key.w)
    assert ui.state.document is None
    return ui


# -- start page ---------------------------------------------------------------------------------------------


def test_close_shows_the_start_page_and_nothing_of_the_drawing(ui):
    left, top, right, bottom = map(round, ui.editor.canvas)
    x, y = map(round, ui.to_screen((70.0, 80.0)))
    drawn = ui.screenshot()[y, x]
    ui.menu("File", "Close")
    assert ui.state.document is None
    assert ui.state.title == "akap-editor"
    shot = ui.screenshot()
    assert (shot[top:bottom, left:right] != drawn).any(axis=2).mean() > 0.99
    ui.do(lambda hand: [hand.item_info(START + path.stem) for path in bundled_drawings()])


def test_closing_asks_for_unsaved_changes(pinned):
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0], start[1] - 80))
    pinned.key(CTRL | Key.w)
    assert pinned.state.document is not None
    pinned.dialog("Unsaved changes", "Cancel")
    assert pinned.state.document is not None
    pinned.key(CTRL | Key.w)
    pinned.dialog("Unsaved changes", "Don't Save")
    assert pinned.state.document is None


@pytest.mark.parametrize("path", bundled_drawings()[1:3], ids=lambda path: path.stem)
def test_a_thumbnail_opens_its_drawing(closed, path):
    closed.do(lambda hand: hand.item_click(START + path.stem))
    closed.settle()
    assert closed.document.drawing.name == path.stem
    assert closed.editor.camera == closed.editor._fitted


def test_thumbnails_show_the_drawings(closed):
    """Each thumbnail shows about as much as is visible of its drawing."""
    shot = closed.screenshot()
    places = {}

    def look(hand):
        for path in bundled_drawings():
            rect = hand.item_info(START + path.stem).rect_full
            places[path] = round(rect.min.x), round(rect.min.y), round(rect.max.x), round(rect.max.y)

    closed.do(look)
    assert len({place[1] for place in places.values()}) == 1, "all in one row"
    for path, (left, top, right, bottom) in places.items():
        alpha = read_image(path)[..., 3]
        visible = (alpha > 200).sum() / max(alpha.shape) ** 2  # of the square that the drawing fits into
        part = shot[top + 12 : bottom - 30, left + 12 : right - 12].astype(int)
        tile = np.median(part[0], axis=0)  # the color around the drawing
        assert (np.abs(part - tile).max(axis=2) > 30).mean() > 0.6 * visible, path.stem


def test_the_drop_zone_asks_for_a_file(closed):
    closed.do(lambda hand: hand.item_click(f"{START}Drop a picture here"))
    assert closed.file_request is not None
    closed.key(Key.escape)
    assert closed.file_request is None


def test_recent_files_are_listed_and_opened(closed, tmp_path, image):
    path = tmp_path / "a folder with a rather long name" / "seen before.png"
    path.parent.mkdir()
    write_png(path, image)
    closed.state.preferences.add_recent(path)
    closed.settle()
    closed.do(lambda hand: hand.item_click(f"{START}\uf1c5  seen before.png##recent 0"))
    closed.settle()
    assert closed.document.drawing.name == "seen before"
    closed.key(CTRL | Key.w)
    closed.menu("File", "Open Recent", "###0")
    closed.settle()
    assert closed.document.drawing.name == "seen before"


def test_a_picture_dropped_on_the_start_page_opens(closed, tmp_path, image):
    write_png(tmp_path / "dropped.png", image)
    closed.drop(tmp_path / "dropped.png")
    closed.settle()
    assert closed.document.drawing.name == "dropped"


def test_a_bad_file_leaves_the_start_page(closed, tmp_path):
    (tmp_path / "bad.png").write_text("no picture")
    closed.drop(tmp_path / "bad.png")
    closed.settle()
    assert "bad.png" in closed.state.error
    assert closed.state.document is None
    closed.dialog("Error", "OK")
    closed.do(lambda hand: hand.item_click(f"{START}bar"))
    closed.settle()
    assert closed.document.drawing.name == "bar"


@pytest.fixture
def shown(monkeypatch):
    """What `edit` shows in place of a window: documents, and what could not be opened."""
    seen = []

    class Screen:
        state = SimpleNamespace(error="")

        def __init__(self, **options):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *error):
            pass

        def run(self, document):
            seen.append((document, self.state.error))

    monkeypatch.setenv("DISPLAY", ":of-a-test")
    monkeypatch.setattr("akap_editor.app.window.Window", Screen)
    return seen


def test_a_file_that_cannot_be_opened_at_the_start_leads_to_the_start_page(shown, tmp_path):
    cli.edit.callback(tmp_path / "missing.png", None)
    ((document, error),) = shown
    assert document is None
    assert "missing.png" in error


def test_without_a_file_the_program_begins_with_the_start_page(shown):
    cli.edit.callback(None, None)
    assert shown == [(None, "")]


def test_a_bundled_drawing_is_opened_by_its_name(shown):
    cli.edit.callback(None, None, "cat")
    ((document, error),) = shown
    assert (document.drawing.name, error) == ("cat", "")


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        ((None, None, "mammoth"), r"elephant.*, got 'mammoth'"),
        (("a.png", None, "cat"), "got both: a.png and cat"),
        ((None, "mask.png", None), "expected a FILE .* mask.png"),
        ((None, "mask.png", "cat"), "expected a FILE .* mask.png"),
    ],
)
def test_arguments_that_make_no_sense_open_no_window(shown, arguments, part):
    with pytest.raises(InputError, match=part):
        cli.edit.callback(*arguments)
    assert not shown


def test_without_a_display_a_file_that_cannot_be_opened_is_an_error(monkeypatch, tmp_path):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    with pytest.raises(InputError, match=r"missing\.png"):
        cli.edit.callback(tmp_path / "missing.png", None)


def test_drop_works_while_a_page_of_help_is_open(ui, tmp_path, image):
    write_png(tmp_path / "dropped.png", image)
    ui.key(Key.f1)
    ui.drop(tmp_path / "dropped.png")
    ui.settle()
    assert ui.document.drawing.name == "dropped"
    ui.key(Key.escape)


def test_of_several_dropped_files_the_first_opens_and_that_is_said(ui, tmp_path, image):
    for name in ("one", "two"):
        write_png(tmp_path / f"{name}.png", image)
    ui.drop(tmp_path / "one.png", tmp_path / "two.png")
    ui.settle()
    assert ui.document.drawing.name == "one"
    assert ui.state.notice == "Opened one.png, the first of 2 files"


# -- first steps --------------------------------------------------------------------------------------------


@pytest.fixture
def newcomer(ui, tmp_path):
    """The window of a first run."""
    ui.state.preferences = Preferences(tmp_path / "preferences.json")
    ui.state.part(FirstSteps).is_open = None
    ui.settle()
    return ui


def test_the_steps_follow_what_is_done(newcomer):
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 0
    newcomer.click(newcomer.to_screen((60.0, 80.0)))
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 1
    start = newcomer.to_screen((200.0, 80.0))
    newcomer.drag(start, (start[0], start[1] - 100))
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 2
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == len(STEPS) - 1


def test_the_steps_never_go_back(newcomer):
    newcomer.click(newcomer.to_screen((60.0, 80.0)))
    start = newcomer.to_screen((200.0, 80.0))
    newcomer.drag(start, (start[0], start[1] - 100))
    seen = []
    for _ in range(2):
        newcomer.key(CTRL | Key.z)
        seen.append(newcomer.state.part(FirstSteps).step(newcomer.state))
    assert not newcomer.pins
    assert seen == [2, 2]


def test_they_wait_on_the_start_page_for_a_drawing(newcomer, document):
    files.close_document(newcomer.state)
    newcomer.settle()
    bottom = newcomer.editor.canvas[3]
    files.show_document(newcomer.state, document)
    newcomer.settle()
    assert newcomer.editor.canvas[3] < bottom
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 0


def test_whoever_drags_the_only_pin_is_told_why_nothing_bends(newcomer):
    start = newcomer.to_screen((200.0, 80.0))
    newcomer.drag(start, (start[0], start[1] - 100))
    assert newcomer.session.is_posed
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 0
    newcomer.click(newcomer.to_screen((60.0, 20.0)))  # the head, where it is now
    assert len(newcomer.pins) == 2
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 1
    end = newcomer.to_screen(newcomer.pin_position(1))
    newcomer.drag(end, (end[0], end[1] + 100))
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 2


@pytest.mark.parametrize("steps", [0, 2])
def test_put_away_they_are_gone_for_good(newcomer, tmp_path, steps):
    if steps:
        newcomer.click(newcomer.to_screen((60.0, 80.0)))
        start = newcomer.to_screen((200.0, 80.0))
        newcomer.drag(start, (start[0], start[1] - 100))
    bottom = newcomer.editor.canvas[3]
    newcomer.do(lambda hand: hand.item_click("//First steps/###away"))
    assert not newcomer.state.part(FirstSteps).is_open
    assert newcomer.editor.canvas[3] > bottom, "the canvas has the room again"
    newcomer.window.remember()
    assert not FirstSteps.is_wanted(Preferences(tmp_path / "preferences.json"))


def test_whoever_has_no_preferences_to_keep_sees_no_first_steps():
    assert not FirstSteps.is_wanted(Preferences())


# -- page of keys -------------------------------------------------------------------------------------------


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
