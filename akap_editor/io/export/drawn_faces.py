"""The faces of a drawing as they are drawn: sorted from back to front, and cut along seams."""

from dataclasses import dataclass

import numpy as np

from ...editor.document.drawing import Drawing
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from ...overlap.face_pairs import overlapping_faces
from ...overlap.seams import CutMesh
from ...overlap.topology import mesh_topology


@dataclass(frozen=True, eq=False)
class DrawnFaces:
    """What a file holds of a mesh: rest, pose: (v, 2) vertices in pixels, y down; uv: (v, 2) texture
    coordinates; faces: (q, 3) from back to front; components: (q,) the component of each face.
    """

    rest: Floats
    pose: Floats
    uv: Floats
    faces: Ints
    components: Ints

    @property
    def low_and_high(self) -> tuple[Ints, Ints]:
        """The lower and the upper face of each pair that overlaps in the pose, (p,) each."""
        pairs = overlapping_faces(mesh_topology(TriMesh(self.rest, self.faces)), self.pose)
        return np.minimum(pairs.first, pairs.second), np.maximum(pairs.first, pairs.second)


def drawn_faces(drawing: Drawing, positions: Floats, order: Ints | CutMesh | None) -> DrawnFaces:
    """The faces of a drawing in the pose ``positions`` (n, 2), in an ``order`` of `Document.draw_order`.

    The first n vertices are those of the mesh; where a seam cuts faces, new ones follow.
    """
    mesh, uv = drawing.mesh, drawing.uv.astype(float)
    component = mesh.component
    if isinstance(order, CutMesh):
        rest, pose, uv = (order.values(values) for values in (mesh.vertices, positions, uv))
        component = np.concatenate([component, component[order.edges[:, 0]]])
        return DrawnFaces(rest, pose, uv, order.faces, component[order.faces[:, 0]])
    faces = mesh.faces if order is None else mesh.faces[order]
    return DrawnFaces(mesh.vertices, positions, uv, faces, component[faces[:, 0]])
