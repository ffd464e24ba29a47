"""Every command once, with its name, key and icon; menus, tool bar and keyboard all read this table."""

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.tools.rotate import toggle_hold
from ...resources import bundled_drawings
from .. import masking, poses, recordings, reference
from ..app_state import Workspace
from ..canvas.view_options import RANGES, Measure
from ..dialogs.file_dialog import Palette
from ..panels.method_parameters import defaults
from . import keying
from .command import CTRL, SHIFT, Command, Key, Submenu, always, has_drawing
from .keyboard_pointer import CROSSHAIR, MENU_HERE, NEXT_PIN, PANNING, PIN_VALUES, PREVIOUS_PIN
from .timeline import ANIMATION


def _toggle(name: str) -> tuple[Callable[[Workspace], None], Callable[[Workspace], bool]]:
    def flip(space: Workspace) -> None:
        setattr(space, name, not getattr(space, name))

    return flip, lambda space: bool(getattr(space, name))


def _tool(name: Literal["pins", "hand", "brush"], label: str, key: Key, icon: str) -> Command:
    def choose(space: Workspace) -> None:
        space.editor.chosen_tool = name

    return Command(label, choose, (key,), icon, always, lambda space: space.editor.chosen_tool == name)


def _has_brush(space: Workspace) -> bool:
    return has_drawing(space) and space.editor.chosen_tool == "brush"


def _resize(up: bool) -> Callable[[Workspace], None]:
    def resize(space: Workspace) -> None:
        space.editor.brush = space.editor.brush.resized(up)

    return resize


def _erase(space: Workspace) -> None:
    brush = space.editor.brush
    space.editor.brush = replace(brush, erasing=not brush.erasing)


def _can_hold(space: Workspace) -> bool:
    session = space.editor.session
    return session is not None and session.turns and bool(space.editor.selection)


def _holds(space: Workspace) -> bool:
    session, chosen = space.editor.session, space.editor.selection
    held = [pin.angle is not None for pin in session.state.pins if pin.id in chosen] if session else []
    return bool(held) and all(held)


def _remove(space: Workspace) -> None:
    """Pins, or where none is selected, keyframes."""
    if space.editor.selection:
        space.editor.remove_selected()
    else:
        space.key_player.remove()


def _find(space: Workspace) -> None:
    space.palette = Palette()


def _actual_size(space: Workspace) -> None:
    space.editor.zoom(1.0 / space.editor.camera.zoom)


def _remember(space: Workspace) -> None:
    session = space.editor.session
    if session is not None:
        settings = session.state.settings
        space.change_settings(settings.with_parameter("memory", 0.0 if remembers(space) else 1.0))


def _defaults(space: Workspace) -> None:
    assert space.document is not None
    space.change_settings(defaults(space.document.state.settings))


def _can_undo(space: Workspace) -> bool:
    """In the middle of a gesture undo takes that one back."""
    editor = space.editor
    return editor.busy or (editor.session is not None and editor.session.history.undo_label is not None)


def _is_akap(space: Workspace) -> bool:
    session = space.editor.session
    return session is not None and session.state.settings.method == "akap"


def remembers(space: Workspace) -> bool:
    """Whether the drawing remembers its rest shape."""
    session = space.editor.session
    return session is not None and bool(session.state.settings.get("memory", 0.0))


def _view_toggle(name: str) -> tuple[Callable[[Workspace], None], Callable[[Workspace], bool]]:
    def flip(space: Workspace) -> None:
        setattr(space.view, name, not getattr(space.view, name))

    return flip, lambda space: bool(getattr(space.view, name))


def _next_range(space: Workspace) -> None:
    """The next wider range of the scale; after the widest the narrowest."""
    space.view.heat_range = (space.view.heat_range + 1) % len(RANGES)


def _heat_toggle(measure: Measure) -> tuple[Callable[[Workspace], None], Callable[[Workspace], bool]]:
    """One map at a time: choosing one switches the other off."""

    def flip(space: Workspace) -> None:
        space.view.heat = None if space.view.heat == measure else measure

    return flip, lambda space: space.view.heat == measure


_field, _field_on = _view_toggle("vectors")
_ghost, _ghost_on = _view_toggle("ghost")
_trails, _trails_on = _view_toggle("trails")
_reference, _reference_on = _view_toggle("show_reference")
_area, _area_on = _heat_toggle("area")
_angle, _angle_on = _heat_toggle("angle")
_mesh, _mesh_on = _toggle("show_mesh")
_pins, _pins_on = _toggle("show_pins")
_checker, _checker_on = _toggle("checker")
_split, _split_on = _toggle("split")
_timeline, _timeline_on = _toggle("show_timeline")
_about, _ = _toggle("about")
_keys, _ = _toggle("keys")

