"""The shapes of this folder's tests, and the paper's equations in loops and dense matrices."""

from pathlib import Path
from runpy import run_path
from types import SimpleNamespace

import pytest

from akap_editor.geometry.mesh import TriMesh

FOLDER = Path(__file__).parent
SHAPES = SimpleNamespace(**run_path(str(FOLDER.parent / "geometry" / "shapes.py")))
DENSE = SimpleNamespace(**run_path(str(FOLDER / "dense.py")))


@pytest.fixture(scope="session")
def shapes() -> SimpleNamespace:
    """What geometry/shapes.py defines."""
    return SHAPES


@pytest.fixture(scope="session")
def dense() -> SimpleNamespace:
    """What dense.py defines."""
    return DENSE


@pytest.fixture(params=SHAPES.SHAPES)
def shape_name(request: pytest.FixtureRequest) -> str:
    """Each shape in turn, by name."""
    return request.param


@pytest.fixture
def mesh(shape_name: str) -> TriMesh:
    """Each shape in turn."""
    return SHAPES.SHAPES[shape_name]
