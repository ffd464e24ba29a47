"""The base of methods that compute their result from the rest pose."""

import time
from abc import ABC, abstractmethod
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from ...errors import SolverError
from ...geometry.mesh import NO_POINTS, MeshPoints, TriMesh, signed_areas
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, Ints, as_indices, as_points
from ..deformer import SAME_PLACE, Deformer, StepReport, StepResult, as_targets


def product(matrix: Floats | Complexes, values: Complexes) -> Complexes:
    """Matrix (n, k) times values (k,). Not by BLAS, whose threads wait for one another on a busy machine."""
    return np.asarray(np.einsum("nk,k->n", matrix, values))


class RestBasedDeformer(Deformer, ABC):
    """A `Deformer` whose result follows from the rest pose, without a path of the vertices.

    mesh: the rest pose. Components without a pin stay where they are. Subclasses implement `_prepare` and
    `_deform`.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._mesh = mesh
        self._rest = to_complex(mesh.vertices)
        self._same_place = SAME_PLACE * mesh.length
        self.set_pins(NO_POINTS)

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins, k points of the mesh; moves nothing.

        Raises InputError for points with faces that the mesh does not have.
        """
        as_indices(points.faces, "points.faces", None, len(self._mesh.faces))
        corners = self._mesh.faces[points.faces]
        k, n = len(points), len(self._rest)
        rows = np.repeat(np.arange(k), 3)
        self._weights = csr_array((points.weights.ravel(), (rows, corners.ravel())), shape=(k, n))
        self._pins = self._weights @ self._rest
        self._pin_components = self._mesh.component[corners[:, 0]]
        self._is_unpinned = ~np.isin(self._mesh.component, self._pin_components)
        self._prepare()

    def step(self, positions: ArrayLike, targets: ArrayLike) -> StepResult:
        """Move the pose (n, 2) so that its pins reach ``targets`` (k, 2), see `Deformer.step`.

        Raises InputError and SolverError.
        """
        started = time.perf_counter()
        pose = to_complex(as_points(positions, "positions", len(self._rest)))
        goals = as_targets(targets, len(self._pins), self._mesh, pose)
        moved = self._deform(pose, goals) if len(goals) else pose
        moved = np.where(self._is_unpinned, pose, moved)
        if not np.isfinite(moved).all():
            raise SolverError("the step has no finite result")
        result = to_points(moved)
        report = StepReport(
            seconds=time.perf_counter() - started,
            substeps=1,
            energy=0.0,
            flipped=int((signed_areas(result, self._mesh.faces) <= 0).sum()),
            pin_error=float(np.abs(goals - self._weights @ moved).max(initial=0.0)),
        )
        return StepResult(result, None, report)

    def _pinned_components(self) -> Iterator[tuple[int, Ints, Ints, bool]]:
        """For each component with pins: number, vertices, pins, and whether the pins are at one place."""
        for component in np.unique(self._pin_components):
            pins = np.flatnonzero(self._pin_components == component)
            at_one_place = np.abs(self._pins[pins] - self._pins[pins[0]]).max() <= self._same_place
            yield int(component), np.flatnonzero(self._mesh.component == component), pins, bool(at_one_place)

    @abstractmethod
    def _prepare(self) -> None:
        """Compute what depends on the pins but not on their targets."""

    @abstractmethod
    def _deform(self, pose: Complexes, goals: Complexes) -> Complexes:
        """The new pose (n,) for the targets ``goals`` (k,), at least one.

        Values at vertices of components without a pin are ignored.
        """
