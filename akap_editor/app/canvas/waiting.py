"""Says on the canvas what it waits for."""

import time

from imgui_bundle import ImVec2, imgui

from ...words import tr
from ..app_state import AppState
from ..jobs.engine_preparation import TEXT as PREPARATION_TEXT
from ..jobs.task import LATE_SECONDS
from .legend import draw_plate

_TOP = 16  # design points between the canvas and the plate


class WaitingPlate:
    """A text at the top of the canvas; like a dialog, it appears after a moment."""

    def __init__(self) -> None:
        self._since: float | None = None

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame; while the canvas takes no input, the pointer over it is a barred circle."""
        if not state.is_canvas_waiting:
            self._since = None
            if state.editor.is_moving and not state.engine.can_step:
                _draw_plate(state, tr(PREPARATION_TEXT), scale)
            return
        now = time.perf_counter()
        self._since = now if self._since is None else self._since
        left, top, right, bottom = state.editor.canvas
        pointer = imgui.get_mouse_pos()
        if left <= pointer.x < right and top <= pointer.y < bottom:
            imgui.set_mouse_cursor(imgui.MouseCursor_.not_allowed)
        if now < self._since + LATE_SECONDS or state.task is not None:  # the dialog of the task says more
            return
        _draw_plate(state, state.remesher.progress[1] or tr("Making the mesh"), scale)


def _draw_plate(state: AppState, text: str, scale: float) -> None:
    left, top, right, _ = state.editor.canvas
    size, margin = imgui.calc_text_size(text), 10 * scale
    x, y = (left + right - size.x) / 2, top + _TOP * scale
    draw = imgui.get_background_draw_list()
    draw_plate(draw, ImVec2(x, y), text, ImVec2(margin, margin / 2))
