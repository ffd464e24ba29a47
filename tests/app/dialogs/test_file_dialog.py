"""The file dialog without that of the system."""

import os
import time

import pytest

from akap_editor.app import files
from akap_editor.app.commands.command import CTRL, SHIFT, Key
from akap_editor.app.dialogs.file_dialog import FileDialog, FileRequest
from akap_editor.display_text import display_text
from akap_editor.io.akap.project import load, save
from akap_editor.io.images import write_png
from tests.support.names import strange_names
from tests.support.native_dialog import StandInDialog
from tests.support.window_driver import DEADLINE, state_bits

OPEN, SAVE, UNSAVED = "Open picture or drawing", "Save drawing", "Unsaved changes"


def test_enter_goes_into_the_folder_that_the_keyboard_is_at(bent, tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    save(bent.document, inner / "there.akap")
    bent.key(CTRL | Key.o)
    bent.enter_at(f"//{OPEN}###dialog {OPEN}/**/###inner")
    assert bent.file_request.folder == inner
    bent.enter_at(f"//{OPEN}###dialog {OPEN}/**/###there.akap")
    assert bent.file_request is None
    bent.settle()


def test_an_existing_file_is_replaced_only_on_demand(bent, tmp_path):
    (tmp_path / "old.akap").write_bytes(b"old")
    bent.key(CTRL | SHIFT | Key.s)
    bent.type_name(SAVE, "old", enter=False)

    def look(hand):
        assert hand.item_exists(f"//{SAVE}###dialog {SAVE}/Replace")
        assert not hand.item_exists(f"//{SAVE}###dialog {SAVE}/Save")

    bent.do(look)
    bent.dialog(SAVE, "Cancel")
    assert (tmp_path / "old.akap").read_bytes() == b"old"
    assert bent.editor.is_modified
    bent.key(CTRL | SHIFT | Key.s)
    bent.type_name(SAVE, "old", enter=False)
    bent.dialog(SAVE, "Replace")
    assert state_bits(load(tmp_path / "old.akap").state) == state_bits(bent.session.state)


def test_the_file_dialog_goes_through_folders(bent, tmp_path):
    inner = tmp_path / "inner" / "deeper"
    inner.mkdir(parents=True)
    save(bent.document, inner / "there.akap")
    write_png(tmp_path / "picture.png", bent.document.drawing.image)
    (tmp_path / "notes.txt").write_text("not listed")
    (tmp_path / ".hidden.png").write_bytes(b"")
    bent.menu("File", "Open...")
    request = bent.file_request
    assert request.entries() == [("inner", True), ("picture.png", False)]

    def open_(name):
        bent.do(lambda hand: hand.item_double_click(f"//{OPEN}###dialog {OPEN}/**/{name}"))

    open_("###inner")
    assert request.folder == tmp_path / "inner"
    bent.dialog(OPEN, "\uf062##up")
    assert request.folder == tmp_path
    bent.type_name(OPEN, "inner/deeper")
    assert request.folder == inner
    assert request.name == ""
    open_("###there.akap")
    bent.dialog(UNSAVED, "Don't Save")
    bent.settle()
    assert bent.document.path == inner / "there.akap"


@pytest.mark.parametrize("chord", [CTRL | Key.o, CTRL | SHIFT | Key.s])
def test_a_name_can_be_typed_at_once(bent, chord):
    typed = []

    def actions(hand):
        hand.key_press(int(chord))
        hand.yield_(3)
        hand.key_press(int(CTRL | Key.a))
        hand.key_chars("mine")
        hand.yield_(2)
        typed.append(bent.file_request.name)
        hand.key_press(Key.escape)

    bent.do(actions)
    assert typed == ["mine"]
    assert bent.file_request is None


@pytest.mark.parametrize("saving", [False, True])
def test_no_name_that_can_be_typed_breaks_the_file_dialog(bent, tmp_path, saving):
    """Each is seen half typed, e.g. the "/" of "/home"."""
    state = bent.session.state
    bent.key(CTRL | SHIFT | Key.s if saving else CTRL | Key.o)
    for name in ("/", "~nobody-of-this-name/x", "..", "x" * 300, "\N{ELEPHANT}", "a/b/c", "\0"):
        bent.file_request.name = name
        bent.settle()
    bent.key(Key.escape)
    assert bent.file_request is None
    assert bent.session.state is state
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "saving", "expected"),
    [
        ("cat", True, "cat.akap"),
        ("cat.akap", True, "cat.akap"),
        (" cat.akap ", True, "cat.akap"),
        ("sub/cat", True, "sub/cat.akap"),
        ("folder", True, "folder"),
        ("cat", False, "cat"),
        ("/elsewhere/cat.png", False, "/elsewhere/cat.png"),
    ],
)
def test_the_path_that_a_name_means(tmp_path, name, saving, expected):
    (tmp_path / "folder").mkdir()
    request = FileRequest("", (".akap", ".png"), tmp_path, print, name, saving)
    assert request.path == tmp_path / expected


