"""Parts that bend less: factors of the faces' energies, painted with a soft brush."""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, as_number, as_points

MIN_STIFFNESS, MAX_STIFFNESS = 1.0, 1000.0  # 1 bends as the drawing does by itself
_FULL_STRENGTH = 0.5  # share of a brush's radius within which it works fully
_DECIMALS = 2  # decimals of a factor: few, so that files and recordings stay small


def as_stiffness(values: ArrayLike, faces: int) -> Floats:
    """Factors (m,) float64 of so many faces. Raises InputError where they are not from 1 to 1000."""
    try:
        factors = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"stiffness: expected {faces} numbers, got something else") from error
    if factors.shape != (faces,):
        raise InputError(f"stiffness: expected {faces} numbers, got shape {factors.shape}")
    outside = factors[~((factors >= MIN_STIFFNESS) & (factors <= MAX_STIFFNESS))]
    if len(outside):
        expected = f"factors from {MIN_STIFFNESS:g} to {MAX_STIFFNESS:g}"
        raise InputError(f"stiffness: expected {expected}, got {outside[0]:g}")
    return factors


def stroke_coverage(mesh: TriMesh, dabs: ArrayLike, radius: float) -> Floats:
    """How much of each face, (m,) from 0 to 1, brushes at ``dabs`` (d, 2) with this radius cover at rest.

    All of it near a dab, softly less towards the rim. A brush is never smaller than the face it is on.
    Raises InputError.
    """
    radius = as_number(radius, "radius", 0.0, np.inf)
    x, y, sizes = _faces(mesh)
    reach, result = max(radius, sizes.max()), np.zeros(len(sizes))
    for dab_x, dab_y in as_points(dabs, "dabs").tolist():
        dx, dy = x - dab_x, y - dab_y
        near = np.flatnonzero((np.abs(dx) <= reach) & (np.abs(dy) <= reach))
        away = np.hypot(dx[near], dy[near])
        share = (1.0 - away / np.maximum(radius, sizes[near])) / (1.0 - _FULL_STRENGTH)
        result[near] = np.maximum(result[near], np.clip(share, 0.0, 1.0))
    return result * result * (3.0 - 2.0 * result)


@lru_cache(maxsize=2)
def _faces(mesh: TriMesh) -> tuple[Floats, Floats, Floats]:
    """Centers of the faces at rest, x (m,) and y (m,), and how far they reach from there, (m,)."""
    corners = mesh.vertices[mesh.faces]
    centers = corners.mean(axis=1)
    sizes = np.sqrt(((corners - centers[:, None]) ** 2).sum(axis=2).max(axis=1))
    return centers[:, 0].copy(), centers[:, 1].copy(), sizes


def apply_stroke(stiffness: Floats | None, covered: Floats, factor: float) -> Floats | None:
    """Factors (m,) after a stroke with ``factor`` that covers faces so far, (m,); None is 1 everywhere.

    What is half covered comes half-way, in equal ratios. A factor of 1 erases. Raises InputError.
    """
    factor = as_number(factor, "factor", MIN_STIFFNESS, MAX_STIFFNESS)
    before = np.zeros(len(covered)) if stiffness is None else np.log(stiffness)
    after = before + covered * (np.log(factor) - before)
    factors = np.clip(np.round(np.exp(after), _DECIMALS), MIN_STIFFNESS, MAX_STIFFNESS)
    factors = np.where(covered > 0, factors, 1.0 if stiffness is None else stiffness)
    return None if (factors == 1.0).all() else factors
