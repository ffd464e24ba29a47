"""The table of all commands and the menus; toolbar, keyboard and palette read it, too."""

from collections.abc import Callable
from dataclasses import replace

from imgui_bundle import icons_fontawesome_6 as icons

from ...deform.methods import get_method
from ...display_text import display_name
from ...editor import gestures
from ...editor.editor import Editor
from ...editor.session.edits import SetLoose, SetStiffness
from ...editor.tools.base import IdleTool
from ...editor.tools.suggested_pins import suggest_pins
from ...resources import bundled_files, drawing_title
from ...words import mark, mark_in, tr
from .. import file_commands, files, widgets
from ..app_state import AppState
from ..dialogs.about import AboutDialog
from ..dialogs.export.pose import ExportPoseDialog
from ..dialogs.preferences_page import PreferencesPage
from ..jobs.reload_artwork import can_reload, reload_artwork
from ..panels.method_parameters import with_default_values
from ..preferences import Preferences
from .clipboard import COPY_PICTURE, COPY_POSE, PASTE
from .command import (
    ALT,
    CTRL,
    SHIFT,
    Command,
    CommandGroup,
    Key,
    Menu,
    Submenu,
    always,
    commands_and_files,
    has_drawing,
)
from .edit.arrange import ALIGN_PINS, DISTRIBUTE_PINS
from .edit.mirror import MIRROR
from .keyboard_pointer import CONTEXT_MENU, CROSSHAIR, FINISH, NEXT_PIN, PANNING, PIN_VALUES, PREVIOUS_PIN
from .keymap import KEYMAP, is_any_pressed
from .palette import Palette
from .shortcuts_page import ShortcutsPage
from .timeline import ANIMATION, has_selected_keyframes
from .view import (
    ACTUAL_SIZE,
    CHOOSE_REFERENCE,
    COMPARE_METHODS,
    FIT,
    FULL_SCREEN,
    HIDE_PANELS,
    NEXT_RANGE,
    OVERLAYS,
    PANELS,
    SHOW_CHECKERBOARD,
    SHOW_MESH,
    SHOW_PINS,
    SHOW_REFERENCE,
    SHOW_TIMELINE,
    SMOOTH_BENDS,
    ZOOM_IN,
    ZOOM_OUT,
)

# -- File ---------------------------------------------------------------------------------------------------


OPEN = Command("Open...", files.choose_and_open, (CTRL | Key.o,), icons.ICON_FA_FOLDER_OPEN)
OPEN_RECENT = Submenu(
    "Open Recent", lambda state: [(display_name(path), path) for path in state.preferences.recent]
)
OPEN_BUNDLED = Submenu(
    "Open Bundled Drawing", lambda state: [(drawing_title(path), path) for path in bundled_files()]
)
CUT_OUT = Command("Cut Out with Mask...", file_commands.choose_mask, (), "", file_commands.can_mask)
RELOAD = Command("Reload Artwork", reload_artwork, (CTRL | Key.r, Key.f5), "", can_reload)
MERGE_LAYERS = Command("Merge Layers", file_commands.merge_layers, (), "", file_commands.has_layers)
CLOSE = Command("Close", files.close_document, (CTRL | Key.w,), "", has_drawing)
SAVE = Command("Save", files.save, (CTRL | Key.s,), icons.ICON_FA_FLOPPY_DISK, has_drawing)
SAVE_AS = Command("Save As...", files.save_as, (CTRL | SHIFT | Key.s,), "", has_drawing)
EXPORT = Command(
    "Export...",
    lambda state: state.part(ExportPoseDialog).open(state),
    (CTRL | Key.e,),
    icons.ICON_FA_FILE_EXPORT,
    has_drawing,
)
EXPORT_POSE_FILE = Command("Export Pose File...", file_commands.choose_pose_to_save, (), "", has_drawing)
APPLY_POSE_FILE = Command("Apply Pose File...", file_commands.choose_pose_to_apply, (), "", has_drawing)
SAVE_RECORDING = Command("Save Recording...", file_commands.choose_recording_to_save, (), "", has_drawing)
QUIT = Command("Quit", files.quit_program, (CTRL | Key.q,))

# -- Edit ---------------------------------------------------------------------------------------------------


def _on_editor(action: Callable[[Editor], object]) -> Callable[[AppState], None]:
    def run(state: AppState) -> None:
        action(state.editor)

    return run


