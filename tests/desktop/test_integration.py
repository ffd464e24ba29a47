"""Integration into a desktop: files that are valid, start this program, and can be removed again."""

import configparser
import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from akap_editor.desktop.integration import data_folder, integrate, program_command, remove_integration
from akap_editor.errors import InputError
from akap_editor.io.akap.project import MIMETYPE

COMMAND = ['/opt/akap editor/$new "100 %"/akap-editor', "-m"]


def read_entry(path: Path) -> dict[str, str]:
    """The values of the first group of a desktop entry; backslashes are no longer doubled."""
    parser = configparser.RawConfigParser()
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    parser.read(path, encoding="utf-8")
    return {key: value.replace("\\\\", "\\") for key, value in parser[parser.sections()[0]].items()}


def split(command: str) -> list[str]:
    """The arguments of a command; the shell's rules and those of desktop entries agree on those in quotes."""
    process = subprocess.run(["sh", "-c", f"printf '%s\\n' {command}"], capture_output=True, text=True)
    return [part.replace("%%", "%") for part in process.stdout.splitlines()]


def test_all_files_are_installed_and_removed_again(tmp_path):
    other = tmp_path / "applications" / "other.desktop"
    other.parent.mkdir()
    other.write_text("[Desktop Entry]\n")
    paths = integrate(tmp_path, ["akap-editor"])
    assert all(path.is_file() for path in paths)
    assert {path.suffix for path in paths} == {".desktop", ".xml", ".thumbnailer", ".1", ".png"}
    assert integrate(tmp_path, ["akap-editor"]) == paths
    assert remove_integration(tmp_path) == paths
    assert not any(path.exists() for path in paths)
    assert other.exists()
    assert remove_integration(tmp_path) == []


def test_entries_start_the_program_wherever_it_is(tmp_path):
    integrate(tmp_path, COMMAND)
    entry = read_entry(tmp_path / "applications" / "akap-editor.desktop")
    assert split(entry["Exec"]) == [*COMMAND, "%f"]
    assert entry["TryExec"] == COMMAND[0]
    thumbnailer = read_entry(tmp_path / "thumbnailers" / "akap-editor.thumbnailer")
    assert split(thumbnailer["Exec"]) == [*COMMAND, "thumbnail", "--size", "%s", "%i", "%o"]


def test_types_of_files_are_the_same_everywhere(tmp_path):
    integrate(tmp_path, ["akap-editor"])
    root = ElementTree.parse(tmp_path / "mime" / "packages" / "akap-editor-mime.xml").getroot()
    types = {each.get("type") for each in root}
    assert MIMETYPE.decode() in types
    for path in ("applications/akap-editor.desktop", "thumbnailers/akap-editor.thumbnailer"):
        assert types <= set(read_entry(tmp_path / path)["MimeType"].split(";"))
    metainfo = ElementTree.parse(tmp_path / "metainfo" / "akap-editor.metainfo.xml")
    assert {each.text for each in metainfo.iter("mediatype")} == types


@pytest.mark.parametrize(
    ("program", "arguments", "place"),
    [
        ("desktop-file-validate", [], "applications/akap-editor.desktop"),
        ("appstreamcli", ["validate", "--no-net"], "metainfo/akap-editor.metainfo.xml"),
    ],
)
def test_the_validators_of_the_desktop_agree(tmp_path, program, arguments, place):
    if not shutil.which(program):
        pytest.skip(f"{program} is not installed")
    integrate(tmp_path, COMMAND)
    process = subprocess.run([program, *arguments, tmp_path / place], capture_output=True, text=True)
    assert process.returncode == 0, process.stdout + process.stderr


def test_the_program_is_an_appimage_a_bundle_a_script_or_a_module(tmp_path, monkeypatch):
    monkeypatch.delenv("APPIMAGE", raising=False)
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    assert program_command() == [str(tmp_path / "python"), "-m", "akap_editor"]
    (tmp_path / "akap-editor").touch()
    assert program_command() == [str(tmp_path / "akap-editor")]
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    assert program_command() == [str(tmp_path / "python")]
    monkeypatch.setenv("APPIMAGE", "/home/x/akap-editor.AppImage")
    assert program_command() == ["/home/x/akap-editor.AppImage"]


def test_the_data_folder_is_the_user_s(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    assert data_folder() == tmp_path / ".local" / "share"
    monkeypatch.setenv("XDG_DATA_HOME", "relative")  # the specification ignores it
    assert data_folder() == tmp_path / ".local" / "share"
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    assert data_folder() == tmp_path / "data"
    monkeypatch.setattr(sys, "platform", "darwin")
    with pytest.raises(InputError, match="integrate: expected Linux"):
        data_folder()


def test_a_folder_that_cannot_be_made_is_told(tmp_path):
    (tmp_path / "applications").write_text("a file")
    with pytest.raises(InputError, match=r"akap-editor\.desktop"):
        integrate(tmp_path, ["akap-editor"])


def test_a_name_with_control_characters_is_refused(tmp_path):
    with pytest.raises(InputError, match="expected the program in a folder of a printable name"):
        integrate(tmp_path, [f"/opt/a{os.linesep}b/akap-editor"])
