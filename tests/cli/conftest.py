"""Runs the program in an empty folder, without a display."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from akap_editor import cli
from akap_editor.editor.document.document import EditState
from akap_editor.io.akap.project import save
from akap_editor.io.images import write_png
from akap_editor.io.open_document import open_document
from tests.support.command_line import Result
from tests.support.opengl import shared_context  # noqa: F401  # for all tests of this folder
from tests.support.pictures import bar_picture


@pytest.fixture
def run(monkeypatch, capfd, tmp_path) -> Callable[..., Result]:
    """Runs the program with arguments."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)

    def call(*arguments: object) -> Result:
        monkeypatch.setattr(sys, "argv", ["akap-editor", *map(str, arguments)])
        code = 0
        try:
            cli.main()
        except SystemExit as leaving:
            code = leaving.code or 0
        return code, *capfd.readouterr()

    return call


@pytest.fixture
def image() -> NDArray[np.uint8]:
    """An orange bar with soft edges, (60, 90, 4)."""
    return bar_picture()


@pytest.fixture
def picture(tmp_path, image) -> Path:
    """The bar as a file."""
    write_png(tmp_path / "bar.png", image)
    return tmp_path / "bar.png"


@pytest.fixture
def posed(tmp_path, picture) -> Path:
    """A saved drawing, sheared out of its frame, so that its picture is larger."""
    document = open_document(picture)
    pose = document.state.positions @ [[1.0, 0.4], [0.3, 1.0]] - [20.0, 5.0]
    save(document.with_state(EditState((), pose, document.state.settings)), tmp_path / "posed.akap")
    return tmp_path / "posed.akap"
