"""Showing a file in the file manager of the system."""

import subprocess
from threading import Event

import pytest

from akap_editor.app.jobs import file_manager
from akap_editor.app.jobs.file_manager import show_in_folder
from akap_editor.errors import FileError


@pytest.fixture
def system(monkeypatch):
    """What is installed, how it ends, and what was run."""

    class System:
        platform, installed, codes = "linux", {"gdbus", "xdg-open"}, {}

        def __init__(self):
            self.ran, self.done = [], Event()

        def run(self, command, **_):
            self.ran.append(list(command))
            code = self.codes.get(command[0], 0)
            if code == 0 or command[0] in ("explorer", "xdg-open"):
                self.done.set()
            return subprocess.CompletedProcess(command, code)

    made = System()
    monkeypatch.setattr(file_manager.subprocess, "run", made.run)
    monkeypatch.setattr(file_manager.shutil, "which", lambda name: name if name in made.installed else None)
    return made


@pytest.mark.parametrize(
    ("platform", "codes", "programs"),
    [
        ("linux", {}, ["gdbus"]),
        ("linux", {"gdbus": 1}, ["gdbus", "xdg-open"]),
        ("darwin", {}, ["open"]),
        ("win32", {"explorer": 1}, ["explorer"]),
    ],
)
def test_the_first_command_that_works_is_run(system, monkeypatch, tmp_path, platform, codes, programs):
    monkeypatch.setattr(file_manager.sys, "platform", platform)
    system.codes = codes
    path = tmp_path / "it's a file.gif"
    path.touch()
    show_in_folder(path)
    assert system.done.wait(5)
    assert [command[0] for command in system.ran] == programs
    named = " ".join(system.ran[0])
    assert "file.gif" in named
    if len(programs) == 2:
        assert system.ran[1][1] == str(tmp_path)


def test_what_cannot_be_shown_is_said_in_one_sentence(system, monkeypatch, tmp_path):
    monkeypatch.setattr(file_manager.sys, "platform", "linux")
    with pytest.raises(FileError, match="no longer exists"):
        show_in_folder(tmp_path / "gone.gif")
    (tmp_path / "wave.gif").touch()
    system.installed = set()
    with pytest.raises(FileError, match="No file manager was found"):
        show_in_folder(tmp_path / "wave.gif")
