"""What an open drawing is: frozen values, replaced and never edited."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..deform.variants import parse_method
from ..errors import InputError
from ..geometry.background import remove_background
from ..geometry.checks import Floats, Ints, as_points, frozen
from ..geometry.mesh import MeshPoints, TriMesh
from ..geometry.meshing import mesh_picture
from .depth import face_order
from .keyframes import NO_ANIMATION, Animation
from .poses import NamedPose


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
        image = masked(image, mask)
    return drawing_from(image, Meshing(vertices, expand, threshold, background), name)


def drawing_from(image: NDArray[np.uint8], meshing: Meshing, name: str) -> Drawing:
    """A picture (h, w, 4) uint8 as a drawing, without its background if so wanted. Raises InputError."""
    if meshing.background is None:
        return drawing_on(image, meshing, name)
    original = image if not image.flags.writeable else frozen(image.copy())
    return drawing_on(remove_background(image, meshing.background), meshing, name, original)


def drawing_on(
    image: NDArray[np.uint8], meshing: Meshing, name: str, original: NDArray[np.uint8] | None = None
) -> Drawing:
    """A picture (h, w, 4) uint8 as it is with a mesh of what is visible of it. Raises InputError."""
    made = mesh_picture(image[..., 3], meshing.vertices, meshing.expand, meshing.threshold)
    mesh = replace(made.mesh, tied=True)
    height, width = image.shape[:2]
    uv = (mesh.vertices / [width, height]).astype(np.float32)
    return Drawing(image, mesh, uv, name, meshing, original)


def masked(image: NDArray[np.uint8], mask: NDArray[np.uint8]) -> NDArray[np.uint8]:
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


@dataclass(frozen=True, eq=False)
class Pin:
    """A point of the drawing that the artist controls.

    id: unique in its document; face, weights (3,): where on the mesh; target (2,): where it should be,
    in pixels; depth: what is higher passes in front, see `depth.face_order`; angle: by how many radians the
    drawing around it is to be turned from rest (clockwise on the screen), None where it turns as it will.
    """

    id: int
    face: int
    weights: Floats
    target: Floats
    depth: int = 0
    angle: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "weights", frozen(np.array(self.weights, dtype=np.float64)))
        object.__setattr__(self, "target", frozen(np.array(self.target, dtype=np.float64)))


@dataclass(frozen=True)
class Settings:
    """How the drawing bends: the method's name and its parameters (see `deform.deformer.make_deformer`)."""

    method: str = "akap"
    parameters: tuple[tuple[str, Any], ...] = (("memory", 1.0),)

    def get(self, name: str, default: Any = None) -> Any:
        """The value of one parameter, or ``default`` where it is left to the method."""
        return dict(self.parameters).get(name, default)

    def with_parameter(self, name: str, value: Any) -> "Settings":
        """These settings with one parameter changed."""
        return replace(self, parameters=tuple(sorted({**dict(self.parameters), name: value}.items())))

    @classmethod
    def of(cls, spec: str) -> "Settings":
        """The editor's settings of a method, with what ``spec`` says of it (see `parse_method`).

        Raises InputError.
        """
        name, parameters = parse_method(spec)
        settings = cls() if name == cls.method else cls(name, ())
        for parameter, value in parameters.items():
            settings = settings.with_parameter(parameter, value)
        return settings


@dataclass(frozen=True, eq=False)
class EditState:
    """All that undo restores: pins, pose (n, 2) float64 in pixels, settings.

    drawing: what is bent, where it was given another mesh in this session; None: what was opened.
    poses: those that were given names, of the same mesh; animation: its keyframes. stiffness: (m,) float64,
    by what factor each face bends less, see `stiffness`; None is 1 everywhere.
    """

    pins: tuple[Pin, ...]
    positions: Floats
    settings: Settings = field(default_factory=Settings)
    drawing: Drawing | None = None
    poses: tuple[NamedPose, ...] = ()
    stiffness: Floats | None = None
    animation: Animation = NO_ANIMATION

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", frozen(np.asarray(self.positions, dtype=np.float64)))
        if self.stiffness is not None:
            object.__setattr__(self, "stiffness", frozen(np.asarray(self.stiffness, dtype=np.float64)))

    @property
    def points(self) -> MeshPoints:
        """The pins as points of the mesh, in order."""
        return MeshPoints(
            np.array([pin.face for pin in self.pins], dtype=np.int32),
            np.array([pin.weights for pin in self.pins]).reshape(-1, 3),
        )

    @property
    def targets(self) -> Floats:
        """(k, 2) where the pins should be."""
        return np.array([pin.target for pin in self.pins]).reshape(-1, 2)

    @property
    def angles(self) -> Floats:
        """(k,) radians that pins hold, NaN for those that turn as they will."""
        return np.array([np.nan if pin.angle is None else pin.angle for pin in self.pins])

    def pin(self, pin_id: int) -> Pin:
        """The pin with this id. Raises KeyError."""
        for pin in self.pins:
            if pin.id == pin_id:
                return pin
        raise KeyError(pin_id)


@dataclass(frozen=True, eq=False)
class Document:
    """An open drawing.

    revision: grows with every change of ``state``; path: the .akap file, if any.
    """

    drawing: Drawing
    state: EditState
    revision: int = 0
    path: Path | None = None

    @property
    def order(self) -> Ints | None:
        """(m,) the faces from the hindmost to the foremost; None is the order of the mesh."""
        return face_order(self.drawing.mesh, self.state.pins)

    def with_state(self, state: EditState) -> "Document":
        """This document with another state, one revision on."""
        return replace(self, state=state, revision=self.revision + 1)


def new_document(drawing: Drawing, settings: Settings | None = None) -> Document:
    """A drawing at rest, without pins."""
    return Document(drawing, EditState((), drawing.mesh.vertices, settings or Settings()))
