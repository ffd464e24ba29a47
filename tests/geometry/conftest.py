"""The shapes of this folder's tests."""

from collections.abc import Callable
from types import ModuleType

import pytest

from akap_editor.geometry.mesh import TriMesh
from tests.support import dense as DENSE
from tests.support import shapes as SHAPES


@pytest.fixture(scope="session")
def dense() -> ModuleType:
    """What tests/support/dense.py defines: the paper's equations in loops and dense matrices."""
    return DENSE


@pytest.fixture(scope="session")
def shapes() -> ModuleType:
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