def _has_selected_pins(state: AppState) -> bool:
    return bool(state.editor.selection)


def _is_posed(state: AppState) -> bool:
    return state.editor.session is not None and state.editor.session.is_posed


def _can_undo(state: AppState) -> bool:
    """Also during a gesture, which undo cancels."""
    editor = state.editor
    return editor.is_busy or (editor.session is not None and editor.session.history.undo_label is not None)


def _can_redo(state: AppState) -> bool:
    return state.editor.session is not None and state.editor.session.history.redo_label is not None


def _remove_selected(state: AppState) -> None:
    """Remove the selected pins; if there are none, delete the selected keyframes."""
    if state.editor.selection:
        gestures.remove_selected_pins(state.editor)
    else:
        state.timeline.keyframe_playback.delete_keyframes()


def _has_selection(state: AppState) -> bool:
    return _has_selected_pins(state) or has_selected_keyframes(state)


def _has_pins(state: AppState) -> bool:
    return state.editor.session is not None and bool(state.editor.session.state.pins)


def _can_hold_angle(state: AppState) -> bool:
    session = state.editor.session
    return session is not None and session.supports_rotation and bool(state.editor.selection)


def _holds_angle(state: AppState) -> bool:
    """Whether all selected pins hold their angles."""
    session, selection = state.editor.session, state.editor.selection
    held = [pin.angle is not None for pin in session.state.pins if pin.id in selection] if session else []
    return bool(held) and all(held)


def _has_memory(state: AppState) -> bool:
    session = state.editor.session
    return session is not None and get_method(session.state.settings.method).deformer.has_memory


def remembers_rest_shape(state: AppState) -> bool:
    """Whether the drawing springs back towards its rest shape."""
    session = state.editor.session
    return session is not None and bool(session.state.settings.get("memory", 0.0))


def _toggle_memory(state: AppState) -> None:
    session = state.editor.session
    if session is not None:
        memory = 0.0 if remembers_rest_shape(state) else 1.0
        state.change_settings(session.state.settings.with_parameter("memory", memory))


def _reset_parameters(state: AppState) -> None:
    assert state.document is not None
    state.change_settings(with_default_values(state.document.state.settings))


def _has_changed_parameters(state: AppState) -> bool:
    if state.document is None:
        return False
    settings = state.document.state.settings
    return with_default_values(settings) != settings


def _has_stiffness(state: AppState) -> bool:
    return state.editor.session is not None and state.editor.session.state.stiffness is not None


def _has_loose(state: AppState) -> bool:
    return state.editor.session is not None and state.editor.session.state.loose is not None


