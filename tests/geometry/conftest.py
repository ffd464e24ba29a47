"""The shapes of this folder's tests."""

from collections.abc import Callable
from pathlib import Path
from runpy import run_path
from types import SimpleNamespace

import pytest

from akap_editor.geometry.mesh import TriMesh

SHAPES = SimpleNamespace(**run_path(str(Path(__file__).with_name("shapes.py"))))

DENSE = SimpleNamespace(**run_path(str(Path(__file__).parents[1] / "deform" / "dense.py")))


@pytest.fixture(scope="session")
def dense() -> SimpleNamespace:
    """What deform/dense.py defines: the paper's equations in loops and dense matrices."""
    return DENSE


@pytest.fixture(scope="session")
def shapes() -> SimpleNamespace:
    """What shapes.py defines."""
    return SHAPES


@pytest.fixture(params=SHAPES.SHAPES)
def shape_name(request: pytest.FixtureRequest) -> str:
    """Each shape in turn, by name."""
    return request.param


@pytest.fixture
def mesh(shape_name: str) -> TriMesh:
    """Each shape in turn."""
    return SHAPES.SHAPES[shape_name]


@pytest.fixture(scope="session")
def renumbered() -> Callable:
    """See shapes.py."""
    return SHAPES.renumbered
