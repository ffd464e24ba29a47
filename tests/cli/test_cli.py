"""The command line as a whole: its entry point, help, and files that cannot be opened."""

import importlib
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import akap_editor
from akap_editor import cli
from akap_editor.io.images import write_png
from tests.support.command_line import assert_one_line

ROOT = Path(__file__).parents[2]


def test_as_a_program():
    """The installed entry point, once, in a process of its own."""
    command = [sys.executable, "-m", "akap_editor.cli", "--version"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    result = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert result.returncode == 0
    assert result.stdout.strip() == f"akap-editor, version {akap_editor.__version__}"
    assert result.stderr == ""


def test_the_entry_point_is_there():
    scripts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["scripts"]
    module, _, name = scripts["akap-editor"].partition(":")
    assert getattr(importlib.import_module(module), name) is cli.main


@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_names_every_command(run, option):
    code, output, errors = run(option)
    assert (code, errors) == (0, "")
    for name in ("edit", "render", "replay", "FILE"):
        assert name in output


@pytest.mark.parametrize("command", ["edit", "render", "replay"])
def test_each_command_has_help_with_an_example(run, command):
    code, output, errors = run(command, "--help")
    assert (code, errors) == (0, "")
    assert f"Example: akap-editor {command}" in output


def bad_files(folder, image):
    write_png(folder / "whole.png", image)
    whole = (folder / "whole.png").read_bytes()
    (folder / "whole.png").unlink()
    (folder / "text.png").write_text("This is no picture.\n")
    (folder / "truncated.png").write_bytes(whole[: len(whole) // 2])
    write_png(folder / "transparent.png", np.zeros_like(image))
    write_png(folder / "pixel.png", np.zeros((1, 1, 4), dtype=np.uint8))
    (folder / "corrupt.akap").write_bytes(b"PK\x03\x04" + bytes(200))
    (folder / "folder.png").mkdir()


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("nothing.png", "no such file"),
        ("nothing.akap", "no such file"),
        ("text.png", "not a PNG"),
        ("truncated.png", "damaged or incomplete"),
        ("transparent.png", "transparent"),
        ("pixel.png", "expected"),
        ("corrupt.akap", "damaged or not an .akap file"),
        ("folder.png", "contains no PNG pictures"),
    ],
)
@pytest.mark.parametrize("command", ["edit", "render"])
def test_a_bad_file_is_told_in_one_line(run, tmp_path, image, name, part, command):
    bad_files(tmp_path, image)
    before = sorted(tmp_path.iterdir())
    arguments = (name,) if command == "edit" else ("render", name, "-o", "pose.png")
    result = run(*arguments)
    assert_one_line(result, name, part)
    assert "no display" not in result[2]
    assert sorted(tmp_path.iterdir()) == before
