"""Exporting through the window: the dialog, its numbers, and the files."""

import numpy as np
import pygltflib
import pytest

from akap_editor.app.commands.command import CTRL, Key
from akap_editor.app.dialogs.export.pose import ExportPoseDialog
from akap_editor.editor.framing import crop_box
from akap_editor.io.export import EXPORT_FORMATS
from akap_editor.io.images import read_image, write_png
from akap_editor.io.open_document import open_document
from akap_editor.render.offscreen import OffscreenRenderer

EXPORT, FILE, MESSAGE, REPLACE = "Export", "Export to", "Error", "Replace files"
BY_SUFFIX = {each.suffix: each for each in EXPORT_FORMATS}


def dialog(ui):
    return ui.state.part(ExportPoseDialog)


def expected_picture(ui, crop="none", scale=1.0, background=None):
    drawing, pose = ui.document.drawing, ui.session.state.positions
    with OffscreenRenderer(ui.window.ctx) as renderer:
        return renderer.render(drawing, pose, crop_box(drawing, pose, crop), scale, background)


def export_as(ui, name):
    ui.dialog(EXPORT, "Export...")
    assert not dialog(ui).is_open
    ui.type_name(FILE, name)
    ui.settle()
    assert not ui.state.is_busy


def option(label):
    return f"**/{label}"


def test_enter_twice_writes_the_picture_as_it_is_seen(bent, tmp_path):
    bent.key(CTRL | Key.e)
    assert dialog(bent).is_open
    bent.key(Key.enter)
    assert bent.file_request.name == "figure-posed.png"
    bent.key(Key.enter)
    bent.settle()
    expected = expected_picture(bent)
    np.testing.assert_array_equal(read_image(tmp_path / "figure-posed.png"), expected)
    assert bent.state.notice == f"Exported figure-posed.png, {expected.shape[1]} × {expected.shape[0]} pixels"
    assert bent.editor.is_modified, "an export is not the drawing's file"


def test_all_that_can_be_chosen_about_a_picture(bent, tmp_path):
    bent.menu("File", "Export...")
    bent.dialog(EXPORT, option("2×"), option("Color"))

    def crop(hand):
        hand.set_ref(hand.window_info(f"//{EXPORT}###dialog {EXPORT}/##options").window)
        hand.combo_click("##crop/Pose only")

    bent.do(crop)
    choice = dialog(bent).options
    assert (choice.scale, choice.is_opaque, choice.crop) == (2.0, True, "pose")
    size = choice.output_size(bent.document)
    export_as(bent, "large")
    written = read_image(tmp_path / "large.png")
    assert written.shape == (size[1], size[0], 4)
    np.testing.assert_array_equal(written, expected_picture(bent, "pose", 2.0, (1.0, 1.0, 1.0)))
    bent.menu("File", "Export...")
    assert (choice.scale, choice.is_opaque, choice.crop) == (2.0, True, "pose"), "kept for the next time"
    bent.dialog(EXPORT, "Cancel")


@pytest.mark.parametrize("suffix", BY_SUFFIX)
def test_every_format(bent, tmp_path, suffix):
    bent.menu("File", "Export...")
    bent.dialog(EXPORT, option(BY_SUFFIX[suffix].label))
    assert dialog(bent).options.format is BY_SUFFIX[suffix]
    export_as(bent, "cat")
    assert (tmp_path / f"cat{suffix}").stat().st_size
    for path in tmp_path.iterdir():
        assert path.name in bent.state.notice


def test_an_svg_with_its_texture(bent, tmp_path):
    bent.menu("File", "Export...")
    bent.dialog(EXPORT, option("SVG"), option("Texture"))
    export_as(bent, "figure")
    assert not bent.state.error
    assert "<image " in (tmp_path / "figure.svg").read_text()


def test_depth_in_z_is_on_for_obj_until_it_is_switched(bent):
    bent.menu("File", "Export...")
    for label, default in (("Wavefront OBJ", None), ("glTF binary", None)):
        bent.dialog(EXPORT, option(label))
        assert dialog(bent).options.export_options.z_order is default
    bent.dialog(EXPORT, option("Depth in z"))
    assert dialog(bent).options.export_options.z_order is True
    bent.dialog(EXPORT, option("SVG"))
    assert dialog(bent).options.export_options.z_order is None


