"""Asks for a file: with the system's dialog where there is one, otherwise with a list of the folder."""

import os
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import portable_file_dialogs as native

from ...display_text import display_name, display_text
from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..theme import ACCENT, SECONDARY
from .replace_files import ask_unless_new

_WIDTH, _HEIGHT = 520, 260  # of the list of files, in design points
_OTHER_HEIGHT = 220  # of everything around the list in a low window, in design points
_NOT_PASSED_ON = mark(
    "The file dialog of the system cannot pass on a name of this file or folder, which is not UTF-8. "
    "Choose the file here."
)
DIALOG_VARIABLE = "AKAP_EDITOR_FILE_DIALOG"  # environment variable: "own" for this dialog on every system


def has_native_dialogs() -> bool:
    """Whether the system's dialog is to ask for a file.

    Without these programs, the system would always answer “cancelled”.
    """
    if os.environ.get(DIALOG_VARIABLE) == "own":
        return False
    return sys.platform in ("win32", "darwin") or any(map(shutil.which, ("zenity", "kdialog", "qarma")))


@dataclass
class FileRequest:
    """A file that the user is to choose.

    title: of the dialog; suffixes: of the files that are listed, the first one is added to a name without
    any; folder, name: content of the dialog's fields; use: is called with the chosen path; saving: whether
    the file is to be written.
    """

    title: str
    suffixes: tuple[str, ...]
    folder: Path
    use: Callable[[Path], None]
    name: str = ""
    saving: bool = False

    @property
    def path(self) -> Path:
        """The file that the fields name, or an existing folder."""
        # os.path, unlike Path, accepts whatever may be typed: unknown users, names that are too long
        path = self.folder / os.path.expanduser(self.name.strip())
        if self.saving and not path.suffix and not os.path.isdir(path):
            return path.with_name(path.name + self.suffixes[0])
        return path

    def entries(self) -> list[tuple[str, bool]]:
        """Names of folders, then of files with the suffixes; True for folders. Empty if unreadable."""
        try:
            entries = [(entry.name, entry.is_dir()) for entry in self.folder.iterdir()]
        except OSError:
            return []
        listed = [
            (name, is_folder)
            for name, is_folder in entries
            if not name.startswith(".") and (is_folder or name.lower().endswith(self.suffixes))
        ]
        return sorted(listed, key=lambda entry: (not entry[1], entry[0].lower()))


class FileDialog:
    """Answers one request at a time.

    uses_native: whether the system's own dialog is shown.
    """

    def __init__(self) -> None:
        self.uses_native = False
        self.request: FileRequest | None = None
        self._native: Any = None
        self._is_new = False  # whether the name has yet to get the keyboard focus
        self._replaces_native = False  # whether this request is one that the system's dialog cannot answer

    @property
    def is_open(self) -> bool:
        """Whether a file is to be chosen."""
        return self.request is not None

    @property
    def native_is_open(self) -> bool:
        """Whether the system's dialog is open.

        Its answer must be polled: the library has no callback, and its blocking call would hold the
        interpreter, so that a thread could not wait for it either.
        """
        return self._native is not None

    @property
    def native_is_answered(self) -> bool:
        """Whether the user has answered the system's dialog."""
        return self._native is not None and bool(self._native.ready(0))

    def ask(self, request: FileRequest) -> None:
        """Show the dialog."""
        self.request, self._is_new, self._replaces_native = request, True, False

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        request = self.request
        if request is None:
            return
        if self.uses_native and not self._replaces_native:
            self._poll_native(state, request)
            if self.request is request:
                self._draw_native_note(request)
        elif widgets.begin_dialog(request.title):
            self._draw_fields(request, scale)
            imgui.end_popup()

    def _poll_native(self, state: AppState, request: FileRequest) -> None:
        """Open the system's dialog, or take its answer; a name that is no text is left to this dialog."""
        try:
            if self._native is None:
                self._native = _open_native(request)
                return
            if not self._native.ready(0):
                return
            result = self._native.result()
        except UnicodeError:  # a name that is not UTF-8, which the library cannot pass on
            self._native, self._replaces_native = None, True
            return
        self._native, self.request = None, None
        text = result if isinstance(result, str) else "\n".join(result)  # one name, cut at its line feeds
        path = os.fsdecode(text.encode("utf-8"))
        if path:
            request.name = path
            has_new_ending = request.saving and request.path != Path(path)
            unconfirmed = [request.path] if has_new_ending and os.path.lexists(request.path) else []
            use, ask_again = partial(request.use, request.path), partial(self.ask, request)
            ask_unless_new(state, unconfirmed, use, ask_again)

    def _draw_native_note(self, request: FileRequest) -> None:
        """Say that the window waits; the system's dialog may take a second to appear, or be hidden."""
        if not widgets.begin_dialog(request.title):
            return
        imgui.text_colored(ImVec4(*SECONDARY), tr("Waiting for the file dialog of the system."))
        imgui.spacing()
        if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
            self._native.kill()
            self._native = None
            self._close()
        imgui.end_popup()

    def _draw_fields(self, request: FileRequest, scale: float) -> None:
        if self._replaces_native:
            widgets.paragraph(tr(_NOT_PASSED_ON), _WIDTH * scale)
            imgui.spacing()
        _draw_folder(request, scale)
        is_chosen = _draw_entries(request, scale)
        imgui.set_next_item_width(_WIDTH * scale)
        if self._is_new:
            imgui.set_keyboard_focus_here()
            self._is_new = False
        is_edited, name = imgui.input_text("##name", display_text(request.name))
        if is_edited:  # until then, the name is the file's own, also if it cannot be shown
            request.name = name
        replaces = request.saving and bool(request.name.strip()) and os.path.isfile(request.path)
        if replaces:
            warning = mark("{file} already exists and will be replaced")
            room = _WIDTH * scale - imgui.calc_text_size(tr(warning, file="")).x
            name = widgets.shortened(display_name(request.path), room)
            imgui.text_colored(ImVec4(*ACCENT), tr(warning, file=name))
        imgui.spacing()
        imgui.begin_disabled(not request.name.strip())
        is_accepted = widgets.button(
            (tr("Replace") if replaces else tr("Save")) if request.saving else tr("Open"), primary=True
        )
        imgui.end_disabled()
        imgui.same_line()
        if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
            self._close()
        elif (is_accepted or is_chosen or widgets.confirm_pressed()) and request.name.strip():
            self._accept(request)

    def _accept(self, request: FileRequest) -> None:
        """Use the file that the fields name; enter it if it is a folder."""
        path = request.path
        if os.path.isdir(path):
            request.folder, request.name = path, ""
            return
        self._close()
        request.use(path)

    def _close(self) -> None:
        self.request = None
        widgets.close_popup()


