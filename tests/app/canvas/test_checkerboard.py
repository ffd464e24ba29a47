"""The checkerboard: its shade suits the rim of the drawing, or is chosen."""

import gc
import weakref

import numpy as np
import pytest

from akap_editor.app.canvas.checkerboard import board_background, fitting_shade
from akap_editor.app.canvas.view_options import ViewOptions
from akap_editor.editor.document.drawing import make_drawing

BLACK, WHITE, RED = (10, 10, 12, 255), (250, 250, 245, 255), (200, 60, 40, 255)


def disk(rim, rim_on_the_left=None, fill=RED, side=200):
    """A disk with a rim that may have another color on its left half."""
    y, x = np.mgrid[:side, :side] - (side - 1) / 2
    radius = np.hypot(x, y) / side
    image = np.zeros((side, side, 4), np.uint8)
    image[radius < 0.45] = rim
    image[(radius < 0.45) & (x < 0)] = rim_on_the_left or rim
    image[radius < 0.40] = fill
    return make_drawing(image, vertices=100)


CASES = {
    "black outline": (disk(BLACK), "light"),
    "black outline, white inside": (disk(BLACK, fill=WHITE), "light"),
    "white outline": (disk(WHITE, fill=BLACK), "dark"),
    "colored": (disk(RED), "dark"),
    "black and white": (disk(BLACK, WHITE), "mid"),
    "large": (disk(BLACK, side=1500), "light"),
    "opaque": (make_drawing(np.full((40, 60, 4), (0, 0, 0, 255), np.uint8), vertices=50), "dark"),
}


@pytest.mark.parametrize("case", CASES)
def test_the_shade_suits_the_rim(case):
    drawing, shade = CASES[case]
    assert fitting_shade(drawing) == shade
    assert board_background(drawing, "automatic", 12.0) == board_background(drawing, shade, 12.0)


def test_a_chosen_shade_is_used_and_stored():
    drawing = CASES["black outline"][0]
    boards = [board_background(drawing, choice, 12.0) for choice in ("light", "mid", "dark")]
    assert len({board.checker for board in boards}) == 3
    view = ViewOptions(board="mid")
    again = ViewOptions()
    again.restore(view.to_json())
    assert again.board == "mid"
    again.restore({"board": "pink"})
    assert again.board == "automatic"


def test_no_picture_stays_in_memory():
    drawing = disk(BLACK)
    board_background(drawing, "automatic", 12.0)
    picture = weakref.ref(drawing)
    del drawing
    gc.collect()
    assert picture() is None


def test_the_canvas_shows_the_board_that_is_chosen(ui):
    shots = []
    for choice in ("light", "mid", "dark"):
        ui.state.view.board = choice
        shots.append(ui.screenshot())
    x, y = map(round, ui.to_screen((4.0, 4.0)))
    brightness = [int(shot[y, x].sum()) for shot in shots]
    assert brightness == sorted(brightness, reverse=True)
    assert len(set(brightness)) == 3
