"""Drawings: a picture, or several in layers, and the mesh that carries them."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...display_text import display_text
from ...errors import InputError
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.validation import Floats, Ints, as_channel, as_instance, as_picture, as_points, freeze
from ...layers.atlas import pack, pack_shared
from ...layers.drawing_layer import Artwork, DrawingLayer
from ...layers.layer_view import LayerView, group_slots
from ...layers.layered_picture import Layer, LayeredPicture
from ...layers.merging import movable_layers
from ...meshing.background import remove_background
from ...meshing.faint import DEFAULT_THRESHOLD, MIN_VISIBLE, fitting_threshold
from ...meshing.layer_mesh import mesh_layers
from ...meshing.meshers import check_mesher, default_mesher, nearest_mesher
from ...meshing.picture_mesh import mesh_picture
from ...meshing.slits import Cut, check_cuts
from ...progress import announce, part
from ...words import tr

MAX_NAME = 255  # characters


@dataclass(frozen=True)
class Meshing:
    """The options by which a mesh is made from a picture.

    vertices ("Detail"): wanted number of mesh vertices; expand ("Margin"): pixels by which the outline is
    moved outwards, so that soft edges lie inside the mesh and parts that are close together join; threshold
    ("Alpha threshold"): share of full opacity at which the picture ends; background: tolerance with which a
    plain background was removed (see `remove_background`), None if none was; mesher: the program that makes
    the mesh, see `meshers`; cuts: strokes of the knife, in pixels of the picture, along which the mesh is
    open, see `slits`; a drawing in layers has none. Raises InputError on bad strokes.
    """

    vertices: int = 2000
    expand: float = 2.0
    threshold: float = 0.5
    background: float | None = None
    mesher: str = field(default_factory=default_mesher)
    cuts: tuple[Cut, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "cuts", check_cuts(self.cuts))


@dataclass(frozen=True, eq=False)
class Drawing:
    """A picture and the mesh that carries it; arrays are read-only.

    image: (h, w, 4) uint8 RGBA, straight alpha; mesh: the rest pose; uv: (n, 2) float32 texture coordinates,
    (0, 0) at the picture's top left corner; name: for titles and file names, at most `MAX_NAME` characters,
    those that cannot be shown are escaped; meshing: how the mesh was made,
    None if unknown; original: (h, w, 4) uint8, the picture before its background was removed, None if it
    was not. Raises InputError on wrong shapes or dtypes.

    A drawing in layers: layers: one for each number in ``mesh.layers``; layer_order: these numbers from back
    to front; canvas: width and height in pixels. Its image is a texture that holds the pictures of all
    layers, see `Artwork.corner`. Without layers these are empty, and the image is the canvas.
    """

    image: NDArray[np.uint8]
    mesh: TriMesh
    uv: NDArray[np.float32]
    name: str = "untitled"
    meshing: Meshing | None = None
    original: NDArray[np.uint8] | None = None
    layers: tuple[DrawingLayer, ...] = ()
    layer_order: tuple[int, ...] = ()
    canvas: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        image = as_picture(self.image, "image")
        as_instance(self.mesh, "mesh", TriMesh)
        name = display_text(as_instance(self.name, "name", str))[:MAX_NAME]
        uv = self.uv
        is_ready = isinstance(uv, np.ndarray) and uv.dtype == np.float32 and not uv.flags.writeable
        if not (is_ready and uv.shape == self.mesh.vertices.shape):
            uv = freeze(as_points(uv, "uv", len(self.mesh.vertices)).astype(np.float32))
        if image.flags.writeable or not image.flags.owndata:
            image = freeze(image.copy())
        object.__setattr__(self, "image", image)
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "uv", uv)
        self._check_layers()

    def _check_layers(self) -> None:
        count = len(self.layers)
        used = 0 if self.mesh.layers is None else int(self.mesh.layers.max()) + 1
        if used != count or len(set(self.face_layers.tolist())) != max(count, 1):
            raise InputError(
                tr(
                    "layers: expected one for each layer of the mesh, {used}, got {count}",
                    used=used,
                    count=count,
                )
            )
        if sorted(self.layer_order) != list(range(count)):
            raise InputError(
                tr(
                    "layer_order: expected each of {count} layers once, got {layer_order}",
                    count=count,
                    layer_order=self.layer_order,
                )
            )
        if (self.canvas is None) != (not count):
            raise InputError(tr("canvas: expected a size for a drawing in layers, and none for another one"))
        object.__setattr__(self, "layers", tuple(self.layers))
        object.__setattr__(self, "layer_order", tuple(self.layer_order))

    @property
    def face_layers(self) -> Ints:
        """(m,) the layer of each face; 0 without layers."""
        return self.mesh.face_layers

    @cached_property
    def is_opaque(self) -> bool:
        """Whether no pixel of the picture is transparent; the mesh then covers its whole rectangle."""
        return bool((self.image[..., 3] == 255).all())

    @property
    def layer_view(self) -> LayerView | None:
        """Which layers are visible, and their order; None without layers."""
        if not self.layers:
            return None
        return LayerView(tuple(layer.visible for layer in self.layers), self.layer_order)

    def with_layer_view(self, view: LayerView | None) -> "Drawing":
        """This drawing with other layers visible, in another order; itself for None or its own view.

        Raises InputError on a view of other layers.
        """
        if view is None or view == self.layer_view:
            return self
        if not view.fits(len(self.layers)):
            raise InputError(
                tr(
                    "layers: expected a view of {count} layers, got {view!r:.60}",
                    count=len(self.layers),
                    view=view,
                )
            )
        layers = (
            layer if layer.visible is visible else replace(layer, visible=visible)
            for layer, visible in zip(self.layers, view.visible, strict=True)
        )
        return replace(self, layers=tuple(layers), layer_order=view.order)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, or of the canvas of all layers, in pixels."""
        if self.canvas is not None:
            return self.canvas
        return self.image.shape[1], self.image.shape[0]