def _open_native(request: FileRequest) -> Any:
    """Open the system's dialog, which takes UTF-8 in every locale. Raises UnicodeError for other names."""
    suggested = os.fsencode(request.path if request.saving else request.folder).decode("utf-8")
    patterns = " ".join(f"*{suffix}" for suffix in request.suffixes)
    if request.saving:
        return native.save_file(request.title, suggested, [patterns, patterns])
    return native.open_file(request.title, suggested, [patterns, patterns])


def _draw_folder(request: FileRequest, scale: float) -> None:
    """Draw the folder's path and a button that leads to its parent."""
    if imgui.button(icons.ICON_FA_ARROW_UP + "##up"):
        request.folder = request.folder.parent
    widgets.show_tooltip(tr("Parent folder"))
    imgui.same_line()
    imgui.align_text_to_frame_padding()
    folder = widgets.shortened(display_text(request.folder), (_WIDTH - 50) * scale, keeps_end=True)
    imgui.text_colored(ImVec4(*SECONDARY), folder)


def _draw_entries(request: FileRequest, scale: float) -> bool:
    """Draw the folder's content; return whether a file was double-clicked or confirmed with Enter.

    A folder is entered by the same actions.
    """
    is_chosen = False
    is_confirmed = imgui.is_mouse_double_clicked(0) or widgets.enter_key_pressed()
    height = min(_HEIGHT * scale, imgui.get_main_viewport().size.y - _OTHER_HEIGHT * scale)
    child_flags = imgui.ChildFlags_.borders | widgets.NAV_FLATTENED
    imgui.begin_child("##entries", ImVec2(_WIDTH * scale, height), child_flags)
    entries = request.entries()
    if not entries and not request.saving:
        widgets.secondary_text(tr("There is no file here that can be opened."))
    for name, is_folder in entries:
        icon = icons.ICON_FA_FOLDER if is_folder else icons.ICON_FA_FILE
        flags = imgui.SelectableFlags_.allow_double_click | imgui.SelectableFlags_.no_auto_close_popups
        shown = display_text(name)
        label = widgets.shortened(shown, imgui.get_content_region_avail().x - 2 * imgui.get_font_size())
        imgui.push_id(
            name.encode(errors="surrogatepass").hex()
        )  # names that are shown alike are different items
        is_clicked = imgui.selectable(
            f"{icon}  {widgets.as_label(label)}###{shown}", name == request.name, flags
        )[0]
        imgui.pop_id()
        widgets.show_tooltip(shown if label != shown else "")
        if is_clicked and not is_folder:
            request.name, is_chosen = name, is_confirmed
        elif is_clicked and is_confirmed:
            request.folder /= name
    imgui.end_child()
    return is_chosen
