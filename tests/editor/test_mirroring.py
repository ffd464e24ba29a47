"""Gestures of the mirror on a drawing that is symmetric about an upright axis."""

import math

import numpy as np
import pytest

from akap_editor.editor import gestures, mirroring
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.rig.mirror import Mirror
from akap_editor.editor.events import KeyEvent, PointerEvent
from akap_editor.editor.session.edits import SetMirror
from akap_editor.errors import InputError
from tests.support.editor_driver import Driver, bits, replayed_state
from tests.support.pictures import colored

MIDDLE = 100.0
AXIS = Mirror(MIDDLE, 50.0, math.pi / 2)
LEFT, RIGHT, TOP = (30.0, 60.0), (170.0, 60.0), (100.0, 25.0)


@pytest.fixture(scope="module")
def cross():
    """A body with two arms, alike left and right, (100, 200) pixels."""
    y, x = np.mgrid[:100, :200] + 0.5
    shape = (np.abs(x - MIDDLE) < 25) | ((np.abs(y - 60) < 14) & (np.abs(x - MIDDLE) < 90))
    shape &= (y > 8) & (y < 94)
    return make_drawing(colored(shape, (80, 160, 90)), vertices=200)


@pytest.fixture
def mirrored(cross):
    """A driver with the mirror on, and no pins."""
    driver = Driver(new_document(cross))
    driver.editor.apply("Mirror On", SetMirror(AXIS))
    return driver


def pointer(driver, kind, at):
    driver.handle(PointerEvent(kind, driver.editor.camera.to_screen(at)))


def drag(driver, *path):
    pointer(driver, "move", path[0])
    pointer(driver, "press", path[0])
    for point in path[1:]:
        pointer(driver, "move", point)
    pointer(driver, "release", path[-1])
    driver.settle()


def targets(driver):
    return {pin.id: pin.target.tolist() for pin in driver.state.pins}


def is_mirrored(driver, first, second):
    np.testing.assert_allclose(targets(driver)[second], AXIS.points([targets(driver)[first]])[0], atol=1e-6)


def test_a_pin_gets_a_partner_across_and_they_are_dragged_as_one(mirrored):
    before = bits(mirrored.state)
    drag(mirrored, LEFT, (28.0, 40.0), (26.0, 30.0))
    assert mirrored.state.mirror.pairs == ((1, 2),)
    is_mirrored(mirrored, 1, 2)
    assert targets(mirrored)[1] == pytest.approx([26.0, 30.0])
    assert mirrored.session.history.labels[-1] == "Add and Drag Pin"
    mirrored.editor.undo()
    assert bits(mirrored.state) == before


def test_a_pin_on_the_axis_has_no_partner_and_goes_where_it_is_dragged(mirrored):
    for place in (LEFT, TOP):
        drag(mirrored, place)
    drag(mirrored, TOP, (112.0, 20.0))
    assert [pin.id for pin in mirrored.state.pins] == [1, 2, 3]
    assert targets(mirrored)[3] == pytest.approx([112.0, 20.0])
    assert targets(mirrored)[1] == pytest.approx(LEFT)


def test_a_pin_that_is_there_becomes_the_partner(cross):
    driver = Driver(new_document(cross))
    drag(driver, RIGHT)
    driver.editor.apply("Mirror On", SetMirror(AXIS))
    drag(driver, LEFT)
    assert len(driver.state.pins) == 2
    assert driver.state.mirror.partner(1) == 2


def test_turning_it_on_finds_the_axis_and_pairs(cross):
    driver = Driver(new_document(cross))
    for place in (LEFT, RIGHT, TOP):
        drag(driver, place)
    mirroring.toggle_mirror(driver.editor)
    mirror = driver.state.mirror
    assert (mirror.pairs, mirror.is_on) == (((1, 2),), True)
    assert math.degrees(mirror.angle) == pytest.approx(90, abs=2)
    assert mirror.x == pytest.approx(MIDDLE, abs=2)
    mirroring.toggle_mirror(driver.editor)
    assert not driver.state.mirror.is_on
    drag(driver, LEFT, (40.0, 40.0))
    assert targets(driver)[2] == pytest.approx(RIGHT)


def test_both_selected_and_one_dragged_mirrors_the_other(mirrored):
    drag(mirrored, LEFT)
    mirrored.editor.select({1, 2})
    drag(mirrored, RIGHT, (160.0, 40.0))
    assert targets(mirrored)[2] == pytest.approx([160.0, 40.0])
    is_mirrored(mirrored, 2, 1)


