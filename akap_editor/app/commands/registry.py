"""Every command once, with its name, key and icon; menus, tool bar and keyboard all read this table."""

from collections.abc import Callable
from dataclasses import replace

from imgui_bundle import icons_fontawesome_6 as icons

from ...deform.methods import get_method
from ...editor import gestures
from ...editor.editor import Editor
from ...editor.session.edits import SetStiffness
from ...editor.tools.base import IdleTool
from ...resources import bundled_drawings
from .. import file_commands, files
from ..app_state import AppState
from ..canvas.view_options import Measure
from ..dialogs.about import AboutDialog
from ..dialogs.export_pose import ExportPoseDialog
from ..panels.method_parameters import with_default_values
from . import keying
from .command import CTRL, SHIFT, Command, Key, Menu, Submenu, always, has_drawing
from .keyboard_pointer import CROSSHAIR, MENU_HERE, NEXT_PIN, PANNING, PIN_VALUES, PREVIOUS_PIN
from .palette import Palette
from .shortcuts_page import ShortcutsPage
from .timeline import ANIMATION


def _toggle(name: str) -> tuple[Callable[[AppState], None], Callable[[AppState], bool]]:
    def flip(state: AppState) -> None:
        setattr(state, name, not getattr(state, name))

    return flip, lambda state: bool(getattr(state, name))


def _tool(tool: Callable[[Editor], IdleTool], label: str, key: Key, icon: str) -> Command:
    """The command that chooses a tool of the editor."""

    def choose(state: AppState) -> None:
        state.editor.chosen_tool = tool(state.editor)

    def is_chosen(state: AppState) -> bool:
        return state.editor.chosen_tool is tool(state.editor)

    return Command(label, choose, (key,), icon, always, is_chosen)


def _has_brush(state: AppState) -> bool:
    return has_drawing(state) and state.editor.chosen_tool is state.editor.brush_tool


def _resize(up: bool) -> Callable[[AppState], None]:
    def resize(state: AppState) -> None:
        state.editor.brush_tool.brush = state.editor.brush_tool.brush.resized(up)

    return resize


def _erase(state: AppState) -> None:
    brush = state.editor.brush_tool.brush
    state.editor.brush_tool.brush = replace(brush, erasing=not brush.erasing)


def _can_hold(state: AppState) -> bool:
    session = state.editor.session
    return session is not None and session.supports_rotation and bool(state.editor.selection)


def _holds(state: AppState) -> bool:
    session, chosen = state.editor.session, state.editor.selection
    held = [pin.angle is not None for pin in session.state.pins if pin.id in chosen] if session else []
    return bool(held) and all(held)


def _remove(state: AppState) -> None:
    """Pins, or where none is selected, keyframes."""
    if state.editor.selection:
        gestures.remove_selected_pins(state.editor)
    else:
        state.timeline.keyframe_playback.delete_keyframes()


def _open_palette(state: AppState) -> None:
    state.part(Palette).open(PALETTE_ITEMS)


def _open_shortcuts(state: AppState) -> None:
    state.part(ShortcutsPage).open(MENUS, COMMANDS, SHORTCUTS)


def _actual_size(state: AppState) -> None:
    state.editor.zoom(1.0 / state.editor.camera.zoom)


def _remember(state: AppState) -> None:
    session = state.editor.session
    if session is not None:
        settings = session.state.settings
        state.change_settings(settings.with_parameter("memory", 0.0 if remembers(state) else 1.0))


def _defaults(state: AppState) -> None:
    assert state.document is not None
    state.change_settings(with_default_values(state.document.state.settings))


def _can_undo(state: AppState) -> bool:
    """In the middle of a gesture undo takes that one back."""
    editor = state.editor
    return editor.is_busy or (editor.session is not None and editor.session.history.undo_label is not None)


def _has_memory(state: AppState) -> bool:
    session = state.editor.session
    return session is not None and get_method(session.state.settings.method).deformer.has_memory


def remembers(state: AppState) -> bool:
    """Whether the drawing remembers its rest shape."""
    session = state.editor.session
    return session is not None and bool(session.state.settings.get("memory", 0.0))


