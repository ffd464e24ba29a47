"""Files of strange names in the window: opened, shown, listed, saved; and labels as they are."""

import os
import shutil

import pytest

from akap_editor.app import files
from akap_editor.app.commands.command import CTRL, SHIFT, Key
from akap_editor.display_text import display_text
from akap_editor.io.akap.project import load
from akap_editor.io.images import write_png
from tests.support.names import assert_readable, strange_names

SAVE = "Save drawing"


@pytest.mark.parametrize("stem", strange_names())
def test_a_picture_of_a_strange_name(ui, tmp_path, image, stem):
    """It is dropped on the window, shown everywhere, saved under its name, and opened again."""
    picture = tmp_path / f"{stem}.png"
    write_png(picture, image)
    ui.drop(picture)
    assert ui.document.drawing.name == display_text(stem)
    for text in (ui.state.title, ui.state.notice):
        assert_readable(text)
    assert not ui.state.error
    ui.menu("File", "Open Recent")  # which draws the name
    ui.key(Key.escape, Key.escape)
    assert not ui.state.error

    ui.key(CTRL | Key.o)
    assert (f"{stem}.png", False) in ui.file_request.entries()
    ui.settle()
    ui.key(Key.escape)
    assert not ui.state.error

    saved = tmp_path / f"{stem}.akap"
    files.write_document(ui.state, saved)
    ui.settle()
    assert not ui.state.error
    ui.key(CTRL | SHIFT | Key.s)
    assert ui.file_request.path == saved, "the name itself is suggested, however it is shown"
    ui.dialog(SAVE, "Replace")
    assert ui.document.path == saved
    assert load(saved).drawing.name == display_text(stem)

    ui.key(CTRL | Key.w)
    assert ui.state.document is None
    ui.settle()
    assert not ui.state.error
    files.open_path(ui.state, ui.state.preferences.recent[0])
    ui.settle()
    assert ui.document.path == saved


def test_a_folder_of_a_strange_name(ui, tmp_path):
    folder = tmp_path / "caf\udce9\n\x1b[31m"
    folder.mkdir()
    shutil.copy(os.devnull, folder / "empty.png")
    ui.state.folder = folder
    ui.key(CTRL | Key.o)
    assert not ui.state.error
    assert ui.file_request.entries() == [("empty.png", False)]
    ui.key(Key.escape)
    ui.drop(folder / "empty.png")
    assert_readable(ui.state.error)
    assert "empty.png" in ui.state.error
    ui.state.error = ""
