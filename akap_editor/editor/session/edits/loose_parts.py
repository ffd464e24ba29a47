"""Edits of loose parts, which swing about the pose."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from ....deform.follow_through import DEFAULT_BOUNCE, DEFAULT_SPEED
from ....errors import InputError
from ....geometry.validation import as_points
from ....words import tr
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.rig.loose_parts import make_loose_parts, painted_loose
from ...document.stiffness import stroke_coverage
from .edit import Edit, Json, ReplayTarget


@dataclass(frozen=True, eq=False)
class PaintLoose(Edit):
    """Make the faces loose that a stroke of a brush covers, or fast again; no vertex moves.

    dabs: (d, 2) centers of the brush in the rest pose, pixels; radius: of the brush, pixels; layer: the
    number of the only layer that is painted, None for all.
    """

    name = "paint-loose"
    fields = ("dabs", "radius", "erases")

    dabs: ArrayLike
    radius: float
    erases: bool = False
    layer: int | None = None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        if type(self.erases) is not bool:
            raise InputError(tr("erases: expected true or false, got {value!r}", value=self.erases))
        coverage = stroke_coverage(drawing.mesh, self.dabs, self.radius, self.layer)
        loose = painted_loose(state.loose, coverage, self.erases)
        return state if loose is state.loose else replace(state, loose=loose)

    def to_json(self, drawing: Drawing) -> Json:
        layer = {} if self.layer is None else {"layer": self.layer}
        dabs = as_points(self.dabs, "dabs").tolist()
        return {"dabs": dabs, "radius": self.radius, "erases": self.erases, **layer}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        dabs = target.points(event["dabs"], "dabs", len(event["dabs"]))
        layer = int(event["layer"]) if "layer" in event else None
        return cls(dabs, target.scale * float(event["radius"]), event["erases"], layer)


@dataclass(frozen=True, eq=False)
class SetLoose(Edit):
    """Make exactly the faces with these indices loose, with a speed and a bounce; no vertex moves."""

    name = "loose"
    fields = ("faces", "speed", "bounce")

    faces: ArrayLike
    speed: float = DEFAULT_SPEED
    bounce: float = DEFAULT_BOUNCE

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        loose = make_loose_parts(self.faces, len(drawing.mesh.faces), self.speed, self.bounce)
        return state if loose is None and state.loose is None else replace(state, loose=loose)

    def to_json(self, drawing: Drawing) -> Json:
        faces = np.asarray(self.faces).tolist()
        return {"faces": faces, "speed": float(self.speed), "bounce": float(self.bounce)}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        if len(event["faces"]) and not target.same_mesh:
            raise InputError(tr("loose parts fit only the mesh that they were made on"))
        return cls(event["faces"], event["speed"], event["bounce"])


@dataclass(frozen=True)
class SetSwing(Edit):
    """Let the loose parts swing with another speed and bounce; nothing changes without any."""

    name = "swing"
    fields = ("speed", "bounce")

    speed: float
    bounce: float

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        loose = state.loose
        if loose is None or (loose.speed, loose.bounce) == (self.speed, self.bounce):
            return state
        return replace(state, loose=replace(loose, speed=self.speed, bounce=self.bounce))

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls(event["speed"], event["bounce"])
