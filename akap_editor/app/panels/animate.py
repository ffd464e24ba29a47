"""The sections of the Animate tab: the keyframes, the onion skin, and playback."""

from imgui_bundle import ImVec2, imgui

from ...editor.document.easing import EASING_LABELS, KEYFRAME_EASINGS
from ...editor.document.keyframes import Keyframe
from ...words import number_text, tr
from .. import widgets
from ..app_state import AppState
from ..commands.command import Command
from ..commands.timeline import ADD_KEYFRAME, AUTO_KEY, EXPORT_ANIMATION, PLAY
from ..commands.view import SHOW_MOTION_PATHS, SHOW_TIMELINE
from ..timeline.keyframe_menus import draw_onion_options
from . import parts

_ROWS = 6  # keyframes that are visible at once


def keyframe_count(state: AppState) -> str:
    """The number of keyframes for the section's title; empty if there are none."""
    return str(len(_keyframes(state)) or "")


def _keyframes(state: AppState) -> tuple[Keyframe, ...]:
    return state.timeline.keyframe_playback.animation.keyframes if state.document is not None else ()


def draw_keyframes(state: AppState, scale: float) -> None:
    """Draw the list of keyframes and what adds and eases them. scale: points per design point."""
    playback = state.timeline.keyframe_playback
    keyframes = _keyframes(state)
    parts.begin_list("##keyframes", _ROWS)
    if not keyframes:
        widgets.secondary_text(
            tr("None yet. Bend the drawing, then add a keyframe; the next one at another time.")
        )
    for number, keyframe in enumerate(keyframes):
        _draw_row(state, keyframe, number)
    parts.end_list()
    _button(state, ADD_KEYFRAME)
    auto_key_tooltip = tr("Each change of the pose becomes a keyframe at the playhead.")
    _switch(state, AUTO_KEY, tr("Auto Key"), auto_key_tooltip)
    widgets.label(tr("Easing"), widgets.label_column(tr("Easing")))
    imgui.set_next_item_width(widgets.FULL)
    names = list(KEYFRAME_EASINGS)
    imgui.begin_disabled(not keyframes)
    is_changed, index = widgets.combo(
        "##default easing", names.index(playback.animation.ease), [tr(EASING_LABELS[name]) for name in names]
    )
    imgui.end_disabled()
    widgets.show_tooltip(
        tr("How the motion between keyframes starts and ends; a keyframe's menu has its own.")
    )
    if is_changed:
        state.run_reporting_errors(lambda: playback.set_default_easing(names[index]))


def _draw_row(state: AppState, keyframe: Keyframe, number: int) -> None:
    """Draw a line of the list; a click shows the pose of the keyframe."""
    playback = state.timeline.keyframe_playback
    is_selected = keyframe.time in playback.selected
    right = imgui.get_content_region_avail().x + imgui.get_cursor_pos_x()
    if imgui.selectable(f"{number_text(keyframe.time, '.2f')} s###keyframe {number}", is_selected)[0]:
        state.timeline.show_keyframes()
        playback.selected = frozenset({keyframe.time})
        playback.stop_at(keyframe.time)
    if keyframe.ease is not None:
        label = widgets.shortened(tr(EASING_LABELS[keyframe.ease]), 0.6 * right)
        imgui.same_line(right - imgui.calc_text_size(label).x - 0.5 * imgui.get_font_size())
        widgets.secondary_text(label)
    if is_selected:
        parts.scroll_to_row(number, _ROWS)


def draw_onion_skin(state: AppState, scale: float) -> None:
    """Draw the options of the onion skin. scale: points per design point."""
    draw_onion_options(state.timeline.keyframe_playback.onion_skin, scale)


def draw_playback(state: AppState, scale: float) -> None:
    """Draw what shows, plays and exports the motion. scale: points per design point."""
    playback = state.timeline.playback
    start, end = playback.played_range
    widgets.row(
        tr("Duration"),
        f"{number_text(end - start, '.2f')} s",
        tr("Of the motion that the timeline shows, or of its range."),
    )
    timeline_key = tr("Key: {key}", key=SHOW_TIMELINE.key_name)
    _switch(state, SHOW_TIMELINE, tr("Timeline"), timeline_key)
    _, playback.loop = widgets.switch(tr("Loop") + "###Loop", playback.loop)
    _switch(
        state,
        SHOW_MOTION_PATHS,
        tr("Motion paths"),
        tr("The ways of the selected pins, with their keyframes."),
    )
    _button(state, PLAY)
    _button(state, EXPORT_ANIMATION)


def _switch(state: AppState, command: Command, label: str, tooltip: str) -> None:
    if widgets.switch(f"{label}###{command.label}", command.is_checked(state), tooltip)[0]:
        widgets.run(state, command)


def _button(state: AppState, command: Command) -> None:
    imgui.begin_disabled(not command.enabled(state))
    if imgui.button(f"{command.icon}  {command.text}###{command.label}", ImVec2(widgets.FULL, 0)):
        widgets.run(state, command)
    imgui.end_disabled()
