"""A slim timeline under the canvas: the whole session or the keyframes, to be played, cut and exported."""

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from .. import widgets
from ..app_state import AppState
from ..dialogs.export_animation import ExportAnimationDialog
from ..theme import ACCENT, FRAME, QUIET, TEXT, packed
from . import keyframe_track as key_track
from .keyframe_track import RED

HEIGHT, KEYED_HEIGHT = 44, 64  # design points, as all sizes here


def draw(state: AppState, scale: float) -> None:
    """The bar; nothing without a drawing, or where it is switched off."""
    if state.document is None or not state.timeline.is_shown:
        state.timeline.show_present()
        return
    keyed = state.timeline.mode == "keyframes"
    if keyed:
        state.timeline.keyframe_playback.update()
    state.timeline.playback.advance()
    height = (KEYED_HEIGHT if keyed else HEIGHT) * scale
    if widgets.side_bar("Timeline", imgui.Dir.down, height, ImVec2(10 * scale, 8 * scale)):
        if keyed:
            imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + 10 * scale)
        _which(state, scale)
        imgui.same_line(0, 12 * scale)
        _buttons(state, scale)
        imgui.same_line(0, 12 * scale)
        if keyed:
            imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - 10 * scale)
            key_track.draw(state, scale)
        else:
            _track(state, scale)
    imgui.end()


def _which(state: AppState, scale: float) -> None:
    """Two buttons that choose what the timeline holds."""
    if _button(icons.ICON_FA_CLOCK_ROTATE_LEFT, "session", scale, state.timeline.mode == "session"):
        state.timeline.set_mode("session")
    widgets.show_tooltip("Session: all that was done, to look back and go on from there")
    imgui.same_line(0, 2 * scale)
    if _button(icons.ICON_FA_DIAMOND, "keyframes", scale, state.timeline.mode == "keyframes"):
        state.timeline.set_mode("keyframes")
    widgets.show_tooltip("Keyframes: poses at times, and the motion between them")


def _button(icon: str, name: str, scale: float, on: bool, color: tuple[float, ...] = ACCENT) -> bool:
    """A square button with a picture; on: in a color."""
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(color if on else QUIET)))
    pressed = imgui.button(f"{icon}##{name}", ImVec2(30 * scale, 28 * scale))
    imgui.pop_style_color()
    return bool(pressed)


def _buttons(state: AppState, scale: float) -> None:
    playback, playing = state.timeline.session_playback, state.timeline.playback
    if state.timeline.mode == "session":
        recording = playback.take_start is not None
        icon = icons.ICON_FA_STOP if recording else icons.ICON_FA_CIRCLE
        if _button(icon, "record", scale, True, ACCENT if recording else RED):
            (playback.end_take if recording else playback.start_take)()
        widgets.show_tooltip(
            "Record: what you do from here to the next click is the part that is played and exported"
        )
    else:
        key_track.buttons(state, scale)
    imgui.same_line(0, 4 * scale)
    if _button(icons.ICON_FA_PAUSE if playing.is_playing else icons.ICON_FA_PLAY, "play", scale, True, TEXT):
        playing.toggle_playing()
    widgets.show_tooltip("Play (L)")
    imgui.same_line(0, 4 * scale)
    if _button(icons.ICON_FA_REPEAT, "loop", scale, playing.loop):
        playing.loop = not playing.loop
    widgets.show_tooltip("Play over and over")
    imgui.same_line(0, 4 * scale)
    imgui.begin_disabled(playing.played_range[1] <= playing.played_range[0])
    if _button(icons.ICON_FA_FILM, "export", scale, True, TEXT):
        state.part(ExportAnimationDialog).open(state)
    imgui.end_disabled()
    widgets.show_tooltip("Export the part between the marks as an animation, a video or sprites")


def _track(state: AppState, scale: float) -> None:
    """The time from start to end: what is played in amber, two marks that cut it, and where one is."""
    playback, drawer = state.timeline.session_playback, imgui.get_window_draw_list()
    label = (
        f"{playback.time if playback.time is not None else playback.duration:.1f} / {playback.duration:.1f} s"
    )
    room = imgui.calc_text_size("000.0 / 000.0 s").x + 12 * scale
    corner, rim = imgui.get_cursor_screen_pos(), 8 * scale  # so that both ends can be taken hold of
    width, height = max(imgui.get_content_region_avail().x - room, 40 * scale), 28 * scale
    imgui.invisible_button("##track", ImVec2(width, height))
    corner.x, width = corner.x + rim, width - 2 * rim
    held, hovered = imgui.is_item_active(), imgui.is_item_hovered()
    playback.visible_range.fit(playback.duration or 1.0)
    track = key_track.TimeScale(corner.x, width, playback.visible_range)
    if hovered and not held:
        key_track.zoom(playback.visible_range, track)
    moment = track.time(imgui.get_mouse_pos().x)
    if imgui.is_item_activated():
        near, below = 8 * scale, imgui.get_mouse_pos().y > corner.y + 0.6 * height
        start, end = (abs(imgui.get_mouse_pos().x - track.x(mark)) for mark in playback.played_range)
        on_mark = below and min(start, end) < near
        state.grip = ("start" if start < end else "end") if on_mark else "head"
    if held and playback.snapshots:
        if state.grip == "start":
            playback.mark_range(start=moment)
        elif state.grip == "end":
            playback.mark_range(end=moment)
        else:
            playback.scrub(moment)
    middle = corner.y + height / 2
    low, high = (track.x(mark) for mark in playback.played_range)
    drawer.push_clip_rect(
        ImVec2(corner.x - rim, corner.y), ImVec2(corner.x + width + rim, corner.y + height), True
    )
    key_track.draw_part(drawer, playback.visible_range, corner, width, scale)
    _bar(drawer, corner.x, corner.x + width, middle, scale, packed(FRAME))
    _bar(drawer, low, high, middle, scale, packed(ACCENT, 0.55))
    key_track.draw_marks(drawer, [low, high], corner.y + height, scale)
    if playback.take_start is not None:
        _bar(
            drawer,
            track.x(playback.take_start),
            track.x(playback.duration),
            middle,
            scale,
            packed(RED),
        )
    head = track.x(playback.time if playback.time is not None else playback.visible_range.total)
    thickness = (2.5 if held or hovered else 2) * scale
    drawer.add_line(ImVec2(head, corner.y), ImVec2(head, corner.y + height), packed(TEXT), thickness)
    drawer.pop_clip_rect()
    imgui.same_line(0, 12 * scale)
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*QUIET), label)


def _bar(
    drawer: imgui.ImDrawList, left: float, right: float, middle: float, scale: float, color: int
) -> None:
    low, high = ImVec2(left, middle - 3 * scale), ImVec2(right, middle + 3 * scale)
    drawer.add_rect_filled(low, high, color, 3 * scale)
