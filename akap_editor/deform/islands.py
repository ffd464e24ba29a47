"""Islands ride: a part of a drawing without a pin moves as a rigid body with the part nearest to it.

Parts are tied across the gaps between them, the narrowest first, in chains that begin at a part with a pin:
of three whiskers the outer ones ride with the one that is next to the cheek. All that hangs on one gap rides
with one patch of the pinned part: its vertices near that gap, with weights w that fall with the way to it on
the mesh. For vertices r at rest and p in a pose, as complex numbers, with weighted means r* and p*,

    T(z) = p* + e^iθ (z − r*),    e^iθ = S / |S|,    S = Σ w conj(r − r*) p

is the rigid motion that takes the patch from rest to the pose in the sense of least squares. A step that
takes the patch from T₀ to T₁ takes its riders along by T₁ T₀⁻¹. So where they come to depends only on where
the patch is, not on the way there or on how it was cut into steps, and choosing pins moves nothing.
"""

import math
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace
from heapq import heapify, heappop, heappush
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from ..geometry.mesh import MeshPoints, TriMesh
from ..geometry.operators import to_complex, to_points
from ..geometry.validation import Complexes, Floats, Ints, as_points
from .deformer import Deformer, StepResult

_COLLAPSED = 1e-9  # share of its S at rest below which a patch has no direction
_FARTHEST = 3.0  # reaches: there the weight of a vertex is below 1/8000


@dataclass(frozen=True, eq=False)
class _Islands:
    """The vertices that ride, and the patches that they ride with.

    vertices: (r,); patch: (r,) of each of them; mean, arms: (g, n) sparse, p* and S of each patch from a
    pose; smallest: (g,) |S| below which there is no direction.
    """

    vertices: Ints
    patch: Ints
    mean: csr_array
    arms: csr_array
    smallest: Floats

    def carry_islands(self, before: Complexes, positions: Floats) -> Floats:
        """The pose ``positions`` with the riders where the patches take them from the pose ``before``."""
        pose = to_complex(positions).copy()
        after, first = self.arms @ pose, self.arms @ before
        directed = np.minimum(np.abs(after), np.abs(first)) > self.smallest
        turn = np.where(directed, after * first.conj(), 1.0)
        turn = (turn / np.abs(turn))[self.patch]
        away = before[self.vertices] - (self.mean @ before)[self.patch]
        pose[self.vertices] = (self.mean @ pose)[self.patch] + turn * away
        return to_points(pose)

    def velocities(self, pose: Complexes, field: Floats) -> Floats:
        """The field (n, 2) with the velocities of T at the riders, for a patch that follows the field."""
        result = to_complex(field).copy()
        spread = self.arms @ pose
        directed = np.abs(spread) > self.smallest
        spin = np.divide(self.arms @ result, spread, out=np.zeros_like(spread), where=directed).imag
        away = pose[self.vertices] - (self.mean @ pose)[self.patch]
        result[self.vertices] = (self.mean @ result)[self.patch] + 1j * spin[self.patch] * away
        return to_points(result)


