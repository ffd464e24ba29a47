"""Joints: points at which two components of a mesh are held together, and their rows of eq. 3.

A row is W_a p − W_b p, the difference of two points of the mesh in a pose. A hinge has one strong row, at the
joint, and three weak ones on a circle around it: without them a limb without pins could rotate freely, and
the matrix would be singular. A weld has three strong rows on the circle.
"""

from copy import copy
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from .mesh import TriMesh, barycentric
from .operators import to_points
from .validation import Complexes, Floats, Ints, as_indices, freeze

STRONG, WEAK = 1e4, 1.0  # λ² of a row: a pin's, and one that hardly resists a rotation
_RADIUS = 0.02  # share of √area: of the circle of the weak rows
_RADIUS_OF_SMALL = 0.2  # the same of the smaller of the two components, which it may not exceed
_ROUNDING = 1e-12  # barycentric weight below zero that still counts as on the face
_CIRCLE = np.exp(2j * np.pi * np.arange(3) / 3)


@dataclass(frozen=True, eq=False)
class MeshJoints:
    """Joints of a mesh; arrays are read-only.

    faces: (j, 2) int32, of two components each; weights: (j, 2, 3) float64 barycentric, the point on each of
    them; is_weld: (j,) bool, false for hinges. Raises InputError on other shapes.
    """

    faces: Ints
    weights: Floats
    is_weld: Ints

    def __post_init__(self) -> None:
        faces = as_indices(self.faces, "joints", 2, np.iinfo(np.int32).max)
        weights, is_weld = np.asarray(self.weights, np.float64), np.asarray(self.is_weld, bool)
        if weights.shape != (len(faces), 2, 3) or is_weld.shape != (len(faces),):
            raise InputError(f"joints: expected weights ({len(faces)}, 2, 3), got {weights.shape}")
        for name, array in (("faces", faces), ("weights", weights), ("is_weld", is_weld)):
            object.__setattr__(self, name, freeze(array.copy()))

    def __len__(self) -> int:
        return len(self.faces)

    def components(self, mesh: TriMesh) -> Ints:
        """The two components of each joint, (j, 2)."""
        return mesh.component[mesh.faces[self.faces, 0]]

    def places(self, mesh: TriMesh, positions: Floats) -> Floats:
        """The two points of each joint in a pose (n, 2), (j, 2, 2) pixels."""
        return np.einsum("jsc,jscd->jsd", self.weights, positions[mesh.faces[self.faces]])


NO_JOINTS = MeshJoints(np.zeros((0, 2), dtype=np.int32), np.zeros((0, 2, 3)), np.zeros(0, dtype=bool))


