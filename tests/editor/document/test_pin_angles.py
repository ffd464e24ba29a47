"""Angles of pins: measured from the pose, fixed and held by pins, and counted beyond half a turn."""

import numpy as np
import pytest

from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.pin_angles import (
    FullTurnCounter,
    pin_angles,
    pins_fixed_at_pose,
    with_held_angles,
)


@pytest.fixture
def pins(drawing):
    """Pin 1 rotates freely, pin 2 holds an angle."""
    points = drawing.mesh.locate([(20.0, 40.0), (105.0, 40.0)])
    free, held = zip(points.faces.tolist(), points.weights, strict=True)
    return Pin(1, *free, (20.0, 40.0)), Pin(2, *held, (105.0, 40.0), angle=0.1)


def rotated(drawing, angle):
    """The rest pose rotated about the origin, clockwise on the screen."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return drawing.mesh.vertices @ np.array([[cosine, sine], [-sine, cosine]])


@pytest.mark.parametrize("angle", [0.0, 0.5, -3.0, 3.0])
def test_angles_of_a_rotated_drawing(drawing, pins, angle):
    pose = rotated(drawing, angle)
    np.testing.assert_allclose(pin_angles(drawing.mesh, pins, pose), [np.nan, angle], atol=1e-12)
    np.testing.assert_allclose(pin_angles(drawing.mesh, pins, pose, {1}), [angle, angle], atol=1e-12)
    assert np.isnan(pin_angles(drawing.mesh, pins[:1], pose)).all()


def test_pins_fixed_at_a_pose_have_its_positions_and_angles_as_goals(drawing, pins):
    pose = rotated(drawing, 0.5)
    fixed = pins_fixed_at_pose(drawing.mesh, pins, pose)
    places = [(pin.face, pin.weights.tolist()) for pin in pins]
    assert [(pin.face, pin.weights.tolist()) for pin in fixed] == places
    for old, new in zip(pins, fixed, strict=True):
        x, y = old.target
        expected = x * np.cos(0.5) - y * np.sin(0.5), x * np.sin(0.5) + y * np.cos(0.5)
        np.testing.assert_allclose(new.target, expected, atol=1e-9)
    assert fixed[0].angle is None
    assert fixed[1].angle == pytest.approx(0.5)


def test_pins_hold_the_angles_of_a_pose_or_release_them(drawing, pins):
    pose = rotated(drawing, 0.5)
    held = with_held_angles(drawing.mesh, pins, pose, {1}, True)
    assert held[0].angle == pytest.approx(0.5)
    assert held[1] is pins[1]
    released = with_held_angles(drawing.mesh, held, pose, {1, 2}, False)
    assert [pin.angle for pin in released] == [None, None]


def test_full_turns_are_counted_until_a_reset(pins):
    counter, pin = FullTurnCounter(), pins[1:]
    turns = np.linspace(0.1, 4 * np.pi, 30)
    wrapped = np.angle(np.exp(1j * turns))
    counted = [counter.unwrap(pin, np.array([angle]))[0] for angle in wrapped]
    np.testing.assert_allclose(counted, turns, atol=1e-12)
    counter.reset()
    assert counter.unwrap(pin, wrapped[-1:])[0] == pytest.approx(0.0, abs=1e-12)
