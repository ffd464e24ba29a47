"""What the program remembers between runs: one JSON file in the platform's folder for configuration."""

import json
import os
from pathlib import Path
from typing import Any, TypeVar

import platformdirs

from ..errors import InputError
from ..io.atomic import read_file, write_atomic

CONFIG_FOLDER_VARIABLE = "AKAP_EDITOR_CONFIG"  # environment: another folder, e.g. for tests
FILE_NAME = "preferences.json"
MOST_RECENT = 12

T = TypeVar("T")


def preferences_path() -> Path:
    """The file of the user who runs the program."""
    folder = os.environ.get(CONFIG_FOLDER_VARIABLE) or platformdirs.user_config_dir(
        "akap-editor", appauthor=False
    )
    return Path(folder) / FILE_NAME


class Preferences:
    """Named values, each of which JSON can hold.

    path: of the file, or None to remember nothing beyond this run. A file that cannot be read or makes no
    sense is ignored, and `problem` says so; it is replaced at the next `write`. Programs that run at the same
    time share the file: `write` changes only the names that were `put` here.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._path = path
        self._changed: set[str] = set()
        self.problem = ""
        try:
            self._values = self._read()
        except InputError as error:
            self._values = {}
            self.problem = f"Couldn't read the preferences, so the defaults are used. {error}"

    @property
    def is_kept(self) -> bool:
        """Whether there is a next run that will know them."""
        return self._path is not None

    def get(self, name: str, default: T) -> T:
        """The value, or ``default`` where there is none of the same type; not to be changed in place.

        What lists and objects hold is not checked: the file may have been edited by hand.
        """
        value = self._values.get(name)
        if isinstance(default, float) and type(value) is int:
            value = float(value)
        return value if type(value) is type(default) else default

    def put(self, name: str, value: object) -> None:
        """Remember a value: text, a number, a list, an object. Raises TypeError on what JSON cannot hold."""
        plain = json.loads(json.dumps(value))
        if self._values.get(name) != plain:
            self._values[name] = plain
            self._changed.add(name)

    def write(self) -> None:
        """Write what has changed since the last time, if anything. Raises InputError, but only once."""
        if not self._changed or self._path is None:
            return
        path, changed = self._path, self._changed
        try:
            there = self._read()
        except InputError:
            there = {}
        there.update((name, self._values[name]) for name in changed)
        self._changed = set()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_atomic(path, json.dumps(there, indent=1, sort_keys=True).encode())
        except (OSError, InputError) as error:
            self._path = None
            raise InputError(str(error)) from error

    def _read(self) -> dict[str, Any]:
        if self._path is None or not self._path.exists():
            return {}
        try:
            values = json.loads(read_file(self._path, "preferences"))
        except (ValueError, RecursionError) as error:
            raise InputError(f"{self._path}: expected JSON ({error})") from error
        if not isinstance(values, dict):
            raise InputError(f"{self._path}: expected a JSON object, got {type(values).__name__}")
        return values

    # -- recent files ----------------------------------------------------------------------------------------

    @property
    def recent(self) -> list[Path]:
        """Files that were opened or saved, the newest first."""
        names: list[object] = self.get("recent", [])
        return [Path(name) for name in names if isinstance(name, str)]

    def opened(self, path: Path) -> None:
        """A file was opened or saved."""
        path = path.resolve()
        self.put("recent", [str(path), *(str(old) for old in self.recent if old != path)][:MOST_RECENT])

    def forget(self, path: Path) -> None:
        """A file is no longer of use."""
        self.put("recent", [str(old) for old in self.recent if old not in (path, path.resolve())])
