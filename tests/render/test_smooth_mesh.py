"""Bent drawings with curved faces, as pictures."""

import numpy as np
import pytest

from akap_editor.editor.document.drawing import make_drawing
from akap_editor.render.offscreen import OffscreenRenderer
from tests.support.pictures import colored

SIZE = 40.0
BOX = (-20, -60, 120, 60)


@pytest.fixture(scope="module")
def strip():
    """A plain opaque strip, (30, 120) pixels."""
    return make_drawing(colored(np.ones((30, 120)), (200, 80, 40)), vertices=60)


def rolled(points, share=1.0):
    """The strip rolled to a part of a ring."""
    angle, radius = share * points[:, 0] / 45.0, 20.0 + points[:, 1]
    return np.column_stack([40.0 + radius * np.sin(angle), radius * -np.cos(angle)])


@pytest.fixture
def render(ctx):
    """Renders a drawing with curved faces, or with flat ones."""
    made = []

    def draw(drawing, pose, smooth):
        made.append(OffscreenRenderer(ctx, is_smooth=smooth))
        return made[-1].render(drawing, pose, BOX, 4.0)

    yield draw
    for renderer in made:
        renderer.release()


def test_at_rest_both_are_equal_to_the_bit(render, strip):
    rest = strip.mesh.vertices
    assert (render(strip, rest.copy(), True) == render(strip, rest, False)).all()


def test_a_bend_is_round_and_has_no_holes(render, strip):
    pose = rolled(strip.mesh.vertices)
    smooth, flat = (render(strip, pose, kind)[..., 3] / 255.0 for kind in (True, False))
    y, x = np.mgrid[: smooth.shape[0], : smooth.shape[1]] / 4.0 + 0.125
    x, y = x + BOX[0] - 40.0, y + BOX[1]
    radius, angle = np.hypot(x, y), np.arctan2(x, -y)
    inside = (radius > 21) & (radius < 49) & (angle > 0.1) & (angle < 120 / 45.0 - 0.1)
    assert (smooth[inside] == 1.0).all()
    rim = (np.abs(radius - 50) < 2) & (angle > 0.1) & (angle < 120 / 45.0 - 0.1)
    exact = np.clip((50 - radius) * 4 + 0.5, 0.0, 1.0)
    wrong, wrong_flat = (np.abs(each - exact)[rim].mean() for each in (smooth, flat))
    assert wrong < 0.6 * wrong_flat


def test_an_order_of_the_faces_is_kept(ctx, strip):
    pose = rolled(strip.mesh.vertices, 2.6)  # over itself
    count = len(strip.mesh.faces)
    with OffscreenRenderer(ctx) as renderer:
        one = renderer.render(strip, pose, BOX, 2.0, None, np.arange(count, dtype=np.int32))
        other = renderer.render(strip, pose, BOX, 2.0, None, np.arange(count, dtype=np.int32)[::-1].copy())
        half = renderer.render(strip, pose, BOX, 2.0, None, np.arange(count // 2, dtype=np.int32))
    assert (one[..., 3] == other[..., 3]).mean() > 0.99
    assert half[..., 3].sum() < one[..., 3].sum()
