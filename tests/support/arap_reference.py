"""As-rigid-as-possible deformation run to convergence, a reference for `ArapDeformer` and for memory.

Local and global steps (Sorkine and Alexa 2007) with one rotation for each face (Liu et al. 2008).
"""

import numpy as np
from scipy.sparse import block_array, csr_array
from scipy.sparse.linalg import splu

CONVERGED = 1e-4  # pixels that any vertex still moves in an iteration


def gradient(mesh):
    """(2m, n): the operator from values at the vertices to ∂x and ∂y on each rest face."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    hats = np.linalg.inv(np.stack([b - a, c - a], axis=1)) @ [[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]]
    m = len(mesh.faces)
    rows = np.arange(2 * m).reshape(m, 2, 1) + np.zeros((1, 1, 3), dtype=int)
    columns = np.broadcast_to(mesh.faces[:, None, :], hats.shape)
    return csr_array((hats.ravel(), (rows.ravel(), columns.ravel())), shape=(2 * m, len(mesh.vertices)))


def converged_arap(mesh, points, targets, pose, max_iterations=5000):
    """Minimize Σ A ‖J − R‖² from ``pose`` (n, 2), with pins exactly at ``targets``; return the pose."""
    n, k = len(mesh.vertices), len(points)
    derive = gradient(mesh)
    collect = csr_array(derive.T * np.repeat(mesh.rest_areas, 2))
    indices = (np.repeat(np.arange(k), 3), mesh.faces[points.faces].ravel())
    pins = csr_array((points.weights.ravel(), indices), shape=(k, n))
    system = splu(block_array([[collect @ derive, pins.T], [pins, None]], format="csc"))
    for _ in range(max_iterations):
        jacobian = (derive @ pose).reshape(-1, 2, 2)  # derivative, component
        cos = jacobian[:, 0, 0] + jacobian[:, 1, 1]
        sin = jacobian[:, 0, 1] - jacobian[:, 1, 0]
        rotation = np.array([[cos, sin], [-sin, cos]]).transpose(2, 0, 1) / np.hypot(cos, sin)[:, None, None]
        moved = system.solve(np.concatenate([collect @ rotation.reshape(-1, 2), targets]))[:n]
        change, pose = np.abs(moved - pose).max(), moved
        if change < CONVERGED:
            return pose
    raise AssertionError(f"no convergence: {change:g} pixels in the last iteration")
