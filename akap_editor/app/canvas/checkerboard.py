"""The checkerboard behind the drawing, light, mid or dark: by default so that the drawing's rim is seen."""

from typing import Literal
from weakref import WeakKeyDictionary

import numpy as np

from ...editor.document.drawing import Drawing
from ...render.renderer import CANVAS, Background
from ...words import mark

Shade = Literal["light", "mid", "dark"]
BoardChoice = Literal["automatic", "light", "mid", "dark"]

_CHECKERS = {
    "light": ((0.780, 0.784, 0.796), (0.847, 0.851, 0.863)),
    "mid": ((0.420, 0.424, 0.439), (0.478, 0.482, 0.498)),
    "dark": CANVAS.checker,
}
BOARD_LABELS: dict[BoardChoice, str] = {
    "automatic": mark("Automatic"),
    "light": mark("Light"),
    "mid": mark("Mid"),
    "dark": mark("Dark"),
}
_MOST_PIXELS = 400  # a side of the picture in which the rim is looked at
_DARK, _BRIGHT = 0.3, 0.6  # luminance of the rim, 0 to 1
_MANY = 0.25  # share of the rim
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of red, green and blue

_fitting: WeakKeyDictionary[Drawing, Shade] = WeakKeyDictionary()  # it keeps no picture in memory


def board_background(drawing: Drawing, choice: BoardChoice, cell: float) -> Background:
    """The canvas with a checkerboard in the picture's frame. cell: side of a cell in framebuffer pixels."""
    if choice == "automatic":
        if drawing not in _fitting:
            _fitting[drawing] = fitting_shade(drawing)
        choice = _fitting[drawing]
    return Background(CANVAS.color, _CHECKERS[choice], cell)


def fitting_shade(drawing: Drawing) -> Shade:
    """The shade on which the rim of a drawing is seen: light for dark rims, mid for dark and bright ones."""
    step = max(1, max(drawing.size) // _MOST_PIXELS)
    image = drawing.image[::step, ::step]
    inside = np.pad(image[..., 3] > 127, 1, constant_values=True)  # the frame of the picture is no rim
    is_deep = inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
    rim = image[inside[1:-1, 1:-1] & ~is_deep][:, :3]
    if not len(rim):
        return "dark"
    luminance = rim @ _LUMINANCE / 255
    dark, bright = (luminance < _DARK).mean(), (luminance > _BRIGHT).mean()
    if dark < _MANY:
        return "dark"
    return "mid" if bright >= _MANY else "light"
