"""Quality of a picture's mesh: its angles, and how well it covers the visible pixels."""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats
from .outline import polygons_of, visible_polygons


@dataclass(frozen=True)
class MeshQuality:
    """Measures of a mesh and of how well it fits its picture.

    parts, holes, vertices, faces: their numbers; worst_angle, low_angle: minimum and 1st percentile over the
    faces of each face's smallest angle, degrees; covered: share of the visible area that the mesh covers;
    outside: share of the mesh where nothing is visible.
    """

    parts: int
    holes: int
    vertices: int
    faces: int
    low_angle: float
    worst_angle: float
    covered: float
    outside: float


def mesh_quality(mesh: TriMesh, alpha: NDArray[np.uint8], threshold: float = 0.5) -> MeshQuality:
    """Measure a mesh against the alpha channel (h, w) uint8 of its picture, of which something is visible.

    Visible is the area inside the sub-pixel iso-line of ``threshold``, a share of full opacity.
    """
    angles = smallest_angles(mesh)
    parts = int(mesh.component.max()) + 1
    mesh_area = float(mesh.rest_areas.sum())
    visible = shapely.union_all(visible_polygons(alpha, threshold))
    common = float(shapely.area(shapely.intersection(visible, mesh_polygons(mesh))).sum())
    return MeshQuality(
        parts=parts,
        holes=len(mesh.boundary_loops) - parts,
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        low_angle=float(np.percentile(angles, 1)),
        worst_angle=float(angles.min()),
        covered=common / visible.area,
        outside=max(mesh_area - common, 0.0) / mesh_area,
    )


def mesh_polygons(mesh: TriMesh) -> NDArray[np.object_]:
    """The components of a mesh at rest as shapely polygons with holes."""
    return polygons_of([mesh.vertices[loop] for loop in mesh.boundary_loops])


def smallest_angles(mesh: TriMesh) -> Floats:
    """(m,) the smallest angle of each face at rest, degrees."""
    corners = mesh.vertices[mesh.faces]
    u = np.roll(corners, -1, axis=1) - corners
    v = np.roll(corners, -2, axis=1) - corners
    cross = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return np.degrees(np.arctan2(cross, (u * v).sum(axis=2)).min(axis=1))
