"""Which pin hangs on which: the shortest tree through the drawing, from its middle."""

import numpy as np

from akap_editor.editor.animation.clips.pin_tree import pin_tree
from akap_editor.editor.document.pin import Pin
from akap_editor.geometry.mesh import TriMesh


def bar_pins(*places):
    """Pins on a bar from (0, 0) to (20, 2)."""
    x, y = np.meshgrid(np.arange(21.0), np.arange(3.0))
    corner = (np.arange(20)[None, :] + 21 * np.arange(2)[:, None]).ravel()
    a, b, c, d = corner, corner + 1, corner + 22, corner + 21
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = TriMesh(np.stack([x.ravel(), y.ravel()], axis=1), faces)
    points = mesh.locate([[place, 1.2] for place in places])
    pins = [
        Pin(number, int(face), weights, np.zeros(2))
        for number, (face, weights) in enumerate(zip(points.faces, points.weights, strict=True))
    ]
    return mesh, pins


def test_pins_along_a_bar_are_a_chain_from_the_middle():
    assert pin_tree(*bar_pins(1, 5, 10, 15, 19)) == [1, 2, None, 2, 3]
    assert pin_tree(*bar_pins(19, 1, 10)) == [2, 2, None]


def test_few_pins_and_pins_at_one_place():
    assert pin_tree(*bar_pins()) == []
    assert pin_tree(*bar_pins(4)) == [None]
    assert pin_tree(*bar_pins(4, 4, 4)).count(None) == 1
