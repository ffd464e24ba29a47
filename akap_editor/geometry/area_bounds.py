"""Poses whose faces are given other areas, by moves of their corners that are as short as possible."""

import numpy as np

from .mesh import TriMesh, signed_areas
from .operators import to_complex, to_points
from .validation import Complexes, Floats, Ints

_FIRMLY = 1.5  # times its mean: how far a corner goes, since some faces want it to stay
_ROUNDS = 200  # most rounds of bounding, a few are usual
_ENOUGH = 0.003  # share of an area by which it may be beyond its bound


def grow_faces(pose: Complexes, corners: Ints, missing: Floats, least: Floats) -> Complexes:
    """``pose`` (n,) with the corners (k, 3) of some faces moved, so that these come nearer to their areas.

    missing: (k,) by how much each area is to grow; least: (k,) what their slopes count at least, for faces
    without a size. Where faces share a corner it moves by the mean of what they want, somewhat firmly.
    """
    slopes = 0.5j * (pose[corners[:, [2, 0, 1]]] - pose[corners[:, [1, 2, 0]]])  # of the area, by corner
    size = np.maximum((np.abs(slopes) ** 2).sum(axis=1), least)
    moves = (missing / size)[:, None] * slopes
    n, at = len(pose), corners.ravel()
    total = np.bincount(at, moves.real.ravel(), n) + 1j * np.bincount(at, moves.imag.ravel(), n)
    return pose + _FIRMLY * total / np.maximum(np.bincount(at, minlength=n), 1)


def worst_area_factor(mesh: TriMesh, pose: Floats) -> float:
    """The factor, 1 or more, by which the worst face has shrunk or grown; infinite where one is flipped."""
    ratios = signed_areas(pose, mesh.faces) / mesh.rest_areas
    low = float(ratios.min())
    return max(1.0 / low, float(ratios.max())) if low > 0 else float("inf")


def bound_face_areas(mesh: TriMesh, pose: Floats, most: float) -> Floats:
    """The pose (n, 2) with the few faces mended that have shrunk or grown by more than ``most``, a factor."""
    least, greatest = mesh.rest_areas / most, mesh.rest_areas * most
    areas = signed_areas(pose, mesh.faces)
    if (areas >= (1 - _ENOUGH) * least).all() and (areas <= (1 + _ENOUGH) * greatest).all():
        return pose
    places = to_complex(pose)
    for _ in range(_ROUNDS):
        beyond = np.flatnonzero((areas < least) | (areas > greatest))
        goals = np.clip(areas[beyond], least[beyond], greatest[beyond])
        missing = goals - areas[beyond]
        if (np.abs(missing) <= _ENOUGH * goals).all():
            break
        places = grow_faces(places, mesh.faces[beyond], missing, least[beyond])
        areas = signed_areas(to_points(places), mesh.faces)
    return to_points(places)
