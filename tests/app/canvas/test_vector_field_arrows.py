"""Arrows of the vector fields: their geometry, and when they are computed and shown."""

from imgui_bundle import imgui  # isort: skip
from threading import Event

import numpy as np
import pytest

from akap_editor.app.canvas.scene import scene_overlays
from akap_editor.app.canvas.vector_field_arrows import arrows, compressed, grid_vertices
from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.editor import gestures
from akap_editor.editor.session.edits import SetTargets
from tests.support.window_driver import DEADLINE


def test_arrows_stand_a_spacing_apart_and_cover_the_drawing(drawing):
    chosen = grid_vertices(drawing, 30.0)
    vertices = drawing.mesh.vertices
    assert len(np.unique(np.floor(vertices[chosen] / 30), axis=0)) == len(chosen)
    nearest = np.linalg.norm(vertices[:, None] - vertices[chosen], axis=2).min(axis=1)
    assert nearest.max() < 30 * np.sqrt(2) + 1e-9


def test_an_arrow_is_a_shaft_with_two_even_barbs():
    shaft, first, second = arrows(np.array([[1.0, 2.0]]), np.array([[10.0, 0.0]]), 3.0)
    np.testing.assert_allclose(shaft, [[1, 2], [11, 2]])
    np.testing.assert_allclose(first[0], (11, 2))
    np.testing.assert_allclose(first[1] - (11, 2), (second[1] - (11, 2)) * (1, -1))
    assert np.isfinite(arrows(np.zeros((1, 2)), np.zeros((1, 2)), 3.0)).all()


def test_the_length_of_an_arrow_grows_with_the_root_of_the_speed():
    lengths = np.linalg.norm(compressed(np.array([[1.0, 0], [0.25, 0], [0, 0]]), 8.0), axis=1)
    np.testing.assert_allclose(lengths, [8, 4, 0])


def test_the_fields_are_seen_during_a_drag_only(pinned):
    pinned.state.view.show_vector_fields = True
    start = pinned.to_screen(pinned.pin_position(3))
    counts = []

    def actions(hand):
        pinned.begin_drag(hand, start)
        hand.mouse_move_to_pos(imgui.ImVec2(start[0] - 30, start[1] - 100))
        hand.yield_(2)
        while pinned.state.is_busy:
            hand.yield_()
        counts.append([len(s.segments) for s in scene_overlays(pinned.state, 1.0).lines])
        hand.mouse_up(0)

    pinned.do(actions)
    (outline, u_smooth, u_opt) = counts[0]
    assert outline == u_smooth == u_opt > 30
    assert scene_overlays(pinned.state, 1.0).lines == ()


@pytest.fixture
def gate(monkeypatch):
    """Vector fields are computed once it is set."""
    gate, fields = Event(), AkapDeformer.vector_fields

    def wait(*motion):
        assert gate.wait(DEADLINE)
        return fields(*motion)

    monkeypatch.setattr(AkapDeformer, "vector_fields", wait)
    yield gate
    gate.set()


@pytest.mark.parametrize("ends", ["at rest", "switched off", "closed"])
def test_the_window_sleeps_though_fields_came_too_late_to_be_seen(pinned, gate, ends):
    pinned.state.view.show_vector_fields = True
    gestures.move_pin(pinned.editor, 3, tuple(pinned.pin_position(3) - (0, 20)))
    while not pinned.state.view.is_computing:
        pinned.frame()
    if ends == "switched off":
        pinned.state.view.show_vector_fields = False
    elif ends == "closed":
        pinned.editor.close()
    else:
        gate.set()
        pinned.session.stop_motion()
    gate.set()
    pinned.settle()
    assert not pinned.state.is_busy


def test_fields_are_computed_beside_the_window_and_then_shown(pinned, gate):
    pinned.state.view.show_vector_fields = True
    x, y = pinned.pin_position(3)
    pinned.session.begin("Drag Pin")
    pinned.session.apply(SetTargets({3: (x, y - 40)}))
    while not pinned.state.view.is_computing:
        pinned.frame()
    frames = pinned.window.frames
    pinned.frame()
    assert pinned.window.frames == frames + 1
    assert not scene_overlays(pinned.state, 1.0).lines
    gate.set()
    seen = []
    while pinned.state.is_busy:
        pinned.frame()
        seen.append(len(scene_overlays(pinned.state, 1.0).lines))
    pinned.session.commit()
    assert max(seen) > 0
    pinned.settle()
