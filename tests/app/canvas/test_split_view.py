"""Two methods side by side in the window."""

from imgui_bundle import imgui  # isort: skip
import numpy as np
import pytest

from akap_editor.app.canvas.split_view import halves
from akap_editor.deform.methods import presets
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing
from akap_editor.editor.session.edits import SetPose, SetSettings
from akap_editor.geometry.mesh import TriMesh

MENU = ("View", "Compare Methods")


@pytest.fixture
def split(pinned):
    """The pinned drawing in both halves, pin 3 dragged up."""
    pinned.menu(*MENU)
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0], start[1] - 100))
    assert pinned.session.is_posed
    return pinned


def choose(ui, label):
    def click(hand):
        hand.set_ref("Comparison")
        hand.combo_click(f"##beside/{label}")

    ui.do(click)


def test_menu_cuts_the_canvas_in_two_and_makes_it_whole_again(pinned):
    whole = pinned.editor.canvas
    pinned.menu(*MENU)
    assert pinned.editor.canvas == halves(whole)[0]
    assert pinned.state.comparison.session is not None
    pinned.menu(*MENU)
    assert pinned.editor.canvas == whole
    assert pinned.state.comparison.session is None


def test_a_drag_bends_both_to_the_same_targets(split):
    comparison = split.state.comparison
    assert comparison.session.state.settings.method == "arap"
    assert comparison.session.state.targets.tolist() == split.session.state.targets.tolist()
    assert comparison.session.pin_error() < 0.25
    assert np.abs(comparison.session.state.positions - split.session.state.positions).max() > 0.1


def test_every_method_can_be_seen_beside(split):
    for preset in presets():
        choose(split, preset.label)
        session = split.state.comparison.session
        assert session.state.settings.method == preset.method
        assert preset.parameters.items() <= dict(session.state.settings.parameters).items()
        assert session.pin_error() < 2.0


def test_right_half_shows_the_second_pose(split):
    """The same picture as the left half shows once both methods are one."""
    split.state.view.show_pins = False
    split.session.begin("Method")
    split.session.apply(SetSettings(split.state.comparison.session.state.settings))
    split.session.commit()
    split.session.begin("Step")
    split.session.apply(SetPose(split.state.comparison.session.state.positions))
    split.session.commit()
    picture = split.screenshot().astype(int)
    left, right = halves(
        (
            *split.editor.canvas[:2],
            2 * split.editor.canvas[2] - split.editor.canvas[0],
            split.editor.canvas[3],
        )
    )
    margin = 60  # names at the top, numbers at the bottom
    parts = [
        picture[int(half[1]) + margin : int(half[3]) - margin, int(half[0]) + 2 : int(half[2]) - 2]
        for half in (left, right)
    ]
    assert (parts[0] > 120).any(), "the drawing is there"
    assert np.abs(parts[0] - parts[1]).max() <= 2


def test_a_click_on_the_right_adds_no_pin_and_the_wheel_zooms_both(split):
    shift = split.editor.canvas[2] - split.editor.canvas[0]
    x, y = split.to_screen((100.0, 80.0))
    split.click((x + shift, y))
    assert len(split.pins) == 3
    zoom, place = split.editor.camera.zoom, split.to_drawing((x, y))

    def scroll(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(x + shift, y))
        hand.mouse_wheel_y(2)

    split.do(scroll)
    assert split.editor.camera.zoom > zoom
    assert split.to_drawing((x, y)) == pytest.approx(place, abs=1.0)


def test_undo_takes_both_back(split):
    split.menu("Edit", "Undo")
    assert not split.session.is_posed
    assert not split.state.comparison.session.is_posed


def test_a_drawing_that_the_second_method_refuses_closes_the_half(ui):
    """A strip wound over itself, of which conformal maps know nothing."""
    turn = np.linspace(0, 2.5 * np.pi, 40)
    rim = [np.stack([r * np.cos(turn), r * np.sin(turn)], axis=1) + 60 for r in (20.0, 40.0)]
    i = np.arange(39)
    faces = np.concatenate([np.stack([i, i + 40, i + 41], axis=1), np.stack([i, i + 41, i + 1], axis=1)])
    mesh = TriMesh(np.concatenate(rim), faces)
    image = np.full((120, 120, 4), 255, dtype=np.uint8)
    ui.reset(new_document(Drawing(image, mesh, (mesh.vertices / 120).astype(np.float32))))
    ui.state.comparison.spec = "cauchy-green"
    ui.menu(*MENU)
    assert not ui.state.view.is_split
    assert "does not overlap itself" in ui.state.error
    ui.state.error = ""
    ui.settle()
