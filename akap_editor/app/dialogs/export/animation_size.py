"""The size in pixels of an animation's pictures, which all its poses decide."""

from collections.abc import Callable
from time import perf_counter

from ....editor.framing import Box, fitted_box, frame_box, output_size, union_of_boxes
from ....errors import InputError
from ....words import tr
from ...app_state import AppState

_SLICE = 0.01  # seconds of measuring in a frame of the window


class AnimationSize:
    """Measures the poses of the timeline beside the drawing of a dialog, a few in each frame.

    clock: seconds.
    """

    def __init__(self, clock: Callable[[], float] = perf_counter) -> None:
        self._clock = clock
        self._content: tuple[object, ...] = ()
        self._measured = 0
        self._box: Box | None = None

    def measure(
        self, state: AppState, times: list[float], longest_side: int, is_even: bool
    ) -> tuple[int, int] | None:
        """Width and height of the pictures at ``times``, seconds; None if not all poses are measured yet.

        Arguments as in `framing`. Raises InputError if the pictures would be too large.
        """
        framing = self.framing(state, times, longest_side, is_even)
        return None if framing is None else output_size(*framing)

    def framing(
        self, state: AppState, times: list[float], longest_side: int, is_even: bool
    ) -> tuple[Box, float] | None:
        """Box and scale of the pictures at ``times``, seconds; None if not all poses are measured yet.

        The window is woken, so that measuring goes on in the next frame. longest_side, is_even: see
        `fitted_box`. Raises InputError if the pictures would be too large.
        """
        content = (state.timeline.mode, *state.timeline.playback.content, tuple(times))
        if content != self._content:
            self._content, self._measured, self._box = content, 0, None
        end = self._clock() + _SLICE
        while self._measured < len(times):
            playback, time = state.timeline.playback, times[self._measured]
            drawing, pose = playback.pose_at(time)
            swinging = playback.loose_pose(time)
            pose = pose if swinging is None else swinging
            box = frame_box(drawing, [pose])
            self._box = box if self._box is None else union_of_boxes([self._box, box])
            self._measured += 1
            if self._clock() >= end and self._measured < len(times):
                state.wake()
                return None
        if self._box is None:
            raise InputError(tr("times: expected at least one, got none"))
        return fitted_box(self._box, longest_side, is_even)
