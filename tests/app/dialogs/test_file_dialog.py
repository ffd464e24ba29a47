"""The file dialog without that of the system."""

import pytest

from akap_editor.app.commands.command import CTRL, SHIFT, Key
from akap_editor.app.dialogs.file_dialog import FileRequest
from akap_editor.io.akap.project import load, save
from akap_editor.io.images import write_png
from tests.support.window_driver import state_bits

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
