"""Point-to-point Cauchy–Green coordinates: Weber, Ben-Chen and Gotsman 2009, "Complex Barycentric Coordinates
with Applications to Planar Shape Deformation".

With points as complex numbers, a cage z_1, ..., z_N around the drawing and complex values h_j at its vertices
define the holomorphic, hence conformal, map g(z) = Σ C_j(z) h_j: the Cauchy integral of values that are
linear along edges. With A_j = z_j − z_j−1 and B_j = z_j − z,

    2πi C_j(z) = B_j+1/A_j+1 log(B_j+1/B_j) − B_j−1/A_j log(B_j/B_j−1)
    2πi g''(z) = Σ (h_j − h_j−1) / (B_j−1 B_j)

The values minimize Σ |g(p) − q|² + λ² ∫ |g''|² ds over pins p with targets q and the outline of the drawing,
as in the paper's section on point-to-point coordinates. Similarities cost nothing for any λ. Lengths are in
units of the square root of the area within the outline, so that λ has no unit.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array

from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...geometry.operators import to_complex
from ...geometry.validation import Complexes, as_number
from .rest_based import RestBasedDeformer, product

CAGE_OFFSET = 0.02  # distance of the cage from the drawing, larger if it would have too many vertices
_SAMPLE_DISTANCE = 0.02  # along the outline, where g'' is evaluated; at least two samples per cage vertex
_STRAIGHT = 1e-6  # distance from a straight line below which boundary vertices are dropped
_DAMPING = 1e-2  # weight of Σ |h|², which determines values that g does not depend on


class CauchyGreenDeformer(RestBasedDeformer):
    """Point-to-point Cauchy-Green coordinates (Weber, Ben-Chen and Gotsman 2009).

    mesh: the rest pose, without overlaps.
    cage: maximum number of vertices of a cage; each component has its own.
    smoothness: λ; the smaller it is, the closer pins come to their targets.
    The map is conformal in the whole cage: holes bend as if filled, and narrow gaps as if closed. It scales
    instead of shearing, and parts may overlap. Pins at one place move their component without rotating it.
    The result does not depend on the current pose.
    Raises InputError for arguments out of range, or if a component of the mesh overlaps itself.
    """

    def __init__(self, mesh: TriMesh, cage: int = 200, smoothness: float = 1e-4) -> None:
        size = int(as_number(cage, "cage", 16, 1000))
        self._smoothness = as_number(smoothness, "smoothness", 1e-6, 1e6)
        components = range(mesh.component.max() + 1)
        self._maps = [_holomorphic_maps(mesh, component, size) for component in components]
        super().__init__(mesh)

    def _prepare(self) -> None:
        """Compute the matrix (n, k) that takes displacements of pins to those of vertices."""
        self._influence = np.zeros((len(self._rest), len(self._pins)), dtype=np.complex128)
        for component, own, pins, at_one_place in self._pinned_components():
            block = np.ix_(own, pins)
            if at_one_place:
                self._influence[block] = 1 / len(pins)
            else:
                at_pins = self._weights[pins][:, own]
                self._influence[block] = self._best_maps(self._maps[component], at_pins)

    def _best_maps(self, maps: "_HolomorphicMaps", at_pins: csr_array) -> Complexes:
        """The minimizers for a unit displacement of each pin, (n, k).

        at_pins: (k, n), evaluates a map at the pins. Affine maps follow two dimensions of the pins'
        displacements at no cost; features follow the others.
        """
        features, affine = at_pins @ maps.features, at_pins @ maps.affine
        complement = np.linalg.qr(affine, mode="complete")[0][:, 2:].conj().T
        left, sizes, right = np.linalg.svd(complement @ features, full_matrices=False)
        damped = sizes / (sizes**2 + self._smoothness**2)
        y = right.conj().T @ (damped[:, None] * (left.conj().T @ complement))
        b = np.linalg.pinv(affine) @ (np.eye(len(affine)) - features @ y)
        return np.asarray(maps.features @ y + maps.affine @ b)

    def _deform(self, pose: Complexes, goals: Complexes) -> Complexes:
        return self._rest + product(self._influence, goals - self._pins)


@dataclass(frozen=True, eq=False)
class _HolomorphicMaps:
    """The holomorphic maps of one component, by their values at its vertices.

    features: (n, N) maps, orthonormal in ∫ |g''|² ds; affine: (n, 2) the maps 1 and z, which cost nothing.
    """

    features: Complexes
    affine: Complexes


def _holomorphic_maps(mesh: TriMesh, component: int, size: int) -> _HolomorphicMaps:
    """The maps of a component from a cage of at most ``size`` vertices. Raises InputError."""
    own = mesh.component == component
    outline = max(
        (shapely.Polygon(mesh.vertices[loop]) for loop in mesh.boundary_loops if own[loop[0]]),
        key=lambda polygon: polygon.area,
    )
    if not outline.is_valid:
        raise InputError("mesh: expected a rest pose that does not overlap itself, got one that does")
    center, length = np.array(outline.centroid.coords)[0], np.sqrt(outline.area)
    points = to_complex((mesh.vertices[own] - center) / length)
    outline = shapely.Polygon((np.array(outline.exterior.coords)[:-1] - center) / length)
    outline = _from_farthest(outline).simplify(_STRAIGHT)
    cage = make_cage(outline, size)
    start = _subdivided_ring(outline, min(_SAMPLE_DISTANCE, outline.length / (2 * len(cage))))
    edge = np.roll(start, -1) - start
    roughness = np.sqrt(np.abs(edge))[:, None] * second_derivatives(cage, start + 0.5 * edge)
    # Features are orthogonal to affine maps, which cost nothing.
    affine = np.linalg.qr(np.stack([np.ones_like(cage), cage], axis=1))[0]
    rows = np.vstack([roughness, _DAMPING * np.eye(len(cage)), affine.conj().T])
    lower = np.linalg.cholesky(rows.conj().T @ rows)
    features = solve_triangular(lower, coordinates(cage, points).conj().T, lower=True).conj().T
    return _HolomorphicMaps(features, np.stack([np.ones_like(points), points], axis=1))


def _from_farthest(polygon: shapely.Polygon) -> shapely.Polygon:
    """The polygon counterclockwise from its point farthest from the center, for any numbering."""
    ring = np.array(shapely.orient_polygons(polygon).exterior.coords)[:-1]
    center = np.array(polygon.centroid.coords)[0]
    return shapely.Polygon(np.roll(ring, -int(np.argmax(((ring - center) ** 2).sum(axis=1))), axis=0))


def make_cage(outline: shapely.Polygon, size: int) -> Complexes:
    """A cage (N,), counterclockwise, around an outline: at most ``size`` vertices, nearly evenly spaced."""
    offset = CAGE_OFFSET
    around = _from_farthest(outline.buffer(offset, join_style="mitre"))
    while len(around.exterior.coords) > 3 * size // 4:
        offset *= 1.2
        around = _from_farthest(outline.buffer(offset, join_style="mitre")).simplify(offset / 2)
    return _subdivided_ring(around, around.length / (size - len(around.exterior.coords)))


def _subdivided_ring(polygon: shapely.Polygon, max_edge: float) -> Complexes:
    """The vertices of a polygon, (q,), with edges longer than ``max_edge`` subdivided."""
    ring = shapely.segmentize(polygon.exterior, max_edge * (1 + 1e-9))
    return to_complex(np.array(ring.coords)[:-1])


def coordinates(cage: Complexes, points: Complexes) -> Complexes:
    """C_j at points (n,) inside a counterclockwise cage (N,), (n, N)."""
    before = np.roll(cage, 1)
    ahead, behind = cage - points[:, None], before - points[:, None]
    logarithms = np.log(ahead / behind) / (cage - before)
    return (np.roll(ahead * logarithms, -1, axis=1) - behind * logarithms) / (2j * np.pi)


def second_derivatives(cage: Complexes, points: Complexes) -> Complexes:
    """C_j'' at points (n,) inside a counterclockwise cage (N,), (n, N)."""
    ahead = cage - points[:, None]
    edges = 1 / (ahead * np.roll(ahead, 1, axis=1))
    return (edges - np.roll(edges, -1, axis=1)) / (2j * np.pi)
