"""Overlays of the View menu: their colors, and that the window shows them and an export does not."""

from imgui_bundle import imgui  # isort: skip
import numpy as np
import pytest

from akap_editor.app.canvas.scene import scene_overlays
from akap_editor.app.canvas.view_options import distortion_colors
from akap_editor.geometry.distortion import distortion
from akap_editor.render.overlays import FaceColors
from tests.support.meshers import needs_triangle

Key = imgui.Key


def canvas(ui, shot):
    left, top, right, bottom = map(round, ui.editor.canvas)
    return shot[top:bottom, left:right].astype(int)


# -- colors -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("stretch", "area", "angle"),
    [((1, 1), 0.5, 0.0), ((1.2, 1.2), "up", 0.0), ((0.8, 0.8), "down", 0.0), ((1.2, 1 / 1.2), 0.5, "up")],
)
def test_levels_of_even_stretches(drawing, stretch, area, angle):
    measured = distortion(drawing.mesh, drawing.mesh.vertices * stretch)
    product, ratio = np.log(stretch[0] * stretch[1]), abs(np.log(stretch[0] / stretch[1]))
    span = np.log(1.5)
    expected = {0.5: 0.5, "up": 0.5 + 0.5 * product / span, "down": max(0.5 + 0.5 * product / span, 0)}[area]
    np.testing.assert_allclose(distortion_colors(measured, "area", 1.5).levels, expected, atol=1e-6)
    expected = 0.0 if angle == 0.0 else ratio / span
    np.testing.assert_allclose(distortion_colors(measured, "angle", 1.5).levels, expected, atol=1e-5)


def test_flipped_and_collapsed_faces_are_off_the_scale(drawing):
    for factor in (-1, 0):
        measured = distortion(drawing.mesh, drawing.mesh.vertices * (factor, 1))
        for measure in ("area", "angle"):
            assert (distortion_colors(measured, measure, 2.0).levels == -1).all()


# -- the window ---------------------------------------------------------------------------------------------


def exported(ui):
    return ui.state.offscreen_renderer.render(ui.document.drawing, ui.session.state.positions)


def bend(ui):
    start = ui.to_screen(ui.pin_position(3))
    ui.drag(start, (start[0] - 30, start[1] - 120))


@pytest.mark.parametrize("name", ["distortion_measure", "show_rest_pose", "show_pin_trails", "reference"])
def test_an_overlay_is_seen_and_gone_again_and_never_exported(pinned, name):
    bend(pinned)
    plain = canvas(pinned, pinned.screenshot())
    before = exported(pinned)
    if name == "reference":
        pinned.state.view.set_reference(np.full((30, 30, 4), (200, 0, 0, 255), dtype=np.uint8))
    else:
        setattr(pinned.state.view, name, "area" if name == "distortion_measure" else True)
    shown = canvas(pinned, pinned.screenshot())
    assert (shown != plain).any(axis=2).sum() > 300
    assert (exported(pinned) == before).all()
    if name == "reference":
        pinned.state.view.show_reference = False
    else:
        setattr(pinned.state.view, name, None if name == "distortion_measure" else False)
    assert (canvas(pinned, pinned.screenshot()) == plain).all()


@needs_triangle
def test_a_stroke_of_the_brush_is_tinted_only_while_the_brush_is_at_hand(pinned):
    plain = pinned.screenshot()
    pinned.key(Key.b)
    start, end = pinned.to_screen((120.0, 80.0)), pinned.to_screen((160.0, 80.0))
    pinned.drag(start, end)
    stiffness = pinned.session.state.stiffness
    assert stiffness.max() == 100.0
    assert len(pinned.pins) == 3
    assert isinstance(scene_overlays(pinned.state, 1.0).face_colors, FaceColors)
    tinted = pinned.screenshot()
    x, y = map(round, pinned.to_screen((140.0, 70.0)))
    assert (tinted[y, x] != plain[y, x]).any()
    pinned.key(Key.p)
    assert scene_overlays(pinned.state, 1.0).face_colors is None
    assert (pinned.screenshot()[y, x] == plain[y, x]).all()
    pinned.key(Key.b)
    pinned.drag(start, end, button=1)
    assert pinned.session.state.stiffness is None or pinned.session.state.stiffness.max() < 100.0
    assert pinned.session.history.labels == ["Paint Stiffness", "Erase Stiffness"]