UNDO = Command(
    "Undo",
    _on_editor(Editor.undo),
    (CTRL | Key.z, CTRL | ALT | Key.z),
    icons.ICON_FA_ARROW_ROTATE_LEFT,
    _can_undo,
)
REDO = Command(
    "Redo",
    _on_editor(Editor.redo),
    (CTRL | SHIFT | Key.z, CTRL | Key.y),
    icons.ICON_FA_ARROW_ROTATE_RIGHT,
    _can_redo,
)
REMOVE_SELECTED = Command(
    "Remove Selected Pins", _remove_selected, (Key.delete,), icons.ICON_FA_TRASH_CAN, _has_selection
)
REMOVE_LAST_PIN = Command(
    "Remove Last Pin", _on_editor(gestures.remove_last_pin), (Key.backspace,), "", _has_pins
)
SELECT_ALL = Command("Select All Pins", _on_editor(Editor.select_all), (CTRL | Key.a,), "", has_drawing)
SUGGEST_PINS = Command(
    "Suggest Pins",
    _on_editor(suggest_pins),
    (SHIFT | Key.s,),
    icons.ICON_FA_WAND_MAGIC_SPARKLES,
    has_drawing,
)
DESELECT = Command(
    "Deselect", _on_editor(lambda editor: editor.select(())), (CTRL | Key.d,), "", _has_selected_pins
)
LIMB_TO_FRONT = Command(
    "Bring Limb to Front",
    _on_editor(lambda editor: gestures.order_limb(editor, True)),
    (CTRL | Key.right_bracket,),
    "",
    _has_selected_pins,
)
LIMB_TO_BACK = Command(
    "Send Limb to Back",
    _on_editor(lambda editor: gestures.order_limb(editor, False)),
    (CTRL | Key.left_bracket,),
    "",
    _has_selected_pins,
)
RAISE_DEPTH = Command(
    "Raise Depth",
    _on_editor(lambda editor: gestures.shift_depths(editor, 1)),
    (CTRL | SHIFT | Key.right_bracket,),
    "",
    _has_selected_pins,
)
LOWER_DEPTH = Command(
    "Lower Depth",
    _on_editor(lambda editor: gestures.shift_depths(editor, -1)),
    (CTRL | SHIFT | Key.left_bracket,),
    "",
    _has_selected_pins,
)
HOLD_ANGLE = Command(
    "Hold Angle", _on_editor(gestures.toggle_held_angles), (), "", _can_hold_angle, _holds_angle
)
RESET_POSE = Command(
    "Reset Pose", _on_editor(gestures.reset_pose), (CTRL | SHIFT | Key.r,), icons.ICON_FA_PERSON, _is_posed
)
SET_REST_POSE = Command("Set Rest Pose from Current", _on_editor(gestures.set_rest_pose), (), "", _is_posed)
REMEMBER_REST_SHAPE = Command(
    "Remember Rest Shape", _toggle_memory, (), "", _has_memory, remembers_rest_shape
)
RESET_PARAMETERS = Command("Reset Parameters", _reset_parameters, (), "", _has_changed_parameters)
CLEAR_STIFFNESS = Command(
    "Clear Stiffness",
    _on_editor(lambda editor: editor.apply(mark("Clear Stiffness"), SetStiffness(None))),
    (),
    "",
    _has_stiffness,
)
CLEAR_LOOSE = Command(
    "Clear Loose Parts",
    _on_editor(lambda editor: editor.apply(mark("Clear Loose Parts"), SetLoose(()))),
    enabled=_has_loose,
)

# -- Help ---------------------------------------------------------------------------------------------------


def _open_palette(state: AppState) -> None:
    state.part(Palette).open(PALETTE_ITEMS)


def _open_preferences(state: AppState) -> None:
    state.part(PreferencesPage).open(COMMANDS)


def _open_shortcuts(state: AppState) -> None:
    state.part(ShortcutsPage).open(MENUS, COMMANDS, SHORTCUTS)


PREFERENCES = Command("Preferences...", _open_preferences, (CTRL | Key.comma,))
PALETTE = Command("Find Command...", _open_palette, (CTRL | Key.k, Key.f3))
SHORTCUTS = Command("Keyboard Shortcuts", _open_shortcuts, (Key.f1,), typed="?")
ABOUT = Command("About akap-editor", lambda state: state.part(AboutDialog).open())

# -- tools --------------------------------------------------------------------------------------------------


def _tool(label: str, tool: Callable[[Editor], IdleTool], key: Key, icon: str) -> Command:
    """A command that chooses a tool of the editor."""

    def choose(state: AppState) -> None:
        state.editor.chosen_tool = tool(state.editor)

    def is_chosen(state: AppState) -> bool:
        return state.editor.chosen_tool is tool(state.editor)

    return Command(label, choose, (key,), icon, always, is_chosen)


def _has_brush(state: AppState) -> bool:
    return has_drawing(state) and state.editor.chosen_tool is state.editor.brush_tool


def _is_erasing(state: AppState) -> bool:
    return state.editor.brush_tool.brush.erasing


def _toggle_erasing(state: AppState) -> None:
    brush = state.editor.brush_tool.brush
    state.editor.brush_tool.brush = replace(brush, erasing=not brush.erasing)


def _resize_brush(larger: bool) -> Callable[[AppState], None]:
    def resize(state: AppState) -> None:
        state.editor.brush_tool.brush = state.editor.brush_tool.brush.resized(larger)

    return resize


