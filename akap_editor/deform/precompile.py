"""Compiles the solver's loops before they are needed, so that the first drag does not wait for them."""

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.operators import to_complex
from .akap.deformer import AkapDeformer
from .akap.preconditioned_cholesky import MIN_HALF_VERTICES
from .akap.rest_energy import SymmetricDirichlet

_SIDE = int(np.sqrt(MIN_HALF_VERTICES)) + 3  # of a square whose interior, too, has factors in half precision
_SMALL_SIDE = 3  # of a square with factors in double precision; vertices on a side


def precompile() -> None:
    """Compile the solver's loops, or load them from the cache on disk, before the first step needs them.

    Takes seconds on a machine's first run, and a fraction of a second later; may run in a thread of its own.
    Without it, the first steps take that time.
    """
    precompile_steps()
    precompile_steps_of_small_meshes()


def precompile_new_mesh() -> None:
    """Compile only what a new mesh needs."""
    AkapDeformer(_square(_SMALL_SIDE), memory=1.0)


def precompile_steps() -> None:
    """Compile what steps need if factors have half precision."""
    _step_square(_SIDE)
    mesh = _square(_SMALL_SIDE)
    n, m = len(mesh.vertices), len(mesh.faces)
    energy, change = SymmetricDirichlet(mesh), np.ones((m, 2), dtype=np.complex128)
    energy.relax(to_complex(mesh.vertices).copy(), change, 1.0, np.zeros(n, dtype=bool))


def precompile_steps_of_small_meshes() -> None:
    """Compile what steps need if factors have double precision."""
    _step_square(_SMALL_SIDE)


def _step_square(side: int) -> None:
    """Make two steps of a square with ``side``² vertices."""
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
