"""Pins copy their arrays, and a list of them gives points of the mesh in the same order."""

import json

import numpy as np

from akap_editor.editor.document.pin import Pin, pin_points


def test_a_pin_copies_its_target():
    argument = np.array([3.0, 4.0])
    pin = Pin(1, 0, np.array([1.0, 0.0, 0.0]), argument)
    argument[:] = 0
    assert pin.target.tolist() == [3.0, 4.0]


def test_points_of_pins_are_in_the_order_of_the_pins():
    pins = (Pin(5, 0, [1, 0, 0], [1, 2]), Pin(3, 7, [0, 0.5, 0.5], [3, 4]))
    points = pin_points(pins)
    assert points.faces.tolist() == [0, 7]
    assert points.weights.tolist() == [[1, 0, 0], [0, 0.5, 0.5]]
    assert pin_points(()).weights.shape == (0, 3)


def test_json_leaves_out_depth_0_and_no_angle():
    plain = Pin(np.int64(1), np.int32(2), [1, 0, 0], [3, 4])
    assert json.loads(json.dumps(plain.to_json())) == {
        "id": 1,
        "face": 2,
        "weights": [1, 0, 0],
        "target": [3, 4],
    }
    full = Pin(1, 2, [1, 0, 0], [3, 4], depth=-2, angle=0.0).to_json()
    assert (full["depth"], full["angle"]) == (-2, 0.0)
