"""What must be answered before work goes on: messages, unsaved changes, files; and two pages of help."""

import os
import shutil
import sys
from pathlib import Path
from typing import Any

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import portable_file_dialogs as native

from ... import __version__
from .. import files, widgets
from ..app_state import AppState
from ..commands import shortcuts_page as keys_overlay
from ..theme import ACCENT, QUIET
from . import progress as task_dialog
from .export_animation import ExportAnimationDialog
from .export_pose import ExportPoseDialog
from .file_dialog import FileRequest
from .recovery import Recovery


def has_native_dialogs() -> bool:
    """Whether the system can ask for a file; without these programs it would silently answer «cancelled»."""
    return sys.platform in ("win32", "darwin") or any(map(shutil.which, ("zenity", "kdialog", "qarma")))


class Dialogs:
    """Draws the dialog that the workspace asks for, if any."""

    def __init__(self, use_native: bool, recovery: Recovery) -> None:
        self._recovery = recovery
        self._use_native = use_native
        self._native: Any = None
        self._asked: FileRequest | None = None

    @property
    def native_is_open(self) -> bool:
        """Whether a file dialog of the system is open.

        Its answer must be polled: the library has no callback, and its blocking call would hold the
        interpreter, so that a thread could not wait for it either.
        """
        return self._native is not None

    @property
    def native_is_answered(self) -> bool:
        """Whether the user has answered the file dialog of the system."""
        return self._native is not None and bool(self._native.ready(0))

    def draw(self, state: AppState, scale: float) -> None:
        """One frame of what is to be answered now; a message goes before everything else."""
        if state.error:
            _message(state, scale)
        elif state.task is not None:
            task_dialog.draw(state, state.task, scale)
        elif state.question is not None:
            _unsaved(state, scale)
        elif state.lost:
            self._recovery.draw(state, scale)
        elif state.request is not None:
            self._file(state, state.request, scale)
        elif state.dialog(ExportPoseDialog).is_open:
            state.dialog(ExportPoseDialog).draw(state, scale)
        elif state.dialog(ExportAnimationDialog).is_open:
            state.dialog(ExportAnimationDialog).draw(state, scale)
        elif state.keys:
            keys_overlay.draw(state, scale)
        elif state.about:
            _about(state, scale)

    def _file(self, state: AppState, request: FileRequest, scale: float) -> None:
        if not self._use_native:
            _choose_file(state, request, request is not self._asked, scale)
            self._asked = request
            return
        if self._native is None:
            self._native = _open_native(request)
        elif self._native.ready(0):
            result = self._native.result()
            self._native, state.request = None, None
            path = result if isinstance(result, str) else next(iter(result), "")
            if path:
                request.name = path
                request.use(request.path)


def _open_native(request: FileRequest) -> Any:
    patterns = " ".join(f"*{suffix}" for suffix in request.suffixes)
    if request.saving:
        return native.save_file(request.title, str(request.path), [patterns, patterns])
    return native.open_file(request.title, str(request.folder), [patterns, patterns])


def _message(state: AppState, scale: float) -> None:
    if widgets.begin_dialog("That did not work"):
        widgets.paragraph(state.error, 420 * scale)
        imgui.spacing()
        if widgets.button("OK", primary=True) or widgets.cancel_pressed() or widgets.confirm_pressed():
            widgets.close(state, "error", "")
        imgui.end_popup()


def _unsaved(state: AppState, scale: float) -> None:
    question, document = state.question, state.document
    if question is None or document is None:
        state.question = None
        return
    if widgets.begin_dialog("Unsaved changes"):
        name = document.path.name if document.path is not None else document.drawing.name
        text = f"Save the changes to {name} before it is closed?"
        widgets.paragraph(text, min(imgui.calc_text_size(text).x + 1, 420 * scale))
        imgui.spacing()
        if widgets.button("Save", primary=True) or widgets.confirm_pressed():
            widgets.close(state, "question", None)
            files.save(state, question.go_on)
        imgui.same_line()
        if widgets.button("Discard"):
            widgets.close(state, "question", None)
            question.go_on()
        imgui.same_line()
        if widgets.button("Cancel") or widgets.cancel_pressed():
            widgets.close(state, "question", None)
        imgui.end_popup()


