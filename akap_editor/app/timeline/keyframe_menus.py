"""Buttons and menus for keyframes: add, easing, onion skin, and the context menu of a keyframe."""

from dataclasses import replace

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.animation.keyframe_playback import KeyframePlayback
from ...editor.animation.keyframe_times import TIME_STEP
from ...editor.animation.keyframing.onion_skin import MAX_ONION_POSES, OnionSkin
from ...editor.document.easing import (
    CURVE_LABEL,
    EASING_LABELS,
    KEYFRAME_EASINGS,
    MAX_PROGRESS,
    MIN_PROGRESS,
    curve_like,
    easing_curve,
)
from ...editor.document.keyframes import Keyframe
from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..theme import ACCENT, SECONDARY
from .track import RED

_BUTTON_WIDTH, _BUTTON_HEIGHT, _NUMBER_WIDTH = 30, 28, 118  # design points
_MIN_STEP, _MAX_STEP = 0.01, 10.0  # seconds between poses of the onion skin


def draw_buttons(state: AppState, scale: float) -> None:
    """Draw the buttons beside the track. scale: points per design point."""
    size = ImVec2(_BUTTON_WIDTH * scale, _BUTTON_HEIGHT * scale)
    playback = state.timeline.keyframe_playback
    if imgui.button(f"{icons.ICON_FA_PLUS}##add key", size):
        state.run_reporting_errors(state.timeline.add_keyframe)
    widgets.show_tooltip(tr("Add keyframe (K): keeps the visible pose at this time"))
    imgui.same_line(0, 4 * scale)
    auto_key = playback.auto_key
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(RED if auto_key.is_on else SECONDARY)))
    if imgui.button(f"{icons.ICON_FA_CIRCLE_DOT}##auto key", size):
        auto_key.is_on = not auto_key.is_on
    imgui.pop_style_color()
    widgets.show_tooltip(tr("Auto key: each change of the pose becomes a keyframe at this time"))
    imgui.same_line(0, 4 * scale)
    imgui.begin_disabled(not playback.animation.keyframes)
    if imgui.button(f"{icons.ICON_FA_BEZIER_CURVE}##easing", size):
        imgui.open_popup("easing menu")
    imgui.end_disabled()
    widgets.show_tooltip(tr("Easing: how the motion between keyframes starts and ends"))
    if _begin_menu("easing menu", scale):
        _draw_default_easings(state, playback)
        imgui.end_popup()
    imgui.same_line(0, 4 * scale)
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(ACCENT if playback.onion_skin.is_shown else SECONDARY)))
    if imgui.button(f"{icons.ICON_FA_LAYER_GROUP}##onion", size):
        imgui.open_popup("onion menu")
    imgui.pop_style_color()
    widgets.show_tooltip(tr("Onion skin (Shift+O): earlier poses in blue, later ones in orange"))
    if _begin_menu("onion menu", scale):
        draw_onion_options(playback.onion_skin, scale)
        imgui.end_popup()


def draw_keyframe_menu(state: AppState) -> None:
    """Draw the content of the context menu: for the selected keyframe, or for a time without one."""
    playback = state.timeline.keyframe_playback
    if not playback.selected:
        if imgui.menu_item(tr("Add Keyframe"), "K", False)[0]:
            state.run_reporting_errors(state.timeline.add_keyframe)
        return
    keyframe = next(each for each in playback.animation.keyframes if each.time in playback.selected)
    if len(playback.selected) == 1:
        _draw_time_field(state, playback, keyframe)
    imgui.separator()
    _draw_easings(state, playback, keyframe)
    imgui.separator()
    if imgui.menu_item(tr("Update from Current Pose"), "", False)[0]:
        state.run_reporting_errors(lambda: _update_keyframe(playback, keyframe.time))
    if imgui.menu_item(tr("Duplicate"), tr("Ctrl+Shift+K"), False)[0]:
        state.run_reporting_errors(playback.duplicate_keyframes)
    if len(playback.selected) > 1:
        if imgui.menu_item(tr("Reverse"), "", False)[0]:
            state.run_reporting_errors(playback.reverse_keyframes)
        if imgui.menu_item(tr("Duplicate Reversed"), "", False)[0]:
            state.run_reporting_errors(lambda: playback.reverse_keyframes(copy=True))
    if imgui.menu_item(tr("Delete"), tr("Shift+K"), False)[0]:
        state.run_reporting_errors(playback.delete_keyframes)


