"""Poses that overlap: random drags with the solver, and ropes tied into a trefoil, one with a seam."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.editor.document.crossings import overlaps_of
from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.drawing import make_drawing
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


def rope_with_seam() -> Document:
    """A rope of colors, tied into a trefoil; in one of its crossings both parts are in front of the other."""
    image = np.full((60, 1000, 4), 255, dtype=np.uint8)
    image[..., 0], image[..., 1] = np.arange(1000) // 4, 4 * np.arange(60)[:, None]
    empty = new_document(make_drawing(image, vertices=300))
    mesh = empty.drawing.mesh
    pose = trefoil(mesh, 1000, 30, 1.0)
    overlaps = overlaps_of(mesh, (), pose, empty.state.crossings)
    mine = np.flatnonzero(overlaps.pairs.regions == 0)
    first, second = overlaps.pairs.first[mine], overlaps.pairs.second[mine]
    middles = mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    left, right = np.argmin(middles[first]), np.argmax(middles[first])
    crossings = np.array([[first[left], second[left]], [second[right], first[right]]], dtype=np.int32)
    return empty.with_state(replace(empty.state, positions=pose, crossings=crossings))
