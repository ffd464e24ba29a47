"""Every command once, with its name, key and icon; menus, tool bar and keyboard all read this table."""

from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from .workspace import Workspace

CTRL, SHIFT = imgui.Key.mod_ctrl, imgui.Key.mod_shift
Key = imgui.Key


def _always(_: Workspace) -> bool:
    return True


def _has_drawing(space: Workspace) -> bool:
    return space.document is not None


@dataclass(frozen=True)
class Command:
    """label: as in menus; chords: keys, the first one is shown; checked: of a switch, whether it is on."""

    label: str
    run: Callable[[Workspace], None]
    chords: tuple[int, ...] = ()
    icon: str = ""
    enabled: Callable[[Workspace], bool] = _always
    checked: Callable[[Workspace], bool] | None = None

    @property
    def key_name(self) -> str:
        """The first key in words, e.g. "Ctrl+Shift+S"."""
        return chord_name(self.chords[0]) if self.chords else ""


_KEY_NAMES = {"_1": "1", "delete": "Del", "equal": "+", "minus": "-"}


def chord_name(chord: int) -> str:
    """A key chord as it is printed on the keys."""
    parts = []
    for mod, name in ((CTRL, "Ctrl"), (SHIFT, "Shift")):
        if chord & int(mod):
            parts.append(name)
            chord &= ~int(mod)
    name = str(Key(chord).name)
    return "+".join([*parts, _KEY_NAMES.get(name, name.upper() if len(name) == 1 else name.capitalize())])


def _toggle(name: str) -> tuple[Callable[[Workspace], None], Callable[[Workspace], bool]]:
    def flip(space: Workspace) -> None:
        setattr(space, name, not getattr(space, name))

    return flip, lambda space: bool(getattr(space, name))


def _set_hand(on: bool) -> Callable[[Workspace], None]:
    def choose(space: Workspace) -> None:
        space.editor.hand_tool = on

    return choose


def _actual_size(space: Workspace) -> None:
    space.editor.zoom(1.0 / space.editor.camera.zoom)


def _remember(space: Workspace) -> None:
    session = space.editor.session
    if session is not None:
        settings = session.state.settings
        space.editor.set_settings(settings.with_parameter("memory", 0.0 if remembers(space) else 1.0))


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


_mesh, _mesh_on = _toggle("show_mesh")
_pins, _pins_on = _toggle("show_pins")
_checker, _checker_on = _toggle("checker")
_about, _ = _toggle("about")
_keys, _ = _toggle("keys")

OPEN = Command("Open...", Workspace.ask_open, (CTRL | Key.o,), icons.ICON_FA_FOLDER_OPEN)
SAVE = Command("Save", Workspace.save, (CTRL | Key.s,), icons.ICON_FA_FLOPPY_DISK, _has_drawing)
SAVE_AS = Command("Save As...", Workspace.save_as, (CTRL | SHIFT | Key.s,), "", _has_drawing)
EXPORT = Command("Export PNG...", Workspace.ask_export, (CTRL | Key.e,), icons.ICON_FA_IMAGE, _has_drawing)
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
    lambda space: space.editor.remove_selected(),
    (Key.delete,),
    icons.ICON_FA_TRASH_CAN,
    lambda space: bool(space.editor.selection),
)
SELECT_ALL = Command(
    "Select All Pins", lambda space: space.editor.select_all(), (CTRL | Key.a,), "", _has_drawing
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
REMEMBER = Command("Remember the Rest Shape", _remember, (), "", _is_akap, remembers)

PIN_TOOL = Command(
    "Pins", _set_hand(False), (Key.p,), icons.ICON_FA_THUMBTACK, _always, lambda s: not s.editor.hand_tool
)
HAND_TOOL = Command(
    "Move Canvas", _set_hand(True), (Key.n,), icons.ICON_FA_HAND, _always, lambda s: s.editor.hand_tool
)
FIT = Command("Fit in Window", lambda space: space.editor.fit(), (Key.f,), icons.ICON_FA_EXPAND, _has_drawing)
ACTUAL = Command("100 %", _actual_size, (Key._1,), "", _has_drawing)
ZOOM_IN = Command(
    "Zoom In", lambda space: space.editor.zoom(1.25), (Key.equal, CTRL | Key.equal), "", _has_drawing
)
ZOOM_OUT = Command(
    "Zoom Out", lambda space: space.editor.zoom(0.8), (Key.minus, CTRL | Key.minus), "", _has_drawing
)
SHOW_MESH = Command("Show Mesh", _mesh, (Key.m,), icons.ICON_FA_DRAW_POLYGON, _always, _mesh_on)
SHOW_PINS = Command("Show Pins", _pins, (SHIFT | Key.p,), "", _always, _pins_on)
CHECKER = Command("Checkerboard", _checker, (Key.b,), "", _always, _checker_on)

KEYS = Command("Keys and Mouse", _keys, (Key.f1,))
ABOUT = Command("About akap-editor", _about)

MENUS: tuple[tuple[str, tuple[Command | None, ...]], ...] = (
    ("File", (OPEN, None, SAVE, SAVE_AS, None, EXPORT, None, QUIT)),
    ("Edit", (UNDO, REDO, None, REMOVE, SELECT_ALL, DESELECT, None, RESET, REMEMBER)),
    ("View", (FIT, ACTUAL, ZOOM_IN, ZOOM_OUT, None, SHOW_MESH, SHOW_PINS, CHECKER)),
    ("Help", (KEYS, ABOUT)),
)
COMMANDS = (
    *(command for _, group in MENUS for command in group if command is not None),
    PIN_TOOL,
    HAND_TOOL,
)


def run_pressed(space: Workspace) -> None:
    """Run the commands whose keys were pressed in this frame."""
    for command in COMMANDS:
        pressed = any(imgui.is_key_chord_pressed(int(chord)) for chord in command.chords)
        if pressed and command.enabled(space):
            space.attempt(lambda command=command: command.run(space))  # type: ignore[misc]
