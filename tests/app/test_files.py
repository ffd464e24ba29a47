"""Opening, saving and exporting through the window, the questions on the way, and files that are no good."""

import json
import zipfile

import numpy as np
import pytest
from PIL import Image

from akap_editor.app.commands.command import CTRL, SHIFT, Key
from akap_editor.app.dialogs.question import QuestionDialog
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.io.akap.project import load, save
from akap_editor.io.images import read_image, write_png
from akap_editor.io.open_document import open_document
from akap_editor.resources import bundled_drawings
from tests.support.layered_files import add_layer, filled, ora_bytes, psd_bytes
from tests.support.window_driver import state_bits

OPEN, SAVE = "Open picture or drawing", "Save drawing"
UNSAVED, MESSAGE, REPLACE = "Unsaved changes", "Error", "Replace files"


def finish(ui):
    """Let work that was put off be done."""
    ui.settle()
    assert not ui.state.is_busy


# -- saving and opening -------------------------------------------------------------------------------------


def test_save_as_and_open_again_restore_every_bit(bent, tmp_path):
    before = state_bits(bent.session.state)
    bent.menu("File", "Save As...")
    bent.type_name(SAVE, "posed")
    assert bent.file_request is None
    assert bent.state.notice == "Saved posed.akap"
    assert not bent.editor.is_modified
    assert bent.state.title == "posed.akap - akap-editor"
    bent.menu("Edit", "Reset Pose")
    assert bent.state.title == "posed.akap * - akap-editor"
    bent.menu("Edit", "Undo")
    bent.menu("File", "Open...")
    bent.type_name(OPEN, "posed.akap")
    assert not bent.state.part(QuestionDialog).is_open, "undo has brought back what was saved"
    finish(bent)
    assert bent.document.path == tmp_path / "posed.akap"
    assert state_bits(bent.session.state) == before
    assert bent.session.history.depth == 0
    assert not bent.editor.selection


def test_save_asks_once_and_then_writes_to_the_same_file(bent, tmp_path):
    bent.key(CTRL | Key.s)
    bent.dialog(SAVE, "Save")
    path = tmp_path / "figure.akap"
    assert state_bits(load(path).state) == state_bits(bent.session.state)
    bent.panel("Reset Pose")
    bent.key(CTRL | Key.s)
    assert bent.file_request is None
    assert state_bits(load(path).state) == state_bits(bent.session.state)
    assert not bent.editor.is_modified


@pytest.fixture
def changed_elsewhere(bent, tmp_path):
    """A saved drawing that is changed again, while its file was changed by another program."""
    path = tmp_path / "figure.akap"
    bent.key(CTRL | Key.s)
    bent.dialog(SAVE, "Save")
    path.write_bytes(b"of another program")
    bent.panel("Reset Pose")
    return path


@pytest.mark.parametrize("button", ["Replace", "Cancel", "Save As..."])
def test_a_file_that_another_program_has_changed_is_not_replaced_unasked(bent, changed_elsewhere, button):
    bent.key(CTRL | Key.s)
    assert changed_elsewhere.read_bytes() == b"of another program"
    assert bent.editor.is_modified
    bent.dialog(REPLACE, button)
    if button == "Save As...":
        bent.type_name(SAVE, "mine")
    saved = {"Replace": changed_elsewhere, "Save As...": changed_elsewhere.with_name("mine.akap")}.get(button)
    assert bent.editor.is_modified == (saved is None)
    if saved is not None:
        assert state_bits(load(saved).state) == state_bits(bent.session.state)
        assert bent.document.path == saved
    assert (changed_elsewhere.read_bytes() == b"of another program") == (button != "Replace")
    bent.key(CTRL | Key.s)
    assert bent.state.part(QuestionDialog).is_open == (button == "Cancel"), "it is asked until answered"
    bent.key(Key.escape)


@pytest.mark.parametrize("button", ["Replace", "Cancel"])
def test_closing_after_the_question_about_a_changed_file(bent, changed_elsewhere, button):
    bent.key(CTRL | Key.w)
    bent.dialog(UNSAVED, "Save")
    bent.dialog(REPLACE, button)
    assert (bent.state.document is None) == (button == "Replace")
    assert (changed_elsewhere.read_bytes() == b"of another program") == (button == "Cancel")


