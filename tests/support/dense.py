"""The paper's equations in loops and dense matrices, independent of the code under test."""

import cmath

import numpy as np


def killing_energy(positions, faces, field):
    """∫‖J + Jᵀ‖² of a vector field (n, 2) on a mesh at ``positions`` (paper, eq. 2)."""
    corners = positions[faces]
    edges = np.linalg.inv(np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1))
    values = field[faces]
    gradients = edges @ np.stack([values[:, 1] - values[:, 0], values[:, 2] - values[:, 0]], axis=1)
    areas = 0.5 / np.abs(np.linalg.det(edges))
    return float(areas @ ((gradients + gradients.transpose(0, 2, 1)) ** 2).sum(axis=(1, 2)))


def killing_rows(positions, faces):
    """P of eq. 6 with the gradient split into ∂x and ∂y, rows weighted by √area; columns x0 y0 x1 y1 ..."""
    rows = np.zeros((3 * len(faces), 2 * len(positions)))
    for f, (a, b, c) in enumerate(faces):
        edges = np.linalg.inv(np.array([positions[b] - positions[a], positions[c] - positions[a]]))
        hats = edges @ np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])  # ∂x and ∂y of the three hat functions
        area = 0.5 / abs(np.linalg.det(edges))
        for corner, vertex in enumerate((a, b, c)):
            dx, dy = hats[:, corner] * np.sqrt(area)
            rows[3 * f : 3 * f + 3, 2 * vertex : 2 * vertex + 2] += [
                [2 * dx, 0.0],
                [np.sqrt(2) * dy, np.sqrt(2) * dx],
                [0.0, 2 * dy],
            ]
    return rows


def pin_rows(mesh, points):
    """I_k of eq. 6, with three barycentric weights for each pin."""
    rows = np.zeros((2 * len(points), 2 * len(mesh.vertices)))
    for pin, (face, weights) in enumerate(zip(points.faces, points.weights, strict=True)):
        for vertex, weight in zip(mesh.faces[face], weights, strict=True):
            rows[2 * pin, 2 * vertex] = rows[2 * pin + 1, 2 * vertex + 1] = weight
    return rows


def boundary_vertices(mesh):
    """Indices of the vertices of edges that belong to only one face."""
    sides = [tuple(sorted(s)) for a, b, c in mesh.faces.tolist() for s in ((a, b), (b, c), (c, a))]
    return sorted({vertex for side in sides if sides.count(side) == 1 for vertex in side})


def smooth_field(mesh, positions, points, velocities, weight):
    """U° (n, 2) of eq. 5, by least squares on the stacked rows."""
    rows = np.vstack([killing_rows(positions, mesh.faces), weight * pin_rows(mesh, points)])
    right = np.concatenate([np.zeros(3 * len(mesh.faces)), weight * velocities.ravel()])
    return np.linalg.lstsq(rows, right, rcond=1e-13)[0].reshape(-1, 2)


def dirichlet_field(mesh, positions, smooth):
    """U_opt (n, 2) of eq. 8: minimizes the Killing energy with the boundary values of ``smooth``."""
    rows = killing_rows(positions, mesh.faces)
    free = np.ones(len(smooth), dtype=bool)
    free[boundary_vertices(mesh)] = False
    free = free.repeat(2)
    result = smooth.ravel().copy()
    result[free] = np.linalg.lstsq(rows[:, free], -rows[:, ~free] @ result[~free], rcond=1e-13)[0]
    return result.reshape(-1, 2)


def spiral_flow(mesh, positions, field, t=1.0):
    """The flow of eqs. 14 to 16, edge by edge, with the centers of the spirals."""
    p, u = [complex(*q) for q in positions], [complex(*q) for q in field]
    endpoints = [[] for _ in p]
    for edge in mesh.edges.tolist():
        for i, j in (edge, edge[::-1]):
            s = (u[i] - u[j]) / (p[i] - p[j])
            if abs(s) < 1e-12:
                endpoints[i].append(p[i] + t * u[i])
            else:
                center = p[i] - u[i] / s
                endpoints[i].append(center + cmath.exp(s * t) * (p[i] - center))
    means = [sum(points) / len(points) for points in endpoints]
    return np.array([[z.real, z.imag] for z in means])
