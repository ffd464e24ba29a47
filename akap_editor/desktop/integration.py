"""Puts the program into the menus and file managers of a freedesktop.org system, for the current user."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from ..errors import FileError, InputError
from ..io.atomic import os_error_reason, write_atomic
from ..resources import resource

# Bundled files, and the folders below the user's data folder where the desktop looks for them.
_FILES = {
    "akap-editor.desktop": "applications",
    "akap-editor-mime.xml": "mime/packages",
    "akap-editor.thumbnailer": "thumbnailers",
    "akap-editor.metainfo.xml": "metainfo",
    "akap-editor.1": "man/man1",
}
# Programs that tell the desktop what changed, each with its arguments below the data folder.
_CACHES = (
    ("update-mime-database", "mime"),
    ("update-desktop-database", "-q", "applications"),
    ("gtk-update-icon-cache", "-q", "-t", "-f", "icons/hicolor"),
)


def data_folder() -> Path:
    """The folder of the current user's programs: $XDG_DATA_HOME, by default ~/.local/share.

    Raises InputError on Windows and macOS, where programs are made known in other ways.
    """
    if os.name != "posix" or sys.platform == "darwin":
        raise InputError(
            "integrate: expected Linux or another system with freedesktop.org menus; on Windows and macOS "
            "choose “Open with” in the file manager"
        )
    folder = os.environ.get("XDG_DATA_HOME", "")
    return Path(folder) if Path(folder).is_absolute() else Path.home() / ".local" / "share"


def program_command() -> list[str]:
    """The command that starts this installation of the program, from any folder."""
    image = os.environ.get("APPIMAGE")  # the file that an AppImage was started from
    if image:
        return [image]
    if getattr(sys, "frozen", False):
        return [sys.executable]
    script = Path(sys.executable).with_name("akap-editor")  # not resolved: that would leave a venv
    return [str(script)] if script.exists() else [sys.executable, "-m", "akap_editor"]


def integrate(folder: Path, command: list[str]) -> list[Path]:
    """Install menu entry, file types, icons, thumbnailer, metadata and man page; return their paths.

    folder: see `data_folder`; command: see `program_command`. Raises FileError.
    """
    for path, source in _installed_files(folder).items():
        data = source.read_bytes()
        if source.suffix in (".desktop", ".thumbnailer"):
            data = _with_command(data.decode(), command).encode()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError("save", path, os_error_reason(error)) from error
        write_atomic(path, data)
    _update_caches(folder)
    return list(_installed_files(folder))


def remove_integration(folder: Path) -> list[Path]:
    """Remove what `integrate` installed; return the paths of the removed files. Raises FileError."""
    removed = []
    for path in _installed_files(folder):
        try:
            path.unlink()
            removed.append(path)
        except FileNotFoundError:
            continue
        except OSError as error:
            raise FileError("remove", path, os_error_reason(error)) from error
    _update_caches(folder)
    return removed


def _installed_files(folder: Path) -> dict[Path, Path]:
    """The bundled file of each installed one."""
    files = {
        folder / place / name: resource("assets", "desktop", name) for name, place in sorted(_FILES.items())
    }
    for icon in sorted(resource("assets", "icons").glob("akap-editor-*.png")):
        side = icon.stem.rpartition("-")[2]
        files[folder / "icons" / "hicolor" / f"{side}x{side}" / "apps" / "akap-editor.png"] = icon
    return files


def _with_command(text: str, command: list[str]) -> str:
    """A desktop entry that starts ``command`` instead of the program's name."""
    lines = []
    for line in text.splitlines():
        if line.startswith("TryExec="):
            line = f"TryExec={_escape(command[0])}"
        elif line.startswith("Exec=akap-editor"):
            quoted = " ".join(_escape(_quote(part)) for part in command)
            line = f"Exec={quoted}{line.removeprefix('Exec=akap-editor')}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def _quote(argument: str) -> str:
    """An argument quoted as in desktop entries. Raises InputError on control characters."""
    if any(ord(character) < 32 for character in argument):
        raise InputError(f"integrate: expected the program in a folder of a printable name, got {argument!r}")
    for character in '\\"`$':
        argument = argument.replace(character, f"\\{character}")
    return '"' + argument.replace("%", "%%") + '"'


def _escape(value: str) -> str:
    """A value of a desktop entry, of which every backslash is doubled."""
    return value.replace("\\", "\\\\")


def _update_caches(folder: Path) -> None:
    """Tell the desktop what changed. Without a program for that, it looks by itself after the next login."""
    for program, *arguments in _CACHES:
        place = folder / arguments[-1]
        if shutil.which(program) and place.is_dir():
            command = [program, *arguments[:-1], str(place)]
            subprocess.run(command, capture_output=True, timeout=60, check=False)
