"""Pictures of poses and of frames of an animation, drawn by whatever renderer is at hand."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol

from ..editor.animation.frames import Frame
from ..editor.document.drawing import Drawing
from ..editor.framing import Box, Color, fitted_box, frame_box, union_of_boxes
from ..geometry.validation import Floats, Ints
from ..overlap.seams import CutMesh
from .images import Picture


class Painter(Protocol):
    """Draws poses; `render.offscreen.OffscreenRenderer` is one."""

    def render(
        self,
        drawing: Drawing,
        positions: Floats,
        box: Box,
        scale: float,
        background: Color | None,
        order: Ints | CutMesh | None,
    ) -> Picture:
        """The pose ``positions`` (n, 2) as a picture (h, w, 4) uint8, straight alpha.

        box: the part of the drawing plane that is shown; scale: pixels per drawing unit; background: None for
        transparent; order: what is drawn from back to front, see `Document.draw_order`.
        """


class FramedPose(NamedTuple):
    """A frame of an animation and how it is shown: see `Painter.render`."""

    frame: Frame
    box: Box
    scale: float
    background: Color | None


def framed_poses(
    frames: Sequence[Frame], longest_side: int, background: Color | None, is_even: bool = False
) -> list[FramedPose]:
    """The frames of an animation, with one box around the drawing's frame and all poses.

    longest_side: in pixels, at most: a drawing is not enlarged; is_even: whether width and height must be
    even, see `fitted_box`. Raises InputError if the pictures would be too large.
    """
    box = union_of_boxes([frame_box(frame.drawing, [frame.pose]) for frame in frames])
    box, scale = fitted_box(box, longest_side, is_even)
    return [FramedPose(frame, box, scale, background) for frame in frames]


def paint_frames(
    frames: Sequence[Frame],
    painter: Painter,
    longest_side: int,
    background: Color | None,
    is_even: bool = False,
) -> Iterator[Picture]:
    """The pictures of an animation's frames, all of one size, each drawn when it is asked for.

    See `framed_poses`; raises InputError at once.
    """
    framed = framed_poses(frames, longest_side, background, is_even)
    return (
        painter.render(frame.drawing, frame.pose, box, scale, background, frame.order)
        for frame, box, scale, background in framed
    )
