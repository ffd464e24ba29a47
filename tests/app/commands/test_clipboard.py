"""Copy and paste: pictures become drawings, a pose becomes a picture or goes to another drawing."""

import numpy as np
import pytest

from akap_editor.app.commands import clipboard
from akap_editor.app.commands.clipboard import COPY_PICTURE, COPY_POSE, PASTE
from akap_editor.app.commands.command import CTRL, Key
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.clipboards import FakeClipboard


@pytest.fixture
def system(monkeypatch):
    fake = FakeClipboard()
    monkeypatch.setattr(clipboard, "copykitten", fake)
    return fake


def put(system, image):
    system.copy_image(image.tobytes(), image.shape[1], image.shape[0])


def test_a_picture_in_the_clipboard_is_opened(ui, system):
    image = read_image(resource("assets", "drawings", "cat.png"))
    put(system, image)
    ui.key(PASTE.chords[0])
    drawing = ui.document.drawing
    assert drawing.name == "clipboard"
    np.testing.assert_array_equal(drawing.image, image)
    assert ui.state.notice == "Opened the picture in the clipboard"
    assert ui.document.path is None
    ui.key(CTRL | Key.w)
    ui.dialog("Unsaved changes", "Cancel")
    assert ui.document is not None, "no file holds it, so it is not closed unasked"


def test_unsaved_changes_are_asked_about_first(pinned, system):
    put(system, read_image(resource("assets", "drawings", "cat.png")))
    pinned.bend()
    pinned.key(PASTE.chords[0])
    assert pinned.document.drawing.name == "figure"
    pinned.dialog("Unsaved changes", "Don't Save")
    assert pinned.document.drawing.name == "clipboard"


def test_the_copied_picture_of_the_rest_pose_is_the_picture(ui, system):
    ui.key(COPY_PICTURE.chords[0])
    data, width, height = system.content
    copied = np.frombuffer(data, np.uint8).reshape(height, width, 4)
    image = ui.document.drawing.image
    assert (width, height) == ui.document.drawing.size
    opaque = (image[..., 3] == 255) & (copied[..., 3] == 255)
    assert opaque.sum() > 0.9 * (image[..., 3] == 255).sum()
    np.testing.assert_array_equal(copied[opaque], image[opaque])
    assert copied[0, 0, 3] == 0
    assert f"{width} × {height} px" in ui.state.notice


def test_a_pose_is_copied_as_a_picture_and_pasted_again(pinned, system):
    pinned.bend()
    pinned.key(COPY_PICTURE.chords[0])
    pinned.editor.mark_saved(None)
    pinned.key(PASTE.chords[0])
    assert pinned.document.drawing.name == "clipboard"
    assert not pinned.pins


def test_a_pose_goes_to_another_drawing_of_the_same_mesh(pinned, system, drawing):
    pinned.bend()
    pose, targets = pinned.session.state.positions, pinned.session.state.targets
    pinned.key(COPY_POSE.chords[0])
    pinned.reset(new_document(drawing))
    pinned.key(PASTE.chords[0])
    np.testing.assert_array_equal(pinned.session.state.positions, pose)
    np.testing.assert_allclose(pinned.session.state.targets, targets, atol=0.25)
    assert pinned.session.history.labels == ["Apply Pose"]


def test_a_pose_of_another_mesh_is_refused_and_nothing_changes(pinned, system, image):
    pinned.key(COPY_POSE.chords[0])
    pinned.reset(new_document(make_drawing(image, vertices=300)))
    before = pinned.session.state
    pinned.key(PASTE.chords[0])
    assert "expected a pose of this very mesh" in pinned.state.error
    assert pinned.session.state is before


@pytest.mark.parametrize("content", [None, "", "some text", '{"format": "other"}'])
def test_anything_else_is_a_notice(ui, system, content):
    system.content = content
    before = ui.session
    ui.key(PASTE.chords[0])
    assert ui.state.notice == "The clipboard holds neither a picture nor a pose"
    assert ui.session is before


@pytest.mark.parametrize("command", [COPY_PICTURE, COPY_POSE], ids=["picture", "pose"])
def test_a_system_that_refuses_is_an_error(ui, system, command):
    system.is_refused = True
    ui.key(command.chords[0])
    assert ui.state.error == "Couldn't copy to the clipboard. there is no clipboard"


@pytest.mark.parametrize("size", [(0, 0), (20_000, 20_000)])
def test_a_picture_of_an_impossible_size_is_refused(ui, system, size):
    system.content = b"", *size
    ui.key(PASTE.chords[0])
    assert "in the clipboard" in ui.state.error