def _draw_easings(state: AppState, playback: KeyframePlayback, keyframe: Keyframe) -> None:
    """Draw a line for each easing, and the numbers of a curve."""
    easing = keyframe.ease or playback.animation.ease
    curve = curve_like(easing)
    is_curve = keyframe.ease is not None and easing_curve(keyframe.ease) is not None
    choices = [(None, tr("Default Easing")), *((name, tr(EASING_LABELS[name])) for name in KEYFRAME_EASINGS)]
    for name, label in choices:
        if imgui.menu_item(label, "", keyframe.ease == name)[0]:
            state.run_reporting_errors(lambda name=name: playback.set_easing(name))  # type: ignore[misc]
    if imgui.menu_item(tr(CURVE_LABEL), "", is_curve)[0]:
        state.view.show_speed_graph = True
        state.run_reporting_errors(lambda: playback.set_easing(curve.name))
    if not is_curve:
        return
    for number, x, y in ((1, curve.x1, curve.y1), (2, curve.x2, curve.y2)):
        imgui.set_next_item_width(9 * imgui.get_font_size())
        flags = imgui.InputTextFlags_.enter_returns_true
        is_entered, (x, y) = imgui.input_float2(tr("Handle {number}", number=number), [x, y], "%.3f", flags)
        if is_entered:
            x, y = min(max(x, 0.0), 1.0), min(max(y, MIN_PROGRESS), MAX_PROGRESS)
            changed = replace(curve, **{f"x{number}": x, f"y{number}": y})
            state.run_reporting_errors(lambda changed=changed: playback.set_easing(changed.name))  # type: ignore[misc]


def _begin_menu(name: str, scale: float) -> bool:
    """Begin a menu above the last button, where it does not cover the timeline; return whether it is open."""
    corner = imgui.get_item_rect_min()
    imgui.set_next_window_pos(ImVec2(corner.x, corner.y - 12 * scale), pivot=ImVec2(0, 1))
    return bool(imgui.begin_popup(name))


def _draw_default_easings(state: AppState, playback: KeyframePlayback) -> None:
    widgets.secondary_text(tr("Default easing between keyframes"))
    for name in KEYFRAME_EASINGS:
        if imgui.menu_item(tr(EASING_LABELS[name]), "", playback.animation.ease == name)[0]:
            state.run_reporting_errors(lambda name=name: playback.set_default_easing(name))  # type: ignore[misc]


def draw_onion_options(onion_skin: OnionSkin, scale: float) -> None:
    """Draw a switch for the onion skin and its options. scale: points per design point."""
    _, onion_skin.is_shown = widgets.switch(tr("Onion skin"), onion_skin.is_shown)
    imgui.begin_disabled(not onion_skin.is_shown)
    if widgets.radio(tr("Keyframes before and after"), onion_skin.kind == "keyframes"):
        onion_skin.kind = "keyframes"
    if widgets.radio(tr("Times before and after"), onion_skin.kind == "times"):
        onion_skin.kind = "times"
    imgui.set_next_item_width(_NUMBER_WIDTH * scale)
    _, count = imgui.input_int(tr("on each side"), onion_skin.count)
    onion_skin.count = min(max(count, 1), MAX_ONION_POSES)
    imgui.begin_disabled(onion_skin.kind == "keyframes")
    imgui.set_next_item_width(_NUMBER_WIDTH * scale)
    _, step = imgui.input_float(tr("s apart"), onion_skin.step, TIME_STEP, 0.0, "%.2f")
    onion_skin.step = min(max(float(step), _MIN_STEP), _MAX_STEP)
    imgui.end_disabled()
    imgui.end_disabled()


def _draw_time_field(state: AppState, playback: KeyframePlayback, keyframe: Keyframe) -> None:
    """Draw a field for the time of a keyframe, which moves when Enter is pressed."""
    imgui.set_next_item_width(9 * imgui.get_font_size())
    flags = imgui.InputTextFlags_.enter_returns_true
    is_entered, time = imgui.input_float("##time", keyframe.time, TIME_STEP, 10 * TIME_STEP, "%.3f s", flags)
    if is_entered:
        state.run_reporting_errors(lambda: playback.move_keyframe(keyframe.time, time))


def _update_keyframe(playback: KeyframePlayback, time: float) -> None:
    """Replace the pose of the keyframe at a time by the present pose."""
    playback.show_present()
    playback.set_keyframe(time)
