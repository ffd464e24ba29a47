"""Draws a posed drawing with OpenGL, given a context; the window and the exporter share it."""

from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..editor.document.drawing import Drawing
from ..editor.framing import Color
from ..errors import InputError
from ..geometry.validation import Floats, Ints
from .overlays import NO_OVERLAYS, HeatPainter, Overlays, Reference, StrokePainter
from .shaders import View, load_program


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
        self._heat = HeatPainter(ctx)
        self._strokes = StrokePainter(ctx)
        self._premultiply_pass = ctx.vertex_array(self._premultiply, [])
        self._frame = ctx.vertex_array(self._frame_program, [])
        self._drawing: Drawing | None = None
        self._positions: Floats | None = None
        self._order: Ints | None = None
        self._of_drawing: list[moderngl.Buffer | moderngl.Texture | moderngl.VertexArray] = []
        self._reference: Reference | None = None
        self._of_reference: list[moderngl.Buffer | moderngl.Texture | moderngl.VertexArray] = []

    def show(self, drawing: Drawing, positions: Floats, order: Ints | None = None) -> None:
        """Set what `draw` draws: a drawing in the pose ``positions``, (n, 2) float64 in drawing units.

        order: (m,) the faces as they are drawn, the last one in front; by default as the mesh has them. All
        are compared by identity, so that only what changed is uploaded. Raises InputError where the shape of
        ``positions`` does not fit the drawing.
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
        if order is not self._order:
            faces = drawing.mesh.faces if order is None else drawing.mesh.faces[order]
            self._face_buffer.write(faces.astype(np.uint32))
            self._order = order

    def hide(self) -> None:
        """Nothing is to be drawn until the next `show`."""
        self._release_drawing()

    def draw(
        self,
        framebuffer: moderngl.Framebuffer,
        size: tuple[int, int],
        view: View,
        *,
        background: Background = CANVAS,
        overlays: Overlays = NO_OVERLAYS,
        region: tuple[int, int, int, int] | None = None,
    ) -> None:
        """Draw into the whole ``framebuffer``; without a drawing only the plain background.

        size: width and height in framebuffer pixels; view: (sx, sy, tx, ty) with ndc = s * position + t, see
        `Camera.view`; overlays: what is shown besides the drawing; region: (x, y, width, height) in
        framebuffer pixels from the bottom left, outside of which all stays as it is. Colors come out
        premultiplied.
        """
        framebuffer.use()
        self._ctx.viewport = (0, 0, *size)
        self._ctx.scissor = region
        self._ctx.clear(*((0.0, 0.0, 0.0, 0.0) if background.color is None else (*background.color, 1.0)))
        if self._drawing is None:
            return
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA  # "over" for premultiplied colors
        if background.checker is not None:
            self._draw_checker(background.checker, background.cell, self._drawing.size, size, view)
        if overlays.reference is not None:
            self._draw_reference(overlays.reference, self._drawing.size, view)
        self._texture.use(0)
        if overlays.ghost > 0:
            self._draw_pictured(self._rest, overlays.ghost, view)
        for skin in overlays.skins:
            self._skin_buffer.orphan()
            self._skin_buffer.write(np.ascontiguousarray(skin.positions, dtype=np.float32))
            self._draw_pictured(self._skin, skin.opacity, view, skin.tint)
        if overlays.heat is not None:
            self._heat.draw(self._heated, overlays.heat, self._order, view)
        else:
            self._draw_pictured(self._mesh, 1.0, view)
        if overlays.mesh_lines:
            self._line_program["view"] = view
            self._line_program["viewport"] = size
            self._lines.render(moderngl.LINES)
        self._strokes.draw(overlays.strokes, size, view)

    def release(self) -> None:
        """Free every OpenGL object; the renderer is of no use afterwards."""
        self._release_drawing()
        self._release_reference()
        for item in (
            self._heat,
            self._strokes,
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

    def _draw_pictured(
        self,
        mesh: moderngl.VertexArray,
        opacity: float,
        view: View,
        tint: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """A mesh with the picture that is bound."""
        self._mesh_program["view"] = view
        self._mesh_program["opacity"] = opacity
        self._mesh_program["tint"] = tint
        mesh.render()

    def _draw_reference(self, reference: Reference, frame: tuple[int, int], view: View) -> None:
        """The picture as large as it goes into the frame, in its middle."""
        if self._reference is None or self._reference.image is not reference.image:
            self._release_reference()
            height, width = reference.image.shape[:2]
            half = np.array([width, height]) * min(frame[0] / width, frame[1] / height) / 2
            corners = np.array([(0, 0), (1, 0), (0, 1), (1, 1)], dtype=np.float32)
            places = self._ctx.buffer((np.array(frame) / 2 + (2 * corners - 1) * half).astype(np.float32))
            uv = self._ctx.buffer(corners)
            faces = self._ctx.buffer(np.array([0, 1, 3, 0, 3, 2], dtype=np.uint32))
            self._reference_texture = self._make_texture(reference.image)
            self._reference_quad = self._ctx.vertex_array(
                self._mesh_program, [(places, "2f", "in_position"), (uv, "2f", "in_uv")], faces
            )
            self._of_reference = [self._reference_quad, places, uv, faces, self._reference_texture]
            self._reference = reference
        self._reference_texture.use(0)
        self._draw_pictured(self._reference_quad, reference.opacity, view)

    def _release_reference(self) -> None:
        for item in self._of_reference:
            item.release()
        self._of_reference, self._reference = [], None

    def _upload_drawing(self, drawing: Drawing) -> None:
        self._release_drawing()
        ctx, mesh = self._ctx, drawing.mesh
        self._texture = self._make_texture(drawing.image)
        self._position_buffer = ctx.buffer(reserve=mesh.vertices.size * 4, dynamic=True)
        self._skin_buffer = ctx.buffer(reserve=mesh.vertices.size * 4, dynamic=True)
        uv = ctx.buffer(drawing.uv)
        rest = ctx.buffer(mesh.vertices.astype(np.float32))
        faces = self._face_buffer = ctx.buffer(mesh.faces.astype(np.uint32))
        edges = ctx.buffer(mesh.edges.astype(np.uint32))
        positions = (self._position_buffer, "2f", "in_position")
        corners = (uv, "2f", "in_uv")
        self._mesh = ctx.vertex_array(self._mesh_program, [positions, corners], faces)
        self._heated = ctx.vertex_array(self._heat.program, [positions, corners], faces)
        skin = (self._skin_buffer, "2f", "in_position")
        self._skin = ctx.vertex_array(self._mesh_program, [skin, corners], faces)
        self._rest = ctx.vertex_array(self._mesh_program, [(rest, "2f", "in_position"), corners], faces)
        self._lines = ctx.vertex_array(self._line_program, [positions], edges)
        self._of_drawing = [self._mesh, self._heated, self._rest, self._lines]
        self._of_drawing += [
            self._skin,
            self._skin_buffer,
            self._position_buffer,
            uv,
            rest,
            faces,
            edges,
            self._texture,
        ]
        self._drawing = drawing

    def _release_drawing(self) -> None:
        for item in self._of_drawing:
            item.release()
        self._of_drawing = []
        self._drawing = self._positions = self._order = None

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
