"""Stiffness: factors by which faces deform less, painted with a soft brush."""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, as_number, as_numbers, as_points

MIN_STIFFNESS, MAX_STIFFNESS = 1.0, 1000.0  # factors of the energy of a face; 1 leaves it as it is
_FULL_STRENGTH = 0.5  # share of a brush's radius inside which a dab covers fully
_DECIMALS = 2  # of a factor: few, so that files and recordings stay small


def as_stiffness(values: ArrayLike, faces: int) -> Floats:
    """``values`` as factors (faces,) float64. Raises InputError on another shape or factors out of range."""
    return as_numbers(values, "stiffness", faces, MIN_STIFFNESS, MAX_STIFFNESS)


def stroke_coverage(mesh: TriMesh, dabs: ArrayLike, radius: float, layer: int | None = None) -> Floats:
    """How much of each face of the rest pose a stroke covers, (m,) from 0 to 1.

    dabs: (d, 2) centers of the brush, pixels; radius: of the brush, pixels, but at least that of the face
    under it; layer: the only one that it covers, None for all. Coverage falls off smoothly towards the edge
    of a dab. Raises InputError on bad arguments.
    """
    radius = as_number(radius, "radius", 0.0, np.inf)
    x, y, face_radii = _face_discs(mesh)
    reach, coverage = max(radius, face_radii.max()), np.zeros(len(face_radii))
    for dab_x, dab_y in as_points(dabs, "dabs").tolist():
        dx, dy = x - dab_x, y - dab_y
        near = np.flatnonzero((np.abs(dx) <= reach) & (np.abs(dy) <= reach))
        distances = np.hypot(dx[near], dy[near])
        falloff = (1.0 - distances / np.maximum(radius, face_radii[near])) / (1.0 - _FULL_STRENGTH)
        coverage[near] = np.maximum(coverage[near], np.clip(falloff, 0.0, 1.0))
    if layer is not None:
        coverage[mesh.face_layers != layer] = 0.0
    return coverage * coverage * (3.0 - 2.0 * coverage)


@lru_cache(maxsize=2)
def _face_discs(mesh: TriMesh) -> tuple[Floats, Floats, Floats]:
    """Centroids x and y, (m,) each, of the rest faces, and the distances to their farthest corners, (m,)."""
    corners = mesh.vertices[mesh.faces]
    centers = corners.mean(axis=1)
    radii = np.sqrt(((corners - centers[:, None]) ** 2).sum(axis=2).max(axis=1))
    return centers[:, 0].copy(), centers[:, 1].copy(), radii


def apply_stroke(stiffness: Floats | None, coverage: Floats, factor: float) -> Floats | None:
    """Factors (m,) after a stroke that covers faces by ``coverage`` (m,); None is 1 everywhere.

    Logarithms of factors are blended, so a face that is half covered gets the geometric mean. A factor of 1
    erases. Raises InputError on a factor out of range.
    """
    factor = as_number(factor, "factor", MIN_STIFFNESS, MAX_STIFFNESS)
    log_before = np.zeros(len(coverage)) if stiffness is None else np.log(stiffness)
    log_after = log_before + coverage * (np.log(factor) - log_before)
    factors = np.clip(np.round(np.exp(log_after), _DECIMALS), MIN_STIFFNESS, MAX_STIFFNESS)
    factors = np.where(coverage > 0, factors, 1.0 if stiffness is None else stiffness)
    return None if (factors == 1.0).all() else factors
