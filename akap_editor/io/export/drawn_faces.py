"""The faces of a drawing as they are drawn: sorted from back to front, and cut along seams."""

from dataclasses import dataclass

from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats, Ints
from ...overlap.seams import CutMesh


@dataclass(frozen=True, eq=False)
class DrawnFaces:
    """What a file holds of a mesh: rest, pose: (v, 2) vertices in pixels, y down; uv: (v, 2) texture
    coordinates; faces: (q, 3) from back to front.
    """

    rest: Floats
    pose: Floats
    uv: Floats
    faces: Ints


def drawn_faces(drawing: Drawing, positions: Floats, order: Ints | CutMesh | None) -> DrawnFaces:
    """The faces of a drawing in the pose ``positions`` (n, 2), in an ``order`` of `Document.draw_order`.

    The first n vertices are those of the mesh; where a seam cuts faces, new ones follow.
    """
    mesh, uv = drawing.mesh, drawing.uv.astype(float)
    if isinstance(order, CutMesh):
        rest, pose, uv = (order.values(values) for values in (mesh.vertices, positions, uv))
        return DrawnFaces(rest, pose, uv, order.faces)
    return DrawnFaces(mesh.vertices, positions, uv, mesh.faces if order is None else mesh.faces[order])
