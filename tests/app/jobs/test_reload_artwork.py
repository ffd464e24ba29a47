"""Reloading artwork by its key, after a restart, by the button that offers it, and from another file."""

import os

from imgui_bundle import imgui  # isort: skip
import glfw
import pytest

from akap_editor.app import files
from akap_editor.app.commands.command import CTRL
from akap_editor.app.jobs.reload_artwork import notice_changed_artwork
from akap_editor.io.images import write_png
from tests.support.pictures import figure_picture

ASKED = "Choose the changed picture"


@pytest.fixture
def saved(ui, tmp_path):
    """The window with a drawing that was made from a picture, saved, and opened again; and the picture."""
    path = tmp_path / "figure.png"
    write_png(path, figure_picture(2, soft=True))
    files.open_path(ui.state, path)
    ui.settle()
    files.write_document(ui.state, tmp_path / "figure.akap")
    files.open_path(ui.state, tmp_path / "figure.akap")
    ui.settle()
    return ui, path


def paint(path):
    """Paint a picture gray."""
    picture = figure_picture(2, soft=True)
    picture[..., :3] = 200
    write_png(path, picture)


def is_gray(ui):
    """Whether the drawing is painted gray."""
    image = ui.document.drawing.image
    return bool((image[image[..., 3] == 255][:, :3] == 200).all())


def test_the_key_reloads_the_picture_of_a_drawing_that_was_saved(saved):
    ui, path = saved
    assert not is_gray(ui)
    paint(path)
    ui.key(CTRL | imgui.Key.r)
    ui.settle()
    assert ui.state.notice == "Reloaded figure.png"
    assert is_gray(ui)
    assert ui.session.history.undo_label == "Reload Artwork"


@pytest.mark.parametrize("is_open", [True, False])
def test_a_button_offers_what_was_changed_while_the_drawing_was_open_or_closed(saved, is_open):
    ui, path = saved
    paint(path)
    os.utime(path, (2000, 2000))
    if is_open:
        notice_changed_artwork(ui.state)
    else:
        files.open_path(ui.state, path.with_suffix(".akap"))
    ui.settle()
    assert ui.state.notice == "figure.png has changed on disk"
    ui.do(lambda hand: hand.item_click("//Status/###Reload Artwork"))
    ui.settle()
    assert is_gray(ui)
    notice_changed_artwork(ui.state)
    assert ui.state.notice == "Reloaded figure.png"


def test_a_change_is_offered_when_a_minimized_window_comes_back(saved):
    ui, path = saved
    paint(path)
    os.utime(path, (2000, 2000))
    handle = ui.window.handle
    glfw.iconify_window(handle)
    ui.window.frame()
    glfw.restore_window(handle)
    glfw.focus_window(handle)
    ui.window.frame()
    assert ui.state.notice == "figure.png has changed on disk"


def test_a_picture_that_is_gone_is_asked_for(saved, tmp_path):
    ui, path = saved
    paint(path)
    path.rename(tmp_path / "renamed.png")
    ui.key(CTRL | imgui.Key.r)
    ui.settle()
    assert ui.state.notice == f"figure.png is not in {tmp_path} any more: choose it"
    ui.type_name(ASKED, "renamed.png")
    ui.settle()
    assert is_gray(ui)
    assert ui.document.artwork.path == tmp_path / "renamed.png"
