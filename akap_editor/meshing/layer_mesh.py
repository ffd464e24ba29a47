"""Meshes the pictures of layers: one mesh of all of them, with components of its own for each."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints, as_number
from ..progress import announce, part
from ..words import tr
from .faint import fitting_threshold
from .outline import NoOutlineError, check_lengths
from .picture_mesh import mesh_picture
from .triangulate import MAX_VERTICES, MIN_VERTICES

MIN_LAYER_VERTICES = 24  # of a small layer, which bends as well as a large one
_PADDING = 4  # pixels beyond the margin, so that no outline is cut at the rim of a trimmed picture


def mesh_layers(
    alphas: Sequence[NDArray[np.uint8]],
    offsets: Sequence[tuple[int, int]],
    vertices: int,
    expand: float,
    threshold: float,
    mesher: str | None = None,
    known: Mapping[int, tuple[Floats, Ints]] | None = None,
    counts: Mapping[int, int] | None = None,
) -> TriMesh:
    """One mesh of all layers, from back to front; its `TriMesh.layers` says which vertex is of which.

    alphas: (h, w) uint8 of each layer; offsets: of their corners on the canvas, (x, y) pixels; vertices: the
    wanted number of all layers, shared by visible area, but at least `MIN_LAYER_VERTICES` for each; for the
    others see `mesh_picture`. known: vertices on the canvas and faces of layers that have a mesh already;
    counts: the wanted numbers of vertices of single layers. A layer that is fainter than the threshold is cut
    out at half its opacity; one that is too small for an outline gets a rectangle around it. Raises
    InputError as `mesh_picture` does.
    """
    as_number(vertices, "vertices", MIN_VERTICES, MAX_VERTICES)
    check_lengths(threshold, expand)
    thresholds = [fitting_threshold(alpha, threshold) for alpha in alphas]
    areas = [
        max(int((alpha > 255 * level).sum()), 1) for alpha, level in zip(alphas, thresholds, strict=True)
    ]
    wanted = {**dict(enumerate(shared_counts(areas, vertices))), **(counts or {})}
    places: list[Floats] = []
    faces: list[Ints] = []
    done = 0
    for number, (alpha, level) in enumerate(zip(alphas, thresholds, strict=True)):
        announce(
            number / len(alphas),
            tr("Meshing layer {number} of {count}", number=number + 1, count=len(alphas)),
        )
        if known is not None and number in known:
            points, triangles = known[number]
        else:
            with part(number / len(alphas), (number + 1) / len(alphas)):
                points, triangles = _mesh_layer(alpha, wanted[number], expand, level, mesher)
            points = points + offsets[number]
        places.append(points)
        faces.append(triangles + done)
        done += len(points)
    layers = np.repeat(np.arange(len(places)), [len(points) for points in places])
    return TriMesh(np.concatenate(places), np.concatenate(faces), True, layers)


def shared_counts(areas: Sequence[int], vertices: int) -> list[int]:
    """The wanted number of vertices of each layer, by its visible area."""
    shares = np.rint(vertices * np.array(areas, dtype=float) / max(sum(areas), 1))
    counts: list[int] = np.clip(shares, MIN_LAYER_VERTICES, MAX_VERTICES).astype(int).tolist()
    return counts


def _mesh_layer(
    alpha: NDArray[np.uint8], count: int, expand: float, threshold: float, mesher: str | None
) -> tuple[Floats, Ints]:
    """Vertices (v, 2) relative to the picture's corner, and faces (q, 3), of one layer."""
    padding = math.ceil(expand) + _PADDING
    try:
        mesh = mesh_picture(np.pad(alpha, padding), count, expand, threshold, mesher).mesh
    except NoOutlineError:
        return _rectangle(alpha.shape[1], alpha.shape[0], max(expand, 1.0))
    return mesh.vertices - padding, mesh.faces


def _rectangle(width: int, height: int, margin: float) -> tuple[Floats, Ints]:
    """The mesh of a rectangle with a margin around it."""
    left, top, right, bottom = -margin, -margin, width + margin, height + margin
    x, y = (left + right) / 2, (top + bottom) / 2
    corners = np.array([(left, top), (right, top), (right, bottom), (left, bottom), (x, y)])
    return corners, np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)], dtype=np.int32)
