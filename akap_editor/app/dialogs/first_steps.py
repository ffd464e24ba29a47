"""The first steps: a strip that tells newcomers what to do next, and goes away for good."""

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui

from .. import widgets
from ..app_state import AppState
from ..commands import registry as commands
from ..theme import ACCENT, QUIET, STRONG_LINE, packed

STEPS = (
    ("Hold it", "Click where the drawing should hold still, for instance on its feet."),
    ("Bend it", "Press on the part that should move, and drag."),
    (
        "Look around",
        "The wheel zooms, Space and drag moves the canvas. "
        f"{commands.UNDO.key_name} takes back what you did, {commands.PALETTE.key_name} finds every command.",
    ),
)


ALONE = "With one pin, all of the drawing goes along. Click where it should hold still, as on its feet."
MOVED = 1.0  # pixels: where the way of all vertices differs by less, the drawing was only moved


def step(state: AppState) -> int:
    """The step to be taken, as an index into `STEPS`: what has been done shows in the drawing itself.

    What is undone has been done all the same.
    """
    session = state.editor.session
    alone = _went_along(state)
    if session is not None and session.state.pins and not (alone or state.editor.busy):
        way = session.state.positions - session.drawing.mesh.vertices
        state.steps_taken = max(state.steps_taken, 2 if np.ptp(way, axis=0).max() > MOVED else 1)
    return 0 if alone and state.steps_taken < 2 else state.steps_taken


def _went_along(state: AppState) -> bool:
    """Whether the only pin was dragged, which bends nothing."""
    session = state.editor.session
    return session is not None and len(session.state.pins) == 1 and session.is_posed


def draw(state: AppState, scale: float) -> None:
    """A strip below the canvas, until it is put away."""
    if not state.first_steps or state.document is None:
        return
    now = step(state)
    title, text = STEPS[now]
    text = ALONE if _went_along(state) else text
    padding = ImVec2(16 * scale, 10 * scale)
    room = imgui.get_main_viewport().work_size.x - 2 * padding.x
    height = imgui.get_text_line_height_with_spacing() + imgui.calc_text_size(text, wrap_width=room).y
    if widgets.side_bar("First steps", imgui.Dir.down, height + 2 * padding.y, padding):
        _dots(now, scale)
        imgui.same_line(0, 10 * scale)
        imgui.text_colored(ImVec4(*ACCENT), title)
        label = "Done" if now == len(STEPS) - 1 else "Skip"
        width = imgui.calc_text_size(label).x + 2 * imgui.get_style().frame_padding.x
        imgui.same_line(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - width)
        if imgui.small_button(f"{label}###away"):
            state.first_steps = False
            state.preferences.put("first steps done", True)
        imgui.push_text_wrap_pos(0.0)
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
    imgui.end()


def _dots(now: int, scale: float) -> None:
    """One for each step: done, to be done now, still to come."""
    at, line = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
    draw, radius, gap = imgui.get_window_draw_list(), 3.5 * scale, 12 * scale
    for index in range(len(STEPS)):
        center = ImVec2(at.x + radius + index * gap, at.y + line / 2)
        if index <= now:
            draw.add_circle_filled(center, radius, packed(ACCENT if index == now else QUIET))
        else:
            draw.add_circle(center, radius, packed(STRONG_LINE), 0, 1.5 * scale)
    imgui.dummy(ImVec2(2 * radius + (len(STEPS) - 1) * gap, line))
