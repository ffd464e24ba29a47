"""Commands that ask for a file and use it."""

import numpy as np
import pytest
from PIL import Image

from akap_editor.app import file_commands
from akap_editor.editor import gestures
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.io.akap.pose import load_pose
from akap_editor.io.images import write_png

# -- masks --------------------------------------------------------------------------------------------------

CUT_OUT = "Cut Out with Mask..."


def write_half(path, image, keep):
    """A mask that is white in the left part of a picture, black elsewhere."""
    mask = np.zeros((*image.shape[:2], 3), dtype=np.uint8)
    mask[:, :keep] = 255
    Image.fromarray(mask).save(path)


def test_a_picture_is_cut_out_with_a_mask_that_is_chosen_in_the_window(pinned, image, tmp_path):
    write_half(tmp_path / "half.png", image, 120)
    pinned.menu("File", CUT_OUT)
    pinned.type_name("Choose mask", str(tmp_path / "half.png"))
    pinned.settle()
    assert pinned.state.notice == "Cut out with half.png"
    expected = make_drawing(image, mask=np.repeat([[255] * 120 + [0] * 120], 160, axis=0).astype(np.uint8))
    np.testing.assert_array_equal(pinned.document.drawing.image, expected.image)
    assert pinned.document.drawing.mesh.vertices[:, 0].max() < 125
    assert pinned.document.drawing.name == "figure"
    assert not pinned.pins


def test_what_is_not_saved_is_asked_for_before_a_mask_cuts_it_out(bent, image, tmp_path):
    write_half(tmp_path / "half.png", image, 120)
    bent.menu("File", CUT_OUT)
    bent.type_name("Choose mask", "half.png")
    bent.dialog("Unsaved changes", "Cancel")
    assert len(bent.pins) == 3
    assert bent.document.drawing.image.shape == image.shape


@pytest.mark.parametrize(("keep", "size", "said"), [(0, 1, "transparent"), (120, 2, "expected the size")])
def test_a_mask_that_is_no_good_changes_nothing(pinned, image, tmp_path, keep, size, said):
    write_half(tmp_path / "mask.png", image[::size, ::size], keep)
    pinned.menu("File", CUT_OUT)
    pinned.type_name("Choose mask", str(tmp_path / "mask.png"))
    pinned.settle()
    assert str(tmp_path / "mask.png") in pinned.state.error
    assert said in pinned.state.error
    assert len(pinned.pins) == 3


# -- poses --------------------------------------------------------------------------------------------------


def test_a_pose_is_carried_through_a_file(pinned, tmp_path):
    pinned.state.folder = tmp_path
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0], start[1] - 80))
    posed = pinned.session.state
    pinned.menu("File", "Export Pose File...")
    pinned.type_name("Save pose", "wave")
    assert pinned.state.notice == "Saved wave.pose.json"
    assert load_pose(tmp_path / "wave.pose.json", pinned.session.drawing).positions.tobytes() == (
        posed.positions.tobytes()
    )
    pinned.menu("Edit", "Reset Pose")
    gestures.remove_pins(pinned.editor, {1})
    pinned.menu("File", "Apply Pose File...")
    pinned.type_name("Apply pose", "wave.pose.json")
    assert pinned.state.notice == "Applied wave.pose.json"
    assert pinned.session.state.positions.tobytes() == posed.positions.tobytes()
    assert [pin.id for pin in pinned.pins] == [1, 2, 3]
    before = pinned.session.state
    (tmp_path / "bad.pose.json").write_text("{}")
    pinned.menu("File", "Apply Pose File...")
    pinned.type_name("Apply pose", "bad.pose.json")
    assert "bad.pose.json”. Expected format to be a text" in pinned.state.error
    assert pinned.session.state is before
    pinned.dialog("Error", "OK")


# -- the reference picture ----------------------------------------------------------------------------------


def test_a_reference_picture_is_chosen_by_its_file(pinned, tmp_path, image):
    write_png(tmp_path / "behind.png", image)
    file_commands.choose_reference(pinned.state)
    pinned.settle()
    pinned.type_name("Choose reference picture", str(tmp_path / "behind.png"))
    assert (pinned.state.view.reference.image == image).all()
    file_commands.choose_reference(pinned.state)
    pinned.settle()
    (tmp_path / "broken.png").write_bytes(b"no picture")
    pinned.type_name("Choose reference picture", str(tmp_path / "broken.png"))
    assert "broken.png" in pinned.state.error
    assert (pinned.state.view.reference.image == image).all()
    pinned.state.error = ""


def test_a_faint_mask_lowers_the_threshold(document, image, tmp_path):
    gray = np.full((*image.shape[:2], 4), 255, np.uint8)
    gray[..., :3] = 60
    write_png(tmp_path / "mask.png", gray)
    drawing = file_commands.cut_out(document, tmp_path / "mask.png").drawing
    assert drawing.image[..., 3].max() == 60
    assert 0 < drawing.meshing.threshold < 60 / 255
