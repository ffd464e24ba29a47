"""A monitor of 200 %: everything is twice as large, and the mouse still hits it."""

import numpy as np
import pytest

from akap_editor.editor.editor import PICK_RADIUS


@pytest.fixture(scope="module")
def module_window(new_window):
    return new_window(scale=2.0, size=(2560, 1600))


def test_panels_take_twice_the_room(ui):
    left, top, right, bottom = ui.editor.canvas
    assert (left, right) == (2 * 48.0, 2560 - 2 * 288.0)
    assert 0 < top < bottom < 1600
    assert ui.screenshot().shape == (1600, 2560, 3)


@pytest.mark.parametrize(("distance", "picked"), [(2 * PICK_RADIUS - 1, True), (2 * PICK_RADIUS + 1, False)])
def test_pins_are_picked_within_their_radius(pinned, distance, picked):
    assert PICK_RADIUS == 12
    x, y = pinned.editor.camera.to_screen(pinned.pin_position(2))
    at = float(round(x)), float(round(y + distance))
    pinned.click(at)
    assert pinned.editor.selection == ({2} if picked else {4})
    assert len(pinned.pins) == (3 if picked else 4)


def test_a_drag_lands_where_it_ends(pinned):
    start = pinned.to_screen(pinned.pin_position(3))
    wanted = pinned.pin_position(3) + np.array([0, -300]) / pinned.editor.camera.zoom
    pinned.drag(start, (start[0], start[1] - 300))
    assert np.linalg.norm(pinned.pin_position(3) - wanted) < 0.25


def test_buttons_and_menus_are_hit(pinned):
    pinned.menu("View", "Show Mesh")
    assert pinned.state.view.show_mesh
    pinned.tab("Mesh")
    pinned.panel("Mesh")
    assert not pinned.state.view.show_mesh