@pytest.fixture
def native(pinned, monkeypatch, tmp_path):
    """A stand-in for the system's dialog, which the window uses; file dialogs start in an empty folder."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "pictures").mkdir()
    pinned.state.folder = tmp_path / "pictures"
    monkeypatch.setattr(pinned.state.part(FileDialog), "uses_native", True)
    return StandInDialog(tmp_path / "bin", monkeypatch)


def until(ui, holds):
    """Draw frames until a condition holds, as the loop does while the system's dialog is open."""
    deadline = time.monotonic() + DEADLINE
    while not holds():
        assert time.monotonic() < deadline
        ui.frame()
    ui.settle()


def double_click_first_entry(ui):
    def click(hand):
        entries = hand.window_info(f"//{OPEN}###dialog {OPEN}/##entries").window
        hand.mouse_move_to_pos(type(entries.pos)(entries.pos.x + 60, entries.pos.y + 18))
        hand.mouse_double_click(0)

    ui.do(click)


@pytest.mark.parametrize("stem", strange_names())
def test_a_strange_name_from_the_dialog_of_the_system(pinned, native, tmp_path, image, stem):
    """It is opened; one that the dialog cannot pass on is asked for again, in the editor's own dialog."""
    picture = tmp_path / "pictures" / f"{stem}.png"
    write_png(picture, image)
    pinned.do(lambda hand: hand.key_press(int(CTRL | Key.o)), settle=False)
    until(pinned, lambda: native.is_open)
    native.answer(picture)
    dialog = pinned.state.part(FileDialog)
    until(pinned, lambda: not dialog.native_is_open)
    if not is_utf8(stem):
        assert pinned.file_request is not None
        double_click_first_entry(pinned)
    pinned.settle()
    assert not pinned.state.error
    assert pinned.file_request is None
    assert pinned.document.drawing.name == display_text(stem)


@pytest.mark.parametrize("stem", strange_names())
def test_a_strange_name_that_is_suggested_to_the_dialog_of_the_system(pinned, native, tmp_path, stem):
    saved = tmp_path / "pictures" / f"{stem}.akap"
    files.write_document(pinned.state, saved)
    pinned.do(lambda hand: hand.key_press(int(CTRL | SHIFT | Key.s)), settle=False)
    if is_utf8(stem):
        until(pinned, lambda: native.is_open)
        assert f"--filename={saved}" in "\n".join(native.arguments)
        native.answer(None)
        until(pinned, lambda: pinned.file_request is None)
    else:
        saved.unlink()
        pinned.dialog(SAVE, "Save")
        assert saved.is_file()
    assert not pinned.state.error


def test_a_folder_that_the_dialog_of_the_system_cannot_be_told(pinned, native, tmp_path, image):
    folder = tmp_path / os.fsdecode(b"caf\xe9")
    folder.mkdir()
    write_png(folder / "cat.png", image)
    pinned.state.folder = folder
    pinned.key(CTRL | Key.o)
    pinned.enter_at(f"//{OPEN}###dialog {OPEN}/**/###cat.png")
    pinned.settle()
    assert pinned.document.drawing.name == "cat"


def is_utf8(name):
    try:
        os.fsencode(name).decode("utf-8")
    except UnicodeError:
        return False
    return True
