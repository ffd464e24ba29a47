"""The tree of a drawing's pins: which hangs on which."""

from collections.abc import Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree, shortest_path

from ....geometry.mesh import TriMesh
from ....geometry.validation import Floats
from ...document.crossings import pin_distances
from ...document.pin import Pin, pin_points


def pin_tree(mesh: TriMesh, pins: Sequence[Pin]) -> list[int | None]:
    """The number of the pin on which each hangs; None for the root, the pin in the middle of the tree.

    The tree is the shortest one that connects all pins through the drawing at rest.
    """
    if len(pins) < 2:
        return [None] * len(pins)
    distances = _distances(mesh, pins)
    rows, columns = np.triu_indices(len(pins), 1)
    lengths = np.maximum(distances[rows, columns], 1e-9 * mesh.length)  # a sparse graph has no edges of 0
    k = len(pins)
    tree = minimum_spanning_tree(coo_array((lengths, (rows, columns)), shape=(k, k)).tocsr())
    farthest = shortest_path(tree, directed=False).max(axis=1)
    root = int(np.argmin(farthest.round(6)))
    _, parents = breadth_first_order(tree, root, directed=False)
    return [None if number == root else int(parent) for number, parent in enumerate(parents)]


def _distances(mesh: TriMesh, pins: Sequence[Pin]) -> Floats:
    """Distances (k, k) between pins through the drawing."""
    points = pin_points(pins)
    to_vertices = pin_distances(mesh, pins)
    corners = mesh.faces[points.faces]
    rest = mesh.evaluate(points, mesh.vertices)
    to_corners = np.linalg.norm(mesh.vertices[corners] - rest[:, None], axis=2)
    through = (to_vertices[:, corners] + to_corners).min(axis=2)
    return np.asarray(np.minimum(through, through.T))