PIN_TOOL = _tool("Pin Tool", lambda editor: editor.pins_tool, Key.p, icons.ICON_FA_THUMBTACK)
HAND_TOOL = _tool("Hand Tool", lambda editor: editor.hand_tool, Key.n, icons.ICON_FA_HAND)
BRUSH_TOOL = _tool("Stiffness Brush", lambda editor: editor.brush_tool, Key.b, icons.ICON_FA_PAINTBRUSH)
JOINT_TOOL = _tool("Joint Tool", lambda editor: editor.joint_tool, Key.u, icons.ICON_FA_LINK)
KNIFE_TOOL = _tool("Knife", lambda editor: editor.knife_tool, Key.x, icons.ICON_FA_SCISSORS)
ZOOM_TOOL = _tool("Zoom Tool", lambda editor: editor.zoom_tool, Key.z, icons.ICON_FA_MAGNIFYING_GLASS)
ERASE = Command("Erase Stiffness", _toggle_erasing, (Key.e,), "", _has_brush, _is_erasing)
DECREASE_BRUSH = Command("Decrease Brush Size", _resize_brush(False), (Key.left_bracket,), "", _has_brush)
INCREASE_BRUSH = Command("Increase Brush Size", _resize_brush(True), (Key.right_bracket,), "", _has_brush)

GO_TO_PIN = CommandGroup("Selected Pin", (NEXT_PIN, PREVIOUS_PIN, None, PIN_VALUES, CONTEXT_MENU))
ORDER = CommandGroup("Order", (LIMB_TO_FRONT, LIMB_TO_BACK, None, RAISE_DEPTH, LOWER_DEPTH))
ARRANGE = CommandGroup("Align Pins", (*ALIGN_PINS, None, *DISTRIBUTE_PINS))

# -- the tables ---------------------------------------------------------------------------------------------

MENUS: tuple[Menu, ...] = (
    (
        mark_in("menu", "File"),
        (
            *(OPEN, OPEN_RECENT, OPEN_BUNDLED, RELOAD, CUT_OUT, MERGE_LAYERS, CLOSE, None),
            *(SAVE, SAVE_AS, None),
            *(EXPORT_POSE_FILE, APPLY_POSE_FILE, None),
            *(EXPORT, SAVE_RECORDING, None),
            QUIT,
        ),
    ),
    (
        mark_in("menu", "Edit"),
        (
            *(UNDO, REDO, None),
            *(COPY_PICTURE, COPY_POSE, PASTE, None),
            *(SUGGEST_PINS, REMOVE_SELECTED, REMOVE_LAST_PIN, SELECT_ALL, DESELECT, FINISH, None),
            *(GO_TO_PIN, ORDER, ARRANGE, CommandGroup("Mirror", MIRROR), HOLD_ANGLE, None),
            *(RESET_POSE, SET_REST_POSE, REMEMBER_REST_SHAPE, RESET_PARAMETERS),
            *(CLEAR_STIFFNESS, CLEAR_LOOSE, None),
            PREFERENCES,
        ),
    ),
    (
        mark_in("menu", "View"),
        (
            *(FIT, ACTUAL_SIZE, ZOOM_IN, ZOOM_OUT, None),
            *(SHOW_MESH, SHOW_PINS, *OVERLAYS, NEXT_RANGE, None),
            *(SMOOTH_BENDS, SHOW_CHECKERBOARD, CHOOSE_REFERENCE, SHOW_REFERENCE, None),
            *(SHOW_TIMELINE, COMPARE_METHODS, PANELS, None),
            *(HIDE_PANELS, FULL_SCREEN),
        ),
    ),
    (mark_in("menu", "Animation"), ANIMATION),
    (mark_in("menu", "Help"), (PALETTE, SHORTCUTS, ABOUT)),
)
COMMANDS = (
    *(item for _, items in MENUS for item in commands_and_files(items) if isinstance(item, Command)),
    *(PIN_TOOL, HAND_TOOL, ZOOM_TOOL, BRUSH_TOOL, JOINT_TOOL, KNIFE_TOOL, CROSSHAIR),
    *(ERASE, DECREASE_BRUSH, INCREASE_BRUSH),
    *PANNING,
)
PALETTE_ITEMS = (*(item for _, items in MENUS for item in commands_and_files(items)), *COMMANDS)


def restore_keys(preferences: Preferences) -> None:
    """Give the commands the keys that the user has chosen in an earlier run."""
    KEYMAP.restore(preferences.get("keys", {}), {command.label: command.chords for command in COMMANDS})


def run_pressed(state: AppState) -> None:
    """Run the commands whose keys were pressed in this frame."""
    for command in COMMANDS if is_any_pressed() else ():
        if not command.is_pressed():
            continue
        if not command.enabled(state):
            state.notice = tr(command.missing) or state.notice
        else:
            widgets.run(state, command)
