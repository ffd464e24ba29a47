"""The commands of the Animation menu: playback, range and keyframes."""

from collections.abc import Callable

from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.animation.keyframe_playback import KeyframePlayback
from ...editor.animation.keyframe_times import TIME_STEP
from ...editor.animation.playback import Playback
from ...words import mark
from ..app_state import AppState
from ..dialogs.clips import ClipsDialog, request_clip_file
from ..dialogs.export.animation import ExportAnimationDialog
from ..dialogs.take import TakeDialog
from ..timeline.timeline import snap_time
from .command import CTRL, SHIFT, Command, CommandGroup, Key, MenuItem, has_drawing

_ZOOM_FACTOR = 1.5


def _is_shown(state: AppState) -> bool:
    return has_drawing(state) and state.timeline.is_shown


def _has_duration(state: AppState) -> bool:
    return _is_shown(state) and state.timeline.playback.duration > 0


def _has_marked_range(state: AppState) -> bool:
    return state.timeline.playback.marked_range is not None


def _can_play(state: AppState) -> bool:
    start, end = state.timeline.playback.played_range
    return has_drawing(state) and end > start


def has_keyframes(state: AppState) -> bool:
    """Whether the timeline is visible and shows keyframes."""
    has_any = bool(state.timeline.keyframe_playback.animation.keyframes)
    return has_drawing(state) and state.timeline.shows_keyframes and has_any


def has_several_keyframes(state: AppState) -> bool:
    """Whether the timeline is visible and shows two keyframes or more."""
    return has_keyframes(state) and len(state.timeline.keyframe_playback.animation.keyframes) > 1


def has_selected_keyframes(state: AppState) -> bool:
    """Whether the timeline is visible and shows selected keyframes."""
    return has_keyframes(state) and bool(state.timeline.keyframe_playback.selected)


def _can_paste_keyframes(state: AppState) -> bool:
    return state.timeline.shows_keyframes and state.timeline.keyframe_playback.can_paste()


def _has_session_range(state: AppState) -> bool:
    start, end = state.timeline.session_playback.played_range
    return has_drawing(state) and end > start


def _on_playback(action: Callable[[Playback], None]) -> Callable[[AppState], None]:
    return lambda state: action(state.timeline.playback)


def _on_keyframes(action: Callable[[KeyframePlayback], None]) -> Callable[[AppState], None]:
    return lambda state: action(state.timeline.keyframe_playback)


def _play(state: AppState) -> None:
    state.timeline.is_shown = True
    state.timeline.playback.toggle_playing()


def _step(seconds: float) -> Callable[[AppState], None]:
    """Moves the playhead; on the keyframe track to times where a drag would move it, too."""

    def step(state: AppState) -> None:
        time = state.timeline.playback.playhead + seconds
        state.timeline.playback.stop_at(snap_time(time) if state.timeline.mode == "keyframes" else time)

    return step


def _zoom(factor: float) -> Callable[[Playback], None]:
    return lambda playback: playback.visible_range.zoom(factor, playback.playhead)


def _clear_range(playback: Playback) -> None:
    playback.marked_range = None


def _toggle_onion_skin(playback: KeyframePlayback) -> None:
    playback.onion_skin.is_shown = not playback.onion_skin.is_shown


def _toggle_auto_key(state: AppState) -> None:
    state.timeline.show_keyframes()
    auto_key = state.timeline.keyframe_playback.auto_key
    auto_key.is_on = not auto_key.is_on


def _toggle_speed_graph(state: AppState) -> None:
    state.view.show_speed_graph = not (state.timeline.is_shown and state.view.show_speed_graph)
    state.timeline.is_shown = True


def _select_all(playback: KeyframePlayback) -> None:
    playback.selected = frozenset(playback.stored_animation.times)


_NOTHING_TO_PLAY = mark(
    "There is no motion yet: bend the drawing, or set two keyframes (K) at different times"
)

PLAY = Command("Play", _play, (Key.l,), icons.ICON_FA_PLAY, _can_play, missing=_NOTHING_TO_PLAY)
EXPORT_ANIMATION = Command(
    "Export Animation...",
    lambda state: state.part(ExportAnimationDialog).open(state),
    (CTRL | SHIFT | Key.e,),
    icons.ICON_FA_FILM,
    _can_play,
    missing=_NOTHING_TO_PLAY,
)

STEP_FORWARD = Command("Step Forward", _step(TIME_STEP), (Key.page_down,), "", _is_shown, repeats=True)
STEP_BACK = Command("Step Back", _step(-TIME_STEP), (Key.page_up,), "", _is_shown, repeats=True)
SECOND_FORWARD = Command(
    "One Second Forward", _step(1.0), (SHIFT | Key.page_down,), "", _is_shown, repeats=True
)
SECOND_BACK = Command("One Second Back", _step(-1.0), (SHIFT | Key.page_up,), "", _is_shown, repeats=True)
GO_TO_START = Command(
    "Go to Start",
    _on_playback(lambda playback: playback.stop_at(playback.played_range[0])),
    (Key.home,),
    "",
    _is_shown,
)
GO_TO_END = Command(
    "Go to End",
    _on_playback(lambda playback: playback.stop_at(playback.played_range[1])),
    (Key.end,),
    "",
    _is_shown,
)

SET_RANGE_START = Command(
    "Set Range Start",
    _on_playback(lambda playback: playback.mark_range(start=playback.playhead)),
    (SHIFT | Key.home,),
    "",
    _has_duration,
)
SET_RANGE_END = Command(
    "Set Range End",
    _on_playback(lambda playback: playback.mark_range(end=playback.playhead)),
    (SHIFT | Key.end,),
    "",
    _has_duration,
)
CLEAR_RANGE = Command("Clear Range", _on_playback(_clear_range), (), "", _has_marked_range)

