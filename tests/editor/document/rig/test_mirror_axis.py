"""The axis that is found in a drawing."""

import math

import numpy as np
import pytest

from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.rig.mirror_axis import find_mirror
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.pictures import colored

SIDE = 200


def beetle(degrees: float, shift: float = 0.0) -> np.ndarray:
    """A body with two feelers and six legs, alike on both sides of a tilted axis beside the middle."""
    y, x = np.mgrid[:SIDE, :SIDE] + 0.5
    angle = math.radians(degrees)
    along = (x - SIDE / 2 - shift) * math.cos(angle) + (y - SIDE / 2) * math.sin(angle)
    across = np.abs(-(x - SIDE / 2 - shift) * math.sin(angle) + (y - SIDE / 2) * math.cos(angle))
    shape = (along / 60) ** 2 + (across / 30) ** 2 < 1
    for leg in (-30, 0, 35):
        shape |= (np.abs(along - leg - 0.3 * across) < 6) & (across < 62)
    shape |= (np.abs(across - 12 - 0.5 * (along - 50)) < 5) & (along > 45) & (along < 85)
    return colored(shape, (200, 90, 40))


@pytest.mark.parametrize(("degrees", "shift"), [(90, 0), (90, 14), (60, -8), (0, 0), (135, 5)])
def test_the_axis_of_a_symmetric_figure_is_found(degrees, shift):
    mirror = find_mirror(make_drawing(beetle(degrees, shift), vertices=200))
    off = math.degrees(mirror.angle) - degrees
    assert abs(math.remainder(off, 180)) <= 2.0
    assert mirror.distances([(SIDE / 2 + shift, SIDE / 2)])[0] < 4.0


@pytest.mark.parametrize(("name", "degrees"), [("gingerbread", 81), ("alien", 90)])
def test_the_axis_of_a_bundled_figure_is_found(name, degrees):
    drawing = make_drawing(read_image(resource("assets", "drawings", f"{name}.png")), vertices=200)
    assert math.degrees(find_mirror(drawing).angle) == pytest.approx(degrees, abs=6)


def test_without_opaque_pixels_it_is_upright_in_the_middle():
    picture = np.full((60, 80, 4), 20, np.uint8)
    mirror = find_mirror(make_drawing(picture, threshold=0.02, vertices=200))
    assert (mirror.x, mirror.y, mirror.angle) == (40.0, 30.0, math.pi / 2)
