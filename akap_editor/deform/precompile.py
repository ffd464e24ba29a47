"""Compiles the solver's loops before they are needed, so that the first drag does not wait for them."""

import numpy as np

from ..geometry.mesh import TriMesh
from .akap.deformer import AkapDeformer
from .akap.preconditioned_cholesky import MIN_HALF_VERTICES

_SIDE = int(np.sqrt(MIN_HALF_VERTICES)) + 1  # vertices on a side of the larger square


def precompile() -> None:
    """Compile the solver's loops, or load them from the cache on disk, before the first step needs them.

    Takes seconds on a machine's first run, and a fraction of a second later; may run in a thread of its own.
    Without it, the first steps take that time.
    """
    for side in (3, _SIDE):  # factors in double and in half precision
        mesh = _square(side)
        deformer = AkapDeformer(mesh, memory=1.0)
        deformer.set_pins(mesh.locate([[10.0, 5.0], [60.0, 70.0]]))
        targets = [[10.0, 5.0], [62.0, 71.0]]
        moved = deformer.step(mesh.vertices, targets).positions
        deformer.step(moved, targets)


def _square(side: int) -> TriMesh:
    """A square of 100 pixels with ``side``² vertices."""
    x, y = np.meshgrid(np.linspace(0, 100, side), np.linspace(0, 100, side))
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = (
        part.ravel() for part in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1])
    )
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriMesh(np.stack([x.ravel(), y.ravel()], axis=1), faces)