def _view_toggle(name: str) -> tuple[Callable[[AppState], None], Callable[[AppState], bool]]:
    def flip(state: AppState) -> None:
        setattr(state.view, name, not getattr(state.view, name))

    return flip, lambda state: bool(getattr(state.view, name))


def _toggle_timeline(state: AppState) -> None:
    state.timeline.is_shown = not state.timeline.is_shown


def _distortion_toggle(measure: Measure) -> tuple[Callable[[AppState], None], Callable[[AppState], bool]]:
    return (
        lambda state: state.view.toggle_distortion_map(measure),
        lambda state: state.view.distortion_measure == measure,
    )


_field, _field_on = _view_toggle("show_vector_fields")
_ghost, _ghost_on = _view_toggle("show_rest_pose")
_trails, _trails_on = _view_toggle("show_pin_trails")
_reference, _reference_on = _view_toggle("show_reference")
_area, _area_on = _distortion_toggle("area")
_angle, _angle_on = _distortion_toggle("angle")
_mesh, _mesh_on = _toggle("show_mesh")
_pins, _pins_on = _toggle("show_pins")
_checker, _checker_on = _toggle("checker")
_split, _split_on = _toggle("split")

OPEN = Command("Open...", files.choose_and_open, (CTRL | Key.o,), icons.ICON_FA_FOLDER_OPEN)
MASK = Command("Cut Out with Mask...", file_commands.choose_mask, (), "", file_commands.can_mask)
SAVE = Command("Save", files.save, (CTRL | Key.s,), icons.ICON_FA_FLOPPY_DISK, has_drawing)
SAVE_AS = Command("Save As...", files.save_as, (CTRL | SHIFT | Key.s,), "", has_drawing)
EXPORT = Command(
    "Export...",
    lambda state: state.part(ExportPoseDialog).open(state),
    (CTRL | Key.e,),
    icons.ICON_FA_FILE_EXPORT,
    has_drawing,
)
SAVE_POSE = Command("Save Pose...", file_commands.choose_pose_to_save, (), "", has_drawing)
APPLY_POSE = Command("Apply Pose...", file_commands.choose_pose_to_apply, (), "", has_drawing)
SAVE_RECORDING = Command("Save Recording...", file_commands.choose_recording_to_save, (), "", has_drawing)
CLOSE = Command("Close", files.close_document, (CTRL | Key.w,), "", has_drawing)
QUIT = Command("Quit", files.quit_program, (CTRL | Key.q,))

UNDO = Command(
    "Undo",
    lambda state: state.editor.undo(),
    (CTRL | Key.z,),
    icons.ICON_FA_ARROW_ROTATE_LEFT,
    _can_undo,
)
REDO = Command(
    "Redo",
    lambda state: state.editor.redo(),
    (CTRL | SHIFT | Key.z, CTRL | Key.y),
    icons.ICON_FA_ARROW_ROTATE_RIGHT,
    lambda state: state.editor.session is not None and state.editor.session.history.redo_label is not None,
)
REMOVE = Command(
    "Remove Selected Pins",
    _remove,
    (Key.delete,),
    icons.ICON_FA_TRASH_CAN,
    lambda state: bool(state.editor.selection) or keying.has_chosen(state),
)
LIMB_TO_FRONT = Command(
    "Bring Limb to Front",
    lambda state: gestures.order_limb(state.editor, True),
    (CTRL | Key.right_bracket,),
    "",
    lambda state: bool(state.editor.selection),
)
LIMB_TO_BACK = Command(
    "Send Limb to Back",
    lambda state: gestures.order_limb(state.editor, False),
    (CTRL | Key.left_bracket,),
    "",
    lambda state: bool(state.editor.selection),
)
RAISE_DEPTH = Command(
    "Raise Depth",
    lambda state: gestures.shift_depths(state.editor, 1),
    (CTRL | SHIFT | Key.right_bracket,),
    "",
    lambda state: bool(state.editor.selection),
)
LOWER_DEPTH = Command(
    "Lower Depth",
    lambda state: gestures.shift_depths(state.editor, -1),
    (CTRL | SHIFT | Key.left_bracket,),
    "",
    lambda state: bool(state.editor.selection),
)
REMOVE_LAST = Command(
    "Remove Last Pin",
    lambda state: gestures.remove_last_pin(state.editor),
    (Key.backspace,),
    "",
    lambda state: state.editor.session is not None and bool(state.editor.session.state.pins),
)
SELECT_ALL = Command(
    "Select All Pins", lambda state: state.editor.select_all(), (CTRL | Key.a,), "", has_drawing
)
DESELECT = Command(
    "Deselect",
    lambda state: state.editor.select(()),
    (CTRL | Key.d,),
    "",
    lambda state: bool(state.editor.selection),
)
RESET_POSE = Command(
    "Reset Pose",
    lambda state: gestures.reset_pose(state.editor),
    (CTRL | Key.r,),
    icons.ICON_FA_PERSON,
    lambda state: state.editor.session is not None and state.editor.session.is_posed,
)
BAKE = Command(
    "Make Pose the Rest Pose",
    lambda state: gestures.set_rest_pose(state.editor),
    (),
    "",
    lambda state: state.editor.session is not None and state.editor.session.is_posed,
)
DEFAULTS = Command(
    "Default Parameters",
    _defaults,
    (),
    "",
    lambda state: (
        state.document is not None
        and with_default_values(state.document.state.settings) != state.document.state.settings
    ),
)
REMEMBER = Command("Remember the Rest Shape", _remember, (), "", _has_memory, remembers)

