"""The shapes of this folder's tests."""

import pytest

from akap_editor.geometry.mesh import TriMesh
from tests.support.shapes import SHAPES


@pytest.fixture(params=SHAPES)
def mesh(request: pytest.FixtureRequest) -> TriMesh:
    """Each shape in turn."""
    return SHAPES[request.param]
