"""Rotations of the vertices that agree at the joints, for the preconditioner.

R A₀⁻¹ Rᵀ, with R the rotation of each vertex since A₀ was factorized, is a good preconditioner as long as R
varies little where vertices are coupled. The rows of a hinge couple two components that rotate differently,
with a λ² ten thousand times as strong as the material: R A₀ Rᵀ would hold together W_a R_a⁻¹ u and
W_b R_b⁻¹ u, and an angle of 1/10 between R_a and R_b would change an eigenvalue by a factor of a hundred.
Vectors carried from pose to pose by R would open the hinge. So near a joint R goes over into one common
rotation. What the material there then rotates too much or too little costs far less: with a weight that
falls with the logarithm of the distance, the harmonic one around a point, the least.
"""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ...geometry.joints import JointRows
from ...geometry.mesh import TriMesh
from ...geometry.operators import to_complex
from ...geometry.validation import Complexes, Floats, Ints

_REACH = 0.5  # share of √area of a component: how far from a joint its rotations are blended
_COLLAPSED = 1e-9  # length of a mean of unit numbers below which it has no direction


class JointFrames:
    """Blends the rotations of vertices near joints into rotations that both components have there.

    mesh: the rest pose. Joints that are close to one another on a component have one rotation in common.
    """

    def __init__(self, mesh: TriMesh, joints: JointRows) -> None:
        rest, component = to_complex(mesh.vertices), mesh.component
        areas = np.bincount(component[mesh.faces[:, 0]], mesh.rest_areas)
        ends = _JointEnds(rest, component, joints)
        self._cluster_of_corner = np.repeat(ends.clusters, ends.corners.shape[1])
        self._corners, self._corner_weights = ends.corners.ravel(), ends.weights.ravel()
        self._count = int(ends.clusters.max()) + 1
        vertices, clusters, weights = [], [], []
        for number in np.unique(ends.components):
            own, mine = np.flatnonzero(component == number), np.flatnonzero(ends.components == number)
            distances = np.abs(rest[own][:, None] - ends.places[mine])
            nearest = distances.argmin(axis=1)
            between = np.abs(ends.places[mine][:, None] - ends.places[mine])
            between[ends.clusters[mine][:, None] == ends.clusters[mine]] = np.inf
            radii = ends.radii[mine]
            reach = np.maximum(_REACH * np.sqrt(areas[number]), 2 * radii)
            reach = np.minimum(reach, between.min(axis=1) / 2)[nearest]
            distance = np.maximum(distances.min(axis=1), radii[nearest])
            weight = np.log(reach / distance) / np.log(reach / radii[nearest])
            near = weight > 0
            vertices.append(own[near])
            clusters.append(ends.clusters[mine][nearest[near]])
            weights.append(weight[near])
        self._vertices: Ints = np.concatenate(vertices)
        self._clusters: Ints = np.concatenate(clusters)
        self._weights: Floats = np.concatenate(weights)

    def blend(self, frames: Complexes) -> Complexes:
        """The rotations (n,) of the vertices, unit complex numbers, blended near the joints."""
        common = np.zeros(self._count, dtype=np.complex128)
        np.add.at(common, self._cluster_of_corner, self._corner_weights * frames[self._corners])
        common = _directions(common)
        own = frames[self._vertices]
        result = frames.copy()
        result[self._vertices] = _directions(own + self._weights * (common[self._clusters] - own))
        return result


class _JointEnds:
    """The two ends of each joint, (2j,): first those on the first components, then the others.

    corners, weights: (2j, c) of the strong rows; components, places, radii: (2j,), the places in the rest
    pose, and how far from them the corners are; clusters: (2j,) numbers of the common rotations.
    """

    def __init__(self, rest: Complexes, component: Ints, joints: JointRows) -> None:
        count = len(joints.places)
        places = to_complex(joints.places)
        strong = joints.is_strong.reshape(count, -1)
        corners, weights = joints.corners.reshape(count, -1, 6), np.abs(joints.weights.reshape(count, -1, 6))
        weights = weights * strong[:, :, None]
        sides = [slice(0, 3), slice(3, 6)]
        self.corners = np.concatenate([corners[:, :, side].reshape(count, -1) for side in sides])
        self.weights = np.concatenate([weights[:, :, side].reshape(count, -1) for side in sides])
        self.components, self.places = component[self.corners[:, 0]], np.tile(places, 2)
        far = np.abs(rest[self.corners] - self.places[:, None])
        self.radii = np.where(self.weights > 0, far, 0.0).max(axis=1)
        between = np.abs(self.places[:, None] - self.places)
        close = between < 2 * (self.radii[:, None] + self.radii)
        close &= self.components[:, None] == self.components
        first, second = np.nonzero(close)
        pairs = np.arange(count)
        first, second = np.append(first, pairs), np.append(second, pairs + count)
        graph = coo_array((np.ones(len(first)), (first, second)), shape=(2 * count, 2 * count))
        self.clusters = connected_components(graph, directed=False)[1]


def _directions(values: Complexes) -> Complexes:
    """z / |z| of complex numbers; 1 for those without a direction."""
    lengths = np.abs(values)
    has_direction = lengths > _COLLAPSED
    return np.divide(values, lengths, out=np.ones_like(values), where=has_direction)
