"""A window on GLFW's null platform, which needs no display, and a drawing to open in it."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from akap_editor.editor import gestures
from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.editor import Editor
from tests.support.pictures import figure_picture
from tests.support.window_driver import DeferredPainter, Window, WindowDriver, render_unlocked


@pytest.fixture(scope="session")
def image() -> NDArray[np.uint8]:
    """A head with a long neck and soft edges, (160, 240, 4)."""
    return figure_picture(2, soft=True)


@pytest.fixture(scope="session")
def drawing(image: NDArray[np.uint8]) -> Drawing:
    return make_drawing(image, vertices=200, name="figure")


@pytest.fixture
def document(drawing: Drawing) -> Document:
    return new_document(drawing)


@pytest.fixture(scope="module")
def new_window() -> Iterator[Callable[..., WindowDriver]]:
    """Makes the module's window; the one before it is closed."""
    made: list[WindowDriver] = []
    with DeferredPainter().deferring(), pytest.MonkeyPatch.context() as patch:
        patch.setattr("akap_editor.app.glfw_window.render_imgui", render_unlocked)

        def make(**options: object) -> WindowDriver:
            while made:
                made.pop().close()
            made.append(WindowDriver(Window(null=True, **options)))
            return made[-1]

        yield make
        for driver in made:
            driver.close()


@pytest.fixture(scope="module")
def module_window(new_window: Callable[..., WindowDriver]) -> WindowDriver:
    return new_window()


@pytest.fixture
def ui(module_window: WindowDriver, document: Document) -> WindowDriver:
    """The window with the drawing at rest, without pins, the pointer beside it."""
    module_window.reset(document)
    return module_window


@pytest.fixture
def pinned(module_window: WindowDriver, document: Document) -> WindowDriver:
    """The window with pins 1 to 3, in the head, in the neck and at its end; none selected, all saved."""
    editor = Editor()
    editor.open(document)
    for at in ((50.0, 80.0), (130.0, 80.0), (210.0, 80.0)):
        gestures.add_pin(editor, at)
    assert editor.session is not None
    module_window.reset(editor.session.document)
    return module_window


@pytest.fixture
def bent(pinned: WindowDriver, tmp_path: Path) -> WindowDriver:
    """The window with three pins, one of them dragged, not saved; file dialogs start in an empty folder."""
    pinned.bend()
    pinned.state.folder = tmp_path
    assert pinned.editor.is_modified
    return pinned
