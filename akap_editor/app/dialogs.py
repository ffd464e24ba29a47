"""What must be answered before work goes on: messages, unsaved changes, files; and two pages of help."""

import os
import shutil
import sys
from pathlib import Path
from typing import Any

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import portable_file_dialogs as native

from .. import __version__
from .commands import MENUS
from .theme import ACCENT, QUIET
from .workspace import FileRequest, Workspace

_FLAGS = imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_saved_settings
_MOUSE = (
    ("Click on the drawing", "add a pin"),
    ("Drag a pin", "bend the drawing"),
    ("Press on the drawing and drag", "add a pin and bend"),
    ("Shift-click, or drag a box", "select several pins"),
    ("Middle-drag, or Space and drag", "move the canvas"),
    ("Wheel", "zoom at the pointer"),
    ("Esc while dragging", "go back to before the drag"),
)


def has_native_dialogs() -> bool:
    """Whether the system can ask for a file; without these programs it would silently answer «cancelled»."""
    return sys.platform in ("win32", "darwin") or any(map(shutil.which, ("zenity", "kdialog", "qarma")))


class Dialogs:
    """Draws the dialog that the workspace asks for, if any."""

    def __init__(self, use_native: bool) -> None:
        self._use_native = use_native
        self._native: Any = None
        self._asked: FileRequest | None = None

    @property
    def waiting(self) -> bool:
        """Whether a dialog of the system is open, whose answer must be polled."""
        return self._native is not None

    def draw(self, space: Workspace, scale: float) -> None:
        """One frame of what is to be answered now; a message goes before everything else."""
        if space.error:
            _message(space, scale)
        elif space.question is not None:
            _unsaved(space)
        elif space.request is not None:
            self._file(space, space.request, scale)
        elif space.keys:
            _keys(space, scale)
        elif space.about:
            _about(space, scale)

    def _file(self, space: Workspace, request: FileRequest, scale: float) -> None:
        if not self._use_native:
            _choose_file(space, request, request is not self._asked, scale)
            self._asked = request
            return
        if self._native is None:
            self._native = _open_native(request)
        elif self._native.ready(0):
            result = self._native.result()
            self._native, space.request = None, None
            path = result if isinstance(result, str) else next(iter(result), "")
            if path:
                request.name = path
                request.use(request.path)


def _open_native(request: FileRequest) -> Any:
    patterns = " ".join(f"*{suffix}" for suffix in request.suffixes)
    if request.saving:
        return native.save_file(request.title, str(request.path), [patterns, patterns])
    return native.open_file(request.title, str(request.folder), [patterns, patterns])


def _begin(title: str) -> bool:
    """A dialog in the middle of the window, the rest dimmed."""
    name = f"{title}###dialog {title}"
    if not imgui.is_popup_open(name):
        imgui.open_popup(name)
    imgui.set_next_window_pos(imgui.get_main_viewport().get_center(), imgui.Cond_.always, ImVec2(0.5, 0.5))
    return bool(imgui.begin_popup_modal(name, None, _FLAGS)[0])


def _end() -> None:
    imgui.end_popup()


def _button(label: str, primary: bool = False) -> bool:
    width = max(imgui.calc_text_size(label).x + 2.5 * imgui.get_font_size(), 6 * imgui.get_font_size())
    if primary:
        imgui.push_style_color(imgui.Col_.button, imgui.ImVec4(*ACCENT))
        imgui.push_style_color(imgui.Col_.button_hovered, imgui.ImVec4(1.0, 0.77, 0.38, 1.0))
        imgui.push_style_color(imgui.Col_.button_active, imgui.ImVec4(0.9, 0.62, 0.2, 1.0))
        imgui.push_style_color(imgui.Col_.text, imgui.ImVec4(0.09, 0.1, 0.11, 1.0))
    pressed = bool(imgui.button(label, ImVec2(width, 0)))
    if primary:
        imgui.pop_style_color(4)
    return pressed


def _escape() -> bool:
    return bool(imgui.is_key_pressed(imgui.Key.escape, False))


def _enter() -> bool:
    keys = (imgui.Key.enter, imgui.Key.keypad_enter)
    return any(imgui.is_key_pressed(key, False) for key in keys)


def _close(space: Workspace, field: str, value: object) -> None:
    imgui.close_current_popup()
    setattr(space, field, value)


def _text(text: str, width: float) -> None:
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width)
    imgui.text_unformatted(text)
    imgui.pop_text_wrap_pos()


def _message(space: Workspace, scale: float) -> None:
    if _begin("That did not work"):
        _text(space.error, 420 * scale)
        imgui.spacing()
        if _button("OK", primary=True) or _escape() or _enter():
            _close(space, "error", "")
        _end()


