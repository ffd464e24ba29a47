"""The shapes on which laws are tested, in pixels, made without the code that meshes pictures."""

import numpy as np
from scipy.spatial import Delaunay

from akap_editor.geometry.mesh import MeshPoints, TriMesh, signed_areas


def blocks(picture: str, size: float, divisions: int = 1, jitter: float = 0.0) -> TriMesh:
    """Return a mesh with a square of side ``size`` for each # in the rows of ``picture``.

    divisions: a square has divisions² pairs of faces; jitter: share of a face's side by which vertices are
    moved at random.
    """
    filled = np.array([[mark == "#" for mark in row] for row in picture.split()])
    filled = filled.repeat(divisions, axis=0).repeat(divisions, axis=1)
    rows, columns = np.nonzero(filled)
    width = filled.shape[1] + 1
    corner = rows * width + columns
    a, b, c, d = corner, corner + 1, corner + width + 1, corner + width
    slash = ((rows + columns) % 2 == 0)[:, None]
    first = np.where(slash, np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    second = np.where(slash, np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    used, faces = np.unique(np.concatenate([first, second]), return_inverse=True)
    side = size / divisions
    points = np.stack([used % width, used // width], axis=1) * side
    noise = np.random.default_rng(1).uniform(-1, 1, points.shape)
    return TriMesh(points + jitter * side * noise, faces.reshape(-1, 3))


def random_disc(seed: int, count: int = 60) -> TriMesh:
    """Return a Delaunay mesh of a circle of radius 100 with ``count`` random vertices inside."""
    rng = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    rim = 100 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    phi = rng.uniform(0, 2 * np.pi, count)
    inside = 90 * np.sqrt(rng.uniform(0, 1, count))[:, None] * np.stack([np.cos(phi), np.sin(phi)], axis=1)
    points = np.concatenate([rim, inside]) + 120
    return TriMesh(points, orient(points, Delaunay(points).simplices))


def star() -> TriMesh:
    """Return a star with five points, subdivided twice."""
    angle = np.arange(10) * np.pi / 5
    radius = np.where(np.arange(10) % 2, 45.0, 110.0)
    rim = 120 + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([rim, [[120.0, 120.0]]])
    faces = np.array([[i, (i + 1) % 10, 10] for i in range(10)])
    for _ in range(2):
        points, faces = subdivide(points, faces)
    return TriMesh(points, faces)


def subdivide(points: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cut each face into four at the midpoints of its edges."""
    sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, edge_of_side = np.unique(sides, axis=0, return_inverse=True)
    midpoints = edge_of_side.reshape(-1, 3) + len(points)
    (a, b, c), (ab, bc, ca) = faces.T, midpoints.T
    quarters = np.concatenate(
        [np.stack(corner, axis=1) for corner in [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]]
    )
    return np.concatenate([points, points[edges].mean(axis=1)]), quarters


def orient(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Reverse the faces whose signed area is negative."""
    flipped = signed_areas(points, faces) < 0
    return np.where(flipped[:, None], faces[:, ::-1], faces)


def renumbered(mesh: TriMesh, seed: int) -> tuple[TriMesh, np.ndarray, np.ndarray]:
    """Return the mesh with vertices, faces and first corners in random order, and both permutations.

    The first permutation gives the old index of each new vertex, the second the new index of each old face.
    """
    rng = np.random.default_rng(seed)
    order, face_order = rng.permutation(len(mesh.vertices)), rng.permutation(len(mesh.faces))
    faces = np.argsort(order)[mesh.faces][face_order]
    first_corners = rng.integers(0, 3, len(faces))
    faces = np.take_along_axis(faces, (np.arange(3) + first_corners[:, None]) % 3, axis=1)
    return TriMesh(mesh.vertices[order], faces, mesh.tied), order, np.argsort(face_order)


def random_pins(mesh: TriMesh, seed: int, each: int = 3) -> MeshPoints:
    """Return pins at random points, ``each`` of them in every connected component, in random order."""
    rng = np.random.default_rng(seed)
    labels = mesh.component[mesh.faces[:, 0]]
    faces = np.concatenate([rng.choice(np.flatnonzero(labels == part), each) for part in np.unique(labels)])
    return MeshPoints(rng.permutation(faces), rng.dirichlet([1, 1, 1], len(faces)))


def vertex_pins(mesh: TriMesh, vertices: np.ndarray) -> MeshPoints:
    """Return pins at vertices, as in the paper."""
    faces = [int(np.flatnonzero((mesh.faces == vertex).any(axis=1))[0]) for vertex in vertices]
    weights = (mesh.faces[faces] == np.asarray(vertices)[:, None]).astype(float)
    return MeshPoints(faces, weights)


SHAPES = {
    "triangle": TriMesh(np.array([[10.0, 20.0], [90.0, 30.0], [40.0, 95.0]]), np.array([[0, 1, 2]])),
    "square": blocks("#", 100, 5, 0.2),
    "bar": blocks("#####", 60, 6),
    "L": blocks("#. #. ##", 60, 4, 0.2),
    "star": star(),
    "ring": blocks("### #.# ###", 50, 3, 0.2),
    "islands": blocks("##.# ##.#", 50, 3, 0.2),
    "strip": blocks("########", 25, 1, 0.2),
    "disc 1": random_disc(1),
    "disc 2": random_disc(2, 150),
}

# Numbers of components and of holes, of the shapes with more than one component or with holes.
PARTS, HOLES = {"islands": 2}, {"ring": 1}
