"""The keyframes on the timeline: added, chosen, moved, copied, stretched and eased with the mouse."""

from itertools import pairwise
from math import ceil

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.animation.keyframe_playback import MAX_ONION_POSES, TIME_STEP, KeyframePlayback, stretch_times
from ...editor.animation.playback import VisibleRange
from ...editor.camera import ZOOM_STEP
from ...editor.document.easing import EASING_LABELS, KEYFRAME_EASINGS
from .. import widgets
from ..app_state import AppState
from ..commands import keying
from ..theme import ACCENT, DARK, FRAME, QUIET, STRONG_LINE, TEXT, packed

RED = (0.93, 0.33, 0.31, 1.0)
POSE_PAYLOAD = "pose"  # what thumbnails of poses are dragged as
_REACH = 8  # design points, as all sizes here: how near to a keyframe a press takes it
_DRAG = 3  # how far the pointer goes before a press is a drag
# From the top: where the ruler ends, the middle of the lane, where the marks begin, and the end.
_RULER, _LANE, _MARKS, _BOTTOM = 16, 28, 39, 48
_TICKS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0, 600.0)  # seconds


def buttons(state: AppState, scale: float) -> None:
    """Add a keyframe, choose easings, show the onion skin."""
    side = ImVec2(30 * scale, 28 * scale)
    playback = state.timeline.keyframe_playback
    if imgui.button(f"{icons.ICON_FA_PLUS}##add key", side):
        state.run_reporting_errors(lambda: keying.keyframe_here(state))
    widgets.show_tooltip("Keyframe here (K): keep the pose that is seen at this time")
    imgui.same_line(0, 4 * scale)
    imgui.begin_disabled(not playback.animation.keyframes)
    if imgui.button(f"{icons.ICON_FA_BEZIER_CURVE}##easing", side):
        imgui.open_popup("easing menu")
    imgui.end_disabled()
    widgets.show_tooltip("Easing: how the motion between keyframes starts and ends")
    if _begin_menu("easing menu", scale):
        widgets.secondary_text("Between all keyframes, unless one says otherwise")
        for name in KEYFRAME_EASINGS:
            if imgui.menu_item(EASING_LABELS[name], "", playback.animation.ease == name)[0]:
                state.run_reporting_errors(lambda name=name: playback.set_default_easing(name))  # type: ignore[misc]
        imgui.end_popup()
    imgui.same_line(0, 4 * scale)
    color = ACCENT if playback.onion_skin.is_shown else QUIET
    imgui.push_style_color(imgui.Col_.text, ImVec4(*color))
    if imgui.button(f"{icons.ICON_FA_LAYER_GROUP}##onion", side):
        imgui.open_popup("onion menu")
    imgui.pop_style_color()
    widgets.show_tooltip("Onion skin (O): the poses before, blue, and after, orange")
    if _begin_menu("onion menu", scale):
        _onion(playback, scale)
        imgui.end_popup()


def _begin_menu(name: str, scale: float) -> bool:
    """A menu above the button that was drawn last, so that the timeline stays in sight."""
    place = imgui.get_item_rect_min()
    imgui.set_next_window_pos(ImVec2(place.x, place.y - 12 * scale), pivot=ImVec2(0, 1))
    return bool(imgui.begin_popup(name))


def _onion(playback: KeyframePlayback, scale: float) -> None:
    onion = playback.onion_skin
    _, onion.is_shown = widgets.switch("Onion skin", onion.is_shown)
    imgui.begin_disabled(not onion.is_shown)
    if widgets.radio("Keyframes before and after", onion.kind == "keyframes"):
        onion.kind = "keyframes"
    if widgets.radio("Moments before and after", onion.kind == "times"):
        onion.kind = "times"
    imgui.set_next_item_width(118 * scale)
    _, count = imgui.input_int("on each side", onion.count)
    onion.count = min(max(count, 1), MAX_ONION_POSES)
    imgui.begin_disabled(onion.kind == "keyframes")
    imgui.set_next_item_width(118 * scale)
    _, apart = imgui.input_float("s apart", onion.step, TIME_STEP, 0.0, "%.2f")
    onion.step = min(max(float(apart), 0.01), 10.0)
    imgui.end_disabled()
    imgui.end_disabled()