OPEN = Command("Open...", Workspace.ask_open, (CTRL | Key.o,), icons.ICON_FA_FOLDER_OPEN)
MASK = Command("Cut Out with Mask...", masking.ask_mask, (), "", masking.can_mask)
SAVE = Command("Save", Workspace.save, (CTRL | Key.s,), icons.ICON_FA_FLOPPY_DISK, has_drawing)
SAVE_AS = Command("Save As...", Workspace.save_as, (CTRL | SHIFT | Key.s,), "", has_drawing)
EXPORT = Command("Export...", Workspace.ask_export, (CTRL | Key.e,), icons.ICON_FA_FILE_EXPORT, has_drawing)
SAVE_POSE = Command("Save Pose...", poses.ask_save, (), "", has_drawing)
APPLY_POSE = Command("Apply Pose...", poses.ask_apply, (), "", has_drawing)
SAVE_RECORDING = Command("Save Recording...", recordings.ask_save, (), "", has_drawing)
CLOSE = Command("Close", Workspace.close, (CTRL | Key.w,), "", has_drawing)
QUIT = Command("Quit", Workspace.quit, (CTRL | Key.q,))

UNDO = Command(
    "Undo",
    lambda space: space.editor.undo(),
    (CTRL | Key.z,),
    icons.ICON_FA_ARROW_ROTATE_LEFT,
    _can_undo,
)
REDO = Command(
    "Redo",
    lambda space: space.editor.redo(),
    (CTRL | SHIFT | Key.z, CTRL | Key.y),
    icons.ICON_FA_ARROW_ROTATE_RIGHT,
    lambda space: space.editor.session is not None and space.editor.session.history.redo_label is not None,
)
REMOVE = Command(
    "Remove Selected Pins",
    _remove,
    (Key.delete,),
    icons.ICON_FA_TRASH_CAN,
    lambda space: bool(space.editor.selection) or keying.has_chosen(space),
)
FORWARD = Command(
    "Bring Forward",
    lambda space: space.editor.shift_depth(1),
    (CTRL | Key.right_bracket,),
    "",
    lambda space: bool(space.editor.selection),
)
BACK = Command(
    "Send Back",
    lambda space: space.editor.shift_depth(-1),
    (CTRL | Key.left_bracket,),
    "",
    lambda space: bool(space.editor.selection),
)
REMOVE_LAST = Command(
    "Remove Last Pin",
    lambda space: space.editor.remove_last(),
    (Key.backspace,),
    "",
    lambda space: space.editor.session is not None and bool(space.editor.session.state.pins),
)
SELECT_ALL = Command(
    "Select All Pins", lambda space: space.editor.select_all(), (CTRL | Key.a,), "", has_drawing
)
DESELECT = Command(
    "Deselect",
    lambda space: space.editor.select(()),
    (CTRL | Key.d,),
    "",
    lambda space: bool(space.editor.selection),
)
RESET = Command(
    "Reset Pose",
    lambda space: space.editor.reset_pose(),
    (CTRL | Key.r,),
    icons.ICON_FA_PERSON,
    lambda space: space.editor.session is not None and space.editor.session.posed,
)
BAKE = Command(
    "Make Pose the Rest Pose",
    lambda space: space.editor.bake_pose(),
    (),
    "",
    lambda space: space.editor.session is not None and space.editor.session.posed,
)
DEFAULTS = Command(
    "Default Parameters",
    _defaults,
    (),
    "",
    lambda space: (
        space.document is not None
        and defaults(space.document.state.settings) != space.document.state.settings
    ),
)
REMEMBER = Command("Remember the Rest Shape", _remember, (), "", _is_akap, remembers)

HOLD_ANGLE = Command("Hold Angle", lambda space: toggle_hold(space.editor), (), "", _can_hold, _holds)

