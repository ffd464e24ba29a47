"""The faces of a drawing as they are drawn: from back to front, cut along seams, stacked in z."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...editor.document.drawing import Drawing
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from ...layers.drawing_layer import DrawingLayer
from ...overlap.circles import face_levels
from ...overlap.face_pairs import overlapping_faces
from ...overlap.seams import CutMesh
from ...overlap.topology import mesh_topology

_MOST_LEVELS = 64  # a circle of pairs would lift its faces for ever


@dataclass(frozen=True, eq=False)
class DrawnFaces:
    """What a file holds of a mesh.

    rest, pose: (v, 2) vertices in pixels, y down; uv: (v, 2) texture coordinates; faces: (q, 3) from back to
    front; components, layers: (q,) of each face; z: (v,) levels, the higher the nearer, 0 unless
    `stacked`; sources: (v,) which vertices of the drawing, with those along seams, these are.
    """

    rest: Floats
    pose: Floats
    uv: Floats
    faces: Ints
    components: Ints
    z: Ints
    sources: Ints
    layers: Ints

    def layer_runs(self, drawing: Drawing) -> list[tuple[DrawingLayer | None, Ints]]:
        """Layers with the numbers of their faces, from back to front; without layers None with all faces."""
        numbers = np.arange(len(self.faces))
        if not drawing.layers:
            return [(None, numbers)]
        starts = np.flatnonzero(np.diff(self.layers, prepend=-1)).tolist()
        return [
            (drawing.layers[self.layers[start]], numbers[start:end])
            for start, end in pairwise([*starts, len(numbers)])
        ]

    @property
    def low_and_high(self) -> tuple[Ints, Ints]:
        """The lower and the upper face of each pair that overlaps in the pose, (p,) each.

        Pairs of faces of different layers do not count.
        """
        if not len(self.faces):
            return np.zeros(0, dtype=np.int32), np.zeros(0, dtype=np.int32)
        used, corners = np.unique(self.faces, return_inverse=True)  # not all if layers are hidden
        layers = np.zeros(len(used), dtype=np.int64)
        layers[corners.reshape(-1, 3)] = self.layers[:, None]
        mesh = TriMesh(
            self.rest[used], corners.reshape(-1, 3), layers=layers if layers.any() else None, is_cut=True
        )
        pairs = overlapping_faces(mesh_topology(mesh), self.pose[used])
        return np.minimum(pairs.first, pairs.second), np.maximum(pairs.first, pairs.second)


def drawn_faces(drawing: Drawing, positions: Floats, order: Ints | CutMesh | None) -> DrawnFaces:
    """The faces of a drawing in the pose ``positions`` (n, 2), in an ``order`` of `Document.draw_order`.

    The first n vertices are those of the mesh; where a seam cuts faces, new ones follow.
    """
    mesh, uv = drawing.mesh, drawing.uv.astype(float)
    component = mesh.component
    rest, pose, faces, layers = mesh.vertices, positions, mesh.faces, drawing.face_layers
    if isinstance(order, CutMesh):
        rest, pose, uv = (order.values(values) for values in (rest, pose, uv))
        component = np.concatenate([component, component[order.edges[:, 0]]])
        faces = order.faces
        layers = drawing.face_layers[order.sources] if drawing.layers else np.zeros(len(faces), dtype=int)
    elif order is not None:
        faces, layers = faces[order], layers[order]
    count = len(rest)
    flat = np.zeros(count, dtype=np.int64)
    return DrawnFaces(rest, pose, uv, faces, component[faces[:, 0]], flat, np.arange(count), layers)


def stacked(drawn: DrawnFaces, low: Ints, high: Ints) -> DrawnFaces:
    """The faces with levels z by which each lower one lies behind the upper one of its pairs.

    low, high: (p,) pairs of faces that overlap. The surface stays in one piece if that is possible; else
    vertices are doubled, and the new ones follow the others. A layer lies wholly in front of the one before.
    """
    result = _stacked_in_layers(drawn, low, high)
    base, z = 0, result.z.copy()
    starts = np.flatnonzero(np.diff(result.layers, prepend=-1)).tolist()
    for start, end in pairwise([*starts, len(result.faces)]) if len(starts) > 1 else ():
        own = np.unique(result.faces[start:end])
        z[own] += base
        base = int(z[own].max()) + 1
    return replace(result, z=z)


def _stacked_in_layers(drawn: DrawnFaces, low: Ints, high: Ints) -> DrawnFaces:
    z = _vertex_levels(drawn, low, high)
    if z is not None:
        return replace(drawn, z=z)
    levels, _ = face_levels(len(drawn.faces), low.astype(np.int32), high.astype(np.int32))
    count = len(drawn.rest)
    lowest = np.full(count, levels.max() + 1)
    np.minimum.at(lowest, drawn.faces.ravel(), np.repeat(levels, 3))
    corners, corner_levels = drawn.faces.ravel(), np.repeat(levels, 3)
    keys = np.where(corner_levels == lowest[corners], 0, corner_levels + 1).astype(np.int64) * count + corners
    added, numbers = np.unique(keys[keys >= count], return_inverse=True)
    faces = corners.astype(np.int64)
    faces[keys >= count] = count + numbers
    new = added % count
    take = np.concatenate([np.arange(count), new])
    z = np.concatenate([np.where(lowest > levels.max(), 0, lowest), added // count - 1])
    rest, pose, uv, sources = (values[take] for values in (drawn.rest, drawn.pose, drawn.uv, drawn.sources))
    return replace(drawn, rest=rest, pose=pose, uv=uv, faces=faces.reshape(-1, 3), z=z, sources=sources)


def _vertex_levels(drawn: DrawnFaces, low: Ints, high: Ints) -> Ints | None:
    """Levels (v,) of vertices that separate all pairs without a common corner; None if there are none."""
    faces = drawn.faces
    touches = (faces[low][:, :, None] == faces[high][:, None, :]).any(axis=(1, 2))
    lower, upper = faces[low[~touches]], faces[high[~touches]]
    z = np.zeros(len(drawn.rest), dtype=np.int64)
    for _ in range(_MOST_LEVELS):
        before = z.copy()
        np.maximum.at(z, upper.ravel(), np.repeat(z[lower].max(axis=1, initial=0) + 1, 3))
        if (z == before).all():
            return z
    return None