def make_drawing(
    image: NDArray[np.uint8] | None = None,
    mask: NDArray[np.uint8] | None = None,
    vertices: int = Meshing.vertices,
    expand: float = Meshing.expand,
    threshold: float | None = None,
    background: float | None = Meshing.background,
    name: str = "untitled",
    mesher: str | None = None,
    layers: LayeredPicture | None = None,
) -> Drawing:
    """Cut a picture, or each layer of one in layers, out along its alpha and triangulate it.

    image: (h, w, 4) uint8 RGBA, straight alpha; mask: (h, w) uint8, 255 where the picture is fully visible;
    threshold: None for 0.5, or less if the picture is faint, see `fitting_threshold`; the drawing's
    ``meshing`` holds it; mesher: "triangle", "pythoncdt", or None for the default one; layers: in place of
    ``image``, see `open_layers`; they have no background to remove. For the other arguments see `Meshing`.
    The parts of the mesh are tied: a part without pins moves with the nearest part that has one, and a layer
    without pins with the layer it lies on. Raises InputError on bad arguments, or if nothing of the picture
    is visible.

    >>> from akap_editor import make_drawing, open_layers
    >>> drawing = make_drawing(layers=open_layers("robot.ora"))
    >>> [layer.name for layer in drawing.layers if "arm left" in layer.groups]
    ['arm upper left', 'arm lower left']
    """
    if (image is None) == (layers is None):
        raise InputError(tr("image: expected either a picture or layers"))
    if layers is not None and background is not None:
        raise InputError(tr("background: expected None for a picture in layers"))
    mesher = check_mesher(mesher)
    if layers is not None:
        layered = as_instance(layers, "layers", LayeredPicture)
        level = DEFAULT_THRESHOLD if threshold is None else threshold  # faint layers get their own
        meshing = Meshing(vertices, expand, level, background, mesher)
        return mesh_layered_drawing(layered if mask is None else mask_layers(layered, mask), meshing, name)
    image = as_picture(image, "image")
    if mask is not None:
        image = apply_mask(image, mask)
    if threshold is None:
        threshold = fitting_threshold(image[..., 3])
    meshing = Meshing(vertices, expand, threshold, background, mesher)
    return remove_background_and_mesh(image, meshing, name)