class TimeScale:
    """Where the times of a view are on the track, which begins at ``left``."""

    def __init__(self, left: float, width: float, view: VisibleRange) -> None:
        self._left, self._width, self._view = left, width, view

    def x(self, time: float) -> float:
        """On the screen; where all is shown, at the edge if it is beyond."""
        share = (time - self._view.start) / self._view.seconds
        return self._left + self._width * (share if self._view.is_zoomed else min(max(share, 0.0), 1.0))

    def seconds(self, way: float) -> float:
        """How long so many points of the screen are."""
        return way / self._width * self._view.seconds

    def time(self, x: float) -> float:
        """At a place on the screen; where not all is shown, one that is."""
        share = (x - self._left) / self._width
        share = min(max(share, 0.0), 1.0) if self._view.is_zoomed else share
        return max(self._view.start + share * self._view.seconds, 0.0)


def draw(state: AppState, scale: float) -> None:
    """The ruler, the keyframes below it, and what the mouse does with both."""
    playback = state.timeline.keyframe_playback
    label = f"{playback.time:.2f} / {playback.duration:.2f} s"
    room = imgui.calc_text_size("000.00 / 000.00 s").x + 12 * scale
    corner = imgui.get_cursor_screen_pos()
    width = max(imgui.get_content_region_avail().x - room, 40 * scale)
    track = TimeScale(corner.x + _REACH * scale, width - 2 * _REACH * scale, playback.visible_range)
    imgui.invisible_button("##keys", ImVec2(width, _BOTTOM * scale))
    state.run_reporting_errors(lambda: _handle(state, track, corner.y, scale))
    if imgui.is_item_hovered() and not imgui.is_item_active():
        _explain(playback, track, scale)
        zoom(playback.visible_range, track)
    _drop_target(state, track)
    drawer = imgui.get_window_draw_list()
    drawer.push_clip_rect(corner, ImVec2(corner.x + width, corner.y + _BOTTOM * scale), True)
    _draw_ruler(drawer, playback, track, corner, width, scale)
    _draw_keys(drawer, playback, track, corner.y + _LANE * scale, scale)
    _draw_head(drawer, playback, track, corner.y, scale)
    drawer.pop_clip_rect()
    below = corner.y + (_BOTTOM * scale - imgui.get_text_line_height()) / 2
    imgui.set_cursor_screen_pos(ImVec2(corner.x + width + 12 * scale, below))
    imgui.text_colored(ImVec4(*QUIET), label)


# -- the mouse ----------------------------------------------------------------------------------------------


def _near(playback: KeyframePlayback, track: TimeScale, scale: float) -> float | None:
    """The time of the keyframe under the pointer."""
    x = imgui.get_mouse_pos().x
    time = min(playback.animation.times, key=lambda each: abs(track.x(each) - x), default=None)
    return time if time is not None and abs(track.x(time) - x) <= _REACH * scale else None


def _handle(state: AppState, track: TimeScale, top: float, scale: float) -> None:
    playback = state.timeline.keyframe_playback
    if playback.is_dragging and imgui.is_key_pressed(imgui.Key.escape, False):
        playback.drop_keyframes(keep=False)
        state.grip = "none"
    if imgui.is_item_activated():
        _press(state, track, top, scale)
    if imgui.is_item_active():
        _drag(state, track, scale)
    if imgui.is_item_deactivated():
        playback.drop_keyframes()
    if imgui.is_item_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.right):
        key = _near(playback, track, scale)
        playback.scrub(keying.snapped(track.time(imgui.get_mouse_pos().x)) if key is None else key)
        if key is None or key not in playback.selected:
            playback.selected = frozenset() if key is None else frozenset({key})
        state.held_key = playback.time
        imgui.open_popup("key menu")
    if (
        state.timeline.keyframe_menu_requested
    ):  # by keys: above the track, so that the keyframe stays in sight
        state.timeline.keyframe_menu_requested = False
        at = min(playback.selected, default=playback.time)
        imgui.set_next_window_pos(ImVec2(track.x(at), top - 8 * scale), pivot=ImVec2(0, 1))
        imgui.open_popup("key menu")
    if imgui.begin_popup("key menu"):
        _menu(state)
        imgui.end_popup()


def zoom(view: VisibleRange, track: TimeScale) -> None:
    """The wheel zooms in on the time under the pointer; with Shift, or sideways, it goes along."""
    io = imgui.get_io()
    along = io.mouse_wheel if io.key_shift else -io.mouse_wheel_h
    if along:
        view.pan(-0.1 * view.seconds * along)
    elif io.mouse_wheel:
        view.zoom(ZOOM_STEP**io.mouse_wheel, track.time(imgui.get_mouse_pos().x))


