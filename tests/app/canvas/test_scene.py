"""What lies under the panels; of a large mesh a cached picture is shown, and every change is seen."""

from imgui_bundle import imgui  # isort: skip
from dataclasses import dataclass, fields

import numpy as np
import pytest

from akap_editor.app.canvas import scene as scene_module
from akap_editor.app.canvas.scene import MIN_CACHED_FACES
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.render.overlays import (
    NO_OVERLAYS,
    FaceColors,
    LineSegments,
    OnionPose,
    Overlays,
    Reference,
)
from akap_editor.render.renderer import Renderer


def canvas(ui, shot):
    left, top, right, bottom = map(round, ui.editor.canvas)
    return shot[top:bottom, left:right]


def test_a_cached_picture_shows_every_change(pinned, monkeypatch):
    """It shows the same as a window that draws the scene in each frame."""

    def hover(at):
        imgui.get_io().add_mouse_pos_event(*at)

    x, y = pinned.pin_position(3)
    changes = [
        lambda: hover(pinned.to_screen(pinned.pin_position(2))),
        lambda: setattr(pinned.editor, "camera", pinned.editor.camera.zoomed(1.3, pinned.empty_point)),
        lambda: setattr(pinned.state.view, "show_checkerboard", False),
        lambda: setattr(pinned.state.view, "show_mesh", True),
        lambda: setattr(pinned.state.view, "show_rest_pose", True),
        lambda: setattr(pinned.state.view, "show_pin_trails", True),
        lambda: setattr(pinned.state.view, "distortion_measure", "area"),
        lambda: gestures.move_pin(pinned.editor, 3, (x, y - 30)),
        lambda: setattr(pinned.state.view, "distortion_range", 0),
        lambda: gestures.set_depth(pinned.editor, 3, 2),
        lambda: setattr(pinned.state.view, "is_split", True),
        lambda: setattr(pinned.state.view, "is_split", False),
        pinned.editor.undo,
    ]
    pictures = set()
    for number, change in enumerate(changes):
        change()
        snapshots = []
        for min_faces in (0, 10**9):
            monkeypatch.setattr(scene_module, "MIN_CACHED_FACES", min_faces)
            snapshots.append(canvas(pinned, pinned.screenshot()).astype(np.int16))
        np.testing.assert_allclose(*snapshots, rtol=0, atol=4, err_msg=f"change {number}")  # layers round
        pictures.add(snapshots[0].tobytes())
    assert len(pictures) >= 8, "most of the changes are seen"


# -- a large mesh -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def large_drawing(image):
    drawing = make_drawing(image, vertices=6000, name="large")
    assert len(drawing.mesh.faces) >= MIN_CACHED_FACES
    return drawing


@pytest.fixture
def large(module_window, large_drawing):
    """The window with a mesh whose picture is cached."""
    module_window.reset(new_document(large_drawing))
    return module_window


@pytest.fixture
def draws(monkeypatch):
    """The overlays of each picture that is drawn."""
    draws, draw = [], Renderer.draw

    def record(renderer, *arguments, overlays=NO_OVERLAYS, **options):
        draws.append(overlays)
        draw(renderer, *arguments, overlays=overlays, **options)

    monkeypatch.setattr(Renderer, "draw", record)
    return draws


def show(monkeypatch, overlays):
    monkeypatch.setattr("akap_editor.app.canvas.scene.scene_overlays", lambda state, scale: overlays)


def line(drawing):
    width, height = drawing.size
    return LineSegments(np.array([[[0.0, 0.0], [width, height]]]), (1.0, 1.0, 1.0, 1.0), 3.0)


CHANGED = {  # another value of each field, which is seen
    "mesh_lines": lambda drawing: True,
    "rest_pose_opacity": lambda drawing: 0.5,
    "face_colors": lambda drawing: FaceColors(np.ones(len(drawing.mesh.faces)), np.eye(3)[:2]),
    "lines": lambda drawing: (line(drawing),),
    "reference": lambda drawing: Reference(np.full((9, 9, 4), 255, dtype=np.uint8)),
    "onion_poses": lambda drawing: (OnionPose(drawing.mesh.vertices + 20.0, (1.0, 0.0, 0.0, 1.0), 1.0),),
}


@pytest.mark.parametrize("name", [field.name for field in fields(Overlays)])
def test_every_overlay_is_seen_on_a_large_mesh(large, monkeypatch, name):
    gestures.set_pose(large.editor, large.document.drawing.mesh.vertices + np.array([30.0, 0.0]))
    show(monkeypatch, NO_OVERLAYS)
    plain = canvas(large, large.screenshot())
    show(monkeypatch, Overlays(**{name: CHANGED[name](large.document.drawing)}))
    shown = canvas(large, large.screenshot())
    assert (shown != plain).any(axis=2).sum() > 100
    show(monkeypatch, NO_OVERLAYS)
    np.testing.assert_array_equal(canvas(large, large.screenshot()), plain)


@dataclass(frozen=True, eq=False)
class NewOverlays(Overlays):
    """An overlay that nobody has listed anywhere."""

    cross: LineSegments | None = None


def test_a_new_overlay_is_seen_on_a_large_mesh(large, monkeypatch):
    draw = Renderer.draw

    def draw_cross(renderer, *arguments, overlays=NO_OVERLAYS, **options):
        cross = getattr(overlays, "cross", None)
        lines = () if cross is None else (cross,)
        draw(renderer, *arguments, overlays=Overlays(lines=lines), **options)

    monkeypatch.setattr(Renderer, "draw", draw_cross)
    show(monkeypatch, NewOverlays())
    plain = canvas(large, large.screenshot())
    show(monkeypatch, NewOverlays(cross=line(large.document.drawing)))
    assert (canvas(large, large.screenshot()) != plain).any(axis=2).sum() > 100


def test_a_large_mesh_at_rest_is_drawn_once(large, draws):
    for _ in range(2):  # the first one ends a series of changes
        large.screenshot()
    count = len(draws)
    large.editor.pointer = large.to_screen((100.0, 80.0))
    large.screenshot()
    large.screenshot()
    assert len(draws) == count
    large.state.view.show_mesh = True
    large.screenshot()
    large.screenshot()
    assert len(draws) == count + 1
