"""The dialog that shows the progress of a task and can cancel it."""

from imgui_bundle import ImVec2, ImVec4, imgui

from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..jobs.task import Task
from ..theme import ACCENT, SECONDARY

_WIDTH = 420  # design points


def draw(state: AppState, task: Task, scale: float) -> None:
    """Draw one frame of the dialog for a task. scale: points per design point."""
    if task.seconds_until_shown > 0:
        _draw_invisible(task)
        return
    if not widgets.begin_dialog(task.title):
        return
    imgui.push_style_color(imgui.Col_.plot_histogram, ImVec4(*ACCENT))
    percent = f"{100 * task.progress.share:.0f} %"
    imgui.progress_bar(task.progress.share, ImVec2(_WIDTH * scale, 8 * scale), "")
    imgui.pop_style_color()
    room = _WIDTH * scale - imgui.calc_text_size(percent).x
    stage = tr(task.progress.text)
    text = "" if stage == task.title else widgets.shortened(stage, room - imgui.get_font_size())
    imgui.text_colored(ImVec4(*SECONDARY), text)
    imgui.same_line(imgui.get_style().window_padding.x + room)
    imgui.text(percent)
    imgui.spacing()
    if task.finish_early is not None and widgets.button(tr("Stop Here"), primary=True):
        task.finish_early()
    if task.finish_early is not None:
        imgui.same_line()
    if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
        task.cancel()
        state.task = None
        widgets.close_popup()
        state.notice = tr("{title}: cancelled", title=task.title)
    imgui.end_popup()


def _draw_invisible(task: Task) -> None:
    """Take all input, as the dialog does, while the window looks as before."""
    imgui.push_style_var(imgui.StyleVar_.alpha, 0.0)
    if widgets.begin_dialog(task.title):
        imgui.end_popup()
    imgui.pop_style_var()
    imgui.get_current_context().dim_bg_ratio = 0.0