HOLD_ANGLE = Command(
    "Hold Angle", lambda state: gestures.toggle_held_angles(state.editor), (), "", _can_hold, _holds
)

PIN_TOOL = _tool(lambda editor: editor.pins_tool, "Pins", Key.p, icons.ICON_FA_THUMBTACK)
HAND_TOOL = _tool(lambda editor: editor.hand_tool, "Move Canvas", Key.n, icons.ICON_FA_HAND)
BRUSH_TOOL = _tool(lambda editor: editor.brush_tool, "Stiffness Brush", Key.s, icons.ICON_FA_PAINTBRUSH)
ERASE = Command(
    "Erase Stiffness", _erase, (Key.e,), "", _has_brush, lambda state: state.editor.brush_tool.brush.erasing
)
SMALLER = Command("Smaller Brush", _resize(False), (Key.left_bracket,), "", _has_brush)
LARGER = Command("Larger Brush", _resize(True), (Key.right_bracket,), "", _has_brush)
SOFTEN_ALL = Command(
    "Remove All Stiffness",
    lambda state: state.editor.apply("Remove All Stiffness", SetStiffness(None)),
    (),
    "",
    lambda state: state.editor.session is not None and state.editor.session.state.stiffness is not None,
)
FIT = Command(
    "Fit in Window",
    lambda state: state.editor.fit(),
    (Key.f, CTRL | Key._0),
    icons.ICON_FA_EXPAND,
    has_drawing,
)
ACTUAL_SIZE = Command("100 %", _actual_size, (Key._1, CTRL | Key._1), "", has_drawing)
ZOOM_IN = Command(
    "Zoom In",
    lambda state: state.editor.zoom(1.25),
    (Key.equal, CTRL | Key.equal),
    "",
    has_drawing,
    repeats=True,
)
ZOOM_OUT = Command(
    "Zoom Out",
    lambda state: state.editor.zoom(0.8),
    (Key.minus, CTRL | Key.minus),
    "",
    has_drawing,
    repeats=True,
)
SHOW_MESH = Command("Show Mesh", _mesh, (Key.m,), icons.ICON_FA_DRAW_POLYGON, always, _mesh_on)
SHOW_PINS = Command("Show Pins", _pins, (SHIFT | Key.p,), "", always, _pins_on)
SHOW_TIMELINE = Command(
    "Timeline", _toggle_timeline, (SHIFT | Key.t,), "", has_drawing, lambda state: state.timeline.is_shown
)
SPLIT = Command("Two Methods Side by Side", _split, (), icons.ICON_FA_TABLE_COLUMNS, has_drawing, _split_on)
CHECKER = Command("Checkerboard", _checker, (Key.b,), "", always, _checker_on)
SHOW_FIELD = Command("Vector Field of the Drag", _field, (Key.v,), "", has_drawing, _field_on)
SHOW_AREA = Command("Distortion of Areas", _area, (Key.d,), "", has_drawing, _area_on)
SHOW_ANGLE = Command("Distortion of Angles", _angle, (SHIFT | Key.d,), "", has_drawing, _angle_on)
NEXT_RANGE = Command(
    "Next Range of Distortion",
    lambda state: state.view.use_next_distortion_range(),
    (Key.r,),
    "",
    lambda state: state.view.distortion_measure is not None,
)
SHOW_GHOST = Command("Rest Pose", _ghost, (Key.g,), "", has_drawing, _ghost_on)
SHOW_TRAILS = Command("Pin Trails", _trails, (Key.t,), "", has_drawing, _trails_on)
CHOOSE_REFERENCE = Command("Reference Picture...", file_commands.choose_reference, (), "", has_drawing)
SHOW_REFERENCE = Command(
    "Show Reference Picture",
    _reference,
    (SHIFT | Key.b,),
    "",
    lambda state: state.view.reference is not None,
    _reference_on,
)
OVERLAYS = (SHOW_FIELD, SHOW_AREA, SHOW_ANGLE, SHOW_GHOST, SHOW_TRAILS)

