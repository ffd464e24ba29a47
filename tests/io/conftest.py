"""Documents and pictures for the tests of files."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from akap_editor.editor.document.document import Document, EditState
from akap_editor.editor.document.drawing import Drawing
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.settings import Settings
from akap_editor.geometry.mesh import TriMesh
from tests.support.cartoons import cartoon_paths
from tests.support.opengl import shared_context  # noqa: F401  # for all tests of this folder


@pytest.fixture
def picture() -> np.ndarray:
    """(6, 8, 4): random colours, also where alpha is 0, and alpha of all kinds."""
    image = np.random.default_rng(1).integers(0, 256, (6, 8, 4), dtype=np.uint8)
    image[:2, :, 3] = 0
    image[2, :, 3] = 255
    return image


@pytest.fixture
def make_document() -> Callable[..., Document]:
    """A square of two triangles on a picture; parts of it can be replaced by keyword."""

    def make(image, **parts) -> Document:
        height, width = image.shape[:2]
        mesh = TriMesh([[0, 0], [width, 0], [width, height], [0, height]], [[0, 1, 2], [0, 2, 3]])
        uv = (mesh.vertices / [width, height]).astype(np.float32)
        pins = Pin(1, 0, [0.1, 0.2, 0.7], [0.1 + 0.2, -3.0]), Pin(7, 1, [1.0, 0.0, 0.0], [1e9, 5e-324])
        defaults = {
            "pins": pins,
            "positions": mesh.vertices + np.random.default_rng(2).normal(size=(4, 2)),
            "settings": Settings(),
        }
        state = EditState(**(defaults | parts))
        return Document(Drawing(image, mesh, uv, "square"), state, revision=5)

    return make


@pytest.fixture
def document(make_document, picture) -> Document:
    return make_document(picture)


@pytest.fixture(params=cartoon_paths("noto/*.png", "gophers/*.png"))
def cartoon_path(request) -> Path:
    """The file of each real cartoon in turn."""
    return request.param
