"""Commands with files of strange names: they work, and what they print harms no terminal."""

import io
import json
import os
import subprocess
import sys
from contextlib import suppress

import pytest

from akap_editor import cli
from akap_editor.display_text import display_text
from akap_editor.io.akap.project import load
from akap_editor.io.images import write_png
from tests.support.names import assert_readable, strange_names


@pytest.mark.parametrize("stem", strange_names())
def test_every_command_takes_them(run, tmp_path, image, stem):
    picture = tmp_path / f"{stem}.png"
    write_png(picture, image)
    commands = {
        "info": (),
        "mesh": ("-o", tmp_path / f"{stem}.obj"),
        "export": ("-o", tmp_path / f"{stem}.svg"),
    }
    for command, options in commands.items():
        code, said, errors = run(command, picture, *options)
        assert (code, errors) == (0, "")
        assert_readable(said)
        assert "bar" not in said
        assert not options or options[1].is_file()
    code, said, _ = run("info", tmp_path / f"{stem}.obj", "--json")
    assert code == 0
    assert json.loads(said)["file"] == str(tmp_path / f"{stem}.obj"), "programs get the name itself"


@pytest.mark.parametrize("stem", strange_names())
@pytest.mark.parametrize("command", ["info", "mesh", "export"])
def test_what_is_wrong_is_one_readable_line(run, tmp_path, command, stem):
    options = ("-o", tmp_path / f"{stem}.svg") if command == "export" else ()
    code, said, errors = run(command, tmp_path / f"{stem}.png", *options)
    assert (code, said) == (2, "")
    assert errors.count("\n") == 1
    assert_readable(errors)


@pytest.mark.parametrize("name", ["\x1b[31mred", "a\nb", "\ud800"])
def test_a_name_inside_a_drawing(run, posed, name):
    """As a document of another program could have it: JSON may hold any of them."""
    import zipfile

    with zipfile.ZipFile(posed) as archive:
        entries = {entry: archive.read(entry) for entry in archive.namelist()}
    record = json.loads(entries["document.json"])
    entries["document.json"] = json.dumps({**record, "name": name}).encode()
    with zipfile.ZipFile(posed, "w") as archive:
        for entry, data in entries.items():
            archive.writestr(entry, data)
    assert_readable(load(posed).drawing.name)
    code, said, _ = run("info", posed)
    assert code == 0
    assert_readable(said)


@pytest.mark.parametrize("encoding", ["latin-1", "cp1252", "koi8-r"])
def test_a_terminal_without_these_characters(monkeypatch, tmp_path, image, encoding):
    name = os.fsdecode("猫".encode())  # also where names of files are not UTF-8
    shown = display_text(name).encode(encoding, "backslashreplace").decode(encoding)
    write_png(tmp_path / f"{name}.png", image)
    streams = [io.TextIOWrapper(io.BytesIO(), encoding) for _ in range(2)]
    monkeypatch.setattr(sys, "stdout", streams[0])
    monkeypatch.setattr(sys, "stderr", streams[1])
    monkeypatch.setattr(sys, "argv", ["akap-editor", "info", str(tmp_path / f"{name}.png")])
    cli.main()
    monkeypatch.setattr(sys, "argv", ["akap-editor", "info", str(tmp_path / f"no {name}.png")])
    with pytest.raises(SystemExit):
        cli.main()
    for stream in streams:
        stream.flush()
    said = [stream.buffer.getvalue().decode(encoding) for stream in streams]
    assert f"{shown}.png: picture, sound" in said[0]
    assert f"no {shown}.png" in said[1]


@pytest.mark.skipif(os.name != "posix", reason="pseudo-terminals are those of POSIX")
@pytest.mark.parametrize("is_there", [True, False])
def test_no_escape_sequence_of_a_name_reaches_a_terminal(tmp_path, image, is_there):
    picture = tmp_path / os.fsdecode(b"\x1b]0;title\x07\x1b[31mred\xe9\x9b.png")
    if is_there:
        write_png(picture, image)
    terminal, end = os.openpty()
    command = [sys.executable, "-m", "akap_editor.cli", "info", str(picture)]
    done = subprocess.run(command, stdin=end, stdout=end, stderr=end)
    os.close(end)
    said = b""
    with suppress(OSError):  # on Linux, the end of the output
        while part := os.read(terminal, 4096):
            said += part
    os.close(terminal)
    assert done.returncode == (0 if is_there else 2)
    assert rb"\x1b]0;title\x07\x1b[31mred" in said
    assert not set(said) & {0x1B, 0x07, 0x9B}
