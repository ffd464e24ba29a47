"""A point of the drawing that the artist controls."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...geometry.validation import Floats, frozen


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

    def to_json(self) -> dict[str, Any]:
        """The pin as an object of a document or recording; docs/file-format.md describes it."""
        return {
            "id": int(self.id),
            "face": int(self.face),
            "weights": self.weights.tolist(),
            "target": self.target.tolist(),
            **({"depth": int(self.depth)} if self.depth else {}),
            **({"angle": float(self.angle)} if self.angle is not None else {}),
        }