class JointRows:
    """The rows of joints of a mesh, and the energy Σ strength |W_a p − W_b p|².

    places: (j, 2) of the joints in the rest pose; components: (j, 2) that they hold together. Each joint has
    four successive rows, its own and three on the circle. corners, weights: (r, 6) vertices of both points,
    and their weights, negative for the second point; strengths: (r,) λ²; is_strong: (r,) which rows close
    their gap, the others only resist.
    """

    def __init__(self, mesh: TriMesh, joints: MeshJoints) -> None:
        self.components = joints.components(mesh)
        if (self.components[:, 0] == self.components[:, 1]).any():
            raise InputError("joints: expected points of two components each")
        self.places: Floats = joints.places(mesh, mesh.vertices).mean(axis=1)
        strengths = np.where(joints.is_weld[:, None], STRONG, [STRONG, WEAK, WEAK, WEAK])
        self.strengths: Floats = strengths.ravel()
        self.is_strong = self.strengths == STRONG
        self._set_ends(mesh, self._find_ends(mesh, joints.faces))

    def renumber(self, mesh: TriMesh, face_numbers: Ints) -> "JointRows":
        """The same rows of the renumbered mesh; face_numbers: (m,) the number there of each face."""
        rows = copy(self)
        rows._set_ends(mesh, face_numbers[self._ends])
        return rows

    def _circles(self, mesh: TriMesh) -> tuple[Floats, Floats]:
        """The points of the rows, (j, 4, 2), and the radii of the circles, (j,)."""
        areas = np.bincount(mesh.component[mesh.faces[:, 0]], mesh.rest_areas)
        smaller = np.sqrt(areas[self.components].min(axis=1))
        radii = np.minimum(_RADIUS * mesh.length, _RADIUS_OF_SMALL * smaller)
        around = self.places[:, None] + radii[:, None, None] * to_points(_CIRCLE)
        return np.concatenate([self.places[:, None], around], axis=1), radii

    def _find_ends(self, mesh: TriMesh, faces: Ints) -> Ints:
        """The faces at the two ends of each row, (r, 2).

        Where a component has no face at the point of a row, its face of the joint, ``faces`` (j, 2), is
        extended, so that the row is 0 at rest in any case.
        """
        points, radii = self._circles(mesh)
        ends = np.repeat(faces[:, None], points.shape[1], axis=1)
        component_of_face = mesh.component[mesh.faces[:, 0]]
        for number in np.unique(self.components):
            boxes = _Boxes(mesh, np.flatnonzero(component_of_face == number))
            for joint, side in np.argwhere(self.components == number):
                near, rows = boxes.near(self.places[joint], radii[joint]), points[joint]
                if len(near):
                    corners = np.tile(mesh.vertices[mesh.faces[near]], (len(rows), 1, 1))
                    weights = barycentric(corners, np.repeat(rows, len(near), axis=0))
                    inside = weights.min(axis=1).reshape(len(rows), len(near))
                    is_on_face = inside.max(axis=1) >= -_ROUNDING
                    ends[joint, is_on_face, side] = near[inside.argmax(axis=1)[is_on_face]]
        return ends.reshape(-1, 2)

    def _set_ends(self, mesh: TriMesh, ends: Ints) -> None:
        """Set corners and weights from the faces at the ends of the rows, (r, 2)."""
        self._ends, self._n = ends, len(mesh.vertices)
        corners, points = mesh.faces[ends], self._circles(mesh)[0].reshape(-1, 2)
        first, second = (barycentric(mesh.vertices[corners[:, side]], points) for side in range(2))
        self.corners: Ints = corners.reshape(-1, 6).astype(np.int64)
        self.weights: Floats = np.concatenate([first, -second], axis=1)

    @property
    def links(self) -> Ints:
        """(l, 2) int64 pairs of vertices that the rows couple, the lower one first, each once."""
        first, second = np.repeat(self.corners[:, :3], 3, axis=1), np.tile(self.corners[:, 3:], (1, 3))
        pairs = np.stack([first.ravel(), second.ravel()], axis=1)
        return np.unique(np.sort(pairs, axis=1), axis=0)

    def gaps(self, values: Complexes) -> Complexes:
        """W_a p − W_b p of each row, (r,), for values p (n,) at the vertices."""
        return np.asarray((self.weights * values[self.corners]).sum(axis=1))

    def pull(self, gaps: Complexes) -> Complexes:
        """Half the gradient of `energy` for ``gaps`` (r,), (n,)."""
        result = np.zeros(self._n, dtype=np.complex128)
        np.add.at(result, self.corners.ravel(), ((self.strengths * gaps)[:, None] * self.weights).ravel())
        return result

    def energy(self, gaps: Complexes) -> float:
        """Σ strength |gap|² for ``gaps`` (r,)."""
        return float(self.strengths @ (gaps.real**2 + gaps.imag**2))

    def entries(self) -> tuple[Floats, Ints, Ints]:
        """Values, rows and columns of Σ strength WᵀW in the lower triangle of the 2n × 2n matrix, (q,)."""
        outer = self.strengths[:, None, None] * self.weights[:, :, None] * self.weights[:, None, :]
        rows = 2 * np.broadcast_to(self.corners[:, :, None], outer.shape)
        columns = 2 * np.broadcast_to(self.corners[:, None, :], outer.shape)
        lower = rows >= columns
        values, row, column = outer[lower], rows[lower], columns[lower]
        return np.tile(values, 2), np.concatenate([row, row + 1]), np.concatenate([column, column + 1])


class _Boxes:
    """The bounding boxes of the faces of one component of a mesh at rest."""

    def __init__(self, mesh: TriMesh, faces: Ints) -> None:
        a, b, c = (mesh.vertices[corners] for corners in mesh.faces[faces].T)
        self._faces = faces
        self._low, self._high = (extreme(extreme(a, b), c) for extreme in (np.minimum, np.maximum))

    def near(self, place: Floats, radius: float) -> Ints:
        """The faces whose boxes reach into the square around a circle, ascending."""
        reach = 1.01 * radius  # rounding included
        is_near = (self._low <= place + reach) & (self._high >= place - reach)
        return self._faces[is_near[:, 0] & is_near[:, 1]]


def joined_groups(mesh: TriMesh, joined: Ints) -> Ints:
    """The number of the group of components that each vertex belongs to, (n,) int32.

    joined: (j, 2) components that a joint holds together.
    """
    count = int(mesh.component.max()) + 1
    first, second = joined.T
    graph = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
    return connected_components(graph, directed=False)[1][mesh.component].astype(np.int32)
