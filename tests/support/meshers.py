"""Tests as on a computer with other meshers."""

import pytest

from akap_editor.meshing import meshers


def pretend_installed(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    """Let the program find these meshers only, the first of them being the default one."""
    monkeypatch.setattr(meshers, "installed_meshers", lambda: names)