def _choose_file(state: AppState, request: FileRequest, is_new: bool, scale: float) -> None:
    """An own file dialog, for systems that have none to offer."""
    if not widgets.begin_dialog(request.title):
        return
    if imgui.button(icons.ICON_FA_ARROW_UP + "##up"):
        request.folder = request.folder.parent
    widgets.show_tooltip("Parent folder")
    imgui.same_line()
    imgui.align_text_to_frame_padding()
    folder = widgets.shortened(str(request.folder), 470 * scale, end=True)
    imgui.text_colored(imgui.ImVec4(*QUIET), folder)
    chosen = _list_entries(request, scale)
    imgui.set_next_item_width(520 * scale)
    if is_new:
        imgui.set_keyboard_focus_here()
    _, request.name = imgui.input_text("##name", request.name)
    replaces = request.saving and bool(request.name.strip()) and os.path.isfile(request.path)
    if replaces:
        warning = " is there already and would be replaced"
        room = 520 * scale - imgui.calc_text_size(warning).x
        imgui.text_colored(imgui.ImVec4(*ACCENT), widgets.shortened(request.path.name, room) + warning)
    accept = ("Replace" if replaces else "Save") if request.saving else "Open"
    imgui.spacing()
    imgui.begin_disabled(not request.name.strip())
    accepted = widgets.button(accept, primary=True)
    imgui.end_disabled()
    imgui.same_line()
    if widgets.button("Cancel") or widgets.cancel_pressed():
        widgets.close(state, "request", None)
    elif (accepted or chosen or widgets.confirm_pressed()) and request.name.strip():
        _accept(state, request)
    imgui.end_popup()


def _list_entries(request: FileRequest, scale: float) -> bool:
    """The folder's content; whether a file was taken, by a double click or Enter. A folder is opened then."""
    chosen = False
    taken = imgui.is_mouse_double_clicked(0) or widgets.enter_key_pressed()
    height = min(260 * scale, imgui.get_main_viewport().size.y - 220 * scale)
    imgui.begin_child(
        "##entries", ImVec2(520 * scale, height), imgui.ChildFlags_.borders | widgets.NAV_FLATTENED
    )
    for name, is_folder in request.entries():
        icon = icons.ICON_FA_FOLDER if is_folder else icons.ICON_FA_FILE
        flags = imgui.SelectableFlags_.allow_double_click | imgui.SelectableFlags_.no_auto_close_popups
        shown = widgets.shortened(name, imgui.get_content_region_avail().x - 2 * imgui.get_font_size())
        clicked = imgui.selectable(f"{icon}  {shown}###{name}", name == request.name, flags)[0]
        widgets.show_tooltip(name if shown != name else "")
        if clicked:
            if not is_folder:
                request.name, chosen = name, taken
            elif taken:
                request.folder /= name
    imgui.end_child()
    return chosen


def _accept(state: AppState, request: FileRequest) -> None:
    path = request.path
    if os.path.isdir(path):
        request.folder, request.name = path, ""
        return
    widgets.close(state, "request", None)
    request.use(Path(path))


def _about(state: AppState, scale: float) -> None:
    if not widgets.begin_dialog("About akap-editor"):
        return
    imgui.text(f"akap-editor {__version__}")
    widgets.paragraph(
        "Bends cartoons with as-Killing-as-possible vector fields and logarithmic spirals, after Solomon, "
        "Ben-Chen, Butscher and Guibas, Symposium on Geometry Processing 2011.",
        380 * scale,
    )
    widgets.paragraph(
        "Free software under the GNU General Public License, version 3 or later. Meshes are made by "
        "Triangle, whose own terms allow non-commercial use only.",
        380 * scale,
        QUIET,
    )
    imgui.spacing()
    if widgets.button("Close", primary=True) or widgets.cancel_pressed() or widgets.confirm_pressed():
        widgets.close(state, "about", False)
    imgui.end_popup()
