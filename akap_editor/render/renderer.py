"""Draws a posed drawing with OpenGL, given a context; the window and the exporter share it."""

from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..editor.document import Drawing
from ..errors import InputError
from ..geometry.checks import Floats
from ..resources import resource

Color = tuple[float, float, float]
View = tuple[float, float, float, float]

_STAGES = {"vert": "vertex_shader", "geom": "geometry_shader", "frag": "fragment_shader"}


@dataclass(frozen=True)
class Background:
    """What lies behind the drawing; colors are (r, g, b) from 0 to 1.

    color: fills the target, or None for transparent; checker: two colors of a checkerboard inside the
    picture's frame, or None; cell: side of its cells in framebuffer pixels.
    """

    color: Color | None = None
    checker: tuple[Color, Color] | None = None
    cell: float = 12.0


TRANSPARENT = Background()
CANVAS = Background(color=(0.094, 0.098, 0.110), checker=((0.165, 0.169, 0.184), (0.192, 0.196, 0.212)))


def load_program(ctx: moderngl.Context, *names: str) -> moderngl.Program:
    """Compile shader files of the folder ``shaders``; their endings vert, geom and frag tell the stage."""
    sources: dict[str, Any] = {
        _STAGES[name.rpartition(".")[2]]: resource("shaders", name).read_text("utf-8") for name in names
    }
    return ctx.program(**sources)


class Renderer:
    """Owns every OpenGL object of one context; knows nothing of windows.

    `show` says what to draw and `draw` draws it. The context must be current in all calls, and `release` be
    called in the end. precise: a 16-bit float texture in place of 8 bit, so that colors survive when an
    export divides them by a low alpha.
    """

    def __init__(self, ctx: moderngl.Context, *, precise: bool = False) -> None:
        self._ctx = ctx
        self._texture_dtype = "f2" if precise else "f1"
        self.max_texture_size: int = ctx.info["GL_MAX_TEXTURE_SIZE"]
        self._premultiply = load_program(ctx, "fullscreen.vert", "premultiply.frag")
        self._mesh_program = load_program(ctx, "mesh.vert", "mesh.frag")
        self._line_program = load_program(ctx, "lines.vert", "lines.geom", "lines.frag")
        self._frame_program = load_program(ctx, "frame.vert", "frame.frag")
        self._premultiply_pass = ctx.vertex_array(self._premultiply, [])
        self._frame = ctx.vertex_array(self._frame_program, [])
        self._drawing: Drawing | None = None
        self._positions: Floats | None = None
        self._of_drawing: list[moderngl.Buffer | moderngl.Texture | moderngl.VertexArray] = []

    def show(self, drawing: Drawing, positions: Floats) -> None:
        """Set what `draw` draws: a drawing in the pose ``positions``, (n, 2) float64 in drawing units.

        Both are compared by identity, so that only what changed is uploaded. Raises InputError where the
        shape of ``positions`` does not fit the drawing.
        """
        expected = drawing.mesh.vertices.shape
        if positions.shape != expected:
            raise InputError(f"positions: expected shape {expected}, got {positions.shape}")
        if drawing is not self._drawing:
            self._upload_drawing(drawing)
        if positions is not self._positions:
            self._position_buffer.orphan()  # so that the driver need not wait for the last frame
            self._position_buffer.write(np.ascontiguousarray(positions, dtype=np.float32))
            self._positions = positions

    def draw(
        self,
        framebuffer: moderngl.Framebuffer,
        size: tuple[int, int],
        view: View,
        *,
        background: Background = CANVAS,
        mesh_lines: bool = False,
    ) -> None:
        """Draw into the whole ``framebuffer``; before the first `show`, only the plain background.

        size: width and height in framebuffer pixels; view: (sx, sy, tx, ty) with ndc = s * position + t, see
        `Camera.view`; mesh_lines: whether to draw the edges of the mesh. Colors come out premultiplied.
        """
        framebuffer.use()
        self._ctx.viewport = (0, 0, *size)
        self._ctx.scissor = None
        self._ctx.clear(*((0.0, 0.0, 0.0, 0.0) if background.color is None else (*background.color, 1.0)))
        if self._drawing is None:
            return
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA  # "over" for premultiplied colors
        if background.checker is not None:
            self._draw_checker(background.checker, background.cell, self._drawing.size, size, view)
        self._texture.use(0)
        self._mesh_program["view"] = view
        self._mesh.render()
        if mesh_lines:
            self._line_program["view"] = view
            self._line_program["viewport"] = size
            self._lines.render(moderngl.LINES)

    def release(self) -> None:
        """Free every OpenGL object; the renderer is of no use afterwards."""
        self._release_drawing()
        for item in (
            self._premultiply_pass,
            self._frame,
            self._premultiply,
            self._mesh_program,
            self._line_program,
            self._frame_program,
        ):
            item.release()

    def _draw_checker(
        self,
        colors: tuple[Color, Color],
        cell: float,
        frame: tuple[int, int],
        size: tuple[int, int],
        view: View,
    ) -> None:
        program = self._frame_program
        program["view"] = view
        program["frame"] = frame
        program["origin"] = round((view[2] + 1) / 2 * size[0]), round((view[3] + 1) / 2 * size[1])
        program["cell"] = cell
        program["even"], program["odd"] = colors
        self._frame.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _upload_drawing(self, drawing: Drawing) -> None:
        self._release_drawing()
        ctx, mesh = self._ctx, drawing.mesh
        self._texture = self._make_texture(drawing.image)
        self._position_buffer = ctx.buffer(reserve=mesh.vertices.size * 4, dynamic=True)
        uv = ctx.buffer(drawing.uv)
        faces = ctx.buffer(mesh.faces.astype(np.uint32))
        edges = ctx.buffer(mesh.edges.astype(np.uint32))
        positions = (self._position_buffer, "2f", "in_position")
        self._mesh = ctx.vertex_array(self._mesh_program, [positions, (uv, "2f", "in_uv")], faces)
        self._lines = ctx.vertex_array(self._line_program, [positions], edges)
        self._of_drawing = [self._mesh, self._lines, self._position_buffer, uv, faces, edges, self._texture]
        self._drawing = drawing

    def _release_drawing(self) -> None:
        for item in self._of_drawing:
            item.release()
        self._of_drawing = []
        self._drawing = self._positions = None

    def _make_texture(self, image: NDArray[np.uint8]) -> moderngl.Texture:
        """The picture premultiplied, with mip levels made from premultiplied colors, so that no rim darkens.

        Scaled down where it is larger than the driver allows.
        """
        height, width = image.shape[:2]
        shrink = min(1.0, self.max_texture_size / max(width, height))
        if shrink < 1:
            width, height = max(1, int(width * shrink)), max(1, int(height * shrink))
            image = np.asarray(Image.fromarray(image).resize((width, height), Image.Resampling.BOX))
        source = self._ctx.texture((width, height), 4, image, alignment=1)
        texture = self._ctx.texture((width, height), 4, dtype=self._texture_dtype)
        target = self._ctx.framebuffer([texture])
        source.use(0)
        with self._ctx.scope(target, moderngl.NOTHING):
            self._premultiply_pass.render(moderngl.TRIANGLES, vertices=3)
        target.release()
        source.release()
        texture.build_mipmaps()
        texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        texture.repeat_x = texture.repeat_y = False
        return texture
