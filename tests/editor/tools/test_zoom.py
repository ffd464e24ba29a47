"""The zoom tool: clicks and drags change the view about the place of the press, and edit nothing."""

import pytest

from akap_editor.editor.events import KeyEvent, PointerEvent
from akap_editor.editor.tools.zoom import CLICK_FACTOR

AT = (40.0, 60.0)  # on the screen


@pytest.fixture
def zooming(pinned):
    pinned.editor.chosen_tool = pinned.editor.zoom_tool
    return pinned


def event(driver, kind, at=AT, **more):
    driver.handle(PointerEvent(kind, at, **more))


@pytest.mark.parametrize(
    ("how", "factor"),
    [({}, CLICK_FACTOR), ({"alt": True}, 1 / CLICK_FACTOR), ({"button": "right"}, 1 / CLICK_FACTOR)],
)
def test_a_click_zooms_about_its_place(zooming, how, factor):
    before, camera = zooming.everything[:-1], zooming.editor.camera
    event(zooming, "press", **how)
    event(zooming, "release", **how)
    assert zooming.editor.camera.zoom == pytest.approx(factor * camera.zoom)
    assert zooming.editor.camera.to_drawing(AT) == pytest.approx(camera.to_drawing(AT))
    assert zooming.everything[:-1] == before


def test_a_drag_zooms_continuously_and_escape_returns(zooming):
    camera, zooms = zooming.editor.camera, []
    event(zooming, "press")
    for x in (60.0, 100.0, 160.0):
        event(zooming, "move", (x, 60.0))
        zooms.append(zooming.editor.camera.zoom)
        assert zooming.editor.camera.to_drawing(AT) == pytest.approx(camera.to_drawing(AT))
    assert zooms == sorted(zooms)
    assert zooms[-1] == pytest.approx(2 * camera.zoom)
    zooming.key("escape")
    assert zooming.editor.camera == camera
    assert zooming.tool == "ZoomIdle"


def test_the_held_key_zooms_with_any_tool(pinned):
    pinned.key("zoom")
    assert pinned.tool == "ZoomIdle"
    pinned.handle(KeyEvent("zoom", False))
    assert pinned.tool == "PinsIdle"