def _press(state: AppState, track: TimeScale, top: float, scale: float) -> None:
    playback, io = state.timeline.keyframe_playback, imgui.get_io()
    key, y = _near(playback, track, scale), imgui.get_mouse_pos().y - top
    in_ruler = y < _RULER * scale
    if y > _MARKS * scale and playback.duration > 0:
        away = [abs(track.x(mark) - imgui.get_mouse_pos().x) for mark in playback.played_range]
        if min(away) < _REACH * scale:
            state.grip = "start" if away[0] < away[1] else "end"
            return
    if key is None or in_ruler:
        state.grip = "head"
        playback.selected = frozenset()
        if imgui.is_mouse_double_clicked(0) and not in_ruler:
            state.editor.select(())
            playback.set_keyframe(keying.snapped(track.time(imgui.get_mouse_pos().x)))
        return
    state.grip, state.held_key = "keys", key
    state.editor.select(())
    if io.key_shift:
        playback.selected ^= {key}
    elif key not in playback.selected:
        playback.selected = frozenset({key})
    playback.scrub(key)


def _drag(state: AppState, track: TimeScale, scale: float) -> None:
    playback, io, x = state.timeline.keyframe_playback, imgui.get_io(), imgui.get_mouse_pos().x
    if state.grip in ("start", "end"):
        playback.mark_range(**{state.grip: keying.snapped(track.time(x))})
    elif state.grip == "head" and not imgui.is_mouse_double_clicked(0):
        playback.scrub(track.time(x) if io.key_alt else keying.snapped(track.time(x)))
    elif state.grip == "keys" and playback.selected:
        way = imgui.get_mouse_drag_delta(0, 0.0).x
        if abs(way) < _DRAG * scale and not playback.is_dragging:
            return
        to = max(keying.snapped(state.held_key + track.seconds(way)), 0.0)
        if io.key_alt:
            chosen = playback.selected if len(playback.selected) > 1 else playback.stored_animation.times
            playback.drag_keyframes(stretch_times(chosen, state.held_key, to))
        else:
            by = max(to - state.held_key, -min(playback.selected))
            playback.drag_keyframes({time: time + by for time in playback.selected}, copy=io.key_ctrl)


def _menu(state: AppState) -> None:
    """Of a keyframe, or of a moment without one."""
    playback = state.timeline.keyframe_playback
    if not playback.selected:
        if imgui.menu_item("Keyframe Here", "K", False)[0]:
            state.run_reporting_errors(lambda: keying.keyframe_here(state))
        return
    key = next(key for key in playback.animation.keyframes if key.time in playback.selected)
    if len(playback.selected) == 1:
        imgui.set_next_item_width(9 * imgui.get_font_size())
        flags = imgui.InputTextFlags_.enter_returns_true
        changed, time = imgui.input_float("##time", key.time, TIME_STEP, 10 * TIME_STEP, "%.3f s", flags)
        if changed:
            state.run_reporting_errors(lambda: playback.move_keyframe(key.time, time))
    imgui.separator()
    for name in (None, *KEYFRAME_EASINGS):
        label = "As in the whole animation" if name is None else EASING_LABELS[name]
        if imgui.menu_item(label, "", key.ease == name)[0]:
            state.run_reporting_errors(lambda name=name: playback.set_easing(name))  # type: ignore[misc]
    imgui.separator()
    if imgui.menu_item("Change to the Present Pose", "", False)[0]:
        state.run_reporting_errors(lambda: _change(playback, key.time))
    if imgui.menu_item("Duplicate", "Ctrl+Shift+K", False)[0]:
        state.run_reporting_errors(playback.duplicate_keyframes)
    if imgui.menu_item("Remove", "Shift+K", False)[0]:
        state.run_reporting_errors(playback.delete_keyframes)


def _change(playback: KeyframePlayback, time: float) -> None:
    """Put the present pose in the place of a keyframe's."""
    playback.show_present()
    playback.set_keyframe(time)


def _explain(playback: KeyframePlayback, track: TimeScale, scale: float) -> None:
    time = _near(playback, track, scale)
    key = next((each for each in playback.animation.keyframes if each.time == time), None)
    if key is not None:
        widgets.show_tooltip(
            f"{key.time:.2f} s, {EASING_LABELS[key.ease or playback.animation.ease].lower()}. Drag to move, "
            "with Ctrl to copy, with Alt to stretch; right-click for more"
        )


def _drop_target(state: AppState, track: TimeScale) -> None:
    """A pose that is dragged here becomes a keyframe."""
    if not imgui.begin_drag_drop_target():
        return
    payload = imgui.accept_drag_drop_payload_py_id(POSE_PAYLOAD)
    if payload is not None and state.document is not None:
        pose = state.document.state.poses[payload.data_id]
        time = keying.snapped(track.time(imgui.get_mouse_pos().x))
        state.run_reporting_errors(
            lambda: state.timeline.keyframe_playback.set_keyframe(time, pose.positions)
        )
        state.timeline.keyframe_playback.scrub(time)
    imgui.end_drag_drop_target()