def remove_background_and_mesh(image: NDArray[np.uint8], meshing: Meshing, name: str) -> Drawing:
    """Make a drawing of a picture (h, w, 4) uint8; removes its background if ``meshing`` says so.

    Raises InputError if nothing of the picture is visible.
    """
    if meshing.background is None:
        return mesh_drawing(image, meshing, name)
    original = image if not image.flags.writeable else freeze(image.copy())
    announce(0.0, tr("Removing the background"))
    cut_out = remove_background(image, meshing.background)
    with part(0.4, 1.0):
        return mesh_drawing(cut_out, meshing, name, original)


def mesh_drawing(
    image: NDArray[np.uint8], meshing: Meshing, name: str, original: NDArray[np.uint8] | None = None
) -> Drawing:
    """Make a drawing of the visible part of a picture (h, w, 4) uint8.

    original: see `Drawing`. If the mesher is not installed, another makes the mesh. Raises InputError if
    nothing of the picture is visible.
    """
    meshing = replace(meshing, mesher=nearest_mesher(meshing.mesher))
    picture_mesh = mesh_picture(
        image[..., 3], meshing.vertices, meshing.expand, meshing.threshold, meshing.mesher, meshing.cuts
    )
    mesh = replace(picture_mesh.mesh, tied=True)
    height, width = image.shape[:2]
    uv = (mesh.vertices / [width, height]).astype(np.float32)
    return Drawing(image, mesh, uv, name, meshing, original)


def mesh_layered_drawing(layered: LayeredPicture, meshing: Meshing, name: str) -> Drawing:
    """Make a drawing of a picture in layers, see `movable_layers`.

    Raises InputError if nothing of it is left.
    """
    movable = movable_layers(layered)
    if not movable:
        raise InputError(tr("the layers are fully transparent: expected a drawing"))
    texture, corners = pack_shared(layered, movable, meshing.expand)
    artworks = [
        artwork_in(texture, layer.picture.shape[:2], layer.offset, corner)
        for layer, corner in zip(movable, corners, strict=True)
    ]
    layers = tuple(
        DrawingLayer(
            artwork,
            layer.name,
            tuple(group.name for group in layer.groups),
            layer.opacity,
            layer.blend,
            layer.visible,
            slot=slot,
        )
        for layer, artwork, slot in zip(movable, artworks, group_slots(movable), strict=True)
    )
    return _mesh_artworks(texture, layers, tuple(range(len(layers))), layered.size, meshing, name)


def remesh_layered_drawing(drawing: Drawing, meshing: Meshing) -> Drawing:
    """Make another mesh of a drawing in layers, with the same pictures and the same layer list."""
    artworks = [layer.artwork for layer in drawing.layers]
    texture, corners = pack([artwork.picture for artwork in artworks], meshing.expand)
    layers = tuple(
        replace(layer, artwork=artwork_in(texture, artwork.picture.shape[:2], artwork.offset, corner))
        for layer, artwork, corner in zip(drawing.layers, artworks, corners, strict=True)
    )
    return _mesh_artworks(texture, layers, drawing.layer_order, drawing.size, meshing, drawing.name)


def artwork_in(
    texture: NDArray[np.uint8], shape: tuple[int, ...], offset: tuple[int, int], corner: tuple[int, int]
) -> Artwork:
    """The artwork of a layer whose picture is at ``corner`` of a texture, as a view of it."""
    (x, y), (height, width) = corner, shape
    return Artwork(texture[y : y + height, x : x + width], offset, corner)


def _mesh_artworks(
    texture: NDArray[np.uint8],
    layers: tuple[DrawingLayer, ...],
    layer_order: tuple[int, ...],
    canvas: tuple[int, int],
    meshing: Meshing,
    name: str,
) -> Drawing:
    """The drawing of layers whose pictures are in a texture (h, w, 4) uint8."""
    meshing = replace(meshing, mesher=nearest_mesher(meshing.mesher))
    mesh = mesh_layers(
        [layer.artwork.picture[..., 3] for layer in layers],
        [layer.artwork.offset for layer in layers],
        meshing.vertices,
        meshing.expand,
        meshing.threshold,
        meshing.mesher,
    )
    shifts = texture_shifts(layers)[mesh.layers]
    uv = ((mesh.vertices + shifts) / [texture.shape[1], texture.shape[0]]).astype(np.float32)
    return Drawing(texture, mesh, uv, name, meshing, None, layers, layer_order, canvas)


