"""The smallest deformation method: a row of the table without presets and without parameters."""

import numpy as np
import pytest
from numpy.typing import ArrayLike

from akap_editor.deform.deformer import Deformer, StepReport, StepResult
from akap_editor.deform.methods import METHODS, Method
from akap_editor.geometry.mesh import NO_POINTS, MeshPoints, TriMesh
from akap_editor.geometry.validation import as_points

TOY = "toy"


class TranslationDeformer(Deformer):
    """Translates the whole mesh by the mean offset of the pins from their targets."""

    def __init__(self, mesh: TriMesh) -> None:
        self._mesh = mesh
        self._points = NO_POINTS

    def set_pins(self, points: MeshPoints) -> None:
        self._points = points

    def step(self, positions: ArrayLike, targets: ArrayLike) -> StepResult:
        pose = as_points(positions, "positions", len(self._mesh.vertices))
        offsets = as_points(targets, "targets", len(self._points)) - self._mesh.evaluate(self._points, pose)
        moved = pose + (offsets.mean(axis=0) if len(offsets) else 0.0)
        error = np.linalg.norm(offsets - (offsets.mean(axis=0) if len(offsets) else 0.0), axis=1)
        return StepResult(moved, None, StepReport(0.0, 1, 0.0, 0, float(error.max(initial=0.0))))


def add_toy_method(monkeypatch: pytest.MonkeyPatch) -> None:
    """Add the method to the table until the test ends."""
    monkeypatch.setitem(METHODS, TOY, Method(TranslationDeformer))
