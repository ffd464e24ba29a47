"""What the program remembers between runs: one JSON file in the platform's folder for configuration."""

import json
import os
from pathlib import Path
from typing import Any, TypeVar

import platformdirs

from ..errors import FileError, InputError
from ..io.atomic import os_error_reason, read_file, resolved, write_atomic
from ..meshing.meshers import nearest_mesher
from ..words import mark, tr

CONFIG_FOLDER_VARIABLE = "AKAP_EDITOR_CONFIG"  # environment variable: another folder, e.g. for tests
FILE_NAME = "preferences.json"
MAX_RECENT = 12  # files

T = TypeVar("T")


def preferences_path() -> Path:
    """The preferences file of the user who runs the program."""
    folder = os.environ.get(CONFIG_FOLDER_VARIABLE) or platformdirs.user_config_dir(
        "akap-editor", appauthor=False
    )
    return Path(folder) / FILE_NAME


class Preferences:
    """Named values, each of which JSON can hold.

    path: of the file, or None to store nothing beyond this run. An unreadable file is ignored, and replaced
    at the next `write`; problem: says so, empty if there is none. Programs that run at the same time share
    the file: `write` changes only the names that were `put` here.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._path = path
        self._changed: set[str] = set()
        self.problem = ""
        try:
            self._values = self._read()
        except InputError as error:
            self._values = {}
            self.problem = tr("{error} The default preferences are used.", error=error)

    @property
    def is_stored(self) -> bool:
        """Whether the next run will read them."""
        return self._path is not None

    def get(self, name: str, default: T) -> T:
        """The value, or ``default`` if there is none of the same type; do not change it in place.

        The elements of lists and objects are not checked, although the file may have been edited by hand.
        """
        value = self._values.get(name)
        if isinstance(default, float) and type(value) is int:
            value = float(value)
        return value if type(value) is type(default) else default

    def put(self, name: str, value: object) -> None:
        """Set a value: text, a number, a list, an object. Raises TypeError for one that JSON cannot hold."""
        plain = json.loads(json.dumps(value))
        if self._values.get(name) != plain:
            self._values[name] = plain
            self._changed.add(name)

    def write(self) -> None:
        """Write what has changed since the last call. Raises FileError, once; then nothing is stored."""
        if not self._changed or self._path is None:
            return
        path, changed = self._path, self._changed
        try:
            stored = self._read()
        except InputError:
            stored = {}
        stored.update((name, self._values[name]) for name in changed)
        self._changed = set()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_atomic(path, json.dumps(stored, indent=1, sort_keys=True).encode())
        except OSError as error:
            self._path = None
            raise FileError("save", path, os_error_reason(error)) from error
        except FileError:
            self._path = None
            raise

    def _read(self) -> dict[str, Any]:
        """The values in the file; none if there is no file. Raises FileError."""
        if self._path is None or not self._path.exists():
            return {}
        try:
            values = json.loads(read_file(self._path, mark("preferences")))
        except FileError:
            raise
        except (ValueError, RecursionError) as error:
            raise FileError("open", self._path, tr("expected JSON ({error})", error=error)) from error
        if not isinstance(values, dict):
            raise FileError(
                "open", self._path, tr("expected a JSON object, got {kind}", kind=type(values).__name__)
            )
        return values

    # -- the language ----------------------------------------------------------------------------------------

    @property
    def language(self) -> str:
        """The chosen language, one of `words.LANGUAGES`; empty: the system's."""
        return self.get("language", "")

    @language.setter
    def language(self, name: str) -> None:
        self.put("language", name)

    # -- the mesher of new drawings --------------------------------------------------------------------------

    @property
    def mesher(self) -> str:
        """The mesher that was chosen last, if it is still installed, else the default one."""
        return nearest_mesher(self.get("mesher", ""))

    @mesher.setter
    def mesher(self, name: str) -> None:
        self.put("mesher", name)

    # -- recent files ----------------------------------------------------------------------------------------

    @property
    def recent(self) -> list[Path]:
        """Files that were opened or saved, the latest one first."""
        names: list[object] = self.get("recent", [])
        return [Path(name) for name in names if isinstance(name, str)]

    def add_recent(self, path: Path) -> None:
        """Put a file that was opened or saved first in the list."""
        path = resolved(path)
        self.put("recent", [str(path), *(str(other) for other in self.recent if other != path)][:MAX_RECENT])

    def remove_recent(self, path: Path) -> None:
        """Remove a file that cannot be opened any more from the list."""
        self.put("recent", [str(other) for other in self.recent if other not in (path, resolved(path))])
