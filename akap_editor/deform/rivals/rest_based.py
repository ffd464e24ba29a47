"""What methods have in common whose result is made from the rest pose."""

import time
from abc import ABC, abstractmethod
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from ...errors import SolverError
from ...geometry.mesh import MeshPoints, TriMesh, signed_areas
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, Ints, as_indices, as_points
from ..deformer import Deformer, StepReport, StepResult, as_targets

_SAME_PLACE = 1e-3  # share of √area: pins nearer than this are at one place


def product(matrix: Floats | Complexes, values: Complexes) -> Complexes:
    """Matrix (n, k) times values (k,), not by BLAS: on a busy machine its threads wait for one another."""
    return np.asarray(np.einsum("nk,k->n", matrix, values))


class RestBasedDeformer(Deformer, ABC):
    """A `Deformer` that goes from the rest pose to the result at once, without a way there.

    A component without a pin holds still. A method fills in `_prepare` and `_moved`.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._mesh = mesh
        self._rest = to_complex(mesh.vertices)
        self._same_place = _SAME_PLACE * mesh.length
        self.set_pins(MeshPoints(np.zeros(0, dtype=np.int32), np.zeros((0, 3))))

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins; moves nothing. Raises InputError where a face is not one of the mesh."""
        as_indices(points.faces, "points.faces", None, len(self._mesh.faces))
        corners = self._mesh.faces[points.faces]
        k, n = len(points), len(self._rest)
        rows = np.repeat(np.arange(k), 3)
        self._weights = csr_array((points.weights.ravel(), (rows, corners.ravel())), shape=(k, n))
        self._pins = self._weights @ self._rest
        self._pin_components = self._mesh.component[corners[:, 0]]
        self._held = ~np.isin(self._mesh.component, self._pin_components)
        self._prepare()

    def step(self, positions: ArrayLike, targets: ArrayLike) -> StepResult:
        """Move the pose (n, 2) so that its pins come to ``targets`` (k, 2); see `Deformer.step`."""
        started = time.perf_counter()
        pose = to_complex(as_points(positions, "positions", len(self._rest)))
        goals = as_targets(targets, len(self._pins), self._mesh, pose)
        moved = self._moved(pose, goals) if len(goals) else pose
        moved = np.where(self._held, pose, moved)
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

    def _parts(self) -> Iterator[tuple[int, Ints, Ints, bool]]:
        """Each component with pins: its number, vertices, pins, and whether those are at one place."""
        for part in np.unique(self._pin_components):
            pins = np.flatnonzero(self._pin_components == part)
            together = np.abs(self._pins[pins] - self._pins[pins[0]]).max() <= self._same_place
            yield int(part), np.flatnonzero(self._mesh.component == part), pins, bool(together)

    @abstractmethod
    def _prepare(self) -> None:
        """Compute what depends on where the pins are."""

    @abstractmethod
    def _moved(self, pose: Complexes, goals: Complexes) -> Complexes:
        """The new pose (n,) for at least one target (k,); where nothing is pinned it does not matter."""
