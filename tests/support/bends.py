"""Poses of test shapes: random drags with the solver, and a rope that rolls itself into a trefoil."""

from collections.abc import Iterator

import numpy as np

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.geometry.mesh import TriMesh


def random_drag(mesh: TriMesh, seed: int, steps: int = 12) -> Iterator[np.ndarray]:
    """Poses (n, 2) while one of three random pins goes across the shape, away, and across it again."""
    rng = np.random.default_rng(seed)
    deformer = AkapDeformer(mesh, memory=1.0)
    faces = rng.choice(len(mesh.faces), 3, replace=len(mesh.faces) < 3)
    points = mesh.locate(mesh.vertices[mesh.faces[faces]].mean(axis=1))
    deformer.set_pins(points)
    pose, targets = mesh.vertices, mesh.evaluate(points, mesh.vertices)
    middle, size = mesh.vertices.mean(axis=0), np.ptp(mesh.vertices, axis=0).max()
    for _ in range(3):
        goal = middle + rng.normal(0, 0.45 * size, 2)
        for share in np.linspace(0, 1, steps + 1)[1:]:
            moved = targets.copy()
            moved[0] += share * (goal - targets[0])
            pose = deformer.step(pose, moved).positions
            yield pose
        targets[0] = goal


def trefoil(mesh: TriMesh, length: float, middle: float, share: float) -> np.ndarray:
    """The pose of a rope (x from 0 to ``length``, axis at y = ``middle``) on its way to a trefoil, at 1."""
    t = np.linspace(0.12, 2 * np.pi - 0.12, 4000)
    x, y = np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t)
    heading = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
    arc = np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    angle = heading.mean() + share * (heading - heading.mean())
    lengths = np.diff(arc) * length / arc[-1]
    axis_x = np.concatenate([[0], np.cumsum(np.cos(angle[1:]) * lengths)])
    axis_y = np.concatenate([[0], np.cumsum(np.sin(angle[1:]) * lengths)])
    at = mesh.vertices[:, 0] / length * arc[-1]
    offset, turn = mesh.vertices[:, 1] - middle, np.interp(at, arc, angle)
    along_x, along_y = np.interp(at, arc, axis_x), np.interp(at, arc, axis_y)
    return np.stack([along_x - np.sin(turn) * offset, along_y + np.cos(turn) * offset], axis=1)
