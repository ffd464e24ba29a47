"""Tests as on a computer with other meshers."""

import pytest

from akap_editor.meshing import meshers
from akap_editor.meshing.meshers import MESHERS, TRIANGLE, installed_meshers

# For tests of Triangle, and for figures that hold on its meshes: it has no wheels for the latest Pythons.
needs_triangle = pytest.mark.skipif(TRIANGLE not in installed_meshers(), reason="Triangle is not installed")
EACH_MESHER = [pytest.param(name, marks=needs_triangle if name == TRIANGLE else ()) for name in MESHERS]


def pretend_installed(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    """Let the program find these meshers only, the first of them being the default one."""
    monkeypatch.setattr(meshers, "installed_meshers", lambda: names)
