"""The refined mesh of a posed drawing in an OpenGL context."""

from collections.abc import Sequence
from dataclasses import replace

import moderngl
import numpy as np

from ..editor.document.drawing import Drawing
from ..geometry.validation import Floats, Ints
from .layer_runs import LayerRun
from .refinement import Refinement, refinement


class SmoothMesh:
    """Draws a drawing by its `Refinement`. `release` must be called in the end.

    program: draws textured meshes; parts: of each edge, at most; refinement: the one that fits the pose;
    vertex_array: what to render; uv: (p, 2) texture coordinates of the refinement's points.
    """

    def __init__(
        self, ctx: moderngl.Context, program: moderngl.Program, drawing: Drawing, parts: int
    ) -> None:
        self._finest = self.refinement = refinement(drawing.mesh, parts)
        self.uv = np.asarray(self._finest.linear @ drawing.uv.astype(np.float64))
        places = ctx.buffer(reserve=8 * len(self.uv), dynamic=True)
        self._places, self._uv = places, ctx.buffer(np.ascontiguousarray(self.uv, dtype=np.float32))
        self._faces = ctx.buffer(reserve=4 * self._finest.faces.size, dynamic=True)
        self.vertex_array = ctx.vertex_array(
            program, [(places, "2f", "in_position"), (self._uv, "2f", "in_uv")], self._faces
        )
        self._positions: Floats | None = None  # that are uploaded
        self._shown: tuple[Refinement, Ints | None] | None = None  # whose faces are uploaded
        self._bent: tuple[Floats, float] | None = None  # a pose and how far it is bent

    def fit(self, positions: Floats, scale: float) -> None:
        """Choose the refinement for a pose (n, 2). scale: pixels per drawing unit."""
        if self._bent is None or positions is not self._bent[0]:
            self._bent = positions, self._finest.bend(positions)
        self.refinement = self._finest.fitting(scale * self._bent[1])

    def show(self, positions: Floats, order: Ints | None) -> None:
        """Upload a pose (n, 2) and the faces of the mesh in drawing order, unless they are there already."""
        if positions is not self._positions:
            places = np.asarray(self.refinement.smooth @ positions, dtype=np.float32)
            self._places.orphan()
            self._places.write(np.ascontiguousarray(places))
            self._positions = positions
        if self._shown is None or self._shown[0] is not self.refinement or self._shown[1] is not order:
            faces = self.refinement.faces if order is None else self.refinement.faces[order]
            self._faces.orphan()
            self._faces.write(np.ascontiguousarray(faces, dtype=np.uint32))
            self._shown = self.refinement, order

    def runs(self, runs: Sequence[LayerRun]) -> tuple[LayerRun, ...]:
        """Runs of faces of the mesh as runs of the small faces."""
        count = self.refinement.parts**2
        return tuple(replace(run, first=count * run.first, count=count * run.count) for run in runs)

    def release(self) -> None:
        """Free every OpenGL object."""
        for item in (self.vertex_array, self._places, self._uv, self._faces):
            item.release()
