"""The Mesh section of the side panel."""

from dataclasses import replace

import numpy as np
import pytest
from imgui_bundle import imgui
from PIL import Image

from akap_editor.app import files
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Meshing, make_drawing
from akap_editor.io.mesh_files.mesh_drawing import read_mesh
from akap_editor.meshing.meshers import PYTHONCDT
from akap_editor.resources import resource
from tests.support.meshers import needs_triangle, pretend_installed
from tests.support.window_driver import WindowDriver


def slide(ui: WindowDriver, label: str, *shares: float) -> list[Meshing | None]:
    """Drag a slider through places along it, as shares of its width; what was wanted at each."""
    seen = []

    def drag(hand):
        rect = hand.item_info(f"//Panel/{label}").rect_full
        middle = (rect.min.y + rect.max.y) / 2
        for number, share in enumerate(shares):
            x = rect.min.x + share * (rect.max.x - rect.min.x)
            if number == 0:
                ui.begin_drag(hand, (x, middle))
            else:
                hand.mouse_move_to_pos(type(rect.min)(x, middle))
            hand.yield_(8)
            seen.append(ui.state.remesher.meshing)
            assert number == 0 or ui.state.remesher.is_active
        hand.mouse_up(0)

    ui.do(drag)
    return seen


@pytest.fixture
def opened(pinned):
    """The window with a pinned figure and the section open."""
    pinned.unfold("Mesh", "Mesh parameters")
    return pinned


def test_vertices_slider_gives_another_mesh_as_one_entry(opened):
    places, before = opened.session.pin_positions(), opened.document
    depth = opened.session.history.depth
    slide(opened, "##Detail", 0.2, 0.4, 0.6)
    assert not opened.state.remesher.is_active
    drawing = opened.document.drawing
    assert len(drawing.mesh.vertices) > 3 * len(before.drawing.mesh.vertices)
    assert drawing.meshing.vertices == pytest.approx(len(drawing.mesh.vertices), rel=0.1)
    assert opened.session.history.depth == depth + 1
    assert np.abs(opened.session.pin_positions() - places).max() < 0.5
    opened.editor.undo()
    assert opened.document.state is before.state
    assert opened.document.drawing is before.drawing


@pytest.mark.parametrize(
    ("label", "text", "expected"),
    [("Detail", "700", Meshing(700, 2.0, 0.5)), ("Margin", "5", Meshing(200, 5.0, 0.5))],
)
def test_a_typed_value_gives_another_mesh_and_the_lines_of_the_mesh_go(opened, label, text, expected):
    def type_value(hand):
        hand.key_down(imgui.Key.mod_ctrl)
        hand.item_click(f"//Panel/##{label}")
        hand.key_up(imgui.Key.mod_ctrl)
        hand.key_chars_replace_enter(text)

    opened.do(type_value)
    assert opened.document.drawing.meshing == expected
    assert not opened.state.remesher.is_active, "the wireframe is shown as long as it is active"
    assert opened.session.history.labels[-1] == "Change Mesh"


def test_two_drags_are_two_entries(opened):
    depth = opened.session.history.depth
    slide(opened, "##Margin", 0.1, 0.5)
    *_, wanted = slide(opened, "##Margin", 0.5, 0.2)
    assert opened.session.history.depth == depth + 2
    assert opened.document.drawing.meshing == wanted
    assert 2.0 < wanted.expand < 6.0


def test_a_pin_can_be_dragged_right_after(opened):
    slide(opened, "##Detail", 0.2, 0.5)
    start = opened.to_screen(tuple(opened.pin_position(3)))
    opened.drag(start, (start[0], start[1] - 40))
    assert opened.session.history.undo_label == "Move Pin" or opened.session.is_posed
    assert opened.session.pin_error() < 0.25


def test_nothing_left_is_a_notice_and_all_stays(opened):
    faint = opened.document.drawing.image.copy()
    faint[..., 3] = np.minimum(faint[..., 3], 200)
    files.show_document(opened.state, new_document(make_drawing(faint, vertices=200)))
    opened.settle()
    before = opened.document
    slide(opened, "##Alpha threshold", 0.5, 0.97)
    assert "transparent" in opened.state.notice
    assert not opened.state.error
    assert opened.document.state.positions.shape == before.state.positions.shape


