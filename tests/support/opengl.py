"""One OpenGL context for the renderers of many tests: making a context and its first picture takes 0.15 s."""

from collections.abc import Iterator
from functools import cache

import moderngl
import pytest

from akap_editor.render.offscreen import standalone_context


@cache
def _shared_context() -> moderngl.Context:
    """The context, which stays when a renderer releases it as its own."""
    context = standalone_context()
    context.release = lambda: None
    return context


@pytest.fixture(scope="module", autouse=True)
def shared_context() -> Iterator[None]:
    """Let each `OffscreenRenderer` of the module draw with one context; a conftest imports it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("akap_editor.render.offscreen.standalone_context", _shared_context)
        yield
    if _shared_context.cache_info().currsize:
        with _shared_context() as context:
            assert context.error == "GL_NO_ERROR"
