"""The contract of edits: values that change a state, and are written to recordings and read back."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, ClassVar, Self

import numpy as np

from ....errors import InputError
from ....geometry.mesh import TriMesh
from ....geometry.validation import Floats, Ints, as_points
from ....layers.layer_view import LayerView
from ....words import tr
from ...document.crossings import as_crossings, crossings_in_pose
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
    JOINTS = auto()  # another deformer; the drawing moves until its joints are closed
    POSE = auto()  # another pose, not reached by steps
    MESH = auto()  # another mesh; the drawing settles on it
    DOCUMENT = auto()  # anything else


@dataclass(frozen=True)
class ReplayTarget:
    """The drawing that a recording is replayed on.

    mesh: of the drawing when the replay starts; same_mesh: whether the recording started with an equal mesh;
    scale: size of the drawing's picture divided by the size of the recorded one.
    """

    mesh: TriMesh
    same_mesh: bool
    scale: float

    def points(self, values: Any, name: str, count: int) -> Floats:
        """Recorded points as (count, 2) pixels of this drawing. Raises InputError on bad ones."""
        return self.scale * as_points(values, name, count)

    def pose(self, values: Any, vertices: int) -> Floats:
        """A recorded pose (vertices, 2) of this drawing. Raises InputError if it is one of another mesh."""
        if not self.same_mesh:
            raise InputError(tr("a pose fits only the mesh that it was made on"))
        return as_points(values, "positions", vertices)


class Edit(ABC):
    """A change of the state, as an immutable value.

    name: of its event in recordings ("do"); fields: names of the values that the event must have; effect: on
    the motion; may_overlap_step: whether it can be applied while a step is computed.
    """

    name: ClassVar[str]
    fields: ClassVar[tuple[str, ...]] = ()
    effect: ClassVar[Effect] = Effect.NONE
    may_overlap_step: ClassVar[bool] = False

    @abstractmethod
    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        """The state after the edit; the same object if nothing changes.

        Raises InputError on values that do not fit the state or the drawing.
        """

    def to_json(self, drawing: Drawing) -> Json:
        """The values of the edit's event in a recording; ``drawing`` is the one after the edit."""
        return {name: getattr(self, name) for name in self.fields}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        """Read the edit of a recorded event; ``drawing`` is the current one of the replay.

        Raises InputError on values that do not fit it; KeyError, TypeError or ValueError on malformed values.
        """
        return cls(**{name: event[name] for name in cls.fields})


def positions_to_json(positions: Any) -> Json:
    """The optional pose (n, 2) of an edit, as a value of its event."""
    return {} if positions is None else {"positions": np.asarray(positions, dtype=np.float64).tolist()}


def positions_from_json(event: Json, target: ReplayTarget, drawing: Drawing) -> Floats | None:
    """The optional pose (n, 2) of an event, None if absent. Raises InputError on one of another mesh."""
    if "positions" not in event:
        return None
    return target.pose(event["positions"], len(drawing.mesh.vertices))


def crossings_to_json(crossings: Any) -> Json:
    """The optional crossings (s, 2) of an edit, as a value of its event; absent if there are none."""
    has_any = crossings is not None and len(crossings)
    return {"crossings": np.asarray(crossings, dtype=np.int32).tolist()} if has_any else {}


def crossings_from_json(event: Json) -> Ints | None:
    """The optional crossings (s, 2) of an event, None if absent. Raises InputError."""
    return as_crossings(event["crossings"]) if "crossings" in event else None


def layer_view_to_json(view: LayerView) -> Json:
    """Which layers are visible, and their order, as a value of an event."""
    return {"visible": [number for number, on in enumerate(view.visible) if on], "order": [*view.order]}


def layer_view_from_json(value: Json) -> LayerView:
    """The value that `layer_view_to_json` made. Raises InputError."""
    visible, order = value["visible"], value["order"]
    count = len(order)
    for name, numbers in (("visible", visible), ("order", order)):
        if any(type(number) is not int or not 0 <= number < count for number in numbers):
            raise InputError(
                tr(
                    "{name}: expected numbers of {count} layers, got {numbers!r:.60}",
                    name=name,
                    count=count,
                    numbers=numbers,
                )
            )
    chosen = set(visible)
    view = LayerView(tuple(number in chosen for number in range(count)), tuple(order))
    if not view.fits(count):
        raise InputError(
            tr("order: expected each of {count} layers once, got {order!r:.60}", count=count, order=order)
        )
    return view


def pose_and_crossings(
    positions: Any, crossings: Any, state: EditState, drawing: Drawing
) -> tuple[Floats, Ints]:
    """The optional pose (n, 2) of an edit with its crossings (s, 2), by default the current ones.

    Of a pose without crossings they follow from the current ones. Raises InputError on bad values.
    """
    if positions is None:
        return state.positions, state.crossings
    mesh = drawing.mesh
    pose = as_pose(positions, "positions", len(state.positions))
    if crossings is None:
        crossings = crossings_in_pose(mesh, state.pins, state.positions, state.crossings, pose)
    return pose, as_crossings(crossings, len(mesh.faces))
