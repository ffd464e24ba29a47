"""Suggested pins: ghosts that are moved or removed, and then added in one step."""

import numpy as np
import pytest

from akap_editor.editor.events import PointerEvent
from akap_editor.editor.tools.suggested_pins import MIN_DISTANCE, suggest_pins


@pytest.fixture
def suggesting(pinned):
    """A driver whose drawing has pins and suggestions beside them."""
    suggest_pins(pinned.editor)
    return pinned


def ghosts(driver):
    return [ghost.position for ghost in driver.editor.tool.ghosts]


def event(driver, kind, at, **more):
    driver.handle(PointerEvent(kind, driver.editor.camera.to_screen(at), **more))


def test_they_are_on_the_drawing_and_away_from_the_pins(suggesting):
    mesh = suggesting.session.drawing.mesh
    assert ghosts(suggesting)
    for position in ghosts(suggesting):
        assert mesh.find(position) is not None
        places = suggesting.session.pin_positions()
        assert np.linalg.norm(places - position, axis=1).min() > MIN_DISTANCE * mesh.length
    assert suggesting.state.pins == suggesting.session.state.pins


def test_enter_adds_them_in_one_step_and_selects_none(suggesting):
    before, positions = len(suggesting.state.pins), ghosts(suggesting)
    pose = suggesting.state.positions.tobytes()
    suggesting.key("enter")
    added = suggesting.state.pins[before:]
    np.testing.assert_allclose([pin.target for pin in added], positions)
    assert not suggesting.editor.selection, "otherwise a drag of one would move all"
    assert suggesting.state.positions.tobytes() == pose
    assert suggesting.tool == "PinsIdle"
    suggesting.editor.undo()
    assert len(suggesting.state.pins) == before


def test_escape_cancels_them(suggesting):
    before = suggesting.everything[:-1]
    suggesting.key("escape")
    assert suggesting.tool == "PinsIdle"
    assert suggesting.everything[:-1] == before


def test_one_is_moved(suggesting):
    first, *others = ghosts(suggesting)
    x, y = others[0]
    event(suggesting, "press", first)
    event(suggesting, "move", (x + 1.0, y))
    event(suggesting, "move", (-500.0, -500.0))  # beside the drawing: it stays where it was
    event(suggesting, "release", (-500.0, -500.0))
    assert ghosts(suggesting)[0] == pytest.approx((x + 1.0, y))
    assert ghosts(suggesting)[1:] == others
    event(suggesting, "move", first)
    assert ghosts(suggesting)[0] == pytest.approx((x + 1.0, y)), "a released one stays"


def test_escape_takes_a_movement_back(suggesting):
    first, *others = before = ghosts(suggesting)
    event(suggesting, "press", first)
    event(suggesting, "move", others[0])
    suggesting.key("escape")
    assert ghosts(suggesting) == before


def test_a_pan_keeps_them(suggesting):
    before, tool = ghosts(suggesting), suggesting.editor.tool
    event(suggesting, "press", before[0], button="middle")
    event(suggesting, "move", before[1])
    event(suggesting, "release", before[1], button="middle")
    assert suggesting.editor.tool is tool
    assert ghosts(suggesting) == before


@pytest.mark.parametrize("how", [{"alt": True}, {"button": "right"}])
def test_one_is_removed(suggesting, how):
    first, *others = ghosts(suggesting)
    event(suggesting, "press", first, **how)
    event(suggesting, "release", first, **how)
    assert ghosts(suggesting) == others


def test_a_press_beside_them_does_nothing(suggesting):
    before = ghosts(suggesting), suggesting.everything[:-1]
    event(suggesting, "press", (-500.0, -500.0))
    event(suggesting, "release", (-500.0, -500.0))
    assert (ghosts(suggesting), suggesting.everything[:-1]) == before


def test_without_a_drawing_and_during_a_gesture_nothing_is_suggested(pinned):
    event(pinned, "press", pinned.session.pin_positions()[0])
    tool = pinned.tool
    suggest_pins(pinned.editor)
    assert pinned.tool == tool
    pinned.key("escape")
    pinned.editor.close()
    suggest_pins(pinned.editor)
    assert pinned.tool == "PinsIdle"