ADD_KEYFRAME = Command(
    "Add Keyframe",
    lambda state: state.timeline.add_keyframe(),
    (Key.k,),
    icons.ICON_FA_DIAMOND,
    has_drawing,
)
DELETE_KEYFRAME = Command(
    "Delete Keyframe",
    _on_keyframes(KeyframePlayback.delete_keyframes),
    (SHIFT | Key.k,),
    "",
    has_keyframes,
)
DUPLICATE_KEYFRAME = Command(
    "Duplicate Keyframe",
    _on_keyframes(KeyframePlayback.duplicate_keyframes),
    (CTRL | SHIFT | Key.k,),
    "",
    has_keyframes,
)
REVERSE_KEYFRAMES = Command(
    "Reverse Keyframes", _on_keyframes(KeyframePlayback.reverse_keyframes), (), "", has_several_keyframes
)
DUPLICATE_REVERSED = Command(
    "Duplicate Keyframes Reversed",
    _on_keyframes(lambda playback: playback.reverse_keyframes(copy=True)),
    (),
    "",
    has_several_keyframes,
)
COPY_KEYFRAMES = Command(
    "Copy Keyframes", _on_keyframes(KeyframePlayback.copy_keyframes), (), "", has_keyframes
)
PASTE_KEYFRAMES = Command(
    "Paste Keyframes", _on_keyframes(KeyframePlayback.paste_keyframes), (), "", _can_paste_keyframes
)
PASTE_REVERSED = Command(
    "Paste Keyframes Reversed",
    _on_keyframes(lambda playback: playback.paste_keyframes(reverse=True)),
    (),
    "",
    _can_paste_keyframes,
)
KEYFRAMES_FROM_TAKE = Command(
    "Keyframes from Take...",
    lambda state: state.part(TakeDialog).open(state),
    (),
    icons.ICON_FA_WAND_MAGIC_SPARKLES,
    _has_session_range,
)
CLIPS = Command("Clips...", lambda state: state.part(ClipsDialog).open(state), (), "", has_drawing)
SAVE_CLIP = Command("Save as Clip...", request_clip_file, (), "", has_several_keyframes)
SELECT_ALL_KEYFRAMES = Command("Select All Keyframes", _on_keyframes(_select_all), (), "", has_keyframes)
PREVIOUS_KEYFRAME = Command(
    "Previous Keyframe",
    _on_keyframes(lambda playback: playback.go_to_keyframe(False)),
    (Key.comma,),
    "",
    has_keyframes,
)
NEXT_KEYFRAME = Command(
    "Next Keyframe",
    _on_keyframes(lambda playback: playback.go_to_keyframe(True)),
    (Key.period,),
    "",
    has_keyframes,
)
MOVE_EARLIER = Command(
    "Move Keyframe Earlier",
    _on_keyframes(lambda playback: playback.shift_keyframes(-TIME_STEP)),
    (SHIFT | Key.comma,),
    "",
    has_keyframes,
)
MOVE_LATER = Command(
    "Move Keyframe Later",
    _on_keyframes(lambda playback: playback.shift_keyframes(TIME_STEP)),
    (SHIFT | Key.period,),
    "",
    has_keyframes,
)

AUTO_KEY = Command(
    "Auto Key",
    _toggle_auto_key,
    (),
    icons.ICON_FA_CIRCLE_DOT,
    has_drawing,
    lambda state: state.timeline.keyframe_playback.auto_key.is_on,
)
ONION_SKIN = Command(
    "Onion Skin",
    _on_keyframes(_toggle_onion_skin),
    (SHIFT | Key.o,),
    icons.ICON_FA_LAYER_GROUP,
    has_keyframes,
    lambda state: state.timeline.keyframe_playback.onion_skin.is_shown,
)
SPEED_GRAPH = Command(
    "Speed Graph",
    _toggle_speed_graph,
    (),
    icons.ICON_FA_CHART_LINE,
    has_drawing,
    lambda state: state.timeline.is_shown and state.view.show_speed_graph,
)
ZOOM_IN_TIMELINE = Command("Zoom In Timeline", _on_playback(_zoom(_ZOOM_FACTOR)), (), "", _is_shown)
ZOOM_OUT_TIMELINE = Command("Zoom Out Timeline", _on_playback(_zoom(1 / _ZOOM_FACTOR)), (), "", _is_shown)

GO_TO = CommandGroup(
    "Go To",
    (
        *(STEP_BACK, STEP_FORWARD, SECOND_BACK, SECOND_FORWARD, None),
        *(PREVIOUS_KEYFRAME, NEXT_KEYFRAME, None, GO_TO_START, GO_TO_END),
    ),
)
RANGE = CommandGroup("Range", (SET_RANGE_START, SET_RANGE_END, CLEAR_RANGE))

ANIMATION: tuple[MenuItem, ...] = (
    *(PLAY, EXPORT_ANIMATION, None),
    *(ADD_KEYFRAME, DELETE_KEYFRAME, DUPLICATE_KEYFRAME, SELECT_ALL_KEYFRAMES),
    *(COPY_KEYFRAMES, PASTE_KEYFRAMES, PASTE_REVERSED, REVERSE_KEYFRAMES, DUPLICATE_REVERSED),
    *(MOVE_EARLIER, MOVE_LATER, None),
    *(GO_TO, RANGE, None),
    *(AUTO_KEY, KEYFRAMES_FROM_TAKE, CLIPS, SAVE_CLIP, None),
    *(ONION_SKIN, SPEED_GRAPH, ZOOM_IN_TIMELINE, ZOOM_OUT_TIMELINE),
)
