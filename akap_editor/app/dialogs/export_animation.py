"""The dialog for exports of the timeline: format on the left, what can be chosen about it on the right."""

from imgui_bundle import ImVec2, ImVec4, imgui

from ...editor.document.easing import EASINGS
from .. import widgets
from ..app_state import AppState
from ..theme import QUIET
from . import animating
from .animating import FORMATS, LIMITS, RATES, AnimationExportOptions

EASING_LABELS = {
    "none": "Steady",
    "in": "Slow start",
    "out": "Slow end",
    "in-out": "Slow start and end",
    "hold": "Hold, then jump",
}
_WIDTH, _HEIGHT, _LEFT, _LABEL = 600, 292, 190, 104  # points of the design


def draw(state: AppState, scale: float) -> None:
    """One frame of the dialog."""
    start, end = state.playback.range
    if state.document is None or end <= start:
        state.animating = False
        return
    if not widgets.begin_dialog("Export animation"):
        return
    choice = animating.remembered(state)
    imgui.begin_child(
        "##formats", ImVec2(_LEFT * scale, _HEIGHT * scale), imgui.ChildFlags_.borders | widgets.WALKED
    )
    _formats(choice)
    imgui.end_child()
    imgui.same_line(0, 18 * scale)
    imgui.begin_child("##options", ImVec2((_WIDTH - _LEFT - 18) * scale, _HEIGHT * scale), widgets.WALKED)
    _options(choice, scale)
    _facts(state, choice, scale)
    imgui.end_child()
    imgui.spacing()
    animating.remember(state, choice)
    accepted = widgets.button("Export...", primary=True)
    imgui.same_line()
    if widgets.button("Cancel") or widgets.escape():
        widgets.close(state, "animating", False)
    elif accepted or (widgets.enter() and not imgui.get_io().want_text_input):
        widgets.close(state, "animating", False)
        animating.ask_file(state)
    imgui.end_popup()


def _formats(choice: AnimationExportOptions) -> None:
    flags = imgui.SelectableFlags_.no_auto_close_popups
    for each in FORMATS:
        right = imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x
        if imgui.selectable(each.label, each is choice.kind, flags)[0]:
            choice.format = each.label
        ending = each.suffix or "folder"
        imgui.same_line(right - imgui.calc_text_size(ending).x)
        imgui.text_colored(ImVec4(*QUIET), ending)


def _options(choice: AnimationExportOptions, scale: float) -> None:
    below = imgui.get_cursor_pos_y() + 2 * imgui.get_text_line_height()
    widgets.quiet(choice.kind.about)
    imgui.set_cursor_pos_y(below + imgui.get_style().item_spacing.y)
    choice.fps = _number("Frame rate", choice.fps, "fps", "%.4g fps", 0.2, scale)
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(7 * scale, imgui.get_style().frame_padding.y))
    for rate in RATES:
        imgui.same_line(0, 5 * scale)
        if imgui.button(f"{rate}"):
            choice.fps = float(rate)
    imgui.pop_style_var()
    choice.size = round(_number("Size", choice.size, "size", "%.0f px", 2.0, scale))
    widgets.explain("Of the longest side, at most; a drawing is not enlarged.")
    choice.speed = _number("Speed", 100 * choice.speed, "speed", "%.4g %%", 0.5, scale, 100) / 100
    widgets.label("Easing", _LABEL * scale)
    imgui.set_next_item_width(widgets.FULL)
    names = list(EASINGS)
    labels = [EASING_LABELS[name] for name in names]
    _, chosen = imgui.combo("##easing", names.index(choice.ease), labels)
    choice.ease = names[chosen]
    widgets.explain("Of the whole, on top of what keyframes do.")
    widgets.switch_label("Repeat", _LABEL * scale)
    _, choice.ping_pong = widgets.switch("Ping-pong", choice.ping_pong, "Forwards, then backwards.")
    if choice.kind.repeats:
        imgui.same_line(0, 16 * scale)
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.rise())
        _, choice.loop = widgets.switch("For ever", choice.loop, "Off: it is shown once, and stops.")
    widgets.switch_label("Background", _LABEL * scale)
    always = not choice.kind.transparent
    imgui.begin_disabled(always)
    clicked, opaque = widgets.switch("Color", choice.opaque or always, "Without it, it is transparent.")
    imgui.end_disabled()
    choice.opaque = opaque if clicked else choice.opaque
    if opaque:
        imgui.same_line(0, 10 * scale)
        choice.background = widgets.color("##background", choice.background)


def _number(
    label: str, value: float, limited: str, form: str, speed: float, scale: float, times: float = 1.0
) -> float:
    """A field for a number, in its limits; times: how much larger it is shown."""
    low, high = (times * limit for limit in LIMITS[limited])
    widgets.label(label, _LABEL * scale)
    imgui.set_next_item_width(96 * scale)
    clamp = imgui.SliderFlags_.always_clamp
    _, value = imgui.drag_float(f"##{label}", value, speed, low, high, form, clamp)
    widgets.explain("Drag, or double-click to type.")
    return float(value)


def _facts(state: AppState, choice: AnimationExportOptions, scale: float) -> None:
    count = len(animating.chosen_times(state, choice))
    seconds = f"{count / choice.fps:.1f}".removesuffix(".0")
    widgets.label("Makes", _LABEL * scale)
    imgui.text(f"{count} frame{'s' * (count != 1)}, {seconds} s")
