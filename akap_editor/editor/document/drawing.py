"""A picture and the mesh that it is drawn on."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...geometry.validation import as_points, frozen
from ...meshing.background import remove_background
from ...meshing.picture_mesh import mesh_picture


@dataclass(frozen=True)
class Meshing:
    """How a picture becomes a mesh.

    vertices: wanted number of mesh vertices; expand: pixels by which the outline is moved outwards, so that
    the soft rim lies inside the mesh and near parts join; threshold: share of full opacity at which the
    picture ends; background: tolerance with which a plain background was made transparent (see
    `remove_background`), None where it was not.
    """

    vertices: int = 2000
    expand: float = 2.0
    threshold: float = 0.5
    background: float | None = None


@dataclass(frozen=True, eq=False)
class Drawing:
    """A picture and the mesh it is drawn on.

    image: (h, w, 4) uint8, straight alpha; mesh: the rest pose; uv: (n, 2) float32, texture coordinates,
    (0, 0) at the picture's top left corner; name: for titles and file names.
    meshing: how the mesh was made, None where that is not known; original: the picture while it still had
    the background that was removed, else None.
    """

    image: NDArray[np.uint8]
    mesh: TriMesh
    uv: NDArray[np.float32]
    name: str = "untitled"
    meshing: Meshing | None = None
    original: NDArray[np.uint8] | None = None

    def __post_init__(self) -> None:
        image = np.asarray(self.image)
        if image.ndim != 3 or image.shape[2] != 4 or image.dtype != np.uint8 or not image.size:
            raise InputError(f"image: expected shape (h, w, 4) uint8, got {image.shape} {image.dtype}")
        uv = as_points(self.uv, "uv", len(self.mesh.vertices)).astype(np.float32)
        if image.flags.writeable or not image.flags.owndata:
            image = frozen(image.copy())
        object.__setattr__(self, "image", image)
        object.__setattr__(self, "uv", frozen(uv))

    @cached_property
    def is_opaque(self) -> bool:
        """Whether nothing of the picture is transparent, so that all of its rectangle bends."""
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
    threshold: float = Meshing.threshold,
    background: float | None = Meshing.background,
    name: str = "untitled",
) -> Drawing:
    """Cut a picture out along its alpha and triangulate it.

    image: (h, w, 4) uint8 RGBA, straight alpha; mask: (h, w) uint8, what is shown of it, 255 fully; for the
    other arguments see `Meshing`. The parts of the mesh are tied: one without a pin rides with the one
    nearest to it. Raises InputError where there is nothing to cut out.
    """
    image = np.asarray(image)
    if image.ndim != 3 or image.shape[2] != 4 or image.dtype != np.uint8:
        raise InputError(f"image: expected shape (h, w, 4) uint8, got {image.shape} {image.dtype}")
    if mask is not None:
        image = apply_mask(image, mask)
    return remove_background_and_mesh(image, Meshing(vertices, expand, threshold, background), name)


def remove_background_and_mesh(image: NDArray[np.uint8], meshing: Meshing, name: str) -> Drawing:
    """A picture (h, w, 4) uint8 as a drawing, without its background if so wanted. Raises InputError."""
    if meshing.background is None:
        return mesh_drawing(image, meshing, name)
    original = image if not image.flags.writeable else frozen(image.copy())
    return mesh_drawing(remove_background(image, meshing.background), meshing, name, original)


def mesh_drawing(
    image: NDArray[np.uint8], meshing: Meshing, name: str, original: NDArray[np.uint8] | None = None
) -> Drawing:
    """A picture (h, w, 4) uint8 as it is with a mesh of what is visible of it. Raises InputError."""
    made = mesh_picture(image[..., 3], meshing.vertices, meshing.expand, meshing.threshold)
    mesh = replace(made.mesh, tied=True)
    height, width = image.shape[:2]
    uv = (mesh.vertices / [width, height]).astype(np.float32)
    return Drawing(image, mesh, uv, name, meshing, original)


def apply_mask(image: NDArray[np.uint8], mask: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture (h, w, 4) uint8 of which only what a mask (h, w) uint8 shows is visible.

    Raises InputError where they do not have the same size.
    """
    mask = np.asarray(mask)
    if mask.ndim != 2 or mask.dtype != np.uint8:
        raise InputError(f"mask: expected shape (h, w) uint8, got {mask.shape} {mask.dtype}")
    if mask.shape != image.shape[:2]:
        sizes = [f"{shape[1]} x {shape[0]}" for shape in (image.shape, mask.shape)]
        raise InputError(f"mask: expected the size of the picture, {sizes[0]} pixels, got {sizes[1]}")
    result = image.copy()
    result[..., 3] = (image[..., 3].astype(np.uint16) * mask + 127) // 255
    return result
