"""The open document: a drawing and the state that undo restores. Values are replaced, never changed."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.validation import Floats, Ints, as_floats, as_instance
from ...overlap.seams import CutMesh
from .crossings import as_crossings, draw_order, face_order, no_crossings
from .drawing import Drawing
from .keyframes import NO_ANIMATION, Animation
from .named_poses import NamedPose
from .pin import Pin, pin_points
from .rig.joint import Joint
from .rig.loose_parts import LooseParts
from .rig.mirror import Mirror
from .settings import Settings


@dataclass(frozen=True, eq=False)
class EditState:
    """Everything that undo restores; arrays are read-only.

    pins: in the order in which they were added; positions: the pose, (n, 2) float64 pixels; settings: the
    deformation method; drawing: the drawing since it was last given another mesh or layer list in this
    session, None if it never was; poses: the named ones; stiffness: factors of the faces, (m,) float64 (see
    `stiffness`), None is 1 everywhere; animation: the keyframes; crossings: which part passes in front
    where the pose overlaps itself, (s, 2) int32 upper and lower faces (see `overlap.overlaps.Overlaps`);
    joints: between layers; mirror: its axis and pairs of pins, None until it is used; loose: parts that
    swing about the pose, None without any.
    """

    pins: tuple[Pin, ...]
    positions: Floats
    settings: Settings = field(default_factory=Settings)
    drawing: Drawing | None = None
    poses: tuple[NamedPose, ...] = ()
    stiffness: Floats | None = None
    animation: Animation = NO_ANIMATION
    crossings: Ints = field(default_factory=no_crossings)
    joints: tuple[Joint, ...] = ()
    mirror: Mirror | None = None
    loose: LooseParts | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", as_floats(self.positions, "positions"))
        if self.stiffness is not None:
            object.__setattr__(self, "stiffness", as_floats(self.stiffness, "stiffness"))
        object.__setattr__(self, "crossings", as_crossings(self.crossings))

    @cached_property  # asked for several times a frame
    def points(self) -> MeshPoints:
        """The places of the pins on the mesh, (k,), in order."""
        return pin_points(self.pins)

    @property
    def targets(self) -> Floats:
        """The targets of the pins, (k, 2) pixels, in order."""
        return np.array([pin.target for pin in self.pins]).reshape(-1, 2)

    @property
    def angles(self) -> Floats:
        """The angles that the pins hold, (k,) radians, in order; NaN for pins that rotate freely."""
        return np.array([np.nan if pin.angle is None else pin.angle for pin in self.pins])

    def pin_positions(self, mesh: TriMesh) -> Floats:
        """Where the pins are in the pose of ``mesh``, (k, 2) pixels, in order."""
        return mesh.evaluate(self.points, self.positions)

    def pin_offsets(self, mesh: TriMesh) -> Floats:
        """Offsets from the pins in the pose of ``mesh`` to their targets, (k, 2) pixels, in order."""
        return self.targets - self.pin_positions(mesh)

    def pin_error(self, mesh: TriMesh) -> float:
        """The largest distance of a pin from its target, pixels; 0 without pins."""
        return float(np.linalg.norm(self.pin_offsets(mesh), axis=1).max(initial=0.0))

    def pin(self, pin_id: int) -> Pin:
        """The pin with this id. Raises KeyError on an unknown id."""
        for pin in self.pins:
            if pin.id == pin_id:
                return pin
        raise KeyError(pin_id)


@dataclass(frozen=True)
class ArtworkFile:
    """The picture that a drawing was made from, which the artist may change.

    path: of a file or a folder of layers, absolute; digest: SHA-256 of the content that the drawing shows, ""
    if unknown; has_changed: whether the content was another one when the document was opened.
    """

    path: Path
    digest: str = ""
    has_changed: bool = False


@dataclass(frozen=True, eq=False)
class Document:
    """An open drawing with its state.

    revision: grows with every change of ``state``; path: the .akap file, None if there is none; digest: of
    the bytes of this file when they were read or written here, "" if unknown; notes: sentences, without
    period, about what opening a file of another program merged or left out; sources: the files that it was
    read from, for example a mesh with its material and texture; artwork: the picture that can be painted on
    and reloaded, None if it is not known. Notes and sources are not saved.
    """

    drawing: Drawing
    state: EditState
    revision: int = 0
    path: Path | None = None
    digest: str = ""
    notes: tuple[str, ...] = ()
    sources: tuple[Path, ...] = ()
    artwork: ArtworkFile | None = None

    @property
    def face_order(self) -> Ints | None:
        """Indices of the faces from back to front, (m,) int; None stands for the order of the mesh."""
        state = self.state
        return face_order(self.drawing, state.pins, state.positions, state.crossings)

    @property
    def draw_order(self) -> Ints | CutMesh | None:
        """What is drawn, from back to front: `face_order`, or the mesh cut along its seams."""
        state = self.state
        return draw_order(self.drawing, state.pins, state.positions, state.crossings)

    def with_state(self, state: EditState) -> "Document":
        """This document with another state and the next revision."""
        return replace(self, state=state, revision=self.revision + 1)


def new_document(drawing: Drawing, settings: Settings | None = None) -> Document:
    """A document of a drawing in its rest pose, without pins. Raises InputError on other types."""
    as_instance(drawing, "drawing", Drawing)
    if settings is not None:
        as_instance(settings, "settings", Settings)
    return Document(drawing, EditState((), drawing.mesh.vertices, settings or Settings()))
