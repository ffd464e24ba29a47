"""Meshes of cartoons."""

from collections.abc import Callable

import numpy as np
import pytest
from PIL import Image

from akap_editor.geometry.mesh import TriMesh
from akap_editor.meshing.outline import outlines
from akap_editor.meshing.triangulate import triangulate
from akap_editor.resources import resource


@pytest.fixture(scope="session")
def cartoon_mesh(request: pytest.FixtureRequest) -> Callable[..., TriMesh]:
    """Makes meshes of cartoons by name: "cat" is a bundled one, "noto/cat" a real one."""
    meshes: dict[tuple[str, int], TriMesh] = {}

    def make_mesh(name: str, vertices: int = 800) -> TriMesh:
        if (name, vertices) not in meshes:
            shared = "/" in name
            folder = request.getfixturevalue("shared_data") if shared else resource("assets", "drawings")
            image = Image.open(folder / f"{name}.png")
            is_mask = name.endswith("-mask")
            alpha = np.array(image.convert("L") if is_mask else image.convert("RGBA").getchannel("A"))
            meshes[name, vertices] = triangulate(outlines(alpha), vertices)
        return meshes[name, vertices]

    return make_mesh
