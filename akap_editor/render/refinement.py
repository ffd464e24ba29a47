"""A mesh refined for drawing: each face divided into smaller ones that follow a smooth map of the pose.

A pose moves points inside a face linearly, so that a line of the picture has a corner at each edge that it
crosses. Here a face is a cubic Bézier triangle over its rest shape. Its control points follow from the
corners and from the derivatives of the pose at them, as in PN triangles (Vlachos, Peters, Boyd, Mitchell,
Curved PN Triangles, I3D 2001). A derivative at a vertex is the mean over its faces, weighted by area. The
curve of an edge depends only on its two ends, so that neighbors meet without gaps, and a linear map stays
what it is. All points are linear in the pose, so that one sparse matrix makes them.
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np
from scipy import sparse

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints

MAX_PARTS = 4  # of an edge
MAX_FACES = 160_000  # of a refined mesh
TOLERANCE = 0.1  # pixels between a curve and the lines that are drawn for it


@dataclass(frozen=True, eq=False)
class Refinement:
    """How the points of a refined mesh follow from those of the mesh, (n, 2).

    parts: of each edge, k; smooth: (p, n) makes its places in a pose; linear: (p, n) interpolates what is
    linear on faces, for example texture coordinates; faces: (m, k², 3) indices of its points, by face;
    curvature: (2 e, n) makes the second derivatives of the curves of the edges at both ends, by their
    parameter from 0 to 1; coarser: refinements with fewer parts of the same points, coarsest first.
    """

    parts: int
    smooth: sparse.csr_matrix
    linear: sparse.csr_matrix
    faces: Ints
    curvature: sparse.csr_matrix
    coarser: tuple["Refinement", ...] = ()

    def bend(self, positions: Floats) -> float:
        """The distance between the curves of the edges and straight lines in a pose (n, 2), at most."""
        return float(np.linalg.norm(self.curvature @ positions, axis=1).max(initial=0.0)) / 8

    def fitting(self, bend: float) -> "Refinement":
        """The coarsest one that shows the curves within `TOLERANCE`. bend: in pixels, of the pose."""
        return next((each for each in self.coarser if bend <= TOLERANCE * each.parts**2), self)


def suitable_parts(mesh: TriMesh, most: int = MAX_PARTS) -> int:
    """Into how many parts edges are divided: fewer of a fine mesh, whose faces are small; 1 for none."""
    faces = max(len(mesh.faces), 1)
    return max(1, min(most, int((MAX_FACES / faces) ** 0.5)))


@lru_cache(maxsize=4)
def refinement(mesh: TriMesh, parts: int) -> Refinement:
    """The refinement of a mesh with edges in ``parts`` parts."""
    n, edges = len(mesh.vertices), mesh.edges
    keys = edges[:, 0].astype(np.int64) * n + edges[:, 1]
    derivatives = _derivatives(mesh)
    edge_smooth, edge_linear = _edge_points(mesh, derivatives, parts)
    inner_smooth, inner_linear = _inner_points(mesh, derivatives, parts)
    identity = sparse.identity(n, format="csr")
    smooth = sparse.vstack([identity, edge_smooth, inner_smooth], format="csr")
    linear = sparse.vstack([identity, edge_linear, inner_linear], format="csr")
    curvature, numbers = _edge_curvature(mesh, derivatives), _point_numbers(mesh, keys, parts)
    coarser = tuple(
        Refinement(fewer, smooth, linear, _faces(numbers, fewer), curvature)
        for fewer in range(1, parts)
        if parts % fewer == 0
    )
    return Refinement(parts, smooth, linear, _faces(numbers, parts), curvature, coarser)


def _derivatives(mesh: TriMesh) -> tuple[sparse.csr_matrix, sparse.csr_matrix]:
    """(n, n) each: the derivatives of a function at the vertices by x and by y of the rest pose."""
    n, faces = len(mesh.vertices), mesh.faces
    corners = mesh.vertices[faces]
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)  # edge across from each corner
    # The gradient of a corner's hat function times the double area is the edge rotated by a quarter turn.
    gradients = np.stack([-opposite[..., 1], opposite[..., 0]], axis=-1)  # (m, corner, 2)
    doubled = 2.0 * np.bincount(faces.ravel(), np.repeat(mesh.rest_areas, 3), n)
    rows = np.repeat(faces, 3, axis=1).ravel()  # each corner ...
    columns = np.tile(faces, (1, 3)).ravel()  # ... gets a share of each corner

    def derivative(axis: int) -> sparse.csr_matrix:
        values = np.tile(gradients[..., axis], (1, 3)).ravel() / doubled[rows]
        return sparse.csr_matrix((values, (rows, columns)), shape=(n, n))

    return derivative(0), derivative(1)


def _edge_points(
    mesh: TriMesh, derivatives: tuple[sparse.csr_matrix, sparse.csr_matrix], parts: int
) -> tuple[sparse.csr_matrix, sparse.csr_matrix]:
    """The points that divide the edges, edge by edge from the lower to the higher vertex: cubic curves."""
    edges = np.repeat(mesh.edges, parts - 1, axis=0)
    t = np.tile(np.arange(1, parts) / parts, len(mesh.edges))
    start, end = edges.T
    along = mesh.vertices[end] - mesh.vertices[start]
    rows, n = np.arange(len(t)), len(mesh.vertices)
    shape = (len(t), n)

    def selected(weights_start: Floats, weights_end: Floats) -> sparse.csr_matrix:
        values, columns = np.concatenate([weights_start, weights_end]), np.concatenate([start, end])
        return sparse.csr_matrix((values, (np.tile(rows, 2), columns)), shape=shape)

    s = 1.0 - t
    smooth = selected(s**3 + 3 * s * s * t, t**3 + 3 * s * t * t)
    for axis, derivative in enumerate(derivatives):
        smooth = smooth + sparse.diags(s * s * t * along[:, axis]) @ derivative[start]
        smooth = smooth - sparse.diags(s * t * t * along[:, axis]) @ derivative[end]
    return smooth.tocsr(), selected(s, t)


def _edge_curvature(
    mesh: TriMesh, derivatives: tuple[sparse.csr_matrix, sparse.csr_matrix]
) -> sparse.csr_matrix:
    """Second derivatives at the starts of the edges, then at their ends; see `Refinement`."""
    start, end = mesh.edges.T
    along = mesh.vertices[end] - mesh.vertices[start]
    identity = sparse.identity(len(mesh.vertices), format="csr")
    chords = 6.0 * (identity[end] - identity[start])
    at_start, at_end = chords, -chords
    for axis, derivative in enumerate(derivatives):
        tangents = [sparse.diags(along[:, axis]) @ derivative[vertices] for vertices in (start, end)]
        at_start = at_start - 4.0 * tangents[0] - 2.0 * tangents[1]
        at_end = at_end + 2.0 * tangents[0] + 4.0 * tangents[1]
    return sparse.vstack([at_start, at_end], format="csr")


def _inner_points(
    mesh: TriMesh, derivatives: tuple[sparse.csr_matrix, sparse.csr_matrix], parts: int
) -> tuple[sparse.csr_matrix, sparse.csr_matrix]:
    """The points inside the faces, face by face, in the order of `_inner_weights`."""
    weights = _inner_weights(parts)
    m, n, faces = len(mesh.faces), len(mesh.vertices), mesh.faces
    shape = (m * len(weights), n)
    smooth, linear = sparse.csr_matrix(shape), sparse.csr_matrix(shape)
    if not len(weights):
        return smooth, linear
    rows = np.arange(shape[0])
    product = np.tile(weights.prod(axis=1), m)
    for i in range(3):
        vertices = np.repeat(faces[:, i], len(weights))
        own = np.tile(weights[:, i], m)
        coefficient = own**3 - product
        for j in (j for j in range(3) if j != i):
            other = np.tile(weights[:, j], m)
            control = 3 * own * own * other + 1.5 * product
            coefficient = coefficient + control
            along = np.repeat(mesh.vertices[faces[:, j]] - mesh.vertices[faces[:, i]], len(weights), axis=0)
            for axis, derivative in enumerate(derivatives):
                smooth = smooth + sparse.diags(control / 3 * along[:, axis]) @ derivative[vertices]
        smooth = smooth + sparse.csr_matrix((coefficient, (rows, vertices)), shape=shape)
        linear = linear + sparse.csr_matrix((own, (rows, vertices)), shape=shape)
    return smooth.tocsr(), linear.tocsr()


def _inner_weights(parts: int) -> Floats:
    """Barycentric weights (q, 3) of the points inside a face."""
    found = [(parts - a - b, a, b) for a in range(1, parts) for b in range(1, parts - a) if a + b < parts]
    return np.array(found, dtype=np.float64).reshape(-1, 3) / parts


def _point_numbers(mesh: TriMesh, keys: Ints, parts: int) -> Ints:
    """(m, parts + 1, parts + 1) the points of each face by their weights of corner 1 and of corner 2."""
    n, m = len(mesh.vertices), len(mesh.faces)
    numbers = np.empty((m, parts + 1, parts + 1), dtype=np.int64)
    numbers[:, 0, 0], numbers[:, parts, 0], numbers[:, 0, parts] = mesh.faces.T
    steps = np.arange(1, parts)
    for first, second in combinations(range(3), 2):
        a, b = mesh.faces[:, first].astype(np.int64), mesh.faces[:, second].astype(np.int64)
        edge = np.searchsorted(keys, np.minimum(a, b) * n + np.maximum(a, b))
        at = np.where((a < b)[:, None], steps, parts - steps)  # of each point from first to second
        points = n + edge[:, None] * (parts - 1) + at - 1
        weights = np.zeros((parts - 1, 3), dtype=int)
        weights[:, first], weights[:, second] = parts - steps, steps
        numbers[:, weights[:, 1], weights[:, 2]] = points
    inner = np.rint(_inner_weights(parts) * parts).astype(int)
    base = n + len(keys) * (parts - 1) + np.arange(m)[:, None] * len(inner)
    numbers[:, inner[:, 1], inner[:, 2]] = base + np.arange(len(inner))
    return numbers


def _faces(numbers: Ints, parts: int) -> Ints:
    """(m, parts², 3) the points of the small faces of each face. numbers: see `_point_numbers`."""
    corners = _small_faces(parts) * ((numbers.shape[1] - 1) // parts)
    return numbers[:, corners[..., 0], corners[..., 1]].astype(np.int32)


def _small_faces(parts: int) -> Ints:
    """(parts², 3, 2) corners of the small faces of a face: steps along its second and its third corner."""
    small = []
    for row in range(parts):
        for column in range(parts - row):
            small.append([(row, column), (row + 1, column), (row, column + 1)])
            if row + column < parts - 1:
                small.append([(row + 1, column), (row + 1, column + 1), (row, column + 1)])
    return np.array(small)


def small_corners(parts: int) -> Floats:
    """(parts², 3, 3) corners of the small faces of a face, barycentric in it."""
    others = _small_faces(parts) / parts
    return np.concatenate([1.0 - others.sum(axis=2, keepdims=True), others], axis=2)
