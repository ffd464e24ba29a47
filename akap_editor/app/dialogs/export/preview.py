"""The preview of an animation in the dialog that exports it: its frames, played over and over."""

from collections import OrderedDict
from collections.abc import Callable
from time import perf_counter

from imgui_bundle import ImVec2, imgui

from ....editor.framing import Box, Color
from ....io.images import Picture
from ...app_state import AppState
from ...theme import FRAME, packed

_MOST_PICTURES = 240  # that are kept, of at most 0.3 MB each on a screen of 100 %
_CELL = 8  # of the checkerboard behind transparent pictures, design points
_LIGHT, _DARK = (0.80, 0.80, 0.80, 1.0), (0.62, 0.62, 0.62, 1.0)


class AnimationPreview:
    """Draws the frame that is due, and keeps the pictures of frames that were drawn.

    clock: seconds.
    """

    def __init__(self, clock: Callable[[], float] = perf_counter) -> None:
        self._clock = clock
        self._start = clock()
        self._content: tuple[object, ...] = ()
        self._pictures: OrderedDict[float, Picture] = OrderedDict()  # by their times

    def draw(
        self,
        state: AppState,
        times: list[float],
        fps: float,
        framing: tuple[Box, float] | None,
        background: Color | None,
        side: float,
        scale: float,
    ) -> None:
        """Draw a square with the current frame; the window draws the next one when it is due.

        times: of the frames in playing order, seconds on the timeline; framing: the box that is shown and its
        scale, None if they are not known yet; side: of the square in points; scale: points per design point.
        """
        corner = imgui.get_cursor_screen_pos()
        imgui.dummy(ImVec2(side, side))
        draw, end = imgui.get_window_draw_list(), ImVec2(corner.x + side, corner.y + side)
        draw.add_rect_filled(corner, end, packed(FRAME), 6 * scale)
        if framing is None:
            return
        box, written_scale = framing
        pixels = min(side, written_scale * max(box[2] - box[0], box[3] - box[1]))
        shrink = pixels / max(box[2] - box[0], box[3] - box[1])
        content = (state.timeline.mode, *state.timeline.playback.content, box, shrink, background)
        if content != self._content:
            self._content = content
            self._pictures.clear()
        elapsed = self._clock() - self._start
        number = int(elapsed * fps)
        state.frame_delay = min(state.frame_delay, (number + 1) / fps - elapsed)
        time = times[number % len(times)]
        picture = self._picture(state, time, box, shrink, background)
        if background is None:
            _draw_checkerboard(draw, corner, side, picture.shape[1], picture.shape[0], _CELL * scale)
        state.thumbnails.draw(("preview", self, time, content), corner, side, lambda: picture)

    def _picture(
        self, state: AppState, time: float, box: Box, scale: float, background: Color | None
    ) -> Picture:
        if time not in self._pictures:
            frame = state.timeline.frame(time)
            self._pictures[time] = state.offscreen_renderer.render(
                frame.drawing, frame.pose, box, scale, background, frame.order
            )
            if len(self._pictures) > _MOST_PICTURES:
                self._pictures.popitem(last=False)
        return self._pictures[time]


def _draw_checkerboard(
    draw: imgui.ImDrawList, corner: ImVec2, side: float, width: int, height: int, cell: float
) -> None:
    """Draw a checkerboard behind a picture in the middle of a square."""
    left, top = corner.x + round((side - width) / 2), corner.y + round((side - height) / 2)
    draw.add_rect_filled(ImVec2(left, top), ImVec2(left + width, top + height), packed(_LIGHT))
    dark = packed(_DARK)
    rows, columns = int(height / cell) + 1, int(width / cell) + 1
    for row in range(rows):
        for column in range(row % 2, columns, 2):
            low = ImVec2(left + column * cell, top + row * cell)
            high = ImVec2(min(low.x + cell, left + width), min(low.y + cell, top + height))
            if low.x < high.x and low.y < high.y:
                draw.add_rect_filled(low, high, dark)
