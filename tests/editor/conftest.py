"""A small picture, its drawing, and drivers of an editor that shows it."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from tests.support.editor_driver import Driver
from tests.support.pictures import figure_picture


@pytest.fixture(scope="session")
def image() -> NDArray[np.uint8]:
    """A head with a long neck, (80, 120, 4)."""
    return figure_picture()


@pytest.fixture(scope="session")
def drawing(image: NDArray[np.uint8]) -> Drawing:
    return make_drawing(image, vertices=150, name="figure")


@pytest.fixture(scope="session")
def finer_drawing(image: NDArray[np.uint8]) -> Drawing:
    return make_drawing(image, vertices=300, name="figure")


@pytest.fixture
def new_driver(drawing: Drawing) -> Callable[[], Driver]:
    """A function that makes drivers with the drawing in its rest pose, without pins."""
    return lambda: Driver(new_document(drawing))


@pytest.fixture
def driver(new_driver: Callable[[], Driver]) -> Driver:
    return new_driver()


@pytest.fixture
def pinned(driver: Driver) -> Driver:
    """A driver with three pins, ids 1 to 3: in the head, in the neck and at its end; none selected."""
    for place in ((20.0, 40.0), (62.0, 40.0), (105.0, 40.0)):
        driver.click(place)
    driver.editor.select(())
    return driver
