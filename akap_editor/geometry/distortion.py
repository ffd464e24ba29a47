"""How far a pose is from an isometry, in the paper's measures (section 3.3)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .mesh import TriMesh, signed_areas
from .validation import Floats, as_points


@dataclass(frozen=True, eq=False)
class Distortion:
    """Area-weighted means over the faces of σ1 σ2 + 1/(σ1 σ2) and of σ1/σ2 + σ2/σ1; 2 is none.

    area, angle: E_area and E_angle (inf where a face has collapsed); flipped: number of faces without a
    positive determinant, whose singular values count by their size; face_area, face_angle: (m,) per face;
    face_determinant: (m,) the area by that at rest.
    """

    area: float
    angle: float
    flipped: int
    face_area: Floats
    face_angle: Floats
    face_determinant: Floats


def _squared_norms(mesh: TriMesh, pose: Floats) -> Floats:
    """‖J‖² of each face, (m,): J [u v] = [U V] with two edges u, v of a face at rest and U, V in the pose."""
    (uu, uv, vv), (UU, UV, VV) = _edge_products(mesh.vertices, mesh), _edge_products(pose, mesh)
    return (UU * vv - 2 * UV * uv + VV * uu) / (4 * mesh.rest_areas**2)


def _edge_products(positions: Floats, mesh: TriMesh) -> tuple[Floats, Floats, Floats]:
    """u·u, u·v and v·v of the edges u and v from the first corner of each face, (m,) each."""
    a, b, c = (positions[:, 0] + 1j * positions[:, 1])[mesh.faces.T]
    u, v = b - a, c - a
    return (u * u.conj()).real, (u * v.conj()).real, (v * v.conj()).real


def distortion(mesh: TriMesh, positions: ArrayLike) -> Distortion:
    """Distortion of the map from the rest pose to ``positions`` (n, 2). Raises InputError."""
    pose = as_points(positions, "positions", len(mesh.vertices))
    determinant = signed_areas(pose, mesh.faces) / mesh.rest_areas
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        size = np.abs(determinant)
        face_area = size + 1.0 / size
        # σ1/σ2 + σ2/σ1 = (σ1² + σ2²) / (σ1 σ2) = ‖J‖² / |det J|
        face_angle = np.where(size > 0, _squared_norms(mesh, pose) / size, np.inf)
    weights = mesh.rest_areas / mesh.rest_areas.sum()
    return Distortion(
        area=float(weights @ face_area),
        angle=float(weights @ face_angle),
        flipped=int((determinant <= 0).sum()),
        face_area=face_area,
        face_angle=face_angle,
        face_determinant=determinant,
    )
