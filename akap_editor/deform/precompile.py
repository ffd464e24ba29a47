"""Compiles the solver's loops before they are needed, so that the first drag does not wait for them."""

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.operators import to_complex
from .akap.deformer import AkapDeformer
from .akap.rest_energy import SymmetricDirichlet

_SIDE = 3  # of the square that is deformed, vertices


def precompile() -> None:
    """Compile the solver's loops, or load them from the cache on disk, before the first step needs them.

    Takes seconds on a machine's first run, and a fraction of a second later; may run in a thread of its own.
    Without it, the first steps take that time.
    """
    precompile_steps()
    precompile_exact_steps()


def precompile_new_mesh() -> None:
    """Compile only what a new mesh needs."""
    AkapDeformer(_square(), memory=1.0)


def precompile_steps() -> None:
    """Compile what steps need unless they are exact."""
    _step_square(exact=False)
    mesh = _square()
    n, m = len(mesh.vertices), len(mesh.faces)
    energy, change = SymmetricDirichlet(mesh), np.ones((m, 2), dtype=np.complex128)
    energy.relax(to_complex(mesh.vertices).copy(), change, 1.0, np.zeros(n, dtype=bool))


def precompile_exact_steps() -> None:
    """Compile what steps need in double precision: if they are exact, or material is extremely stiff."""
    _step_square(exact=True)


def _step_square(exact: bool) -> None:
    """Make two steps of a square."""
    mesh = _square()
    deformer = AkapDeformer(mesh, memory=1.0, exact=exact)
    deformer.set_pins(mesh.locate([[10.0, 5.0], [60.0, 70.0]]))
    targets = [[10.0, 5.0], [62.0, 71.0]]
    moved = deformer.step(mesh.vertices, targets).positions
    deformer.step(moved, targets)


def _square() -> TriMesh:
    """A square of 100 pixels with ``_SIDE``² vertices."""
    x, y = np.meshgrid(np.linspace(0, 100, _SIDE), np.linspace(0, 100, _SIDE))
    corner = np.arange(_SIDE**2).reshape(_SIDE, _SIDE)
    a, b, c, d = (
        part.ravel() for part in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1])
    )
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriMesh(np.stack([x.ravel(), y.ravel()], axis=1), faces)
