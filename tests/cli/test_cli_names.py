"""Commands with files of strange names: they work, and what they print harms no terminal."""

import io
import json
import sys

import pytest

from akap_editor import cli
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
    write_png(tmp_path / "猫.png", image)
    streams = [io.TextIOWrapper(io.BytesIO(), encoding) for _ in range(2)]
    monkeypatch.setattr(sys, "stdout", streams[0])
    monkeypatch.setattr(sys, "stderr", streams[1])
    monkeypatch.setattr(sys, "argv", ["akap-editor", "info", str(tmp_path / "猫.png")])
    cli.main()
    monkeypatch.setattr(sys, "argv", ["akap-editor", "info", str(tmp_path / "no “猫”.png")])
    with pytest.raises(SystemExit):
        cli.main()
    for stream in streams:
        stream.flush()
    said = [stream.buffer.getvalue().decode(encoding) for stream in streams]
    assert r"\u732b.png: picture, sound" in said[0]
    assert r"\u732b" in said[1]
