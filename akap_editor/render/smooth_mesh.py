"""The refined mesh of a posed drawing in an OpenGL context."""

from collections.abc import Sequence
from dataclasses import replace

import moderngl
import numpy as np

from ..editor.document.drawing import Drawing
from ..geometry.validation import Floats, Ints
from .layer_runs import LayerRun
from .refinement import refinement


class SmoothMesh:
    """Draws a drawing by its `Refinement`. `release` must be called in the end.

    program: draws textured meshes; parts: of each edge; vertex_array: what to render; uv: (p, 2) texture
    coordinates of the refinement's points.
    """

    def __init__(
        self, ctx: moderngl.Context, program: moderngl.Program, drawing: Drawing, parts: int
    ) -> None:
        self._refinement = refinement(drawing.mesh, parts)
        self.uv = np.asarray(self._refinement.linear @ drawing.uv.astype(np.float64))
        places = ctx.buffer(reserve=8 * len(self.uv), dynamic=True)
        self._places, self._uv = places, ctx.buffer(np.ascontiguousarray(self.uv, dtype=np.float32))
        self._faces = ctx.buffer(reserve=4 * self._refinement.faces.size, dynamic=True)
        self.vertex_array = ctx.vertex_array(
            program, [(places, "2f", "in_position"), (self._uv, "2f", "in_uv")], self._faces
        )
        self._positions: Floats | None = None
        self._order: Ints | None = None
        self._has_faces = False

    def show(self, positions: Floats, order: Ints | None) -> None:
        """Upload a pose (n, 2) and the faces of the mesh in drawing order, unless they are there already."""
        if positions is not self._positions:
            places = np.asarray(self._refinement.smooth @ positions, dtype=np.float32)
            self._places.orphan()
            self._places.write(np.ascontiguousarray(places))
            self._positions = positions
        if order is not self._order or not self._has_faces:
            faces = self._refinement.faces if order is None else self._refinement.faces[order]
            self._faces.orphan()
            self._faces.write(np.ascontiguousarray(faces, dtype=np.uint32))
            self._order, self._has_faces = order, True

    def runs(self, runs: Sequence[LayerRun]) -> tuple[LayerRun, ...]:
        """Runs of faces of the mesh as runs of the small faces."""
        count = self._refinement.parts**2
        return tuple(replace(run, first=count * run.first, count=count * run.count) for run in runs)

    def release(self) -> None:
        """Free every OpenGL object."""
        for item in (self.vertex_array, self._places, self._uv, self._faces):
            item.release()