# -- what is seen -------------------------------------------------------------------------------------------


def _draw_ruler(
    drawer: imgui.ImDrawList,
    playback: KeyframePlayback,
    track: TimeScale,
    corner: ImVec2,
    width: float,
    scale: float,
) -> None:
    """Ticks with their seconds, and the marks of the range."""
    low, high = ImVec2(corner.x, corner.y), ImVec2(corner.x + width, corner.y + _BOTTOM * scale)
    drawer.add_rect_filled(low, high, packed(DARK), 5 * scale)
    font, size = imgui.get_font(), 0.8 * imgui.get_font_size()
    enough = track.seconds(52 * scale)
    step = next((tick for tick in _TICKS if tick >= enough), _TICKS[-1])
    form = "%.1f" if step < 1 else "%.0f"
    view = playback.visible_range
    for number in range(ceil(view.start / step - 1e-6), int((view.start + view.seconds) / step + 1e-6) + 1):
        x = track.x(number * step)
        drawer.add_line(
            ImVec2(x, corner.y + (_RULER - 4) * scale),
            ImVec2(x, corner.y + _RULER * scale),
            packed(STRONG_LINE),
        )
        if x + 24 * scale < high.x:
            drawer.add_text(
                font, size, ImVec2(x + 3 * scale, corner.y + 1 * scale), packed(QUIET), form % (number * step)
            )
    draw_part(drawer, view, corner, width, scale)
    if playback.duration > 0:
        draw_marks(
            drawer,
            [track.x(mark) for mark in playback.played_range],
            corner.y + (_BOTTOM - 1) * scale,
            scale,
        )


def draw_part(
    drawer: imgui.ImDrawList, view: VisibleRange, corner: ImVec2, width: float, scale: float
) -> None:
    """A line above the track: which part of all is shown, where it is not all."""
    if view.is_zoomed:
        first, last = (corner.x + width * at / view.total for at in (view.start, view.start + view.seconds))
        drawer.add_rect_filled(
            ImVec2(first, corner.y), ImVec2(last, corner.y + 2 * scale), packed(QUIET), scale
        )


def draw_marks(drawer: imgui.ImDrawList, marks: list[float], bottom: float, scale: float) -> None:
    """Where the range begins and where it ends."""
    for x, turn in zip(marks, (1, -1), strict=True):
        tip = 8 * scale
        ends = ImVec2(x, bottom), ImVec2(x, bottom - tip), ImVec2(x + turn * tip, bottom)
        drawer.add_triangle_filled(*ends, packed(ACCENT))


def _draw_keys(
    drawer: imgui.ImDrawList,
    playback: KeyframePlayback,
    track: TimeScale,
    middle: float,
    scale: float,
) -> None:
    """A diamond for each keyframe, a bar for each motion between two; a line where it holds."""
    keys = playback.animation.keyframes
    start, end = playback.played_range
    for key, after in pairwise(keys):
        half = (0.8 if (key.ease or playback.animation.ease) == "hold" else 3) * scale
        inside = start <= key.time and after.time <= end
        color = packed(ACCENT, 0.5) if inside else packed(FRAME)
        drawer.add_rect_filled(
            ImVec2(track.x(key.time), middle - half), ImVec2(track.x(after.time), middle + half), color
        )
    shown = playback.selected_in_drag
    for key in keys:
        center, size = ImVec2(track.x(key.time), middle), 8 * scale
        drawer.add_ngon_filled(center, size + 1.5 * scale, packed(DARK), 4)
        drawer.add_ngon_filled(center, size, packed(ACCENT if key.time in shown else TEXT), 4)


def _draw_head(
    drawer: imgui.ImDrawList, playback: KeyframePlayback, track: TimeScale, top: float, scale: float
) -> None:
    """Where one looks; quiet while the present pose is seen in place of that moment's."""
    x, half = track.x(playback.time), 5 * scale
    color = packed(TEXT if playback.is_previewing else QUIET, 1.0 if playback.is_previewing else 0.6)
    drawer.add_line(ImVec2(x, top), ImVec2(x, top + _BOTTOM * scale), color, 2 * scale)
    drawer.add_triangle_filled(
        ImVec2(x - half, top), ImVec2(x + half, top), ImVec2(x, top + 1.4 * half), color
    )