def _unsaved(space: Workspace) -> None:
    question, document = space.question, space.document
    if question is None or document is None:
        space.question = None
        return
    if _begin("Unsaved changes"):
        name = document.path.name if document.path is not None else document.drawing.name
        imgui.text(f"Save the changes to {name} before it is closed?")
        imgui.spacing()
        if _button("Save", primary=True) or _enter():
            _close(space, "question", None)
            space.save(question.go_on)
        imgui.same_line()
        if _button("Discard"):
            _close(space, "question", None)
            question.go_on()
        imgui.same_line()
        if _button("Cancel") or _escape():
            _close(space, "question", None)
        _end()


def _choose_file(space: Workspace, request: FileRequest, is_new: bool, scale: float) -> None:
    """An own file dialog, for systems that have none to offer."""
    if not _begin(request.title):
        return
    if imgui.button(icons.ICON_FA_ARROW_UP + "##up"):
        request.folder = request.folder.parent
    imgui.set_item_tooltip("Parent folder")
    imgui.same_line()
    imgui.align_text_to_frame_padding()
    imgui.text_colored(imgui.ImVec4(*QUIET), str(request.folder))
    chosen = _list_entries(request, scale)
    imgui.set_next_item_width(520 * scale)
    if is_new:
        imgui.set_keyboard_focus_here()
    _, request.name = imgui.input_text("##name", request.name)
    replaces = request.saving and bool(request.name.strip()) and os.path.isfile(request.path)
    if replaces:
        imgui.text_colored(
            imgui.ImVec4(*ACCENT), f"{request.path.name} is there already and would be replaced"
        )
    accept = ("Replace" if replaces else "Save") if request.saving else "Open"
    imgui.spacing()
    imgui.begin_disabled(not request.name.strip())
    accepted = _button(accept, primary=True)
    imgui.end_disabled()
    imgui.same_line()
    if _button("Cancel") or _escape():
        _close(space, "request", None)
    elif (accepted or chosen or _enter()) and request.name.strip():
        _accept(space, request)
    _end()


def _list_entries(request: FileRequest, scale: float) -> bool:
    """The folder's content; whether a file was double-clicked."""
    chosen = False
    imgui.begin_child("##entries", ImVec2(520 * scale, 260 * scale), imgui.ChildFlags_.borders)
    for name, is_folder in request.entries():
        icon = icons.ICON_FA_FOLDER if is_folder else icons.ICON_FA_FILE
        flags = imgui.SelectableFlags_.allow_double_click | imgui.SelectableFlags_.no_auto_close_popups
        if imgui.selectable(f"{icon}  {name}", name == request.name, flags)[0]:
            if is_folder:
                if imgui.is_mouse_double_clicked(0):
                    request.folder /= name
            else:
                request.name = name
                chosen = bool(imgui.is_mouse_double_clicked(0))
    imgui.end_child()
    return chosen


def _accept(space: Workspace, request: FileRequest) -> None:
    path = request.path
    if os.path.isdir(path):
        request.folder, request.name = path, ""
        return
    _close(space, "request", None)
    request.use(Path(path))


def _keys(space: Workspace, scale: float) -> None:
    if not _begin("Keys and mouse"):
        return
    if imgui.begin_table("##keys", 2):
        imgui.table_setup_column("what", imgui.TableColumnFlags_.width_fixed, 250 * scale)
        imgui.table_setup_column("key", imgui.TableColumnFlags_.width_fixed, 210 * scale)
        rows = [*_MOUSE]
        for _, commands in MENUS:
            rows += [(c.label.rstrip("."), c.key_name) for c in commands if c is not None and c.chords]
        for left, right in rows:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text(left)
            imgui.table_next_column()
            imgui.text_colored(imgui.ImVec4(*QUIET), right)
        imgui.end_table()
    imgui.spacing()
    if _button("Close", primary=True) or _escape() or _enter():
        _close(space, "keys", False)
    _end()


def _about(space: Workspace, scale: float) -> None:
    if not _begin("About akap-editor"):
        return
    imgui.text(f"akap-editor {__version__}")
    _text(
        "Bends cartoons with as-Killing-as-possible vector fields and logarithmic spirals, after Solomon, "
        "Ben-Chen, Butscher and Guibas, Symposium on Geometry Processing 2011.",
        380 * scale,
    )
    imgui.push_style_color(imgui.Col_.text, imgui.ImVec4(*QUIET))
    _text(
        "Free software under the GNU General Public License, version 3 or later. Meshes are made by "
        "Triangle, whose own terms allow non-commercial use only.",
        380 * scale,
    )
    imgui.pop_style_color()
    imgui.spacing()
    if _button("Close", primary=True) or _escape() or _enter():
        _close(space, "about", False)
    _end()
