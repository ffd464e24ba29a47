"""Islands: components of a drawing without pins, which move rigidly with the nearest component that has pins.

Components are joined across the gaps between them, the narrowest first, in chains that start at a component
with a pin: of three whiskers, the outer ones move with the one next to the cheek. All islands that hang on
one gap move with one patch of the pinned component: its vertices near that gap, with weights w that fall with
the distance along the mesh. For vertices r at rest and p in a pose, as complex numbers, with weighted means
r* and p*,

    T(z) = p* + e^iθ (z − r*),    e^iθ = S / |S|,    S = Σ w conj(r − r*) p

is the rigid motion that takes the patch from rest to the pose in the sense of least squares. A step that
takes the patch from T₀ to T₁ moves the islands by T₁ T₀⁻¹. So their position depends only on that of the
patch, not on its path or on how the path was divided into steps, and choosing pins moves nothing.
"""

import math
import time
from collections import defaultdict
from dataclasses import dataclass, replace
from heapq import heapify, heappop, heappush
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from ..geometry.joints import NO_JOINTS, MeshJoints
from ..geometry.mesh import NO_POINTS, MeshPoints, TriMesh, signed_areas
from ..geometry.operators import to_complex, to_points
from ..geometry.validation import Complexes, Floats, Ints, as_points
from .deformer import Deformer, Flow, StepResult
from .layer_groups import solved_groups

_COLLAPSED = 1e-9  # share of its |S| at rest below which a patch has no direction
_CUTOFF = 3.0  # reaches from the gap at which the weight of a vertex, below 1/8000, is set to 0


@dataclass(frozen=True, eq=False)
class Islands:
    """The vertices of all islands, and the patches that carry them.

    vertices: (r,) of the islands; patch: (r,) the patch of each; mean, arms: (g, n) sparse matrices that take
    a pose to p*, or to the point of the joint that an island hangs on, and S of each patch;
    min_arms: (g,) |S| below which a patch has no direction.
    """

    vertices: Ints
    patch: Ints
    mean: csr_array
    arms: csr_array
    min_arms: Floats

    def carry(self, before: Complexes, positions: Floats, growth: Floats | None = None) -> Floats:
        """Move the islands with their patches, from the pose ``before`` (n,) to ``positions`` (n, 2).

        growth: (r,) by how much each vertex's island becomes larger, None for not at all. Returns the pose
        (n, 2) with the islands moved.
        """
        pose = to_complex(positions).copy()
        arms, arms_before = self.arms @ pose, self.arms @ before
        has_direction = np.minimum(np.abs(arms), np.abs(arms_before)) > self.min_arms
        rotation = np.where(has_direction, arms * arms_before.conj(), 1.0)
        rotation = (rotation / np.abs(rotation))[self.patch]
        offsets = before[self.vertices] - (self.mean @ before)[self.patch]
        if growth is not None:
            offsets *= growth
        pose[self.vertices] = (self.mean @ pose)[self.patch] + rotation * offsets
        return to_points(pose)

    def extend_field(self, pose: Complexes, field: Floats) -> Floats:
        """The vector field (n, 2) with the velocities of the islands, whose patches follow the field.

        pose: (n,) at which the field is given.
        """
        result = to_complex(field).copy()
        arms = self.arms @ pose
        has_direction = np.abs(arms) > self.min_arms
        rate = np.divide(self.arms @ result, arms, out=np.zeros_like(arms), where=has_direction).imag
        offsets = pose[self.vertices] - (self.mean @ pose)[self.patch]
        result[self.vertices] = (self.mean @ result)[self.patch] + 1j * rate[self.patch] * offsets
        return to_points(result)