def test_the_drawing_at_rest(bent, tmp_path):
    bent.menu("File", "Export...")
    bent.dialog(EXPORT, option("glTF binary"), option("Rest pose"), "Export...")
    assert bent.file_request.name == "figure-rest.glb"
    bent.key(Key.enter)
    bent.settle()
    gltf = pygltflib.GLTF2().load(str(tmp_path / "figure-rest.glb"))
    target = gltf.accessors[gltf.meshes[0].primitives[0].targets[0]["POSITION"]]
    assert target.min == target.max == [0.0, 0.0, 0.0]


def test_too_large_a_picture_cannot_be_asked_for(bent):
    bent.menu("File", "Export...")
    dialog(bent).options.scale = 60.0
    bent.settle()
    bent.key(Key.enter)
    assert dialog(bent).is_open
    assert bent.file_request is None
    bent.dialog(EXPORT, option("glTF binary"))
    bent.key(Key.enter)
    assert bent.file_request.suffixes == (".glb",), "a mesh has no size in pixels"
    bent.key(Key.escape)


def test_a_scale_can_be_typed(bent):
    bent.menu("File", "Export...")

    def type_(hand):
        hand.item_input(f"//{EXPORT}###dialog {EXPORT}/**/##Scale")
        hand.key_chars_replace_enter("37.5")

    bent.do(type_)
    assert dialog(bent).is_open, "Enter ended the typing only"
    assert dialog(bent).options.scale == pytest.approx(0.375)
    bent.key(Key.escape)
    assert not dialog(bent).is_open


def test_cancel_and_escape_write_nothing(bent, tmp_path):
    bent.key(CTRL | Key.e)
    bent.key(Key.escape)
    assert not dialog(bent).is_open
    bent.key(CTRL | Key.e)
    bent.dialog(EXPORT, "Cancel")
    bent.key(CTRL | Key.e, Key.enter)
    bent.dialog(FILE, "Cancel")
    assert bent.file_request is None
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_cannot_be_written_is_told(bent, tmp_path):
    bent.key(CTRL | Key.e)
    export_as(bent, "no-such-folder/cat")
    assert str(tmp_path / "no-such-folder" / "cat.png") in bent.state.error
    bent.dialog(MESSAGE, "OK")


def test_only_files_of_the_format_are_listed(bent, tmp_path):
    for name in ("a.json", "b.spine.json", "c.png"):
        (tmp_path / name).write_bytes(b"")
    bent.menu("File", "Export...")
    bent.dialog(EXPORT, option("Spine skeleton"), "Export...")
    assert bent.file_request.entries() == [("b.spine.json", False)]
    bent.key(Key.escape)


@pytest.mark.parametrize("button", ["Replace", "Cancel", "Other Name..."])
def test_files_beside_the_named_one_are_replaced_only_on_demand(bent, tmp_path, button):
    (tmp_path / "cat.mtl").write_bytes(b"of somebody")
    bent.menu("File", "Export...")
    bent.dialog(EXPORT, option(BY_SUFFIX[".obj"].label))
    export_as(bent, "cat")
    assert not (tmp_path / "cat.obj").exists()
    bent.dialog(REPLACE, button)
    if button == "Other Name...":
        bent.type_name(FILE, "dog")
    bent.settle()
    assert not bent.state.error
    assert ((tmp_path / "cat.mtl").read_bytes() == b"of somebody") == (button != "Replace")
    written = {"Replace": ["cat.obj"], "Other Name...": ["dog.obj"]}.get(button, [])
    assert [path.name for path in tmp_path.glob("*.obj")] == written


@pytest.mark.parametrize("button", ["Replace", "Cancel", "Other Name..."])
def test_the_picture_that_the_drawing_was_opened_from_is_replaced_only_on_demand(bent, tmp_path, button):
    source = tmp_path / "cat.png"
    write_png(source, bent.document.drawing.image)
    before = source.read_bytes()
    bent.reset(open_document(source))
    bent.state.folder = tmp_path
    bent.menu("File", "Export...")
    bent.dialog(EXPORT, option(BY_SUFFIX[".png"].label), option("2×"))
    export_as(bent, "cat")
    assert source.read_bytes() == before
    bent.dialog(REPLACE, button)
    if button == "Other Name...":
        bent.type_name(FILE, "dog")
    bent.settle()
    assert not bent.state.error
    assert (source.read_bytes() == before) == (button != "Replace")
    assert (tmp_path / "dog.png").exists() == (button == "Other Name...")
