"""A mesh in its order of elimination, in which the solver keeps it."""

import numpy as np

from ...geometry.edges import coupled_pairs
from ...geometry.joints import JointRows
from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, Ints
from ..dissection import dissect


class EliminationOrder:
    """Renumbers a mesh by nested dissection, and what belongs to it back and forth.

    Factors need no permutation then, and vertices of one face are close in memory, so that all loops over
    faces and edges are faster. Faces are in the order of their last vertex.

    links: (l, 2) further pairs of vertices that are coupled, by joints. mesh: renumbered; starts: (f + 1,)
    the groups of vertices that are eliminated together, see `Dissection`.
    """

    def __init__(self, mesh: TriMesh, links: Ints | None = None) -> None:
        coupled = mesh.edges
        if links is not None and len(links):
            coupled = coupled_pairs(coupled, links, len(mesh.vertices))
        order, self.starts = dissect(mesh.vertices, coupled)
        self._vertices = order.astype(np.intp)
        n, m = len(order), len(mesh.faces)
        self._numbers = np.empty(n, dtype=np.intp)
        self._numbers[self._vertices] = np.arange(n)
        self._faces = np.argsort(self._numbers[mesh.faces].max(axis=1), kind="stable")
        self._face_numbers = np.empty(m, dtype=np.int32)
        self._face_numbers[self._faces] = np.arange(m)
        self.mesh = mesh.renumber(self._vertices, self._faces)

    def points(self, points: MeshPoints) -> MeshPoints:
        """The same points of the renumbered mesh."""
        return MeshPoints(self._face_numbers[points.faces], points.weights)

    def joint_rows(self, rows: JointRows) -> JointRows:
        """The same rows of joints of the renumbered mesh."""
        return rows.renumber(self.mesh, self._face_numbers)

    def face_values(self, values: Floats) -> Floats:
        """Values (m,) of the faces in the order of the renumbered mesh."""
        return values[self._faces]

    def pose(self, positions: Floats) -> Complexes:
        """The pose of the renumbered mesh, (n,), from positions (n, 2)."""
        return to_complex(positions)[self._vertices]

    def positions(self, pose: Complexes) -> Floats:
        """Positions or velocities (n, 2) from those of the renumbered mesh, (n,)."""
        return to_points(pose[self._numbers])
