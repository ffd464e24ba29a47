"""One OpenGL context for all tests of this folder, and small drawings."""

from collections.abc import Callable, Iterator

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from akap_editor.editor.document.drawing import Drawing
from akap_editor.geometry.mesh import TriMesh
from akap_editor.render.offscreen import OffscreenRenderer, standalone_context
from akap_editor.render.renderer import Renderer
from tests.support.cartoons import cartoon_paths


@pytest.fixture(scope="session")
def session_context() -> Iterator[moderngl.Context]:
    """Tests fail without OpenGL; they are not skipped."""
    context = standalone_context()
    yield context
    context.release()


@pytest.fixture
def ctx(session_context: moderngl.Context) -> Iterator[moderngl.Context]:
    """The context, current, with a clean error flag before and after."""
    with session_context:
        assert session_context.error == "GL_NO_ERROR"
        yield session_context
        assert session_context.error == "GL_NO_ERROR"


@pytest.fixture
def renderer(ctx: moderngl.Context) -> Iterator[Renderer]:
    made = Renderer(ctx)
    yield made
    made.release()


@pytest.fixture
def offscreen(ctx: moderngl.Context) -> Iterator[OffscreenRenderer]:
    with OffscreenRenderer(ctx) as made:
        yield made


@pytest.fixture
def sheet() -> Callable[..., Drawing]:
    """Makes a drawing whose mesh is a grid of ``cells`` × ``cells`` squares over the whole picture."""

    def make(image: NDArray[np.uint8], cells: int = 4) -> Drawing:
        height, width = image.shape[:2]
        ticks = np.linspace(0, 1, cells + 1)
        uv = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
        corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
        a, b, c, d = corner, corner + 1, corner + cells + 2, corner + cells + 1
        faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
        return Drawing(image, TriMesh(uv * [width, height], faces.astype(np.int32)), uv.astype(np.float32))

    return make


@pytest.fixture
def plain() -> Callable[..., NDArray[np.uint8]]:
    """Makes a picture of one color."""

    def make(width: int, height: int, *rgba: int) -> NDArray[np.uint8]:
        return np.full((height, width, 4), rgba, dtype=np.uint8)

    return make


@pytest.fixture
def noise() -> NDArray[np.uint8]:
    """(48, 64, 4): random colors and alpha; a fifth of the pixels is opaque, a fifth transparent."""
    rng = np.random.default_rng(7)
    image = rng.integers(0, 256, (48, 64, 4), dtype=np.uint8)
    kind = rng.integers(0, 5, image.shape[:2])
    image[kind == 0, 3] = 255
    image[kind == 1] = 0
    return image


@pytest.fixture
def disc() -> NDArray[np.uint8]:
    """(64, 64, 4): an orange disc with a soft edge on transparent black."""
    y, x = np.mgrid[:64, :64] + 0.5
    alpha = np.clip(24.5 - np.hypot(x - 32, y - 32), 0, 1)
    image = np.zeros((64, 64, 4), dtype=np.uint8)
    image[..., 3] = np.rint(alpha * 255)
    image[image[..., 3] > 0, :3] = (250, 130, 20)
    return image


@pytest.fixture(params=cartoon_paths("noto/cat.png", "noto/gecko.png", "noto/dancer.png"))
def cartoon_image(request: pytest.FixtureRequest) -> NDArray[np.uint8]:
    """The picture of each of three real cartoons in turn."""
    return np.asarray(Image.open(request.param).convert("RGBA"))
