"""The first steps: a strip below the canvas that tells newcomers what to do, until they dismiss it."""

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui

from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..commands.registry import PALETTE, UNDO
from ..preferences import Preferences
from ..theme import ACCENT, SECONDARY, STRONG_LINE, packed

STEPS = (
    (mark("Hold it"), mark("Click where the drawing should hold still, for instance on its feet.")),
    (mark("Bend it"), mark("Press on the part that should move, and drag.")),
    (
        mark("Look around"),
        mark(
            "The wheel zooms, Space and drag moves the canvas. "
            "{undo} takes back what you did, {palette} finds every command."
        ),
    ),
)
ONE_PIN = mark(
    "With one pin, all of the drawing goes along. Click where it should hold still, as on its feet."
)
BENT = 1.0  # pixels: if all vertices move by the same vector, up to this, the drawing was only moved
_PREFERENCE = "first steps done"


class FirstSteps:
    """Knows which steps have been taken.

    is_open: None as long as the preferences decide.
    """

    def __init__(self) -> None:
        self.is_open: bool | None = None
        self._steps_taken = 0

    @staticmethod
    def is_wanted(preferences: Preferences) -> bool:
        """Whether this is a newcomer: preferences are kept, and do not say that the strip was dismissed."""
        return preferences.is_stored and not preferences.get(_PREFERENCE, False)

    def step(self, state: AppState) -> int:
        """The index into `STEPS` of the next step; what was done is seen in the drawing.

        Undo does not bring a step back.
        """
        session, only_moved = state.editor.session, _only_pin_was_dragged(state)
        if session is not None and session.state.pins and not (only_moved or state.editor.is_busy):
            displacements = session.state.positions - session.drawing.mesh.vertices
            is_bent = np.ptp(displacements, axis=0).max() > BENT
            self._steps_taken = max(self._steps_taken, 2 if is_bent else 1)
        return 0 if only_moved and self._steps_taken < 2 else self._steps_taken

    def draw(self, state: AppState, scale: float) -> None:
        """Draw the strip if it is open. scale: points per design point."""
        if self.is_open is None:
            self.is_open = self.is_wanted(state.preferences)
        if not self.is_open or state.document is None:
            return
        step = self.step(state)
        title, text = STEPS[step]
        text = ONE_PIN if _only_pin_was_dragged(state) else text
        text = tr(text, undo=UNDO.key_name, palette=PALETTE.key_name)
        padding = ImVec2(16 * scale, 10 * scale)
        room = imgui.get_main_viewport().work_size.x - 2 * padding.x
        height = imgui.get_text_line_height_with_spacing() + imgui.calc_text_size(text, wrap_width=room).y
        if widgets.side_bar("First steps", imgui.Dir.down, height + 2 * padding.y, padding):
            _draw_dots(step, scale)
            imgui.same_line(0, 10 * scale)
            imgui.text_colored(ImVec4(*ACCENT), tr(title))
            if _dismiss_button(tr("Done") if step == len(STEPS) - 1 else tr("Skip")):
                self.is_open = False
                state.preferences.put(_PREFERENCE, True)
            imgui.push_text_wrap_pos(0.0)
            imgui.text_unformatted(text)
            imgui.pop_text_wrap_pos()
        imgui.end()


def _only_pin_was_dragged(state: AppState) -> bool:
    """Whether the drawing has one pin and was dragged by it, which bends nothing."""
    session = state.editor.session
    return session is not None and len(session.state.pins) == 1 and session.is_posed


def _dismiss_button(label: str) -> bool:
    """Draw a small button at the right end of the line; return whether it was pressed."""
    width = imgui.calc_text_size(label).x + 2 * imgui.get_style().frame_padding.x
    imgui.same_line(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - width)
    return bool(imgui.small_button(f"{label}###away"))


def _draw_dots(step: int, scale: float) -> None:
    """Draw a dot for each step: filled up to the next one, a ring for a later one."""
    corner, line = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
    draw, radius, gap = imgui.get_window_draw_list(), 3.5 * scale, 12 * scale
    for index in range(len(STEPS)):
        center = ImVec2(corner.x + radius + index * gap, corner.y + line / 2)
        if index <= step:
            draw.add_circle_filled(center, radius, packed(ACCENT if index == step else SECONDARY))
        else:
            draw.add_circle(center, radius, packed(STRONG_LINE), 0, 1.5 * scale)
    imgui.dummy(ImVec2(2 * radius + (len(STEPS) - 1) * gap, line))
