"""A short drag of a small bar, recorded, for tests of what replays recordings."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import Recording
from akap_editor.editor.session.session import Session

Point = tuple[float, float]


def record_drag(
    drawing: Drawing, points: Sequence[Point], offsets: Sequence[Point], moves: int = 12
) -> Recording:
    """Add pins at ``points`` and drag them by ``offsets`` in equal moves, with one step after each."""
    session = Session(new_document(drawing), clock=iter(np.arange(1e4) / 30).__next__)
    session.begin("Add Pins")
    pins = [add_pin(session, point) for point in points]
    session.commit()
    session.begin("Drag Pins")
    for move in range(1, moves + 1):
        targets = np.add(points, np.multiply(offsets, move / moves)).tolist()
        session.apply(SetTargets({pin: tuple(target) for pin, target in zip(pins, targets, strict=True)}))
        session.step()
    session.commit()
    return session.recording


@cache
def plank_drawing() -> Drawing:
    """A bar of 130 × 30 pixels with about 120 vertices."""
    image = np.zeros((50, 150, 4), dtype=np.uint8)
    image[10:40, 10:140] = (250, 130, 20, 255)
    return make_drawing(image, vertices=120, name="plank")


@cache
def plank_recording() -> Recording:
    """The bar, held by two pins at its left end, while a third pin drags its right end."""
    points = [(20.0, 20.0), (20.0, 32.0), (130.0, 25.0)]
    return record_drag(plank_drawing(), points, [(0.0, 0.0), (0.0, 0.0), (-15.0, 30.0)])
