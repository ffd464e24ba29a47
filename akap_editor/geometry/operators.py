"""Differential operators of piecewise linear functions on a triangle mesh.

In formulas a point or vector (x, y) is the complex number x + iy, as in the paper's section 2.3.
"""

import numpy as np
from scipy.sparse import csr_array

from .mesh import TriMesh, signed_areas
from .validation import Complexes, Floats, Ints

NEXT, PREVIOUS = [1, 2, 0], [2, 0, 1]  # the other two corners of a face, for each corner


def to_complex(points: Floats) -> Complexes:
    """(n, 2) float64 as (n,) complex128; a view if the array is contiguous."""
    return np.ascontiguousarray(points).view(np.complex128)[:, 0]


def to_points(values: Complexes) -> Floats:
    """(n,) complex128 as (n, 2) float64; a view if the array is contiguous."""
    return np.ascontiguousarray(values).view(np.float64).reshape(-1, 2)


def hat_gradients(positions: Floats, faces: Ints) -> tuple[Floats, Floats, Floats]:
    """Gradients of the three hat functions on each face: ∂x (m, 3), ∂y (m, 3); and the face areas (m,).

    positions: (n, 2); areas of flipped faces are negative. The gradient of a hat function is the opposite
    edge rotated by 90°, divided by twice the area (Botsch et al. 2010, Polygon Mesh Processing, chapter 3).
    """
    areas = signed_areas(positions, faces)
    x, y = positions[:, 0][faces], positions[:, 1][faces]
    scale = 0.5 / areas[:, None]
    dx = (y[:, NEXT] - y[:, PREVIOUS]) * scale
    dy = (x[:, PREVIOUS] - x[:, NEXT]) * scale
    return dx, dy, areas


def gradient_matrices(mesh: TriMesh) -> tuple[csr_array, csr_array]:
    """Sparse (m, n) matrices G_x and G_y that take vertex values to derivatives on each rest face."""
    dx, dy, _ = hat_gradients(mesh.vertices, mesh.faces)
    m, n = len(mesh.faces), len(mesh.vertices)
    rows = np.repeat(np.arange(m), 3)
    columns = mesh.faces.ravel()
    return (
        csr_array((dx.ravel(), (rows, columns)), shape=(m, n)),
        csr_array((dy.ravel(), (rows, columns)), shape=(m, n)),
    )
