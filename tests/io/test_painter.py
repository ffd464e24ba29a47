"""The pictures of an animation's frames."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from akap_editor.editor.animation.frames import Frame
from akap_editor.editor.framing import MAX_SIZE, output_size
from akap_editor.errors import InputError
from akap_editor.io.painter import paint_frames


@dataclass
class RecordingPainter:
    """Returns empty pictures and records the arguments of each call."""

    calls: list[tuple[Any, ...]] = field(default_factory=list)

    def render(self, *arguments):
        self.calls.append(arguments)
        return np.zeros((1, 1, 4), dtype=np.uint8)


@pytest.fixture
def drawing(document):
    return document.drawing


def test_all_frames_have_one_view_that_holds_every_pose(drawing):
    painter, rest = RecordingPainter(), drawing.mesh.vertices
    order = np.array([1, 0])
    frames = [Frame(drawing, rest), Frame(drawing, rest + 10.5, order), Frame(drawing, rest - 3.0)]
    assert len(list(paint_frames(frames, painter, 1000, (1.0, 0.5, 0.0)))) == 3
    width, height = drawing.size
    box = (-3, -3, width + 11, height + 11)
    for frame, (drawn, pose, *view, drawn_order) in zip(frames, painter.calls, strict=True):
        assert drawn is drawing
        assert pose is frame.pose
        assert view == [box, 1.0, (1.0, 0.5, 0.0)]
        assert drawn_order is frame.order


def test_large_drawings_are_reduced_to_the_longest_side(drawing):
    painter = RecordingPainter()
    list(paint_frames([Frame(drawing, drawing.mesh.vertices * 10)], painter, 16, None))
    _, _, box, scale, _, _ = painter.calls[0]
    assert scale == pytest.approx(16 / max(box[2] - box[0], box[3] - box[1]))


def test_sizes_are_even_where_a_format_needs_it(drawing):
    painter = RecordingPainter()
    list(paint_frames([Frame(drawing, drawing.mesh.vertices)], painter, 7, None, is_even=True))
    _, _, box, scale, _, _ = painter.calls[0]
    assert [side % 2 for side in output_size(box, scale)] == [0, 0]


def test_pictures_are_drawn_one_at_a_time(drawing):
    painter = RecordingPainter()
    pictures = paint_frames([Frame(drawing, drawing.mesh.vertices)] * 3, painter, 100, None)
    assert painter.calls == []
    next(pictures)
    assert len(painter.calls) == 1


def test_pictures_that_would_be_too_large_are_refused_at_once(drawing):
    frames = [Frame(drawing, drawing.mesh.vertices * 10_000)]
    with pytest.raises(InputError, match="picture size: expected at most"):
        paint_frames(frames, RecordingPainter(), 2 * MAX_SIZE, None)
