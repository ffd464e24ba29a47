"""What is shown over or behind a drawing in the window, and never exported."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ..geometry.validation import Floats, Ints
from .shaders import View, load_program

_ROW = 1024  # faces in one row of the texture of levels


@dataclass(frozen=True, eq=False)
class FaceColors:
    """A color for each face.

    levels: (m,) from 0 to 1 along the scale; below 0 or NaN is off it; colors: (c, 3) the scale, 0 to 1.
    sheer: at 0 the picture is seen as it is, and the less of it the higher the level.
    """

    levels: Floats
    colors: Floats
    sheer: bool = False


@dataclass(frozen=True, eq=False)
class LineSegments:
    """Lines of one color: segments (s, 2, 2) in drawing units; width in framebuffer pixels; RGBA 0 to 1."""

    segments: Floats
    color: tuple[float, float, float, float]
    width: float


@dataclass(frozen=True, eq=False)
class Reference:
    """A picture behind the drawing: image (h, w, 4) uint8, fitted into the drawing's frame; opacity 0…1."""

    image: NDArray[np.uint8]
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class OnionPose:
    """The drawing in another pose (n, 2), behind it; tint: (r, g, b, share of it), all from 0 to 1."""

    positions: Floats
    tint: tuple[float, float, float, float]
    opacity: float


@dataclass(frozen=True, eq=False)
class Overlays:
    """mesh_lines: the edges of the mesh; ghost: opacity of the rest pose behind the drawing; skins: other
    poses of it, the last one in front.
    """

    mesh_lines: bool = False
    ghost: float = 0.0
    heat: FaceColors | None = None
    strokes: tuple[LineSegments, ...] = ()
    reference: Reference | None = None
    skins: tuple[OnionPose, ...] = ()


NO_OVERLAYS = Overlays()


class StrokePainter:
    """Draws `LineSegments` with one growing buffer."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = load_program(ctx, "lines.vert", "strokes.geom", "strokes.frag")
        self._buffer: moderngl.Buffer | None = None
        self._lines: moderngl.VertexArray | None = None

    def draw(self, strokes: Sequence[LineSegments], size: tuple[int, int], view: View) -> None:
        """Draw them in their order into the current target."""
        self._program["view"] = view
        self._program["viewport"] = size
        for stroke in strokes:
            ends = np.ascontiguousarray(stroke.segments, dtype=np.float32)
            if not ends.size:
                continue
            self._reserve(ends.nbytes)
            assert self._buffer is not None
            assert self._lines is not None
            self._buffer.orphan()
            self._buffer.write(ends)
            self._program["paint"], self._program["width"] = stroke.color, stroke.width
            self._lines.render(moderngl.LINES, vertices=2 * len(ends))

    def release(self) -> None:
        """Free every OpenGL object."""
        for item in (self._lines, self._buffer, self._program):
            if item is not None:
                item.release()

    def _reserve(self, size: int) -> None:
        if self._buffer is not None and self._buffer.size >= size:
            return
        for item in (self._lines, self._buffer):
            if item is not None:
                item.release()
        self._buffer = self._ctx.buffer(reserve=2 * size, dynamic=True)
        self._lines = self._ctx.vertex_array(self._program, [(self._buffer, "2f", "in_position")])


class HeatPainter:
    """Draws a mesh in the colors of a `FaceColors`."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self.program = load_program(ctx, "mesh.vert", "heat.frag")
        for unit, name in enumerate(("picture", "levels", "scale")):
            self.program[name] = unit
        self._levels: moderngl.Texture | None = None
        self._scale: moderngl.Texture | None = None
        self._shown: tuple[Any, ...] = ()

    def draw(self, mesh: moderngl.VertexArray, heat: FaceColors, order: Ints | None, view: View) -> None:
        """Draw ``mesh``, made with `program`, its picture bound to texture unit 0, its faces in ``order``."""
        self._upload(heat, order)
        assert self._levels is not None
        assert self._scale is not None
        self._levels.use(1)
        self._scale.use(2)
        self.program["view"] = view
        self.program["sheer"] = heat.sheer
        mesh.render()

    def release(self) -> None:
        """Free every OpenGL object."""
        for item in (self._levels, self._scale, self.program):
            if item is not None:
                item.release()

    def _upload(self, heat: FaceColors, order: Ints | None) -> None:
        """Compared by identity, as in `Renderer.show`."""
        shown = heat.levels, heat.colors, order
        if len(shown) == len(self._shown) and all(a is b for a, b in zip(shown, self._shown, strict=True)):
            return
        for item in (self._levels, self._scale):
            if item is not None:
                item.release()
        levels = np.nan_to_num(heat.levels if order is None else heat.levels[order], nan=-1.0)
        rows = -(-len(levels) // _ROW)
        padded = np.zeros(rows * _ROW, dtype=np.float32)
        padded[: len(levels)] = levels
        self._levels = self._ctx.texture((_ROW, rows), 1, padded, dtype="f4")
        self._levels.filter = moderngl.NEAREST, moderngl.NEAREST
        colors = np.rint(255 * heat.colors).astype(np.uint8)
        self._scale = self._ctx.texture((len(colors), 1), 3, np.ascontiguousarray(colors), alignment=1)
        self._scale.repeat_x = self._scale.repeat_y = False
        self._shown = shown