class IslandDeformer(Deformer):
    """A `Deformer` that bends the parts with pins by another one, and takes the other parts along.

    mesh: the rest pose; deformer: of the same mesh, holds parts without a pin still.
    """

    def __init__(self, mesh: TriMesh, deformer: Deformer) -> None:
        self._mesh = mesh
        self._bending: Any = deformer  # of a method that may have more than the contract asks for
        self.holds_angles, self.takes_stiffness = deformer.holds_angles, deformer.takes_stiffness
        self.has_memory, self.has_vector_fields = deformer.has_memory, deformer.has_vector_fields
        self._rest = to_complex(mesh.vertices)
        corner_areas = np.repeat(mesh.rest_areas / 3, 3)
        self._masses = np.bincount(mesh.faces.ravel(), corner_areas, len(self._rest))
        self._part_areas = np.bincount(mesh.component, self._masses)
        self.set_pins(MeshPoints(np.zeros(0, dtype=np.int32), np.zeros((0, 3))))

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins; moves nothing. Raises InputError where a face is not one of the mesh."""
        self._bending.set_pins(points)
        pinned = np.unique(self._mesh.component[self._mesh.faces[points.faces, 0]])
        carriers = _carriers(self._mesh, pinned.tolist())
        gaps = sorted(set(carriers.values()))
        patches = np.full(len(self._part_areas), -1)
        patches[list(carriers)] = [gaps.index(gap) for gap in carriers.values()]
        patch = patches[self._mesh.component]
        riders = np.flatnonzero(patch >= 0)
        mean = csr_array(np.array([self._weights(*gap) for gap in gaps]).reshape(-1, len(self._rest)))
        arms = mean.astype(np.complex128).tocoo()
        row, column = arms.coords
        arms.data *= (self._rest[column] - (mean @ self._rest)[row]).conj()
        smallest = _COLLAPSED * np.abs(arms @ self._rest)
        self._riders = _Islands(riders, patch[riders], mean, arms.tocsr(), smallest)

    def step(self, positions: ArrayLike, targets: ArrayLike, angles: ArrayLike | None = None) -> StepResult:
        """Move the pose (n, 2) so that its pins come to ``targets`` (k, 2); see `Deformer.step`.

        angles: (k,) of a method that `holds_angles`; to be left out for others.
        """
        started = time.perf_counter()
        pose, riders = as_points(positions, "positions", len(self._rest)), self._riders
        more = () if angles is None else (angles,)
        result: StepResult = self._bending.step(pose, targets, *more)
        if not len(riders.vertices):
            return result
        before = to_complex(pose)
        moved, field, flow = riders.carry_islands(before, result.positions), result.field, None
        if result.flow is not None:
            flow = _after(result.flow, lambda parts: riders.carry_islands(before, parts))
            if field is not None:  # that of the last substep
                start = flow(1 - 1 / max(result.report.substeps, 1))
                field = riders.velocities(to_complex(start), field)
        report = replace(result.report, seconds=time.perf_counter() - started)
        return StepResult(moved, field, report, flow)

    def vector_field(self, positions: ArrayLike, velocities: ArrayLike) -> Floats:
        """U_opt at a pose (n, 2) for pin velocities (k, 2), (n, 2), of a method that has fields."""
        return self.vector_fields(positions, velocities)[0]

    def vector_fields(self, positions: ArrayLike, velocities: ArrayLike) -> tuple[Floats, Floats]:
        """U_opt and U°, (n, 2) each, of a method that has fields; otherwise like `vector_field`."""
        pose = as_points(positions, "positions", len(self._rest))
        optimal, smooth = self._bending.vector_fields(pose, velocities)
        here = to_complex(pose)
        return self._riders.velocities(here, optimal), self._riders.velocities(here, smooth)

    def _weights(self, carrier: int, island: int) -> Floats:
        """Weights (n,) with sum 1 of the patch at the gap between these two vertices.

        It reaches as far as the island is away and half as far as it is large: a wide one rides with more
        than the nearest tip.
        """
        gap = float(np.abs(self._rest[island] - self._rest[carrier]))
        size = math.sqrt(self._part_areas[self._mesh.component[island]])
        reach = max(gap + size / 2, self._mesh.edge_graph[[carrier]].data.max())
        way = dijkstra(self._mesh.edge_graph, indices=carrier, limit=_FARTHEST * reach)
        weights = self._masses * np.exp(-((way / reach) ** 2))
        return np.asarray(weights / weights.sum())


def _carriers(mesh: TriMesh, pinned: list[int]) -> dict[int, tuple[int, int]]:
    """Of each part without a pin the gap at which its chain leaves a pinned part: vertices there and here."""
    gaps: dict[int, list[tuple[float, int, int]]] = defaultdict(list)
    for i, j in mesh.gaps.tolist():
        width = float(np.hypot(*(mesh.vertices[i] - mesh.vertices[j])))
        gaps[int(mesh.component[i])].append((width, i, j))
        gaps[int(mesh.component[j])].append((width, j, i))
    carriers: dict[int, tuple[int, int]] = {}
    queue = [gap for part in pinned for gap in gaps[part]]
    heapify(queue)
    while queue:
        _, here, there = heappop(queue)
        part = int(mesh.component[there])
        if part not in carriers and part not in pinned:
            carriers[part] = carriers.get(int(mesh.component[here]), (here, there))
            for gap in gaps[part]:
                heappush(queue, gap)
    return carriers


def _after(flow: Callable[[float], Floats], then: Callable[[Floats], Floats]) -> Callable[[float], Floats]:
    return lambda t: then(flow(t))