class IslandDeformer(Deformer):
    """Deforms components with pins by another method, and moves the islands with them.

    mesh: the rest pose; deformer: of the same mesh, keeps components without a pin where they are; joints:
    components hang on one another by them before they do by gaps.
    """

    def __init__(self, mesh: TriMesh, deformer: Deformer, joints: MeshJoints | None = None) -> None:
        self._mesh = mesh
        self._joints = NO_JOINTS if joints is None else joints
        self._deformer: Any = deformer  # may have more methods than the contract asks for
        self.holds_angles, self.takes_stiffness = deformer.holds_angles, deformer.takes_stiffness
        self.has_memory, self.has_vector_fields = deformer.has_memory, deformer.has_vector_fields
        self.takes_joints, self.takes_scales = deformer.takes_joints, deformer.takes_scales
        self._scales: Floats | None = None
        self._rest = to_complex(mesh.vertices)
        corner_areas = np.repeat(mesh.rest_areas / 3, 3)
        self._vertex_areas = np.bincount(mesh.faces.ravel(), corner_areas, len(self._rest))
        self._component_areas = np.bincount(mesh.component, self._vertex_areas)
        self.set_pins(NO_POINTS)

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins, k points of the mesh; moves nothing.

        Raises InputError for points with faces that the mesh does not have.
        """
        self._deformer.set_pins(points)
        mesh, joints = self._mesh, self._joints
        pinned: list[int] = np.unique(mesh.component[mesh.faces[points.faces, 0]]).tolist()
        if self.takes_joints:
            pinned = [each for group in solved_groups(joints.components(mesh), pinned) for each in group]
        gap_of_island = _gaps_of_islands(mesh, joints, pinned)
        gaps = sorted(set(gap_of_island.values()))
        patch_of_component = np.full(len(self._component_areas), -1)
        patch_of_component[list(gap_of_island)] = [gaps.index(gap) for gap in gap_of_island.values()]
        patch = patch_of_component[self._mesh.component]
        vertices = np.flatnonzero(patch >= 0)
        weights = np.array([self._patch_weights(near, far) for near, far, _ in gaps])
        patches = csr_array(weights.reshape(-1, len(self._rest)))
        arms = patches.astype(np.complex128).tocoo()
        row, column = arms.coords
        arms.data *= (self._rest[column] - (patches @ self._rest)[row]).conj()
        mean = patches
        if any(joint >= 0 for *_, joint in gaps):
            mean = csr_array(
                np.array(
                    [
                        weights[number] if joint < 0 else self._joint_weights(near, joint)
                        for number, (near, _, joint) in enumerate(gaps)
                    ]
                )
            )
        min_arms = _COLLAPSED * np.abs(arms @ self._rest)
        self._islands = Islands(vertices, patch[vertices], mean, arms.tocsr(), min_arms)

    def prepare(self, positions: ArrayLike) -> None:
        """Announce the pose (n, 2) of the next step, see `Deformer.prepare`."""
        self._deformer.prepare(positions)

    def step(self, positions: ArrayLike, targets: ArrayLike, angles: ArrayLike | None = None) -> StepResult:
        """Move the pose (n, 2) so that its pins reach ``targets`` (k, 2), see `Deformer.step`.

        angles: (k,) as the method takes them, if it `holds_angles`. Raises InputError and SolverError.
        """
        started = time.perf_counter()
        pose, islands = as_points(positions, "positions", len(self._rest)), self._islands
        optional = () if angles is None else (angles,)
        result: StepResult = self._deformer.step(pose, targets, *optional)
        if not len(islands.vertices):
            return result
        growth = self._growth(pose)
        before, field, flow = (
            to_complex(pose),
            result.field,
            _carried_flow(result.flow, islands, pose, growth),
        )
        moved = islands.carry(before, result.positions, growth)
        if flow is not None and field is not None:  # the field belongs to the last substep
            start = flow(1 - 1 / max(result.report.substeps, 1))
            field = islands.extend_field(to_complex(start), field)
        report = replace(result.report, seconds=time.perf_counter() - started)
        return StepResult(moved, field, report, flow)

    def set_scales(self, scales: Floats | None) -> None:
        """Take scales (m,) of the faces, see `Deformer`; islands become as large as those of their own."""
        if scales is not self._scales:
            self._scales = scales
            self._deformer.set_scales(scales)

    def _growth(self, pose: Floats) -> Floats | None:
        """By how much each vertex's island becomes larger in a step from a pose (n, 2), (r,)."""
        if self._scales is None:
            return None
        mesh, count = self._mesh, len(self._component_areas)
        component = mesh.component[mesh.faces[:, 0]]
        areas = np.bincount(component, signed_areas(pose, mesh.faces), count)
        wanted = np.bincount(component, mesh.rest_areas * self._scales**2, count)
        ratio = np.divide(wanted, areas, out=np.ones(count), where=areas > 0)
        growth: Floats = np.sqrt(ratio)[mesh.component[self._islands.vertices]]
        return growth

    def vector_field(self, positions: ArrayLike, velocities: ArrayLike) -> Floats:
        """U_opt (n, 2) at a pose (n, 2) for pin velocities (k, 2), if the method has vector fields."""
        return self.vector_fields(positions, velocities)[0]

    def vector_fields(self, positions: ArrayLike, velocities: ArrayLike) -> tuple[Floats, Floats]:
        """U_opt and U°, (n, 2) each, if the method has vector fields; otherwise like `vector_field`."""
        points = as_points(positions, "positions", len(self._rest))
        optimal, smooth = self._deformer.vector_fields(points, velocities)
        pose = to_complex(points)
        return self._islands.extend_field(pose, optimal), self._islands.extend_field(pose, smooth)

    def _joint_weights(self, carrier: int, joint: int) -> Floats:
        """Weights (n,) of the point of a joint on the component of the vertex ``carrier``."""
        weights, joints = np.zeros(len(self._rest)), self._joints
        corners = self._mesh.faces[joints.faces[joint]]
        side = int(self._mesh.component[corners[1, 0]] == self._mesh.component[carrier])
        weights[corners[side]] = joints.weights[joint, side]
        return weights

    def _patch_weights(self, carrier: int, island: int) -> Floats:
        """Weights (n,) with sum 1 of the patch at the gap from the vertex ``carrier`` to ``island``.

        The patch reaches as far as the island is away, plus half the island's size: a wide island moves with
        more than the nearest tip.
        """
        gap = float(np.abs(self._rest[island] - self._rest[carrier]))
        size = math.sqrt(self._component_areas[self._mesh.component[island]])
        reach = max(gap + size / 2, self._mesh.edge_graph[[carrier]].data.max())
        distance = dijkstra(self._mesh.edge_graph, indices=carrier, limit=_CUTOFF * reach)
        weights = self._vertex_areas * np.exp(-((distance / reach) ** 2))
        return np.asarray(weights / weights.sum())


