"""The layers of a drawing: their pictures, and what the layer list shows of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..display_text import display_text
from ..errors import InputError
from ..geometry.validation import Ints, as_choice, as_number, as_picture, as_switch, freeze
from ..words import tr
from .composite import composite
from .layered_picture import BLEND_MODES, MAX_NAME, Layer, LayeredPicture


@dataclass(frozen=True, eq=False)
class Artwork:
    """The picture of a layer; it never changes, and drawings that differ otherwise share it.

    picture: (h, w, 4) uint8 RGBA, straight alpha, read-only; offset: of its top left corner on the canvas, x
    and y in pixels; corner: of its top left corner in the drawing's texture, x and y in pixels.
    """

    picture: NDArray[np.uint8]
    offset: tuple[int, int]
    corner: tuple[int, int]

    def __post_init__(self) -> None:
        picture = as_picture(self.picture, "picture")
        if picture.flags.writeable:
            picture = freeze(picture.copy())
        object.__setattr__(self, "picture", picture)
        for name in ("offset", "corner"):
            x, y = getattr(self, name)
            object.__setattr__(self, name, (int(x), int(y)))


@dataclass(frozen=True, eq=False)
class DrawingLayer:
    """One layer of a drawing.

    name, groups: as in the file that it comes from, the outermost group first; opacity: 0 to 1; blend: one of
    `BLEND_MODES`; visible: whether its eye is open; solo: whether only this one and other such layers are
    shown; locked: whether clicks go through it; slot: name of the slot that it is in, of whose layers one is
    shown (see `layer_view`), empty for none; closed_groups: indices of its groups whose eye is closed, which
    hides it. Raises InputError on other values.
    """

    artwork: Artwork
    name: str
    groups: tuple[str, ...] = ()
    opacity: float = 1.0
    blend: str = "normal"
    visible: bool = True
    solo: bool = False
    locked: bool = False
    slot: str = ""
    closed_groups: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", display_text(self.name)[:MAX_NAME])
        groups = tuple(display_text(group)[:MAX_NAME] for group in self.groups)
        object.__setattr__(self, "groups", groups)
        object.__setattr__(self, "opacity", as_number(self.opacity, "opacity", 0, 1))
        as_choice(self.blend, "blend", BLEND_MODES)
        object.__setattr__(self, "slot", display_text(self.slot)[:MAX_NAME])
        closed = tuple(sorted(set(self.closed_groups)))
        if any(type(index) is not int or not 0 <= index < len(groups) for index in closed):
            raise InputError(
                tr(
                    "closed_groups: expected indices of {count} groups, got {closed!r:.60}",
                    count=len(groups),
                    closed=closed,
                )
            )
        object.__setattr__(self, "closed_groups", closed)
        for name in ("visible", "solo", "locked"):
            object.__setattr__(self, name, as_switch(getattr(self, name), name))

    @property
    def path(self) -> tuple[str, ...]:
        """The names of its groups, the outermost first, and its own name."""
        return (*self.groups, self.name)


def closed_groups(layers: Sequence[DrawingLayer], groups: tuple[str, ...]) -> tuple[int, ...]:
    """The indices in ``groups``, the outermost first, of those whose eye is closed among the layers."""
    closed = {
        index
        for layer in layers
        for index in layer.closed_groups
        if layer.groups[: index + 1] == groups[: index + 1]
    }
    return tuple(sorted(closed))


def shown_layers(layers: Sequence[DrawingLayer]) -> NDArray[np.bool_]:
    """Whether each layer is shown, (l,).

    By its eye and those of its groups; and if there are solo layers, only if it is one of them.
    """
    any_solo = any(layer.solo for layer in layers)
    shown = (layer.visible and not layer.closed_groups and (layer.solo or not any_solo) for layer in layers)
    return np.array(list(shown), dtype=bool)


def stacked_faces(
    order: Ints | None, face_layers: Ints, layers: Sequence[DrawingLayer], layer_order: Sequence[int]
) -> Ints | None:
    """Faces from back to front (q,), layer by layer and without hidden ones; None stands for all by index.

    order: (m,) the faces as they are to follow one another within a layer, None for by index; face_layers:
    (m,) the layer of each face; layer_order: the layers from back to front.
    """
    shown = shown_layers(layers)
    if order is None and shown.all() and list(layer_order) == list(range(len(layers))):
        return None  # the faces of a mesh follow one another by layer
    order = np.arange(len(face_layers)) if order is None else order
    ranks = np.empty(len(layers), dtype=np.int64)
    ranks[list(layer_order)] = np.arange(len(layers))
    order = order[shown[face_layers[order]]]
    stacked: Ints = order[np.argsort(ranks[face_layers[order]], kind="stable")]
    return freeze(stacked)


def as_layered_picture(
    layers: Sequence[DrawingLayer], layer_order: Sequence[int], size: tuple[int, int], step: int = 1
) -> LayeredPicture:
    """The layers at rest, from back to front, at every ``step``-th pixel of the canvas; hidden ones, too.

    size: of the canvas, pixels.
    """
    shown = shown_layers(layers)

    def at_rest(number: int) -> Layer:
        layer = layers[number]
        (x, y), picture = layer.artwork.offset, layer.artwork.picture[::step, ::step]
        offset, visible = (x // step, y // step), bool(shown[number])
        return Layer(layer.name, picture, offset, (), layer.opacity, layer.blend, visible)

    width, height = (-(-side // step) for side in size)
    return LayeredPicture((width, height), tuple(map(at_rest, layer_order)))


def flat_picture(
    layers: Sequence[DrawingLayer], layer_order: Sequence[int], size: tuple[int, int], step: int = 1
) -> NDArray[np.uint8]:
    """What the layers show together at rest, (h, w, 4) uint8; see `as_layered_picture`."""
    return composite(as_layered_picture(layers, layer_order, size, step))


def faded_texture(texture: NDArray[np.uint8], layers: Sequence[DrawingLayer]) -> NDArray[np.uint8]:
    """A texture (h, w, 4) uint8 with the opacity of the layers in its alpha; itself if all are opaque."""
    if all(layer.opacity == 1 for layer in layers):
        return texture
    result = texture.copy()
    for layer in layers:
        (x, y), (height, width) = layer.artwork.corner, layer.artwork.picture.shape[:2]
        alpha = result[y : y + height, x : x + width, 3]
        alpha[...] = np.rint(alpha * layer.opacity).astype(np.uint8)
    return result
