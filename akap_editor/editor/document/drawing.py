"""Drawings: a picture and the mesh that carries it."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...display_text import display_text
from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...geometry.validation import as_channel, as_instance, as_picture, as_points, freeze
from ...meshing.background import remove_background
from ...meshing.faint import fitting_threshold
from ...meshing.meshers import check_mesher, default_mesher, nearest_mesher
from ...meshing.picture_mesh import mesh_picture
from ...progress import announce, part

MAX_NAME = 255  # characters


@dataclass(frozen=True)
class Meshing:
    """The options by which a mesh is made from a picture.

    vertices ("Detail"): wanted number of mesh vertices; expand ("Margin"): pixels by which the outline is
    moved outwards, so that soft edges lie inside the mesh and parts that are close together join; threshold
    ("Alpha threshold"): share of full opacity at which the picture ends; background: tolerance with which a
    plain background was removed (see `remove_background`), None if none was; mesher: the program that makes
    the mesh, see `meshers`.
    """

    vertices: int = 2000
    expand: float = 2.0
    threshold: float = 0.5
    background: float | None = None
    mesher: str = field(default_factory=default_mesher)


@dataclass(frozen=True, eq=False)
class Drawing:
    """A picture and the mesh that carries it; arrays are read-only.

    image: (h, w, 4) uint8 RGBA, straight alpha; mesh: the rest pose; uv: (n, 2) float32 texture coordinates,
    (0, 0) at the picture's top left corner; name: for titles and file names, at most `MAX_NAME` characters,
    those that cannot be shown are escaped; meshing: how the mesh was made,
    None if unknown; original: (h, w, 4) uint8, the picture before its background was removed, None if it
    was not. Raises InputError on wrong shapes or dtypes.
    """

    image: NDArray[np.uint8]
    mesh: TriMesh
    uv: NDArray[np.float32]
    name: str = "untitled"
    meshing: Meshing | None = None
    original: NDArray[np.uint8] | None = None

    def __post_init__(self) -> None:
        image = as_picture(self.image, "image")
        as_instance(self.mesh, "mesh", TriMesh)
        name = display_text(as_instance(self.name, "name", str))[:MAX_NAME]
        uv = as_points(self.uv, "uv", len(self.mesh.vertices)).astype(np.float32)
        if image.flags.writeable or not image.flags.owndata:
            image = freeze(image.copy())
        object.__setattr__(self, "image", image)
        object.__setattr__(self, "name", name)
        object.__setattr__(self, "uv", freeze(uv))

    @cached_property
    def is_opaque(self) -> bool:
        """Whether no pixel of the picture is transparent; the mesh then covers its whole rectangle."""
        return bool((self.image[..., 3] == 255).all())

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self.image.shape[1], self.image.shape[0]


def make_drawing(
    image: NDArray[np.uint8],
    mask: NDArray[np.uint8] | None = None,
    vertices: int = Meshing.vertices,
    expand: float = Meshing.expand,
    threshold: float | None = None,
    background: float | None = Meshing.background,
    name: str = "untitled",
    mesher: str | None = None,
) -> Drawing:
    """Cut a picture out along its alpha and triangulate it.

    image: (h, w, 4) uint8 RGBA, straight alpha; mask: (h, w) uint8, 255 where the picture is fully visible;
    threshold: None for 0.5, or less if the picture is faint, see `fitting_threshold`; the drawing's
    ``meshing`` holds it; mesher: "triangle", "pythoncdt", or None for the default one; for the other
    arguments see `Meshing`. The parts of the mesh are tied: a part without pins moves with the nearest part
    that has one. Raises InputError on bad arguments, or if nothing of the picture is visible.
    """
    image = as_picture(image, "image")
    if mask is not None:
        image = apply_mask(image, mask)
    if threshold is None:
        threshold = fitting_threshold(image[..., 3])
    meshing = Meshing(vertices, expand, threshold, background, check_mesher(mesher))
    return remove_background_and_mesh(image, meshing, name)


def remove_background_and_mesh(image: NDArray[np.uint8], meshing: Meshing, name: str) -> Drawing:
    """Make a drawing of a picture (h, w, 4) uint8; removes its background if ``meshing`` says so.

    Raises InputError if nothing of the picture is visible.
    """
    if meshing.background is None:
        return mesh_drawing(image, meshing, name)
    original = image if not image.flags.writeable else freeze(image.copy())
    announce(0.0, "Removing the background")
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
        image[..., 3], meshing.vertices, meshing.expand, meshing.threshold, meshing.mesher
    )
    mesh = replace(picture_mesh.mesh, tied=True)
    height, width = image.shape[:2]
    uv = (mesh.vertices / [width, height]).astype(np.float32)
    return Drawing(image, mesh, uv, name, meshing, original)


def apply_mask(image: NDArray[np.uint8], mask: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Multiply the alpha of a picture (h, w, 4) uint8 by a mask (h, w) uint8; returns a new picture.

    Raises InputError if their sizes differ.
    """
    mask = as_channel(mask, "mask")
    if mask.shape != image.shape[:2]:
        sizes = [f"{shape[1]} x {shape[0]}" for shape in (image.shape, mask.shape)]
        raise InputError(f"mask: expected the size of the picture, {sizes[0]} pixels, got {sizes[1]}")
    result = image.copy()
    result[..., 3] = (image[..., 3].astype(np.uint16) * mask + 127) // 255
    return result
