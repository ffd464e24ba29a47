"""Compiles the solver's loops before they are needed, so that the first drag does not wait for them."""

import numpy as np

from ..geometry.killing_matrix import KillingMatrix
from ..geometry.mesh import TriMesh
from ..geometry.operators import to_complex
from .akap.deformer import AkapDeformer
from .akap.flips import count_flipped, is_acceptable
from .akap.killing_field import VertexFrames
from .akap.log_spiral import LogSpirals
from .akap.rest_energy import SymmetricDirichlet
from .fronts import Fronts
from .multifrontal import Matrix, Preconditioner, dot, factorize, iterate, multiply

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


def precompile_loops() -> None:
    """Compile only the loops of a step over faces and edges."""
    mesh = _square()
    n, m = len(mesh.vertices), len(mesh.faces)
    pose, faces = to_complex(mesh.vertices).copy(), mesh.faces.astype(np.uint32)
    matrix, energy = KillingMatrix(mesh), SymmetricDirichlet(mesh)
    matrix.nonzeros(pose)
    VertexFrames(mesh)(pose)
    moved = LogSpirals(mesh).flow(pose, np.full(n, 1.0 + 1.0j))
    is_acceptable(pose, moved, 1.0, faces, np.zeros(m))
    count_flipped(pose, faces)
    _, gradient, columns = energy.evaluate(pose)
    change, _ = energy.direction(columns, gradient)
    energy.value(columns, change, 0.5)
    energy.half_hessian(columns, False, matrix.blocks)
    energy.relax(pose, np.ones((m, 2), dtype=np.complex128), 1.0, np.zeros(n, dtype=bool))


def precompile_factors() -> None:
    """Compile only the solution of linear systems, except exact ones."""
    none = np.zeros(0, dtype=np.int32)
    starts, ends = np.array([0, 2], dtype=np.int32), np.zeros(2, dtype=np.int32)
    fronts = Fronts(  # of one vertex
        starts, ends, none.view(np.uint32), ends, none, ends, none.reshape(0, 3),
        np.array([0, 3], dtype=np.int32), np.array([0, 1, 3], dtype=np.uint32),
        np.array([0, 3], dtype=np.int64), np.zeros(1, dtype=np.int64),
    )  # fmt: skip
    nonzeros, factor = np.array([1.0, 0.0, 1.0]), np.empty(3, dtype=np.uint16)
    front, values = np.empty(4, dtype=np.float32), np.empty(2, dtype=np.float32)
    factorize(fronts, nonzeros, factor, front, front.copy(), 0.0)
    one, earlier = np.ones(1, dtype=np.complex128), np.empty((2, 1), dtype=np.complex128)
    matrix = Matrix(np.zeros(2, dtype=np.uint32), none.view(np.uint32), nonzeros)
    preconditioner = Preconditioner(fronts, factor, one, values, front)
    iterate(preconditioner, matrix, one, one, earlier, 0, 1.0, 1.0, 1, 1, one.copy())
    multiply(matrix, one, one.copy())
    dot(one, one)


def precompile_steps() -> None:
    """Compile what steps need unless they are exact."""
    precompile_loops()
    _step_square(exact=False)


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
