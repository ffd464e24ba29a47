"""Edits of the deformation method and of stiffness."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError
from ....geometry.validation import as_points
from ....words import tr
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.settings import Settings
from ...document.stiffness import apply_stroke, as_stiffness, stroke_coverage
from .edit import Edit, Effect, Json, ReplayTarget


@dataclass(frozen=True)
class SetSettings(Edit):
    """Deform by another method or other parameters; no vertex moves."""

    name = "settings"
    fields = ("method", "parameters")
    effect = Effect.METHOD

    settings: Settings

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        return replace(state, settings=self.settings)

    def to_json(self, drawing: Drawing) -> Json:
        return self.settings.to_json()

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        settings = Settings.from_json(event)
        settings.check()
        return cls(settings)


@dataclass(frozen=True, eq=False)
class SetStiffness(Edit):
    """Stiffen faces by factors (m,) from 1 to 1000; None is 1 everywhere. No vertex moves."""

    name = "stiffness"
    fields = ("factors",)
    effect = Effect.METHOD

    factors: ArrayLike | None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        factors = None if self.factors is None else as_stiffness(self.factors, len(drawing.mesh.faces))
        return replace(state, stiffness=factors)

    def to_json(self, drawing: Drawing) -> Json:
        return {"factors": None if self.factors is None else np.asarray(self.factors, dtype=float).tolist()}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        if event["factors"] is not None and not target.same_mesh:
            raise InputError(tr("stiffness fits only the mesh that it was made on"))
        return cls(event["factors"])


@dataclass(frozen=True, eq=False)
class PaintStiffness(Edit):
    """Stiffen the faces that a stroke of a brush covers; no vertex moves.

    dabs: (d, 2) centers of the brush in the rest pose, pixels; radius: of the brush, pixels; factor: from 1,
    which erases, to 1000; layer: the number of the only layer that is painted, None for all.
    """

    name = "paint"
    fields = ("dabs", "radius", "factor")
    effect = Effect.METHOD

    dabs: ArrayLike
    radius: float
    factor: float
    layer: int | None = None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        coverage = stroke_coverage(drawing.mesh, self.dabs, self.radius, self.layer)
        return replace(state, stiffness=apply_stroke(state.stiffness, coverage, self.factor))

    def to_json(self, drawing: Drawing) -> Json:
        layer = {} if self.layer is None else {"layer": self.layer}
        dabs = as_points(self.dabs, "dabs").tolist()
        return {"dabs": dabs, "radius": self.radius, "factor": self.factor, **layer}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        dabs = target.points(event["dabs"], "dabs", len(event["dabs"]))
        layer = int(event["layer"]) if "layer" in event else None
        return cls(dabs, target.scale * float(event["radius"]), event["factor"], layer)
