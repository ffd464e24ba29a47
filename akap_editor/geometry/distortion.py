"""How far a pose is from an isometry, in the paper's measures (section 3.3)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .checks import Floats, as_points
from .mesh import TriMesh
from .operators import jacobians


@dataclass(frozen=True, eq=False)
class Distortion:
    """Area-weighted means over the faces of σ1 σ2 + 1/(σ1 σ2) and of σ1/σ2 + σ2/σ1; 2 is none.

    area, angle: E_area and E_angle (inf where a face has collapsed); flipped: number of faces without a
    positive determinant, whose singular values count by their size; face_area, face_angle: (m,) per face.
    """

    area: float
    angle: float
    flipped: int
    face_area: Floats
    face_angle: Floats


def distortion(mesh: TriMesh, positions: ArrayLike) -> Distortion:
    """Distortion of the map from the rest pose to ``positions`` (n, 2). Raises InputError."""
    pose = as_points(positions, "positions", len(mesh.vertices))
    jacobian = jacobians(mesh, pose)
    determinant = np.linalg.det(jacobian)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        size = np.abs(determinant)
        face_area = size + 1.0 / size
        # σ1/σ2 + σ2/σ1 = (σ1² + σ2²) / (σ1 σ2) = ‖J‖² / |det J|
        face_angle = np.where(size > 0, (jacobian**2).sum(axis=(1, 2)) / size, np.inf)
    weights = mesh.rest_areas / mesh.rest_areas.sum()
    return Distortion(
        area=float(weights @ face_area),
        angle=float(weights @ face_angle),
        flipped=int((determinant <= 0).sum()),
        face_area=face_area,
        face_angle=face_angle,
    )
