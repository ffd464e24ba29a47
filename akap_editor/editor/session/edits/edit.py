"""The contract of edits: values that change a state, and are written to recordings and read back."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, ClassVar, Self

import numpy as np

from ....errors import InputError
from ....geometry.mesh import TriMesh
from ....geometry.validation import Floats, as_points
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.named_poses import as_pose

Json = dict[str, Any]


class Effect(Enum):
    """What an edit means for the motion of the drawing."""

    NONE = auto()  # the motion goes on
    TARGETS = auto()  # the drawing starts to move
    PINS = auto()  # other pins; no vertex moves
    METHOD = auto()  # another deformer; no vertex moves
    POSE = auto()  # another pose, not reached by steps
    DOCUMENT = auto()  # anything else, for example another mesh


@dataclass(frozen=True)
class ReplayTarget:
    """The drawing that a recording is replayed on.

    mesh: the one at the start; same_mesh: whether the recording was made on it; scale: the size of its
    picture divided by that of the recorded one.
    """

    mesh: TriMesh
    same_mesh: bool
    scale: float

    def points(self, values: Any, name: str, count: int) -> Floats:
        """Recorded points (count, 2) in pixels of this drawing. Raises InputError."""
        return self.scale * as_points(values, name, count)

    def pose(self, values: Any, vertices: int) -> Floats:
        """A recorded pose (vertices, 2). Raises InputError if it was made on another mesh."""
        if not self.same_mesh:
            raise InputError("a pose fits only the mesh that it was made on")
        return as_points(values, "positions", vertices)


class Edit(ABC):
    """A change of the state as a value.

    name: in recordings ("do"); fields: the values that a recorded event must have; effect: on the motion;
    may_overlap_step: whether it can be applied while a step is computed, so that the step need not finish.
    """

    name: ClassVar[str]
    fields: ClassVar[tuple[str, ...]] = ()
    effect: ClassVar[Effect] = Effect.NONE
    may_overlap_step: ClassVar[bool] = False

    @abstractmethod
    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        """The state after the edit; the same object if it changes nothing. Raises InputError."""

    def to_json(self, drawing: Drawing) -> Json:
        """The values of the recorded event; ``drawing`` is the one after the edit."""
        return {name: getattr(self, name) for name in self.fields}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        """Read a recorded event for the current drawing of a replay.

        Raises InputError on values that do not fit it, and KeyError, TypeError and ValueError on malformed
        ones.
        """
        return cls(**{name: event[name] for name in cls.fields})


def positions_to_json(positions: Any) -> Json:
    """The optional pose (n, 2) of an edit, as an entry of its recorded event."""
    return {} if positions is None else {"positions": np.asarray(positions, dtype=np.float64).tolist()}


def positions_from_json(event: Json, target: ReplayTarget, drawing: Drawing) -> Floats | None:
    """The optional pose (n, 2) of a recorded event. Raises InputError."""
    if "positions" not in event:
        return None
    return target.pose(event["positions"], len(drawing.mesh.vertices))


def pose_or_current(positions: Any, state: EditState) -> Floats:
    """The optional pose (n, 2) of an edit, by default that of the state. Raises InputError."""
    return state.positions if positions is None else as_pose(positions, "positions", len(state.positions))
