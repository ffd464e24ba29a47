"""The axis of the mirror, drawn by hand."""

import math

import pytest

from akap_editor.editor.events import KeyEvent, PointerEvent
from akap_editor.editor.tools.mirror_axis import draw_axis
from tests.support.editor_driver import bits


def event(driver, kind, at, **more):
    driver.handle(PointerEvent(kind, driver.editor.camera.to_screen(at), **more))


@pytest.fixture
def drawing_axis(pinned):
    draw_axis(pinned.editor)
    event(pinned, "press", (40.0, 20.0))
    return pinned


@pytest.mark.parametrize(("shift", "degrees"), [(False, 84), (True, 90)])
def test_a_drag_sets_it_and_shift_snaps(drawing_axis, shift, degrees):
    end = 40.0 + 50 * math.cos(math.radians(84)), 20.0 + 50 * math.sin(math.radians(84))
    event(drawing_axis, "move", end, shift=shift)
    assert drawing_axis.editor.tool.markers.mirror_axis is not None
    event(drawing_axis, "release", end, shift=shift)
    mirror = drawing_axis.state.mirror
    assert math.degrees(mirror.angle) == pytest.approx(degrees, abs=0.5)
    assert mirror.distances([(40.0, 20.0)])[0] < 1e-6
    assert mirror.is_on
    assert drawing_axis.editor.tool is drawing_axis.editor.pins_tool


def test_a_slip_and_escape_set_none(drawing_axis):
    before = bits(drawing_axis.state)
    event(drawing_axis, "release", (40.5, 20.0))
    draw_axis(drawing_axis.editor)
    event(drawing_axis, "press", (40.0, 20.0))
    event(drawing_axis, "move", (40.0, 60.0))
    drawing_axis.handle(KeyEvent("escape"))
    assert bits(drawing_axis.state) == before
    draw_axis(drawing_axis.editor)
    drawing_axis.handle(KeyEvent("escape"))
    assert drawing_axis.editor.tool is drawing_axis.editor.pins_tool
