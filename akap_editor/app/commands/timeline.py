"""The commands of the menu Animation: the timeline, what it plays, and its keyframes."""

from collections.abc import Callable

from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.animation.keyframe_playback import TIME_STEP
from ..app_state import AppState
from ..dialogs.export_animation import ExportAnimationDialog
from . import keying
from .command import CTRL, SHIFT, Command, Key, has_drawing

_ZOOM = 1.5


def _shown(state: AppState) -> bool:
    return has_drawing(state) and state.timeline.is_shown


def _can_cut(state: AppState) -> bool:
    return _shown(state) and state.timeline.playback.duration > 0


def _end(state: AppState) -> None:
    state.timeline.playback.stop_at(state.timeline.playback.played_range[1])


def _zoom(factor: float) -> Callable[[AppState], None]:
    return lambda state: state.timeline.playback.visible_range.zoom(factor, state.timeline.playback.playhead)


def _clear_range(state: AppState) -> None:
    state.timeline.playback.marked_range = None


KEY_HERE = Command("Keyframe Here", keying.keyframe_here, (Key.k,), icons.ICON_FA_DIAMOND, has_drawing)
KEY_REMOVE = Command(
    "Remove Keyframe",
    lambda state: state.timeline.keyframe_playback.delete_keyframes(),
    (SHIFT | Key.k,),
    "",
    keying.shown,
)
KEY_COPY = Command(
    "Duplicate Keyframe",
    lambda state: state.timeline.keyframe_playback.duplicate_keyframes(),
    (CTRL | SHIFT | Key.k,),
    "",
    keying.shown,
)
KEY_NEXT = Command(
    "Next Keyframe",
    lambda state: state.timeline.keyframe_playback.go_to_keyframe(True),
    (Key.period,),
    "",
    keying.shown,
)
KEY_PREVIOUS = Command(
    "Previous Keyframe",
    lambda state: state.timeline.keyframe_playback.go_to_keyframe(False),
    (Key.comma,),
    "",
    keying.shown,
)
KEY_LATER = Command("Move Keyframe Later", keying.nudging(TIME_STEP), (SHIFT | Key.period,), "", keying.shown)
KEY_EARLIER = Command(
    "Move Keyframe Earlier", keying.nudging(-TIME_STEP), (SHIFT | Key.comma,), "", keying.shown
)
PLAY = Command("Play", keying.play, (Key.l,), icons.ICON_FA_PLAY, keying.can_play)
ONION = Command(
    "Onion Skin",
    keying.toggle_onion,
    (Key.o,),
    icons.ICON_FA_LAYER_GROUP,
    keying.shown,
    lambda state: state.timeline.keyframe_playback.onion_skin.is_shown,
)
EXPORT_ANIMATION = Command(
    "Export Animation...",
    lambda state: state.part(ExportAnimationDialog).open(state),
    (CTRL | SHIFT | Key.e,),
    icons.ICON_FA_FILM,
    keying.can_play,
)

STEP_ON = Command("Step Forward", keying.going(TIME_STEP), (Key.page_down,), "", _shown, repeats=True)
STEP_BACK = Command("Step Back", keying.going(-TIME_STEP), (Key.page_up,), "", _shown, repeats=True)
SECOND_ON = Command(
    "One Second Forward", keying.going(1.0), (SHIFT | Key.page_down,), "", _shown, repeats=True
)
SECOND_BACK = Command("One Second Back", keying.going(-1.0), (SHIFT | Key.page_up,), "", _shown, repeats=True)
GO_START = Command(
    "Go to Start",
    lambda state: state.timeline.playback.stop_at(state.timeline.playback.played_range[0]),
    (Key.home,),
    "",
    _shown,
)
GO_END = Command("Go to End", _end, (Key.end,), "", _shown)
RANGE_START = Command(
    "Start Range Here",
    lambda state: state.timeline.playback.mark_range(start=state.timeline.playback.playhead),
    (SHIFT | Key.home,),
    "",
    _can_cut,
)
RANGE_END = Command(
    "End Range Here",
    lambda state: state.timeline.playback.mark_range(end=state.timeline.playback.playhead),
    (SHIFT | Key.end,),
    "",
    _can_cut,
)
RANGE_ALL = Command(
    "Range Is Everything",
    _clear_range,
    (),
    "",
    lambda state: state.timeline.playback.marked_range is not None,
)
ZOOM_IN = Command("Zoom into Timeline", _zoom(_ZOOM), (), "", _shown)
ZOOM_OUT = Command("Zoom out of Timeline", _zoom(1 / _ZOOM), (), "", _shown)
KEY_ALL = Command("Select All Keyframes", keying.choose_all, (), "", keying.shown)

ANIMATION: tuple[Command | None, ...] = (
    *(PLAY, EXPORT_ANIMATION, None),
    *(STEP_BACK, STEP_ON, SECOND_BACK, SECOND_ON, GO_START, GO_END, None),
    *(RANGE_START, RANGE_END, RANGE_ALL, None),
    *(KEY_HERE, KEY_REMOVE, KEY_COPY, KEY_ALL, None),
    *(KEY_PREVIOUS, KEY_NEXT, KEY_EARLIER, KEY_LATER, None),
    *(ONION, ZOOM_IN, ZOOM_OUT),
)
