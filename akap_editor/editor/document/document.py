"""An open document: a drawing and the state that undo restores; frozen values, replaced and never edited."""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ...geometry.mesh import MeshPoints
from ...geometry.validation import Floats, Ints, frozen
from .depth import face_order
from .drawing import Drawing
from .keyframes import NO_ANIMATION, Animation
from .named_poses import NamedPose
from .pin import Pin
from .settings import Settings


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
    def face_order(self) -> Ints | None:
        """(m,) the faces from the hindmost to the foremost; None is the order of the mesh."""
        return face_order(self.drawing.mesh, self.state.pins)

    def with_state(self, state: EditState) -> "Document":
        """This document with another state, one revision on."""
        return replace(self, state=state, revision=self.revision + 1)


def new_document(drawing: Drawing, settings: Settings | None = None) -> Document:
    """A drawing at rest, without pins."""
    return Document(drawing, EditState((), drawing.mesh.vertices, settings or Settings()))
