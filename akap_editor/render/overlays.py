"""Overlays of the window: shown over or behind the drawing, never exported."""

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from ..geometry.validation import Floats, Ints
from .shaders import View, load_program

Rgba = tuple[float, float, float, float]  # straight alpha, 0 to 1

_LEVELS_PER_ROW = 1024  # of the texture with the faces' levels; a single row would exceed the driver's limit


@dataclass(frozen=True, eq=False)
class FaceColors:
    """A color for each face.

    levels: (m,) positions on the scale, 0 to 1; below 0 or NaN is off the scale; colors: (c, 3) the scale,
    RGB 0 to 1; translucent: whether the picture shows through, fully at level 0 and less at higher levels.
    """

    levels: Floats
    colors: Floats
    translucent: bool = False


@dataclass(frozen=True, eq=False)
class LineSegments:
    """Lines of one color: segments (s, 2, 2) in drawing units; width in framebuffer pixels."""

    segments: Floats
    color: Rgba
    width: float


@dataclass(frozen=True, eq=False)
class Reference:
    """A picture behind the drawing, fitted into its frame: image (h, w, 4) uint8; opacity 0 to 1."""

    image: NDArray[np.uint8]
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class OnionPose:
    """Another pose of the drawing, behind it: positions (n, 2); tint: RGB and its share, 0 to 1."""

    positions: Floats
    tint: Rgba
    opacity: float


@dataclass(frozen=True, eq=False)
class Overlays:
    """All overlays of one frame; a new one needs a field here, and its code in `Renderer.draw`.

    mesh_lines: whether the edges of the mesh are drawn; rest_pose_opacity: of the rest pose behind the
    drawing, 0 to 1; onion_poses: other poses behind the drawing, the last one in front.
    """

    mesh_lines: bool = False
    rest_pose_opacity: float = 0.0
    face_colors: FaceColors | None = None
    lines: tuple[LineSegments, ...] = ()
    reference: Reference | None = None
    onion_poses: tuple[OnionPose, ...] = ()


NO_OVERLAYS = Overlays()


class LinePainter:
    """Draws `LineSegments` from one buffer, which grows as needed."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._program = load_program(ctx, "lines.vert", "segments.geom", "segments.frag")
        self._buffer: moderngl.Buffer | None = None
        self._vertex_array: moderngl.VertexArray | None = None

    def draw(self, lines: Sequence[LineSegments], size: tuple[int, int], view: View) -> None:
        """Draw ``lines``, the last one in front, into the current target of ``size`` pixels."""
        self._program["view"] = view
        self._program["viewport"] = size
        for line in lines:
            ends = np.ascontiguousarray(line.segments, dtype=np.float32)
            if not ends.size:
                continue
            self._reserve(ends.nbytes)
            assert self._buffer is not None
            assert self._vertex_array is not None
            self._buffer.orphan()
            self._buffer.write(ends)
            self._program["line_color"], self._program["width"] = line.color, line.width
            self._vertex_array.render(moderngl.LINES, vertices=2 * len(ends))

    def release(self) -> None:
        """Free every OpenGL object."""
        for item in (self._vertex_array, self._buffer, self._program):
            if item is not None:
                item.release()

    def _reserve(self, size: int) -> None:
        """Make room for ``size`` bytes."""
        if self._buffer is not None and self._buffer.size >= size:
            return
        for item in (self._vertex_array, self._buffer):
            if item is not None:
                item.release()
        self._buffer = self._ctx.buffer(reserve=2 * size, dynamic=True)
        self._vertex_array = self._ctx.vertex_array(self._program, [(self._buffer, "2f", "in_position")])


class FaceColorPainter:
    """Draws a mesh in the colors of a `FaceColors`."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self.program = load_program(ctx, "mesh.vert", "face_colors.frag")
        for unit, name in enumerate(("picture", "levels", "scale")):
            self.program[name] = unit
        self._levels: moderngl.Texture | None = None
        self._scale: moderngl.Texture | None = None
        self._uploaded: tuple[object, ...] | None = None  # levels, colors and order in the textures

    def draw(
        self, mesh: moderngl.VertexArray, face_colors: FaceColors, order: Ints | None, view: View
    ) -> None:
        """Draw ``mesh``, made with `program`; its picture is bound to texture unit 0.

        order: the faces in the order in which ``mesh`` draws them, by default that of the mesh.
        """
        self._upload(face_colors, order)
        assert self._levels is not None
        assert self._scale is not None
        self._levels.use(1)
        self._scale.use(2)
        self.program["view"] = view
        self.program["translucent"] = face_colors.translucent
        mesh.render(vertices=-1 if order is None else 3 * len(order))

    def release(self) -> None:
        """Free every OpenGL object."""
        for item in (self._levels, self._scale, self.program):
            if item is not None:
                item.release()

    def _upload(self, face_colors: FaceColors, order: Ints | None) -> None:
        """Fill the textures, unless they hold these very arrays."""
        arrays = face_colors.levels, face_colors.colors, order
        if self._uploaded is not None and all(a is b for a, b in zip(arrays, self._uploaded, strict=True)):
            return
        for item in (self._levels, self._scale):
            if item is not None:
                item.release()
        levels = np.nan_to_num(face_colors.levels if order is None else face_colors.levels[order], nan=-1.0)
        rows = -(-len(levels) // _LEVELS_PER_ROW)
        padded = np.zeros(rows * _LEVELS_PER_ROW, dtype=np.float32)
        padded[: len(levels)] = levels
        self._levels = self._ctx.texture((_LEVELS_PER_ROW, rows), 1, padded, dtype="f4")
        self._levels.filter = moderngl.NEAREST, moderngl.NEAREST
        colors = np.rint(255 * face_colors.colors).astype(np.uint8)
        self._scale = self._ctx.texture((len(colors), 1), 3, np.ascontiguousarray(colors), alignment=1)
        self._scale.repeat_x = self._scale.repeat_y = False
        self._uploaded = arrays
