"""Shows a file in the file manager of the system."""

import shutil
import subprocess
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from threading import Thread

from imgui_bundle import icons_fontawesome_6 as icons

from ...errors import FileError
from ...words import mark, tr
from ..app_state import NoticeButton

_SECONDS = 10.0  # for a file manager to answer


def folder_button(notice: str, path: Path) -> NoticeButton:
    """The button beside a notice about a file that shows the file in its folder."""
    show = partial(show_in_folder, path)
    return NoticeButton(notice, mark("Show in Folder"), icons.ICON_FA_FOLDER_OPEN, show)


def show_in_folder(path: Path) -> None:
    """Open the folder of a file with the file selected, as far as the file manager can.

    It goes on in a thread. Raises FileError if the file is gone or if there is no file manager.
    """
    if not path.exists():
        raise FileError("show", path, tr("the file no longer exists"))
    commands = _commands(path.resolve())
    if not commands:
        raise FileError(
            "show", path, tr("no file manager was found; it is in {folder}", folder=path.resolve().parent)
        )
    Thread(target=_run_first_that_works, args=(commands,), name="file manager", daemon=True).start()


def _commands(path: Path) -> list[Sequence[str]]:
    """The commands that show a file, the best one first, of those that are installed."""
    if sys.platform == "win32":
        return [("explorer", f"/select,{path}")]
    if sys.platform == "darwin":
        return [("open", "-R", str(path))]
    name, shows = "org.freedesktop.FileManager1", f"['{path.as_uri()}']".replace("%27", "\\'")
    bus = ("gdbus", "call", "--session", "--dest", name, "--object-path", "/org/freedesktop/FileManager1")
    candidates = ((*bus, "--method", f"{name}.ShowItems", shows, ""), ("xdg-open", str(path.parent)))
    return [each for each in candidates if shutil.which(each[0])]


def _run_first_that_works(commands: Sequence[Sequence[str]]) -> None:
    for command in commands:
        try:
            run = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
        except (OSError, subprocess.SubprocessError):
            continue
        if run.returncode == 0 or sys.platform == "win32":  # Explorer returns 1 when it has opened a window
            return
