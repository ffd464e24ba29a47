"""Compiles the solver's loops before they are needed, so that the first drag does not wait for them."""

import numpy as np

from ..geometry.mesh import TriMesh
from .akap.deformer import AkapDeformer

_SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0], [50.0, 50.0]])
_FACES = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


def precompile() -> None:
    """Deform a square and let it settle, which calls every compiled function (see `geometry.jit`).

    Takes seconds on a machine's first run, and a fifth of a second later; may run in a thread of its own.
    """
    mesh = TriMesh(_SQUARE, _FACES)
    deformer = AkapDeformer(mesh, memory=1.0)
    deformer.set_pins(mesh.locate([[10.0, 5.0], [60.0, 70.0]]))
    targets = [[10.0, 5.0], [62.0, 71.0]]
    moved = deformer.step(mesh.vertices, targets).positions
    deformer.step(moved, targets)
