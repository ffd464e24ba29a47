"""The commands of the mirror: on and off, its axis, pairs of pins, and the flipped pose."""

from imgui_bundle import icons_fontawesome_6 as icons

from ....editor import mirroring
from ....editor.tools.mirror_axis import draw_axis
from ...app_state import AppState
from ..command import SHIFT, Command, Key, has_drawing


def _has_mirror(state: AppState) -> bool:
    session = state.editor.session
    return session is not None and mirroring.active_mirror(session) is not None


def _has_two_pins(state: AppState) -> bool:
    return len(state.editor.selection) == 2


def _has_pair(state: AppState) -> bool:
    session = state.editor.session
    mirror = session.state.mirror if session is not None else None
    return mirror is not None and any(mirror.partner(pin) is not None for pin in state.editor.selection)


def _can_flip(state: AppState) -> bool:
    session = state.editor.session
    return session is not None and bool(session.state.pins)


MIRROR_PINS = Command(
    "Mirror Pins",
    lambda state: mirroring.toggle_mirror(state.editor),
    (SHIFT | Key.x,),
    icons.ICON_FA_LEFT_RIGHT,
    has_drawing,
    _has_mirror,
)
DRAW_AXIS = Command(
    "Draw Mirror Axis",
    lambda state: draw_axis(state.editor),
    (),
    icons.ICON_FA_RULER_VERTICAL,
    has_drawing,
)
PAIR_PINS = Command(
    "Pair Pins",
    lambda state: mirroring.pair_selected(state.editor),
    (),
    icons.ICON_FA_LEFT_RIGHT,
    _has_two_pins,
)
UNPAIR_PINS = Command("Unpair Pins", lambda state: mirroring.unpair_selected(state.editor), (), "", _has_pair)
FLIP_POSE = Command(
    "Flip Pose",
    lambda state: mirroring.flip_pose(state.editor),
    (SHIFT | Key.f,),
    icons.ICON_FA_RIGHT_LEFT,
    _can_flip,
)
MIRROR = (MIRROR_PINS, DRAW_AXIS, PAIR_PINS, UNPAIR_PINS, None, FLIP_POSE)
