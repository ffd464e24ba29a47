"""What the user is asked: a question, a file, a command."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass
class UnsavedChangesQuestion:
    """Unsaved changes stand in the way of ``go_on``."""

    go_on: Callable[[], None]


@dataclass
class Palette:
    """The command palette: what is typed, which line is chosen, and whether it has been on the screen."""

    query: str = ""
    chosen: int = 0
    shown: bool = False


@dataclass
class FileRequest:
    """A file is to be chosen, and ``use`` gets its path.

    suffixes: of the files that are meant, the first one is added to a name without any; folder, name: what is
    in the dialog's fields; saving: whether the file is to be written.
    """

    title: str
    suffixes: tuple[str, ...]
    folder: Path
    use: Callable[[Path], None]
    name: str = ""
    saving: bool = False

    @property
    def path(self) -> Path:
        """The file that the fields name, or a folder that is there."""
        # os.path, unlike Path, takes whatever may be typed: unknown users, names that are too long
        path = self.folder / os.path.expanduser(self.name.strip())
        if self.saving and not path.suffix and not os.path.isdir(path):
            return path.with_name(path.name + self.suffixes[0])
        return path

    def entries(self) -> list[tuple[str, bool]]:
        """Folders, then files that are meant, each with whether it is a folder; none if unreadable."""
        try:
            found = [(entry.name, entry.is_dir()) for entry in self.folder.iterdir()]
        except OSError:
            return []
        shown = [
            (name, is_folder)
            for name, is_folder in found
            if not name.startswith(".") and (is_folder or name.lower().endswith(self.suffixes))
        ]
        return sorted(shown, key=lambda entry: (not entry[1], entry[0].lower()))
