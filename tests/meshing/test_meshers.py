"""Which mesher is used: the one that was asked for, or the first of those that are installed."""

import numpy as np
import pytest

from akap_editor.editor.document.drawing import Meshing, make_drawing
from akap_editor.editor.document.remesh import remesh_drawing
from akap_editor.errors import InputError
from akap_editor.meshing.meshers import PYTHONCDT, TRIANGLE, check_mesher, default_mesher, nearest_mesher
from tests.support.meshers import needs_triangle, pretend_installed

IMAGE = np.zeros((80, 80, 4), dtype=np.uint8)
IMAGE[10:70, 10:70] = 255


@pytest.fixture
def without_triangle(monkeypatch):
    """A Python for which there is no Triangle."""
    pretend_installed(monkeypatch, PYTHONCDT)


@needs_triangle
def test_triangle_comes_first_where_it_is_installed():
    assert default_mesher() == check_mesher(None) == Meshing().mesher == TRIANGLE
    assert make_drawing(IMAGE, vertices=100).meshing.mesher == TRIANGLE


@needs_triangle
def test_the_mesher_asked_for_makes_the_mesh():
    meshes = [make_drawing(IMAGE, vertices=100, mesher=name).mesh for name in (TRIANGLE, PYTHONCDT)]
    assert meshes[0].vertices.tolist() != meshes[1].vertices.tolist()


def test_without_triangle_pythoncdt_makes_the_meshes(without_triangle):
    assert default_mesher() == nearest_mesher(TRIANGLE) == PYTHONCDT
    assert make_drawing(IMAGE, vertices=100).meshing.mesher == PYTHONCDT


def test_remeshing_keeps_the_mesher_of_the_drawing():
    drawing = make_drawing(IMAGE, vertices=100, mesher=PYTHONCDT)
    assert remesh_drawing(drawing, drawing.meshing).mesh.vertices.tolist() == drawing.mesh.vertices.tolist()


def test_remeshing_says_which_mesher_stood_in(without_triangle):
    drawing = make_drawing(IMAGE, vertices=100)
    assert remesh_drawing(drawing, Meshing(vertices=100, mesher=TRIANGLE)).meshing.mesher == PYTHONCDT


@pytest.mark.parametrize("name", ["gmsh", "", "Triangle", 3, ["triangle"]])
def test_unknown_meshers_are_refused(name):
    with pytest.raises(InputError, match="mesher: expected one of triangle, pythoncdt, got"):
        make_drawing(IMAGE, mesher=name)


def test_a_mesher_that_is_not_installed_is_refused(without_triangle):
    with pytest.raises(InputError, match="Triangle is not installed; install it with: pip install triangle"):
        make_drawing(IMAGE, mesher=TRIANGLE)


def test_no_mesher_at_all(monkeypatch):
    pretend_installed(monkeypatch)
    with pytest.raises(InputError, match="no mesher is installed; install one with: pip install pythoncdt"):
        make_drawing(IMAGE)
