"""Bounds on the areas of a pose's faces, reached by moving their corners as little as possible."""

import numpy as np

from .mesh import TriMesh, signed_areas
from .operators import to_complex, to_points
from .validation import Complexes, Floats, Ints

_RELAXATION = 1.5  # corners move by this times the mean: some of their faces would rather keep them
_MAX_ROUNDS = 200  # of bounding; a few are usual
_AREA_TOLERANCE = 0.003  # share of a bound by which an area may exceed it


def grow_faces(pose: Complexes, corners: Ints, missing: Floats, least: Floats) -> Complexes:
    """Move the corners of some faces along the gradients of their areas, so that these grow.

    pose: (n,) complex; corners: (k, 3) vertices of the faces; missing: (k,) areas to gain, negative to
    shrink; least: (k,) lower bounds of the squared gradients, for faces that have collapsed.
    A corner of several faces moves by the mean of what they ask for, times a relaxation factor.
    """
    gradients = 0.5j * (pose[corners[:, [2, 0, 1]]] - pose[corners[:, [1, 2, 0]]])
    squares = np.maximum((np.abs(gradients) ** 2).sum(axis=1), least)
    moves = (missing / squares)[:, None] * gradients
    n, vertices = len(pose), corners.ravel()
    total = np.bincount(vertices, moves.real.ravel(), n) + 1j * np.bincount(vertices, moves.imag.ravel(), n)
    return pose + _RELAXATION * total / np.maximum(np.bincount(vertices, minlength=n), 1)


def worst_area_factor(mesh: TriMesh, pose: Floats) -> float:
    """The largest factor, at least 1, by which a face has grown or shrunk; infinity if one is flipped.

    pose: (n, 2).
    """
    ratios = signed_areas(pose, mesh.faces) / mesh.rest_areas
    low = float(ratios.min())
    return max(1.0 / low, float(ratios.max())) if low > 0 else float("inf")


def bound_face_areas(mesh: TriMesh, pose: Floats, max_factor: float) -> Floats:
    """Bring faces that have grown or shrunk by more than ``max_factor`` back to that bound.

    Returns the pose (n, 2) itself if all faces are within the bounds.
    """
    least, greatest = mesh.rest_areas / max_factor, mesh.rest_areas * max_factor
    areas = signed_areas(pose, mesh.faces)
    if (areas >= (1 - _AREA_TOLERANCE) * least).all() and (areas <= (1 + _AREA_TOLERANCE) * greatest).all():
        return pose
    bounded = to_complex(pose)
    for _ in range(_MAX_ROUNDS):
        outside = np.flatnonzero((areas < least) | (areas > greatest))
        goals = np.clip(areas[outside], least[outside], greatest[outside])
        missing = goals - areas[outside]
        if (np.abs(missing) <= _AREA_TOLERANCE * goals).all():
            break
        bounded = grow_faces(bounded, mesh.faces[outside], missing, least[outside])
        areas = signed_areas(to_points(bounded), mesh.faces)
    return to_points(bounded)