def test_a_file_that_cannot_be_written_is_told_and_stays_unsaved(bent, tmp_path):
    bent.key(CTRL | SHIFT | Key.s)
    bent.type_name(SAVE, "no-such-folder/posed")
    assert str(tmp_path / "no-such-folder" / "posed.akap") in bent.state.error
    assert bent.editor.is_modified
    assert bent.document.path is None
    bent.dialog(MESSAGE, "OK")
    assert not bent.state.error


@pytest.mark.parametrize("path", bundled_drawings()[:1], ids=lambda path: path.stem)
def test_bundled_drawings_open_from_the_menu(pinned, path):
    pinned.menu("File", "Open Bundled Drawing", "###0")
    finish(pinned)
    assert not pinned.state.error
    assert pinned.document.drawing.name == path.stem
    np.testing.assert_array_equal(pinned.document.drawing.image, read_image(path))


# -- unsaved changes ----------------------------------------------------------------------------------------


def open_other(ui, tmp_path):
    save(ui.document, tmp_path / "other.akap")
    ui.key(CTRL | Key.o)
    ui.type_name(OPEN, "other.akap")


def quit_(ui, tmp_path):
    ui.key(CTRL | Key.q)


def close_window(ui, tmp_path):
    ui.window.request_close()
    finish(ui)


def gone_on(ui):
    return ui.state.is_closing or ui.state.title.startswith("other.akap")


ENDS = [open_other, quit_, close_window]


@pytest.mark.parametrize("end", ENDS)
def test_discard_goes_on(bent, tmp_path, end):
    end(bent, tmp_path)
    assert not gone_on(bent)
    bent.dialog(UNSAVED, "Don't Save")
    finish(bent)
    assert gone_on(bent)
    assert not (tmp_path / "figure.akap").exists()


@pytest.mark.parametrize("end", ENDS)
def test_save_saves_and_goes_on(bent, tmp_path, end):
    state = state_bits(bent.session.state)
    end(bent, tmp_path)
    bent.dialog(UNSAVED, "Save")
    bent.type_name(SAVE, "kept")
    finish(bent)
    assert gone_on(bent)
    assert state_bits(load(tmp_path / "kept.akap").state) == state


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("answer", ["Cancel", "escape"])
def test_cancel_stays(bent, tmp_path, end, answer):
    state = bent.session.state
    end(bent, tmp_path)
    if answer == "escape":
        bent.key(Key.escape)
    else:
        bent.dialog(UNSAVED, "Cancel")
    finish(bent)
    assert not gone_on(bent)
    assert not bent.state.part(QuestionDialog).is_open
    assert bent.session.state is state
    assert bent.editor.is_modified


def test_cancel_of_the_file_dialog_after_save_stays(bent, tmp_path):
    quit_(bent, tmp_path)
    bent.dialog(UNSAVED, "Save")
    bent.dialog(SAVE, "Cancel")
    finish(bent)
    assert not bent.state.is_closing
    assert bent.editor.is_modified


def test_a_failed_save_does_not_go_on(bent, tmp_path):
    quit_(bent, tmp_path)
    bent.dialog(UNSAVED, "Save")
    bent.type_name(SAVE, "no-such-folder/x")
    assert bent.state.error
    bent.dialog(MESSAGE, "OK")
    finish(bent)
    assert not bent.state.is_closing


@pytest.mark.parametrize("end", ENDS)
def test_nothing_is_asked_where_nothing_would_be_lost(pinned, tmp_path, end):
    pinned.state.folder = tmp_path
    end(pinned, tmp_path)
    finish(pinned)
    assert gone_on(pinned)


# -- files that are no good ---------------------------------------------------------------------------------


def png_bytes(tmp_path, image):
    path = tmp_path / "whole.png"
    write_png(path, image)
    return path.read_bytes()


def missing(path, image):
    return path / "nothing.png", "no such file"


def text(path, image):
    file = path / "text.png"
    file.write_text("This is no picture.\n")
    return file, "not a PNG"


