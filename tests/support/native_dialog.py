"""`StandInDialog`: a program called zenity that takes the place of the system's file dialog."""

import os
from pathlib import Path

import pytest

# The arguments are whole when they appear; the answer is read when there is one. Like zenity it ends a while
# after it has answered: portable_file_dialogs loses what comes between its look at the pipe and the end.
_SCRIPT = """#!/bin/sh
case "$1" in --version) exit 0;; esac
printf '%s\\n' "$@" > "{folder}/asked.new"
mv "{folder}/asked.new" "{folder}/asked"
answer=$(cat "{folder}/answer")
rm "{folder}/asked"
[ -n "$answer" ] && printf '%s\\n' "$answer"
sleep 0.1
"""


class StandInDialog:
    """The system's file dialog of all programs that are started while ``patch`` holds; a test is its user.

    folder: empty, for the program and what it is asked.
    """

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self._asked, self._answer = folder / "asked", folder / "answer"
        os.mkfifo(self._answer)
        program = folder / "zenity"
        program.write_text(_SCRIPT.format(folder=folder))
        program.chmod(0o755)
        patch.setenv("PATH", str(folder), prepend=os.pathsep)
        patch.setenv("XDG_SESSION_DESKTOP", "gnome")  # where there is kdialog as well, zenity is preferred
        patch.delenv("AKAP_EDITOR_FILE_DIALOG")

    @property
    def is_open(self) -> bool:
        """Whether the program asks for a file."""
        return self._asked.is_file()

    @property
    def arguments(self) -> list[str]:
        """What zenity was called with; it must be open."""
        return os.fsdecode(self._asked.read_bytes()).split("\n")

    def answer(self, path: Path | None) -> None:
        """Choose a file, or cancel with None; returns when the dialog, which must be open, has read it."""
        self._answer.write_bytes(os.fsencode(path) + b"\n" if path is not None else b"")