def test_a_faint_drawing_keeps_its_threshold_while_other_options_change(opened, image):
    faint = image // np.array([1, 1, 1, 5], np.uint8)
    files.show_document(opened.state, new_document(make_drawing(faint, vertices=200)))
    opened.settle()
    assert "faint" in opened.state.notice
    threshold = opened.document.drawing.meshing.threshold
    assert 0 < threshold < 0.2
    slide(opened, "##Detail", 0.2, 0.4)
    drawing = opened.document.drawing
    assert drawing.meshing.threshold == threshold
    assert len(drawing.mesh.vertices) > 400
    slide(opened, "##Alpha threshold", 0.1, 0.6)
    assert "transparent" in opened.state.notice
    assert opened.document.drawing is drawing, "there is no such mesh, and all stays"


def test_the_background_goes_and_comes_back(opened):
    image = np.full((160, 240, 4), 255, np.uint8)
    image[40:120, 60:180, :3] = (200, 60, 30)
    files.show_document(opened.state, new_document(make_drawing(image, vertices=200, name="scan")))
    opened.settle()
    area = 160 * 240
    assert opened.document.drawing.mesh.rest_areas.sum() == pytest.approx(area)
    opened.panel("Remove Background")
    assert opened.document.drawing.mesh.rest_areas.sum() == pytest.approx(84 * 124, rel=0.02)
    *_, wanted = slide(opened, "##Tolerance", 0.2, 0.5)
    assert opened.document.drawing.meshing == wanted
    assert 0.2 < wanted.background < 0.4
    opened.panel("Restore Background")
    assert opened.document.drawing.image.tolist() == image.tolist()
    assert opened.session.history.depth == 3


def test_a_mesh_from_a_file_that_is_not_on_its_picture_says_so(opened, tmp_path):
    Image.fromarray(opened.document.drawing.image).save(tmp_path / "a.png")
    (tmp_path / "a.obj").write_text(
        "v 0 0 0\nv 90 0 0\nv 70 80 0\nv 0 60 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    )
    files.show_document(opened.state, new_document(read_mesh(tmp_path / "a.obj")))
    opened.settle()
    slide(opened, "##Margin", 0.1, 0.5)
    assert "cannot be made anew" in opened.state.notice


@needs_triangle
def test_another_mesher_is_kept_for_new_drawings(opened):
    depth, before = opened.session.history.depth, opened.document.drawing

    def choose(hand):
        hand.set_ref("Panel")
        hand.combo_click("##Mesher/PythonCDT")

    opened.do(choose)
    drawing = opened.document.drawing
    assert drawing.meshing == replace(before.meshing, mesher=PYTHONCDT)
    assert drawing.mesh.vertices.tolist() != before.mesh.vertices.tolist()
    assert opened.session.history.depth == depth + 1
    assert opened.state.preferences.mesher == PYTHONCDT
    files.open_path(opened.state, resource("assets", "drawings", "bar.png"))
    opened.settle()
    opened.dialog("Unsaved changes", "Don't Save")
    opened.settle()
    assert opened.document.drawing.meshing.mesher == PYTHONCDT


@needs_triangle
def test_without_a_choice_no_mesher_is_shown(opened, monkeypatch):
    def shows_choice():
        shown = []
        opened.do(lambda hand: shown.append(hand.item_exists("//Panel/##Mesher")))
        return shown[0]

    assert shows_choice()
    pretend_installed(monkeypatch, PYTHONCDT)
    assert not shows_choice()


def test_cuts_are_listed_and_removed(pinned):
    pinned.tab("Mesh")
    knife = pinned.editor.knife_tool
    pinned.state.remesher.request(replace(pinned.state.remesher.meshing, cuts=(((0.0, 45.0), (70.0, 45.0)),)))
    pinned.settle()
    assert pinned.session.drawing.mesh.is_cut
    seen = []

    def point(hand):
        hand.item_click("//Panel/**/###cut 0")
        hand.yield_(2)
        seen.append(knife.highlighted)

    pinned.do(point)
    assert seen == [0]
    pinned.do(lambda hand: hand.item_click("//Panel/**/###remove cut 0"))
    pinned.settle()
    assert not pinned.session.drawing.meshing.cuts
    assert pinned.session.history.labels[-1] == "Remove Cut"
