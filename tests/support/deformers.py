"""Deformers with pins, and poses to start from."""

import numpy as np

from akap_editor.deform.akap.deformer import AkapDeformer


def akap_with_pins(mesh, points, **parameters):
    """An `AkapDeformer` whose pins are ``points``."""
    deformer = AkapDeformer(mesh, **parameters)
    deformer.set_pins(points)
    return deformer


def bent_pose(mesh):
    """A pose (n, 2) without flips that is no rigid motion of the rest pose."""
    x, y = mesh.vertices.T
    return np.stack([x + 8 * np.sin(y / 40), 1.1 * y - 6 * np.cos(x / 50)], axis=1)
