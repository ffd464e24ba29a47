"""The shapes of this folder's tests, and the paper's equations in loops and dense matrices."""

from types import ModuleType

import numpy as np
import pytest
from PIL import Image

from akap_editor.geometry.mesh import TriMesh
from akap_editor.meshing.outline import outlines
from akap_editor.meshing.triangulate import triangulate
from akap_editor.resources import resource
from tests.support import arap_reference as ARAP
from tests.support import dense as DENSE
from tests.support import shapes as SHAPES


@pytest.fixture(scope="session")
def shapes() -> ModuleType:
    """What geometry/shapes.py defines."""
    return SHAPES


@pytest.fixture(scope="session")
def dense() -> ModuleType:
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


@pytest.fixture(scope="session")
def arap() -> ModuleType:
    """What arap_reference.py defines."""
    return ARAP


@pytest.fixture(scope="session")
def cartoon_mesh(request: pytest.FixtureRequest):
    """Makes meshes of cartoons by name: "cat" is a bundled one, "noto/cat" a real one."""
    meshes: dict[tuple[str, int], TriMesh] = {}

    def mesh_of(name: str, vertices: int = 800) -> TriMesh:
        if (name, vertices) not in meshes:
            shared = "/" in name
            folder = request.getfixturevalue("shared_data") if shared else resource("assets", "drawings")
            image = Image.open(folder / f"{name}.png")
            is_mask = name.endswith("-mask")
            alpha = np.array(image.convert("L") if is_mask else image.convert("RGBA").getchannel("A"))
            meshes[name, vertices] = triangulate(outlines(alpha), vertices)
        return meshes[name, vertices]

    return mesh_of
