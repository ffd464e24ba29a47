"""What an open drawing is: frozen values, replaced and never edited."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..geometry.checks import Floats, as_points, frozen
from ..geometry.mesh import MeshPoints, TriMesh
from ..geometry.outline import outlines
from ..geometry.triangulate import triangulate

DEFAULT_VERTICES = 2000
DEFAULT_EXPAND = 2.0


@dataclass(frozen=True, eq=False)
class Drawing:
    """A picture and the mesh it is drawn on.

    image: (h, w, 4) uint8, straight alpha; mesh: the rest pose; uv: (n, 2) float32, texture coordinates,
    (0, 0) at the picture's top left corner; name: for titles and file names.
    """

    image: NDArray[np.uint8]
    mesh: TriMesh
    uv: NDArray[np.float32]
    name: str = "untitled"

    def __post_init__(self) -> None:
        image = np.asarray(self.image)
        if image.ndim != 3 or image.shape[2] != 4 or image.dtype != np.uint8 or not image.size:
            raise InputError(f"image: expected shape (h, w, 4) uint8, got {image.shape} {image.dtype}")
        uv = as_points(self.uv, "uv", len(self.mesh.vertices)).astype(np.float32)
        object.__setattr__(self, "image", frozen(image.copy()))
        object.__setattr__(self, "uv", frozen(uv))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self.image.shape[1], self.image.shape[0]


def make_drawing(
    image: NDArray[np.uint8],
    vertices: int = DEFAULT_VERTICES,
    expand: float = DEFAULT_EXPAND,
    name: str = "untitled",
) -> Drawing:
    """Cut a picture out along its alpha and triangulate it.

    image: (h, w, 4) uint8 RGBA, straight alpha; vertices: wanted number of mesh vertices; expand: pixels by
    which the outline is moved outwards, so that the soft rim lies inside the mesh.
    Raises InputError where there is nothing to cut out.
    """
    image = np.asarray(image)
    if image.ndim != 3 or image.shape[2] != 4 or image.dtype != np.uint8:
        raise InputError(f"image: expected shape (h, w, 4) uint8, got {image.shape} {image.dtype}")
    height, width = image.shape[:2]
    mesh = triangulate(outlines(image[..., 3], expand=expand), vertices)
    return Drawing(image, mesh, (mesh.vertices / [width, height]).astype(np.float32), name)


@dataclass(frozen=True, eq=False)
class Pin:
    """A point of the drawing that the artist controls.

    id: unique in its document; face, weights (3,): where on the mesh; target (2,): where it should be,
    in pixels.
    """

    id: int
    face: int
    weights: Floats
    target: Floats

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


@dataclass(frozen=True, eq=False)
class EditState:
    """All that undo restores: pins, pose (n, 2) float64 in pixels, settings."""

    pins: tuple[Pin, ...]
    positions: Floats
    settings: Settings = field(default_factory=Settings)

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", frozen(np.asarray(self.positions, dtype=np.float64)))

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

    def with_state(self, state: EditState) -> "Document":
        """This document with another state, one revision on."""
        return replace(self, state=state, revision=self.revision + 1)


def new_document(drawing: Drawing, settings: Settings | None = None) -> Document:
    """A drawing at rest, without pins."""
    return Document(drawing, EditState((), drawing.mesh.vertices, settings or Settings()))