PIN_TOOL = _tool("pins", "Pins", Key.p, icons.ICON_FA_THUMBTACK)
HAND_TOOL = _tool("hand", "Move Canvas", Key.n, icons.ICON_FA_HAND)
BRUSH_TOOL = _tool("brush", "Stiffness Brush", Key.s, icons.ICON_FA_PAINTBRUSH)
ERASE = Command("Erase Stiffness", _erase, (Key.e,), "", _has_brush, lambda space: space.editor.brush.erasing)
SMALLER = Command("Smaller Brush", _resize(False), (Key.left_bracket,), "", _has_brush)
LARGER = Command("Larger Brush", _resize(True), (Key.right_bracket,), "", _has_brush)
SOFTEN_ALL = Command(
    "Remove All Stiffness",
    lambda space: space.editor.edit("Remove stiffness", lambda session: session.set_stiffness(None)),
    (),
    "",
    lambda space: space.editor.session is not None and space.editor.session.state.stiffness is not None,
)
FIT = Command(
    "Fit in Window",
    lambda space: space.editor.fit(),
    (Key.f, CTRL | Key._0),
    icons.ICON_FA_EXPAND,
    has_drawing,
)
ACTUAL = Command("100 %", _actual_size, (Key._1, CTRL | Key._1), "", has_drawing)
ZOOM_IN = Command(
    "Zoom In",
    lambda space: space.editor.zoom(1.25),
    (Key.equal, CTRL | Key.equal),
    "",
    has_drawing,
    repeats=True,
)
ZOOM_OUT = Command(
    "Zoom Out",
    lambda space: space.editor.zoom(0.8),
    (Key.minus, CTRL | Key.minus),
    "",
    has_drawing,
    repeats=True,
)
SHOW_MESH = Command("Show Mesh", _mesh, (Key.m,), icons.ICON_FA_DRAW_POLYGON, always, _mesh_on)
SHOW_PINS = Command("Show Pins", _pins, (SHIFT | Key.p,), "", always, _pins_on)
SHOW_TIMELINE = Command("Timeline", _timeline, (SHIFT | Key.t,), "", has_drawing, _timeline_on)
SPLIT = Command("Two Methods Side by Side", _split, (), icons.ICON_FA_TABLE_COLUMNS, has_drawing, _split_on)
CHECKER = Command("Checkerboard", _checker, (Key.b,), "", always, _checker_on)
SHOW_FIELD = Command("Vector Field of the Drag", _field, (Key.v,), "", has_drawing, _field_on)
SHOW_AREA = Command("Distortion of Areas", _area, (Key.d,), "", has_drawing, _area_on)
SHOW_ANGLE = Command("Distortion of Angles", _angle, (SHIFT | Key.d,), "", has_drawing, _angle_on)
NEXT_RANGE = Command(
    "Next Range of Distortion", _next_range, (Key.r,), "", lambda space: space.view.heat is not None
)
SHOW_GHOST = Command("Rest Pose", _ghost, (Key.g,), "", has_drawing, _ghost_on)
SHOW_TRAILS = Command("Pin Trails", _trails, (Key.t,), "", has_drawing, _trails_on)
CHOOSE_REFERENCE = Command("Reference Picture...", reference.ask, (), "", has_drawing)
SHOW_REFERENCE = Command(
    "Show Reference Picture",
    _reference,
    (SHIFT | Key.b,),
    "",
    lambda space: space.view.reference is not None,
    _reference_on,
)
OVERLAYS = (SHOW_FIELD, SHOW_AREA, SHOW_ANGLE, SHOW_GHOST, SHOW_TRAILS)

PALETTE = Command("Find Command...", _find, (CTRL | Key.k, Key.f3))
KEYS = Command("Keys and Mouse", _keys, (Key.f1,), typed="?")
ABOUT = Command("About akap-editor", _about)

OPEN_BUNDLED = Submenu(
    "Open Bundled Drawing", lambda space: [(path.stem.capitalize(), path) for path in bundled_drawings()]
)
OPEN_RECENT = Submenu("Open Recent", lambda space: [(path.name, path) for path in space.preferences.recent])

_EXPORTS = (EXPORT, SAVE_RECORDING)

# None is a line between groups.
MENUS: tuple[tuple[str, tuple[Command | Submenu | None, ...]], ...] = (
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
            FORWARD,
            BACK,
            HOLD_ANGLE,
            None,
            RESET,
            BAKE,
            REMEMBER,
            DEFAULTS,
            SOFTEN_ALL,
        ),
    ),
    (
        "View",
        (
            *(FIT, ACTUAL, ZOOM_IN, ZOOM_OUT, None),
            *(SHOW_MESH, SHOW_PINS, *OVERLAYS, NEXT_RANGE, None),
            *(CHECKER, CHOOSE_REFERENCE, SHOW_REFERENCE),
            *(None, SHOW_TIMELINE, SPLIT),
        ),
    ),
    ("Animation", ANIMATION),
    ("Help", (PALETTE, KEYS, ABOUT)),
)
COMMANDS = (
    *(command for _, group in MENUS for command in group if isinstance(command, Command)),
    *(PIN_TOOL, HAND_TOOL, BRUSH_TOOL, CROSSHAIR),
    *(ERASE, SMALLER, LARGER),
    *PANNING,
)


def run_pressed(space: Workspace) -> None:
    """Run the commands whose keys were pressed in this frame."""
    for command in COMMANDS:
        if command.is_pressed() and command.enabled(space):
            space.attempt(lambda command=command: command.run(space))  # type: ignore[misc]
