"""Distortion of a pose: how far the map from the rest pose is from an isometry (paper, section 3.3)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .mesh import TriMesh, signed_areas
from .validation import Floats, as_instance, as_points


@dataclass(frozen=True, eq=False)
class Distortion:
    """The paper's two measures, from the singular values σ₁, σ₂ of the map's Jacobian on each face.

    area, angle: E_area and E_angle, the means over the rest area of σ₁ σ₂ + 1/(σ₁ σ₂) and of
    σ₁/σ₂ + σ₂/σ₁; 2 for an isometry, infinity if a face has collapsed.
    flipped: number of faces whose determinant is not positive; the measures take its absolute value.
    face_area, face_angle: (m,) both measures on each face.
    face_determinant: (m,) area of each face divided by its rest area.
    """

    area: float
    angle: float
    flipped: int
    face_area: Floats
    face_angle: Floats
    face_determinant: Floats


def distortion(mesh: TriMesh, positions: ArrayLike) -> Distortion:
    """Measure the map from the rest pose to ``positions`` (n, 2). Raises InputError."""
    as_instance(mesh, "mesh", TriMesh)
    pose = as_points(positions, "positions", len(mesh.vertices))
    determinant = signed_areas(pose, mesh.faces) / mesh.rest_areas
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        size = np.abs(determinant)
        face_area = size + 1.0 / size
        # σ₁/σ₂ + σ₂/σ₁ = (σ₁² + σ₂²) / (σ₁ σ₂) = ‖J‖² / |det J|
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


def _squared_norms(mesh: TriMesh, pose: Floats) -> Floats:
    """‖J‖² of each face, (m,), from J [u v] = [U V]: edges u, v of a face at rest, and U, V in the pose."""
    (uu, uv, vv), (UU, UV, VV) = _edge_products(mesh.vertices, mesh), _edge_products(pose, mesh)
    return (UU * vv - 2 * UV * uv + VV * uu) / (4 * mesh.rest_areas**2)


def _edge_products(positions: Floats, mesh: TriMesh) -> tuple[Floats, Floats, Floats]:
    """u·u, u·v and v·v, (m,) each, of the edges u and v that leave the first corner of each face."""
    a, b, c = (positions[:, 0] + 1j * positions[:, 1])[mesh.faces.T]
    u, v = b - a, c - a
    return (u * u.conj()).real, (u * v.conj()).real, (v * v.conj()).real