def texture_shifts(layers: Sequence[DrawingLayer]) -> Floats:
    """From the place of each layer on the canvas to that in the texture, (l, 2) pixels."""
    artworks = [layer.artwork for layer in layers]
    return np.array([np.subtract(each.corner, each.offset) for each in artworks], dtype=np.float64)


def mask_layers(layered: LayeredPicture, mask: NDArray[np.uint8]) -> LayeredPicture:
    """Multiply the alpha of all layers by a mask (h, w) uint8 of the size of the canvas.

    Raises InputError on a mask of another size.
    """
    mask = as_channel(mask, "mask")
    width, height = layered.size
    if mask.shape != (height, width):
        raise InputError(
            tr(
                "mask: expected the size of the picture, {width} x {height} pixels, "
                "got {mask_width} x {mask_height}",
                width=width,
                height=height,
                mask_width=mask.shape[1],
                mask_height=mask.shape[0],
            )
        )

    def masked(layer: Layer) -> Layer:
        left, top, right, bottom = layer.box
        own = np.zeros((bottom - top, right - left), np.uint8)
        x, y = max(left, 0), max(top, 0)
        part_of_mask = mask[y : max(bottom, 0), x : max(right, 0)]
        own[y - top :, x - left :][: part_of_mask.shape[0], : part_of_mask.shape[1]] = part_of_mask
        return replace(layer, picture=apply_mask(layer.picture, own))

    return replace(layered, layers=tuple(masked(layer) for layer in layered.layers))


def visible_point(
    drawing: Drawing, point: ArrayLike, positions: Floats, order: Ints | None, unlocked: bool = False
) -> MeshPoints | None:
    """The point of a drawing that is seen at ``point`` (2,) in a pose (n, 2); None if none is.

    Where the foremost layer is transparent, it is one of a layer behind; if all are, the foremost one.
    order: see `Document.face_order`; unlocked: pass through locked layers.
    """
    if not drawing.layers:
        return drawing.mesh.find(point, positions, order)
    hits = drawing.mesh.find_all(point, positions, order)
    numbers = drawing.face_layers[hits.faces]
    if unlocked:
        free = np.array([not drawing.layers[number].locked for number in numbers], dtype=bool)
        hits, numbers = MeshPoints(hits.faces[free], hits.weights[free]), numbers[free]
    if not len(hits):
        return None
    uv = np.einsum("kc,kcd->kd", hits.weights, drawing.uv[drawing.mesh.faces[hits.faces]].astype(float))
    height, width = drawing.image.shape[:2]
    x, y = np.floor(uv * [width, height]).astype(int).T
    alpha = drawing.image[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1), 3]
    seen = np.flatnonzero(alpha >= MIN_VISIBLE)
    chosen = int(seen[-1]) if len(seen) else len(hits) - 1
    return MeshPoints(hits.faces[chosen : chosen + 1], hits.weights[chosen : chosen + 1])


def point_of_layer(
    drawing: Drawing, point: ArrayLike, positions: Floats, order: Ints | None, layer: int
) -> MeshPoints | None:
    """The foremost point of a layer at ``point`` (2,) in a pose (n, 2); None if the layer is not there."""
    hits = drawing.mesh.find_all(point, positions, order)
    own = np.flatnonzero(drawing.face_layers[hits.faces] == layer)[-1:]
    return MeshPoints(hits.faces[own], hits.weights[own]) if len(own) else None


def apply_mask(image: NDArray[np.uint8], mask: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Multiply the alpha of a picture (h, w, 4) uint8 by a mask (h, w) uint8; returns a new picture.

    Raises InputError if their sizes differ.
    """
    mask = as_channel(mask, "mask")
    if mask.shape != image.shape[:2]:
        sizes = [f"{shape[1]} x {shape[0]}" for shape in (image.shape, mask.shape)]
        raise InputError(
            tr(
                "mask: expected the size of the picture, {size} pixels, got {other}",
                size=sizes[0],
                other=sizes[1],
            )
        )
    result = image.copy()
    result[..., 3] = (image[..., 3].astype(np.uint16) * mask + 127) // 255
    return result