PALETTE = Command("Find Command...", _open_palette, (CTRL | Key.k, Key.f3))
SHORTCUTS = Command("Keys and Mouse", _open_shortcuts, (Key.f1,), typed="?")
ABOUT = Command("About akap-editor", lambda state: state.part(AboutDialog).open())

OPEN_BUNDLED = Submenu(
    "Open Bundled Drawing", lambda state: [(path.stem.capitalize(), path) for path in bundled_drawings()]
)
OPEN_RECENT = Submenu("Open Recent", lambda state: [(path.name, path) for path in state.preferences.recent])

_EXPORTS = (EXPORT, SAVE_RECORDING)

MENUS: tuple[Menu, ...] = (
    (
        "File",
        (
            OPEN,
            OPEN_RECENT,
            OPEN_BUNDLED,
            MASK,
            CLOSE,
            None,
            SAVE,
            SAVE_AS,
            None,
            SAVE_POSE,
            APPLY_POSE,
            None,
            EXPORT,
            SAVE_RECORDING,
            None,
            QUIT,
        ),
    ),
    (
        "Edit",
        (
            UNDO,
            REDO,
            None,
            REMOVE,
            REMOVE_LAST,
            SELECT_ALL,
            DESELECT,
            NEXT_PIN,
            PREVIOUS_PIN,
            PIN_VALUES,
            MENU_HERE,
            None,
            LIMB_TO_FRONT,
            LIMB_TO_BACK,
            RAISE_DEPTH,
            LOWER_DEPTH,
            HOLD_ANGLE,
            None,
            RESET_POSE,
            BAKE,
            REMEMBER,
            DEFAULTS,
            SOFTEN_ALL,
        ),
    ),
    (
        "View",
        (
            *(FIT, ACTUAL_SIZE, ZOOM_IN, ZOOM_OUT, None),
            *(SHOW_MESH, SHOW_PINS, *OVERLAYS, NEXT_RANGE, None),
            *(CHECKER, CHOOSE_REFERENCE, SHOW_REFERENCE),
            *(None, SHOW_TIMELINE, SPLIT),
        ),
    ),
    ("Animation", ANIMATION),
    ("Help", (PALETTE, SHORTCUTS, ABOUT)),
)
COMMANDS = (
    *(command for _, group in MENUS for command in group if isinstance(command, Command)),
    *(PIN_TOOL, HAND_TOOL, BRUSH_TOOL, CROSSHAIR),
    *(ERASE, SMALLER, LARGER),
    *PANNING,
)


PALETTE_ITEMS = (*(item for _, items in MENUS for item in items if item is not None), *COMMANDS)


def run_pressed(state: AppState) -> None:
    """Run the commands whose keys were pressed in this frame."""
    for command in COMMANDS:
        if command.is_pressed() and command.enabled(state):
            state.run_reporting_errors(lambda command=command: command.run(state))  # type: ignore[misc]
