"""Compiles the search for overlaps before it is needed, so that the first crossing does not wait for it."""

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats
from .overlaps import Overlaps, asked_overlaps, next_overlaps, no_overlaps, restored_overlaps
from .seams import cut_along_seams

_LENGTH, _RADIUS, _TURN = 40, 8.0, 8.5  # of a strip that is rolled up: unit squares, radius, radians


def precompile_rest() -> None:
    """Compile only the search in a pose that does not overlap, of a drawing of two parts."""
    corners = np.array([[0.0, 0.0], [1, 0], [0, 1], [3, 0], [4, 0], [3, 1]])
    mesh = TriMesh(corners, np.arange(6).reshape(2, 3))
    next_overlaps(mesh, mesh.vertices, no_overlaps(mesh))


def precompile_crossings() -> None:
    """Compile what steps need from the first overlap on."""
    _rolled_up()


def precompile() -> None:
    """Compile all."""
    precompile_rest()
    mesh, pose, overlaps = _rolled_up()
    limb = (
        mesh.vertices[mesh.faces, 0].mean(axis=1) % 12 < 6
    )  # on both sheets, so that the region has to be cut
    asked = asked_overlaps(mesh, pose, overlaps, limb, to_front=True)
    next_overlaps(mesh, 1.01 * pose, asked)
    restored_overlaps(mesh, pose, asked.crossings)
    cut_along_seams(mesh, asked, np.arange(len(mesh.faces)))


def _rolled_up() -> tuple[TriMesh, Floats, Overlaps]:
    """A strip that is rolled up until it crosses itself, its pose, and the overlaps of that."""
    x, y = (grid.ravel() for grid in np.meshgrid(np.arange(_LENGTH + 1.0), np.arange(4.0)))
    corner = (np.arange(3)[:, None] * (_LENGTH + 1) + np.arange(_LENGTH)).ravel()
    a, b, c, d = corner, corner + 1, corner + _LENGTH + 2, corner + _LENGTH + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = TriMesh(np.stack([x, y], axis=1), faces)
    angle, radius = _TURN * x / _LENGTH, _RADIUS + 0.02 * x - y
    pose = np.stack([radius * np.sin(angle), -radius * np.cos(angle)], axis=1)
    overlaps = next_overlaps(mesh, pose, no_overlaps(mesh))
    return mesh, pose, next_overlaps(mesh, 1.001 * pose, overlaps)