def truncated(path, image):
    data = png_bytes(path, image)
    file = path / "truncated.png"
    file.write_bytes(data[: len(data) // 2])
    return file, "damaged or incomplete"


def transparent(path, image):
    file = path / "transparent.png"
    write_png(file, np.zeros_like(image))
    return file, "transparent"


def one_pixel(path, image):
    file = path / "pixel.png"
    write_png(file, np.zeros((1, 1, 4), dtype=np.uint8))
    return file, "expected"


def corrupt(path, image):
    file = path / "corrupt.akap"
    file.write_bytes(b"PK\x03\x04" + bytes(200))
    return file, "damaged or not an .akap file"


def newer(path, image):
    file = path / "newer.akap"
    save(new_document(make_drawing(image, vertices=100)), file)
    with zipfile.ZipFile(file) as archive:
        contents = {name: archive.read(name) for name in archive.namelist()}
    description = json.loads(contents["document.json"])
    description["version"] = 999
    contents["document.json"] = json.dumps(description).encode()
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return file, "999"


def folder(path, image):
    (path / "folder.akap").mkdir()
    return path / "folder.akap", "folder"


BAD = [missing, text, truncated, transparent, one_pixel, corrupt, newer, folder]


@pytest.mark.parametrize("make", BAD)
def test_a_bad_file_is_told_in_one_sentence_and_changes_nothing(bent, tmp_path, image, make):
    path, part = make(tmp_path, image)
    before, camera = bent.document, bent.editor.camera
    bent.drop(path)
    bent.dialog(UNSAVED, "Don't Save")
    finish(bent)
    error = bent.state.error
    assert str(path) in error
    assert part in error.replace(str(path), "")
    assert "\n" not in error
    assert bent.document is before
    assert bent.editor.camera == camera
    assert bent.editor.is_modified
    bent.dialog(MESSAGE, "OK")
    bent.key(CTRL | Key.z)
    assert not bent.session.is_posed, "undo still works"


def test_a_picture_without_alpha_opens_with_a_notice(pinned, tmp_path, image):
    path = tmp_path / "opaque.png"
    Image.fromarray(image[..., :3]).save(path)
    pinned.drop(path)
    finish(pinned)
    assert not pinned.state.error
    assert "no transparency" in pinned.state.notice
    assert pinned.document.drawing.name == "opaque"
    height, width = image.shape[:2]
    assert pinned.document.drawing.mesh.rest_areas.sum() >= 0.98 * width * height
    pinned.click(pinned.to_screen((width / 2, height / 2)))
    assert len(pinned.pins) == 1
    assert not pinned.state.notice


def test_a_dropped_picture_opens(pinned, tmp_path, image):
    path = tmp_path / "dropped.png"
    write_png(path, image)
    pinned.drop(path)
    finish(pinned)
    expected = open_document(path)
    assert pinned.document.drawing.name == "dropped"
    np.testing.assert_array_equal(pinned.document.drawing.mesh.vertices, expected.drawing.mesh.vertices)
    assert pinned.state.folder == tmp_path
    assert not pinned.editor.is_modified


@pytest.mark.parametrize("name", ["puppet.psd", "puppet.ora", "puppet"])
def test_pictures_in_layers_open_with_their_layers_and_a_notice(pinned, tmp_path, name):
    body = filled(60, 30, 200, 30, 30)
    path = tmp_path / name
    if name.endswith(".psd"):
        path.write_bytes(psd_bytes(lambda psd: [add_layer(psd, x, body, 10, 10) for x in "ab"], (90, 60)))
    elif name.endswith(".ora"):
        path.write_bytes(
            ora_bytes("<layer name='body' src='a.png' x='10'/>" * 2, {"a.png": body}, "w='90' h='60'")
        )
    else:
        path.mkdir()
        for number in (1, 2):
            write_png(path / f"{number} body.png", body)
    pinned.drop(path)
    finish(pinned)
    assert not pinned.state.error
    assert pinned.document.drawing.name == "puppet"
    assert pinned.state.notice.startswith("Opened 2 layers; Merge Layers in the File menu")
    assert len(pinned.document.drawing.layers) == 2
    assert path in pinned.state.preferences.recent
    path_of_damage = tmp_path / "damaged.psd"
    path_of_damage.write_bytes(b"8BPS")
    pinned.drop(path_of_damage)
    finish(pinned)
    assert "damaged.psd”. The file is damaged or not a Photoshop file." in pinned.state.error
    assert pinned.document.drawing.name == "puppet"
