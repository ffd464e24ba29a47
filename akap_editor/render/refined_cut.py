"""A refined mesh cut along seams: the small faces of each face that a seam crosses are cut along it, too.

A face of a `CutMesh` is a part of a face of the mesh. It covers whole small faces of the refinement, and
parts of others, which are found by clipping (Sutherland, Hodgman, Reentrant Polygon Clipping, CACM 1974) in
the barycentric coordinates of the face. New points are linear on their small face, so that they lie on the
drawn edges of neighbors that are not cut, and no gap opens.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints
from ..overlap.seams import CutMesh
from .layer_runs import LayerRun
from .refinement import Refinement, small_corners

_LEAST_AREA = 1e-9  # share of a face: smaller parts are left out


@dataclass(frozen=True, eq=False)
class RefinedCut:
    """The faces of a cut mesh as small ones.

    corners: (e, 3) points of the refinement between which each new point lies; weights: (e, 3) barycentric;
    faces: (q, 3) small faces from back to front, p + i for the i-th new point; starts: (f + 1,) the first
    small face of each face of the cut mesh, and their number.
    """

    corners: Ints
    weights: Floats
    faces: Ints
    starts: Ints

    def values(self, values: Floats) -> Floats:
        """Values (p, k) at the points of the refinement, followed by those at the new points, (p + e, k)."""
        return np.concatenate([values, np.einsum("ec,eck->ek", self.weights, values[self.corners])])

    def runs(self, runs: Sequence[LayerRun]) -> tuple[LayerRun, ...]:
        """Runs of faces of the cut mesh as runs of small faces."""
        bounds = [(self.starts[run.first], self.starts[run.first + run.count]) for run in runs]
        return tuple(
            replace(run, first=int(first), count=int(end - first))
            for run, (first, end) in zip(runs, bounds, strict=True)
        )


def refined_cut(mesh: TriMesh, refinement: Refinement, cut: CutMesh) -> RefinedCut:
    """Refine the faces of a cut mesh. refinement: of the mesh."""
    squares, points = refinement.parts**2, refinement.smooth.shape[0]
    is_part = np.bincount(cut.sources, minlength=len(mesh.faces))[cut.sources] > 1
    is_part |= (cut.faces >= len(mesh.vertices)).any(axis=1)  # the other parts may be hidden
    part = np.flatnonzero(is_part)
    polygons, sizes = _clipped(small_corners(refinement.parts), _part_corners(mesh, cut, part))
    triangles = np.maximum(sizes - 2, 0)  # of each polygon, drawn as a fan
    counts = np.full(len(cut.faces), squares)
    counts[part] = triangles.reshape(len(part), squares).sum(axis=1)
    starts = np.concatenate([[0], np.cumsum(counts)])
    faces = np.empty((starts[-1], 3), dtype=np.int64)
    whole = np.flatnonzero(~is_part)
    faces[(starts[whole][:, None] + np.arange(squares)).ravel()] = refinement.faces[
        cut.sources[whole]
    ].reshape(-1, 3)
    rows = np.repeat(np.arange(len(polygons)), triangles)
    step = np.arange(len(rows)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    fan = np.stack([np.zeros_like(step), step + 1, step + 2], axis=1)
    is_drawn_part = np.repeat(is_part, counts)
    faces[is_drawn_part] = points + np.arange(3 * len(rows)).reshape(-1, 3)
    inverse = np.linalg.inv(small_corners(refinement.parts))[rows % squares]
    weights = np.einsum("tkc,tcd->tkd", polygons[rows[:, None], fan], inverse).reshape(-1, 3)
    corners = refinement.faces[cut.sources[part]].reshape(-1, 3)[rows]
    return RefinedCut(np.repeat(corners, 3, axis=0), weights, faces.astype(np.int32), starts)


def _part_corners(mesh: TriMesh, cut: CutMesh, part: Ints) -> Floats:
    """(k, 3, 3) corners of faces of the cut mesh, barycentric in the faces that they are parts of."""
    n = len(mesh.vertices)
    corners, sources = cut.faces[part], mesh.faces[cut.sources[part]]
    ends = np.concatenate([np.repeat(np.arange(n)[:, None], 2, axis=1), cut.edges])[corners]  # (k, 3, 2)
    shares = np.concatenate([np.zeros(n), cut.shares])[corners]
    is_end = ends[..., None] == sources[:, None, None]  # (k, corner, end, corner of the source)
    weights: Floats = is_end[:, :, 0] * (1 - shares)[..., None] + is_end[:, :, 1] * shares[..., None]
    return weights


def _clipped(small: Floats, parts: Floats) -> tuple[Floats, Ints]:
    """Each small face (s, 3, 3) within each part (k, 3, 3), both barycentric in one face.

    Returns polygons (k * s, 6, 3), and the number of corners of each, 0 if nothing is left.
    """
    count = len(parts) * len(small)
    polygons = np.zeros((count, 6, 3))
    polygons[:, :3] = np.tile(small, (len(parts), 1, 1))
    sizes = np.full(count, 3)
    clips = np.repeat(parts, len(small), axis=0)
    turns = np.sign(_doubled_areas(clips[:, 0], clips[:, 1], clips[:, 2]))
    for side in range(3):
        start, end = clips[:, side], clips[:, (side + 1) % 3]
        heights = turns[:, None] * _doubled_areas(start[:, None], end[:, None], polygons)
        polygons, sizes = _cut_off(polygons, sizes, heights)
    fans = _doubled_areas(polygons[:, :1], polygons[:, 1:-1], polygons[:, 2:])
    is_drawn = np.arange(4) < (sizes - 2)[:, None]
    areas = np.abs((fans * is_drawn).sum(axis=1))
    return polygons, np.where(areas > _LEAST_AREA, sizes, 0)


def _cut_off(polygons: Floats, sizes: Ints, heights: Floats) -> tuple[Floats, Ints]:
    """Cut off convex polygons (k, 6, 3) where ``heights`` (k, 6) at their corners are negative."""
    number, slots = np.arange(len(polygons))[:, None], np.arange(6)
    is_corner = slots < sizes[:, None]
    following = np.where(slots + 1 < sizes[:, None], slots + 1, 0)
    next_heights = heights[number, following]
    is_kept = is_corner & (heights >= 0)
    is_crossed = is_corner & ((heights >= 0) != (next_heights >= 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(is_crossed, heights / (heights - next_heights), 0.0)[..., None]
    crossing = polygons + share * (polygons[number, following] - polygons)
    added = np.stack([is_kept, is_crossed], axis=2).reshape(len(polygons), 12)
    candidates = np.stack([polygons, crossing], axis=2).reshape(len(polygons), 12, 3)
    places = np.cumsum(added, axis=1) - 1
    result = np.zeros_like(polygons)
    row, column = np.nonzero(added & (places < 6))
    result[row, places[row, column]] = candidates[row, column]
    return result, np.minimum(added.sum(axis=1), 6)


def _doubled_areas(a: Floats, b: Floats, c: Floats) -> Floats:
    """Signed doubled areas of triangles with barycentric corners (..., 3)."""
    ab, ac = (b - a)[..., 1:], (c - a)[..., 1:]
    areas: Floats = ab[..., 0] * ac[..., 1] - ab[..., 1] * ac[..., 0]
    return areas
