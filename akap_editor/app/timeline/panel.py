"""The timeline panel under the canvas: shows the session or the keyframes, plays and exports them."""

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...render.overlays import Rgba
from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..dialogs.export.animation import ExportAnimationDialog
from ..dialogs.take import TakeDialog
from ..theme import ACCENT, SECONDARY, TEXT
from . import keyframe_menus, speed_graph
from .keyframe_track import KeyframeTrack
from .session_track import SessionTrack
from .speed_graph import SpeedGraph
from .timeline import TimelineMode
from .track import RED

_HEIGHT = 64  # design points, as all sizes here; the same in both modes, so that the canvas stays
_BUTTON_WIDTH, _BUTTON_HEIGHT = 30, 28
_LABEL_PADDING = 9  # at the left and right of an icon with its name
_MIN_LABELED_WIDTH = 800  # of the panel for names beside the icons of the modes
_GRAPH_GAP = 8  # between the track and the speed graph
_TRACK_RISE = 10  # the top of the keyframe track above that of the buttons
_MODES: tuple[tuple[TimelineMode, str, str, str], ...] = (
    (
        "session",
        mark("Session"),
        icons.ICON_FA_CLOCK_ROTATE_LEFT,
        mark("Session: look back at what was done, and continue there"),
    ),
    (
        "keyframes",
        mark("Keyframes"),
        icons.ICON_FA_DIAMOND,
        mark("Keyframes: poses at times, and the motion between them"),
    ),
)


def draw(state: AppState, scale: float, is_hidden: bool = False) -> None:
    """Draw the panel if it is visible and a drawing is open. scale: points per design point.

    is_hidden: whether playback goes on without the panel, because all panels are hidden.
    """
    timeline = state.timeline
    if state.document is None or not timeline.is_shown:
        timeline.show_present()
        return
    if timeline.mode == "keyframes":
        timeline.keyframe_playback.update()
    timeline.playback.advance()
    if is_hidden:
        return
    graph = _GRAPH_GAP * scale + speed_graph.height(scale) if state.view.show_speed_graph else 0.0
    if widgets.side_bar("Timeline", imgui.Dir.down, _HEIGHT * scale + graph, ImVec2(10 * scale, 8 * scale)):
        _draw_content(state, scale)
    imgui.end()


def _draw_content(state: AppState, scale: float) -> None:
    shows_keyframes = state.timeline.mode == "keyframes"
    rise = _TRACK_RISE * scale
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + rise)
    _draw_mode_buttons(state, scale)
    imgui.same_line(0, 12 * scale)
    if shows_keyframes:
        keyframe_menus.draw_buttons(state, scale)
    else:
        _draw_take_buttons(state, scale)
    imgui.same_line(0, 4 * scale)
    _draw_playback_buttons(state, scale)
    imgui.same_line(0, 12 * scale)
    if shows_keyframes:
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - rise)
        time_scale = state.part(KeyframeTrack).draw(state, scale)
    else:
        time_scale = state.part(SessionTrack).draw(state, scale)
    if state.view.show_speed_graph:
        top = imgui.get_window_pos().y + (_HEIGHT - 8 + _GRAPH_GAP) * scale
        state.part(SpeedGraph).draw(state, time_scale, top, scale)


def _draw_mode_buttons(state: AppState, scale: float) -> None:
    """Draw a button for each mode, with its name where there is room."""
    has_room = imgui.get_window_width() >= _MIN_LABELED_WIDTH * scale
    for number, (mode, name, icon, tooltip) in enumerate(_MODES):
        if number:
            imgui.same_line(0, 4 * scale)
        label = f"{icon}  {tr(name)}" if has_room else icon
        if _icon_button(label, mode, scale, ACCENT if state.timeline.mode == mode else SECONDARY):
            state.timeline.set_mode(mode)
        widgets.show_tooltip(tr(tooltip))


def _draw_take_buttons(state: AppState, scale: float) -> None:
    """Draw the buttons that start and end a take, and make keyframes of it."""
    playback = state.timeline.session_playback
    is_recording = playback.take_start is not None
    icon = icons.ICON_FA_STOP if is_recording else icons.ICON_FA_CIRCLE
    if _icon_button(icon, "record", scale, ACCENT if is_recording else RED):
        (playback.end_take if is_recording else playback.start_take)()
    widgets.show_tooltip(tr("Record a take: what you do until the next click becomes the range"))
    imgui.same_line(0, 4 * scale)
    start, end = playback.played_range
    imgui.begin_disabled(end <= start)
    if _icon_button(icons.ICON_FA_WAND_MAGIC_SPARKLES, "take", scale, TEXT):
        state.run_reporting_errors(lambda: state.part(TakeDialog).open(state))
    imgui.end_disabled()
    widgets.show_tooltip(tr("Keyframes from the range"))


def _draw_playback_buttons(state: AppState, scale: float) -> None:
    """Draw the buttons that play, loop and export the range."""
    playback = state.timeline.playback
    icon = icons.ICON_FA_PAUSE if playback.is_playing else icons.ICON_FA_PLAY
    if _icon_button(icon, "play", scale, TEXT):
        playback.toggle_playing()
    widgets.show_tooltip(tr("Play (L)"))
    imgui.same_line(0, 4 * scale)
    if _icon_button(icons.ICON_FA_REPEAT, "loop", scale, ACCENT if playback.loop else SECONDARY):
        playback.loop = not playback.loop
    widgets.show_tooltip(tr("Loop"))
    imgui.same_line(0, 4 * scale)
    view = state.view
    if _icon_button(icons.ICON_FA_CHART_LINE, "speed", scale, ACCENT if view.show_speed_graph else SECONDARY):
        view.show_speed_graph = not view.show_speed_graph
    widgets.show_tooltip(
        tr("Speed graph: how fast pins or drawing move, and the easing of the selected interval")
    )
    imgui.same_line(0, 4 * scale)
    imgui.begin_disabled(playback.played_range[1] <= playback.played_range[0])
    if _icon_button(icons.ICON_FA_FILM, "export", scale, TEXT):
        state.part(ExportAnimationDialog).open(state)
    imgui.end_disabled()
    widgets.show_tooltip(tr("Export the range as an animation, video or sprite sheet"))


def _icon_button(icon: str, name: str, scale: float, color: Rgba) -> bool:
    """Draw a button with an icon, or with icon and text; return whether it was pressed."""
    imgui.push_style_color(imgui.Col_.text, ImVec4(*color))
    padding = 2 * _LABEL_PADDING * scale
    width = _BUTTON_WIDTH * scale if len(icon) == 1 else imgui.calc_text_size(icon).x + padding
    is_pressed = imgui.button(f"{icon}##{name}", ImVec2(width, _BUTTON_HEIGHT * scale))
    imgui.pop_style_color()
    return bool(is_pressed)
