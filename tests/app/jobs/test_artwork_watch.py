"""The window notices that another program has changed the picture of the open drawing."""

import os
from dataclasses import replace

import pytest

from akap_editor.app import files
from akap_editor.app.jobs.artwork_watch import artwork_path
from akap_editor.app.jobs.reload_artwork import notice_changed_artwork
from akap_editor.editor.document.document import new_document
from akap_editor.io.artwork_file import artwork_file
from akap_editor.io.images import write_png
from tests.support.pictures import figure_picture


@pytest.fixture
def painted(ui, drawing, tmp_path):
    """The window with a drawing whose picture is in a file, and this file."""
    path = tmp_path / "figure.png"
    write_png(path, figure_picture(2, soft=True))
    os.utime(path, (1000, 1000))
    files.show_document(ui.state, replace(new_document(drawing), artwork=artwork_file(path)))
    ui.state.notice = ""
    return ui, path


def test_a_change_is_noticed_once_and_reloaded(painted):
    ui, path = painted
    notice_changed_artwork(ui.state)
    assert ui.state.notice == ""
    os.utime(path, (2000, 2000))
    notice_changed_artwork(ui.state)
    assert ui.state.notice == "figure.png has changed on disk"
    ui.state.notice = ""
    notice_changed_artwork(ui.state)
    assert ui.state.notice == ""


def test_a_file_that_is_gone_is_not_offered(painted):
    ui, path = painted
    assert artwork_path(ui.state) == path
    path.unlink()
    assert artwork_path(ui.state) is None
    notice_changed_artwork(ui.state)
    assert ui.state.notice == ""


def test_without_a_picture_there_is_nothing_to_watch(ui):
    assert artwork_path(ui.state) is None
    notice_changed_artwork(ui.state)
