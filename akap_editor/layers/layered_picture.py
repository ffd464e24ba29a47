"""Pictures that consist of layers, as a drawing program saves them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..display_text import display_text
from ..errors import InputError
from ..geometry.validation import as_choice, as_number, as_picture, as_switch, freeze
from ..words import tr

MAX_NAME = 255  # characters
MAX_GROUPS = 50  # in one another
PASS_THROUGH = "pass through"  # the blending of a group whose layers are blended with what lies below it
BLEND_MODES = ("normal", "multiply", "screen", "add")


@dataclass(frozen=True, eq=False)
class LayerGroup:
    """A group of layers; two layers are in one group if they refer to the same object.

    name: characters that cannot be shown are escaped; opacity: 0 to 1; blend: one of `BLEND_MODES`, or
    `PASS_THROUGH`; visible: whether its layers are shown; clipping: whether it is visible only where the
    layer or group below it is. Raises InputError on other values.
    """

    name: str
    opacity: float = 1.0
    blend: str = PASS_THROUGH
    visible: bool = True
    clipping: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", display_text(self.name)[:MAX_NAME])
        object.__setattr__(self, "opacity", as_number(self.opacity, "opacity", 0, 1))
        as_choice(self.blend, "blend", (*BLEND_MODES, PASS_THROUGH))
        as_switch(self.visible, "visible")
        as_switch(self.clipping, "clipping")


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer; the picture is read-only.

    name: characters that cannot be shown are escaped; picture: (h, w, 4) uint8 RGBA, straight alpha; offset:
    of its top left corner on the canvas, x and y in pixels, which may be outside; groups: those that it is
    in, the outermost first; opacity: 0 to 1; blend: one of `BLEND_MODES`; visible: whether it is shown if
    its groups are; clipping: whether it is visible only where the next layer below that does not clip is, or
    the group there. Raises InputError on other values.
    """

    name: str
    picture: NDArray[np.uint8]
    offset: tuple[int, int] = (0, 0)
    groups: tuple[LayerGroup, ...] = ()
    opacity: float = 1.0
    blend: str = "normal"
    visible: bool = True
    clipping: bool = False

    def __post_init__(self) -> None:
        picture = as_picture(self.picture, "picture")
        if picture.flags.writeable or not picture.flags.owndata:
            picture = freeze(picture.copy())
        x, y = self.offset
        object.__setattr__(self, "name", display_text(self.name)[:MAX_NAME])
        object.__setattr__(self, "picture", picture)
        object.__setattr__(self, "offset", (int(x), int(y)))
        object.__setattr__(self, "groups", tuple(self.groups))
        object.__setattr__(self, "opacity", as_number(self.opacity, "opacity", 0, 1))
        as_choice(self.blend, "blend", BLEND_MODES)
        as_switch(self.visible, "visible")
        as_switch(self.clipping, "clipping")

    def share(self, picture: NDArray[np.uint8]) -> None:
        """Refer to an equal picture (h, w, 4) uint8, read-only, so that its pixels are in memory once."""
        object.__setattr__(self, "picture", picture)

    @property
    def path(self) -> tuple[str, ...]:
        """The names of its groups, the outermost first, and its own name."""
        return (*(group.name for group in self.groups), self.name)

    @property
    def is_shown(self) -> bool:
        """Whether the layer and all its groups are visible."""
        return self.visible and all(group.visible for group in self.groups)

    @property
    def box(self) -> tuple[int, int, int, int]:
        """Left, top, right and bottom on the canvas, pixels."""
        (x, y), (height, width) = self.offset, self.picture.shape[:2]
        return x, y, x + width, y + height


@dataclass(frozen=True, eq=False)
class LayeredPicture:
    """A picture in layers.

    size: width and height of the canvas in pixels; layers: from the bottom to the top, those of a group one
    after the other, at least one; left_out: phrases that name what the file contains and the layers do not,
    e.g. "effects of “Hat”". Raises InputError without layers or with a canvas of no pixels.
    """

    size: tuple[int, int]
    layers: tuple[Layer, ...]
    left_out: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        width, height = self.size
        if not (width >= 1 and height >= 1):
            raise InputError(
                tr("size: expected at least 1 x 1 pixels, got {width} x {height}", width=width, height=height)
            )
        if not self.layers:
            raise InputError(tr("expected a picture with layers, got none"))
        object.__setattr__(self, "size", (int(width), int(height)))
        object.__setattr__(self, "layers", tuple(self.layers))
        object.__setattr__(self, "left_out", tuple(self.left_out))


def trimmed(
    picture: NDArray[np.uint8], offset: tuple[int, int]
) -> tuple[NDArray[np.uint8], tuple[int, int]] | None:
    """Cut a picture (h, w, 4) uint8 to its pixels that are not fully transparent.

    Returns a read-only copy and the offset of its corner, x and y in pixels, if that of ``picture`` is
    ``offset``; None if all pixels are transparent.
    """
    alpha = picture[..., 3]
    rows, columns = np.flatnonzero(alpha.any(axis=1)), np.flatnonzero(alpha.any(axis=0))
    if not len(rows):
        return None
    top, left = int(rows[0]), int(columns[0])
    cut = picture[top : rows[-1] + 1, left : columns[-1] + 1].copy()
    return freeze(cut), (offset[0] + left, offset[1] + top)
