"""The frames of an exported animation: their times and their order."""

import numpy as np
import pytest

from akap_editor.editor.animation.frames import Frame, frame_times, loops_seamlessly, playing_order
from akap_editor.errors import InputError


def test_frame_times():
    assert frame_times(1.0, 2.0, fps=4) == [1.0, 1.25, 1.5, 1.75, 2.0]
    assert frame_times(1.0, 2.0, fps=4, speed=2) == [1.0, 1.5, 2.0]
    assert frame_times(0.0, 0.0, fps=30) == [0.0]
    eased = frame_times(0.0, 1.0, fps=10, ease="in-out")
    assert eased[-1] == 1.0
    assert len(eased) == 11
    assert eased[1] < 0.05
    assert (np.diff(eased) > 0).all()


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"fps": 0}, "fps"),
        ({"fps": float("nan")}, "fps"),
        ({"fps": 30, "speed": 0}, "speed"),
        ({"fps": 30, "ease": "bounce"}, "ease"),
        ({"fps": 30, "end": -1.0}, "end"),
    ],
)
def test_bad_frame_times_are_named(options, name):
    with pytest.raises(InputError, match=f"^{name}: expected"):
        frame_times(**{"start": 0.0, "end": 1.0, **options})


@pytest.mark.parametrize(
    ("count", "ping_pong", "is_seamless_loop", "order"),
    [
        (4, False, False, [0, 1, 2, 3]),
        (4, False, True, [0, 1, 2]),
        (4, True, False, [0, 1, 2, 3, 2, 1]),
        (4, True, True, [0, 1, 2, 3, 2, 1]),
        (2, False, True, [0, 1]),
        (2, True, False, [0, 1]),
        (1, False, True, [0]),
        (1, True, False, [0]),
    ],
)
def test_playing_order(count, ping_pong, is_seamless_loop, order):
    assert playing_order(range(count), ping_pong, is_seamless_loop) == order


def test_a_loop_is_seamless_if_it_ends_as_it_begins(drawing):
    first = Frame(drawing, drawing.mesh.vertices)
    assert loops_seamlessly(first, Frame(drawing, drawing.mesh.vertices + 0.009))
    assert not loops_seamlessly(first, Frame(drawing, drawing.mesh.vertices + 0.02))