def _carried_flow(
    flow: Flow | None, islands: Islands, pose: Floats, growth: Floats | None = None
) -> Flow | None:
    """The flow γ(t) of a step from a pose (n, 2), with the islands moved."""
    before = to_complex(pose)
    if flow is None:
        return None
    return lambda t: islands.carry(before, flow(t), None if growth is None else growth**t)


def _gaps_of_islands(mesh: TriMesh, joints: MeshJoints, pinned: list[int]) -> dict[int, tuple[int, int, int]]:
    """For each component without pins, the gap at which its chain starts.

    pinned: the components with pins. A gap is a vertex of a pinned component, one of an island, and the joint
    there, −1 for none. Joints come before all gaps.
    """
    gaps: dict[int, list[tuple[float, int, int, int]]] = defaultdict(list)

    def add(width: float, i: int, j: int, joint: int) -> None:
        gaps[int(mesh.component[i])].append((width, i, j, joint))
        gaps[int(mesh.component[j])].append((width, j, i, joint))

    for joint, (faces, weights) in enumerate(zip(joints.faces, joints.weights, strict=True)):
        i, j = mesh.faces[faces, weights.argmax(axis=1)].tolist()
        add(-1.0, i, j, joint)
    for (i, j), width in zip(mesh.gaps.tolist(), mesh.gap_widths.tolist(), strict=True):
        add(width, i, j, -1)
    first_gaps: dict[int, tuple[int, int, int]] = {}
    queue = [gap for component in pinned for gap in gaps[component]]
    heapify(queue)
    while queue:
        _, near, far, joint = heappop(queue)
        component = int(mesh.component[far])
        if component not in first_gaps and component not in pinned:
            first_gaps[component] = first_gaps.get(int(mesh.component[near]), (near, far, joint))
            for gap in gaps[component]:
                heappush(queue, gap)
    return first_gaps