def test_a_locked_partner_stays(mirrored):
    drag(mirrored, LEFT)
    gestures.set_pin_locked(mirrored.editor, 2, True)
    drag(mirrored, LEFT, (30.0, 40.0))
    assert targets(mirrored)[2] == pytest.approx(RIGHT)


def test_arrows_nudge_both(mirrored):
    drag(mirrored, LEFT)
    mirrored.editor.select({1})
    mirrored.handle(KeyEvent("right"))
    assert targets(mirrored)[1] == pytest.approx([LEFT[0] + 1, LEFT[1]])
    is_mirrored(mirrored, 1, 2)


def test_escape_restores_both_to_the_bit(mirrored):
    drag(mirrored, LEFT)
    before = bits(mirrored.state)
    pointer(mirrored, "press", LEFT)
    pointer(mirrored, "move", (40.0, 30.0))
    mirrored.handle(KeyEvent("escape"))
    assert bits(mirrored.state) == before


def test_a_rotation_is_mirrored(mirrored):
    drag(mirrored, LEFT)
    mirrored.editor.select({1})
    x, y = mirrored.editor.camera.to_screen(LEFT)
    path = [(x + 28 * math.cos(a), y + 28 * math.sin(a)) for a in np.radians([-90, -75, -60])]
    for kind, at in (
        ("move", path[0]),
        ("press", path[0]),
        ("move", path[1]),
        ("move", path[2]),
        ("release", path[2]),
    ):
        mirrored.handle(PointerEvent(kind, at))
    mirrored.settle()
    first, second = (mirrored.state.pin(pin).angle for pin in (1, 2))
    assert first == pytest.approx(math.radians(30), abs=0.02)
    assert second == pytest.approx(-first)


@pytest.fixture
def waving(mirrored):
    """The left arm is up, by the mirror off; a pin in the middle holds."""
    for place in (LEFT, TOP, (100.0, 88.0)):
        drag(mirrored, place)
    mirroring.toggle_mirror(mirrored.editor)
    drag(mirrored, LEFT, (28.0, 45.0), (30.0, 30.0))
    return mirrored


def test_a_flipped_pose_is_mirrored_and_flips_back(waving):
    pose, before = waving.state.positions, targets(waving)
    mirroring.flip_pose(waving.editor)
    waving.settle()
    assert targets(waving)[2] == pytest.approx(AXIS.points([before[1]])[0])
    assert targets(waving)[1] == pytest.approx(AXIS.points([before[2]])[0])
    places = waving.session.pin_positions()
    np.testing.assert_allclose(places, [targets(waving)[pin.id] for pin in waving.state.pins], atol=0.3)
    mirroring.flip_pose(waving.editor)
    waving.settle()
    assert targets(waving) == {pin: pytest.approx(target) for pin, target in before.items()}
    assert np.abs(waving.state.positions - pose).max() < 1.5
    assert waving.session.history.labels[-2:] == ["Flip Pose"] * 2


def test_a_flip_that_changes_nothing_is_no_gesture(mirrored):
    for place in (TOP, LEFT):
        drag(mirrored, place)
    before = mirrored.session.history.labels, mirrored.state
    mirroring.flip_pose(mirrored.editor)
    assert mirrored.session.history.labels == before[0]
    assert mirrored.state is before[1]


def test_all_of_it_is_replayed_to_the_bit(waving, cross):
    mirroring.flip_pose(waving.editor)
    waving.settle()
    assert bits(replayed_state(waving.session.recording, cross)) == bits(waving.state)


def test_pairs_are_made_and_ended_by_hand(mirrored):
    for place in (TOP, (100.0, 88.0)):
        drag(mirrored, place)
    mirrored.editor.select({1, 2})
    mirroring.pair_selected(mirrored.editor)
    assert mirrored.state.mirror.partner(1) == 2
    mirroring.unpair_selected(mirrored.editor)
    assert mirrored.state.mirror.pairs == ()
    mirrored.editor.select({1})
    with pytest.raises(InputError, match="expected 2 pins"):
        mirroring.pair_selected(mirrored.editor)


def test_a_removed_pin_leaves_its_pair(mirrored):
    drag(mirrored, LEFT)
    gestures.remove_pins(mirrored.editor, {2})
    assert mirrored.state.mirror.pairs == ()
