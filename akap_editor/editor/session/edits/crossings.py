"""Edits of what passes in front where the drawing overlaps itself."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError
from ....words import tr
from ...document.crossings import as_crossings, crossings_with_limb
from ...document.document import EditState
from ...document.drawing import Drawing
from .edit import Edit, Json, ReplayTarget


@dataclass(frozen=True)
class OrderLimb(Edit):
    """Bring the limb of some pins in front of all that it overlaps, or send it behind.

    The limb is what is nearer to these pins than to any other. It stays there as long as the overlap lasts.
    """

    name = "limb"
    fields = ("pins", "front")

    pins: Sequence[int]
    front: bool

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        unknown = set(self.pins) - {pin.id for pin in state.pins}
        if unknown or type(self.front) is not bool:
            raise InputError(
                tr(
                    "limb: expected ids of pins, got {pins}; front {front!r}",
                    pins=sorted(self.pins),
                    front=self.front,
                )
            )
        if not self.pins:
            return state
        mesh, pose = drawing.mesh, state.positions
        crossings = crossings_with_limb(mesh, state.pins, pose, state.crossings, self.pins, self.front)
        return state if crossings is state.crossings else replace(state, crossings=crossings)

    def to_json(self, drawing: Drawing) -> Json:
        return {"pins": [int(pin) for pin in self.pins], "front": self.front}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls([int(pin) for pin in event["pins"]], event["front"])


@dataclass(frozen=True, eq=False)
class SetCrossings(Edit):
    """Set all crossings (s, 2), see `EditState`; in a recording, those of the document that was opened."""

    name = "crossings"
    fields = ("crossings",)

    crossings: ArrayLike

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        crossings = as_crossings(self.crossings, len(drawing.mesh.faces))
        if np.array_equal(crossings, state.crossings):
            return state
        return replace(state, crossings=crossings)

    def to_json(self, drawing: Drawing) -> Json:
        return {"crossings": np.asarray(self.crossings, dtype=np.int32).tolist()}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        if not target.same_mesh:
            raise InputError(tr("crossings fit only the mesh that they were made on"))
        return cls(event["crossings"])
