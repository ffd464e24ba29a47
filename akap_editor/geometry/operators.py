"""Differential operators of piecewise linear functions on a triangle mesh.

In formulas a point or vector (x, y) is the complex number x + iy, as in the paper's section 2.3.
"""

import numpy as np
from scipy.sparse import csr_array

from .mesh import TriMesh, signed_areas
from .validation import Complexes, Floats, Ints

_NEXT, _AFTER = [1, 2, 0], [2, 0, 1]  # the other two corners of a face, seen from each


def to_complex(points: Floats) -> Complexes:
    """(n, 2) float64 as (n,) complex128; a view where the array is contiguous."""
    return np.ascontiguousarray(points).view(np.complex128)[:, 0]


def to_points(values: Complexes) -> Floats:
    """(n,) complex128 as (n, 2) float64; a view where the array is contiguous."""
    return np.ascontiguousarray(values).view(np.float64).reshape(-1, 2)


def hat_gradients(positions: Floats, faces: Ints) -> tuple[Floats, Floats, Floats]:
    """Gradients of the three hat functions on each face: ∂x (m, 3), ∂y (m, 3), and the face areas (m,).

    The gradient of a hat function is the opposite edge turned by 90° over twice the area (Botsch et al. 2010,
    chapter 3). Areas of flipped faces are negative.
    """
    areas = signed_areas(positions, faces)
    x, y = positions[:, 0][faces], positions[:, 1][faces]
    scale = 0.5 / areas[:, None]
    dx = (y[:, _NEXT] - y[:, _AFTER]) * scale
    dy = (x[:, _AFTER] - x[:, _NEXT]) * scale
    return dx, dy, areas


def gradient_matrices(mesh: TriMesh) -> tuple[csr_array, csr_array]:
    """Sparse (m, n) matrices G_x, G_y: derivatives on each rest face of a function given at the vertices."""
    dx, dy, _ = hat_gradients(mesh.vertices, mesh.faces)
    m, n = len(mesh.faces), len(mesh.vertices)
    rows = np.repeat(np.arange(m), 3)
    columns = mesh.faces.ravel()
    return (
        csr_array((dx.ravel(), (rows, columns)), shape=(m, n)),
        csr_array((dy.ravel(), (rows, columns)), shape=(m, n)),
    )


def jacobians(mesh: TriMesh, positions: Floats) -> Floats:
    """(m, 2, 2) Jacobians J[:, component, derivative] of the map from the rest pose to ``positions``."""
    gx, gy = gradient_matrices(mesh)
    return np.stack([gx @ positions, gy @ positions], axis=2)


def killing_energy(positions: Floats, faces: Ints, field: Floats) -> float:
    """∫‖J + Jᵀ‖² of a vector field (n, 2) on a mesh at ``positions`` (paper, eq. 2): 0 for rigid motions."""
    dx, dy, areas = hat_gradients(positions, faces)
    u, v = field[:, 0][faces], field[:, 1][faces]
    stretch_x, stretch_y = (dx * u).sum(axis=1), (dy * v).sum(axis=1)
    shear = (dy * u).sum(axis=1) + (dx * v).sum(axis=1)
    return float(np.abs(areas) @ (4 * stretch_x**2 + 4 * stretch_y**2 + 2 * shear**2))
