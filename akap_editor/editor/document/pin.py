"""Pins: the points of a drawing that the artist controls."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...geometry.mesh import MeshPoints
from ...geometry.validation import Floats, as_floats


@dataclass(frozen=True, eq=False)
class Pin:
    """A point of the drawing that the artist controls; arrays are copied and read-only.

    id: unique in its document; face, weights: its place on the mesh, weights (3,) float64 barycentric;
    target: (2,) float64, where it is to go, pixels; depth: higher is nearer to the viewer, see
    `crossings.face_order`; angle: to which the drawing around the pin is to rotate, radians from the rest
    pose, clockwise on the screen; None lets it rotate freely.
    """

    id: int
    face: int
    weights: Floats
    target: Floats
    depth: int = 0
    angle: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "weights", as_floats(self.weights, "weights"))
        object.__setattr__(self, "target", as_floats(self.target, "target"))

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


def pin_points(pins: Sequence[Pin]) -> MeshPoints:
    """The places of pins on the mesh, (k,), in order. Raises InputError on weights that do not sum to 1."""
    return MeshPoints(
        np.array([pin.face for pin in pins], dtype=np.int32),
        np.array([pin.weights for pin in pins]).reshape(-1, 3),
    )
