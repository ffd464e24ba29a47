"""The commands of the View menu: zoom, overlays, panels."""

from collections.abc import Callable

from imgui_bundle import icons_fontawesome_6 as icons

from .. import file_commands
from ..app_state import AppState
from ..canvas.view_options import Measure
from ..frame import layout
from .command import CTRL, SHIFT, Command, CommandGroup, Key, always, has_drawing


def _switch(
    label: str,
    name: str,
    keys: tuple[int, ...] = (),
    icon: str = "",
    enabled: Callable[[AppState], bool] = always,
) -> Command:
    """A command that turns a field of the view options on or off."""

    def toggle(state: AppState) -> None:
        setattr(state.view, name, not getattr(state.view, name))

    return Command(label, toggle, keys, icon, enabled, lambda state: bool(getattr(state.view, name)))


def _distortion(label: str, measure: Measure, key: int) -> Command:
    """A command that shows a distortion map, or hides it."""
    return Command(
        label,
        lambda state: state.view.toggle_distortion_map(measure),
        (key,),
        "",
        has_drawing,
        lambda state: state.view.distortion_measure == measure,
    )


def _show_actual_size(state: AppState) -> None:
    state.editor.zoom(1.0 / state.editor.camera.zoom)


def _has_distortion(state: AppState) -> bool:
    return state.view.distortion_measure is not None


def _has_reference(state: AppState) -> bool:
    return state.view.reference is not None


def _toggle_timeline(state: AppState) -> None:
    state.timeline.is_shown = not state.timeline.is_shown


def _shows_timeline(state: AppState) -> bool:
    return state.timeline.is_shown


def _zoom(factor: float) -> Callable[[AppState], None]:
    return lambda state: state.editor.zoom(factor)


FIT = Command(
    "Fit in Window",
    lambda state: state.editor.fit(),
    (Key.f, CTRL | Key._0),
    icons.ICON_FA_EXPAND,
    has_drawing,
)
ACTUAL_SIZE = Command("Actual Size", _show_actual_size, (Key._1, CTRL | Key._1), "", has_drawing)
ZOOM_IN = Command(
    "Zoom In",
    _zoom(1.25),
    (CTRL | Key.equal, CTRL | SHIFT | Key.equal, CTRL | Key.keypad_add, Key.equal),
    "",
    has_drawing,
    typed="+",  # where a keyboard has it: Shift+= on some, a key of its own on others
    repeats=True,
)
ZOOM_OUT = Command(
    "Zoom Out",
    _zoom(0.8),
    (CTRL | Key.minus, CTRL | Key.keypad_subtract, Key.minus, Key.keypad_subtract),
    "",
    has_drawing,
    repeats=True,
)
SHOW_MESH = _switch("Show Mesh", "show_mesh", (SHIFT | Key.m,), icons.ICON_FA_DRAW_POLYGON)
SHOW_PINS = _switch("Show Pins", "show_pins", (SHIFT | Key.p,))
SHOW_FIELD = _switch("Show Vector Field", "show_vector_fields", (SHIFT | Key.v,), "", has_drawing)
SHOW_AREA = _distortion("Show Area Distortion", "area", SHIFT | Key.d)
SHOW_ANGLE = _distortion("Show Angle Distortion", "angle", SHIFT | Key.a)
SHOW_REST_POSE = _switch("Show Rest Pose", "show_rest_pose", (SHIFT | Key.g,), "", has_drawing)
SHOW_TRAILS = _switch("Show Pin Trails", "show_pin_trails", (SHIFT | Key.l,), "", has_drawing)
SHOW_MOTION_PATHS = _switch("Show Motion Paths", "show_motion_paths", (), "", has_drawing)
OVERLAYS = (SHOW_FIELD, SHOW_AREA, SHOW_ANGLE, SHOW_REST_POSE, SHOW_TRAILS, SHOW_MOTION_PATHS)
SMOOTH_BENDS = _switch("Smooth Bends", "smooth_bends", (), "", has_drawing)
NEXT_RANGE = Command(
    "Next Distortion Range",
    lambda state: state.view.use_next_distortion_range(),
    (SHIFT | Key.r,),
    "",
    _has_distortion,
)
SHOW_CHECKERBOARD = _switch("Show Checkerboard", "show_checkerboard", (SHIFT | Key.c,))
CHOOSE_REFERENCE = Command("Reference Picture...", file_commands.choose_reference, (), "", has_drawing)
SHOW_REFERENCE = _switch("Show Reference Picture", "show_reference", (SHIFT | Key.b,), "", _has_reference)
SHOW_TIMELINE = Command("Show Timeline", _toggle_timeline, (SHIFT | Key.t,), "", has_drawing, _shows_timeline)
COMPARE_METHODS = _switch("Compare Methods", "is_split", (), icons.ICON_FA_TABLE_COLUMNS, has_drawing)


def _toggle_panels(state: AppState) -> None:
    state.panels_are_hidden = not state.panels_are_hidden


def _toggle_full_screen(state: AppState) -> None:
    state.is_full_screen = not state.is_full_screen


HIDE_PANELS = Command(
    "Hide Panels", _toggle_panels, (Key.tab,), "", has_drawing, lambda state: state.panels_are_hidden
)
FULL_SCREEN = Command(
    "Full Screen", _toggle_full_screen, (Key.f11,), "", always, lambda state: state.is_full_screen
)


def _part(label: str, part: layout.Part) -> Command:
    """A command that shows or hides a part of the frame."""
    return Command(
        label,
        lambda state: layout.toggle(state, part),
        enabled=has_drawing,
        checked=lambda state: layout.is_chosen(state, part),
    )


def _tab(label: str, tab: layout.Tab) -> Command:
    """A command that shows a tab of the side panel."""
    return Command(
        label,
        lambda state: layout.show_tab(state, tab),
        enabled=has_drawing,
        checked=lambda state: layout.current_tab(state) == tab,
    )


PANELS = CommandGroup(
    "Panels",
    (
        *(_part("Show Toolbar", "toolbar"), _part("Show Options Bar", "options")),
        *(_part("Show Side Panel", "side panel"), None),
        *(_tab("Pose Tab", "Pose"), _tab("Animate Tab", "Animate"), _tab("Mesh Tab", "Mesh")),
    ),
)
