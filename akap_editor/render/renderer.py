"""Draws a posed drawing and its overlays with OpenGL; the window and the exporter share it."""

from dataclasses import dataclass
from math import inf

import moderngl
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..editor.document.drawing import Drawing
from ..editor.framing import Color
from ..errors import InputError
from ..geometry.validation import Floats, Ints
from ..layers.drawing_layer import shown_layers
from ..overlap.seams import CutMesh
from .draw_calls import DrawTriangles, draw_triangles
from .layer_runs import BLEND_PASSES, OVER, LayerRun, layer_runs
from .overlays import NO_OVERLAYS, FaceColorPainter, LinePainter, Overlays, Reference, Rgba
from .refined_cut import RefinedCut, refined_cut
from .refinement import MAX_PARTS, Refinement, suitable_parts
from .shaders import View, load_program
from .smooth_mesh import SmoothMesh


@dataclass(frozen=True)
class Background:
    """What is drawn behind the drawing.

    color: fills the target, None for transparent; checker: the two colors of a checkerboard in the picture's
    frame, or None; cell: side of its cells in framebuffer pixels.
    """

    color: Color | None = None
    checker: tuple[Color, Color] | None = None
    cell: float = 12.0


TRANSPARENT = Background()
CANVAS = Background(color=(0.094, 0.098, 0.110), checker=((0.165, 0.169, 0.184), (0.192, 0.196, 0.212)))
_SOFTWARE_RENDERERS = ("llvmpipe", "softpipe", "swiftshader", "gdi generic", "software")
SOFTWARE_PARTS = 2  # of an edge in the window, where the processor draws
NO_TINT = (0.0, 0.0, 0.0, 0.0)


class Renderer:
    """Draws one drawing at a time: `show` uploads it, `draw` draws it with its overlays.

    The context must be current in all calls, and `release` must be called in the end. precise: use a texture
    of 16-bit floats instead of 8 bits, so that colors stay exact when an export divides them by a low alpha.
    sharp: enlarge the picture by Catmull-Rom splines and reduce it by means over pixels, instead of linear
    interpolation; by default where a graphics card computes, not the processor. draw_triangles: draws the
    meshes of the drawing, see `draw_calls`.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        *,
        precise: bool = False,
        sharp: bool | None = None,
        draw_triangles: DrawTriangles = draw_triangles,
    ) -> None:
        self._ctx, self._draw_triangles = ctx, draw_triangles
        is_software = _is_software(ctx)
        sharp = not is_software if sharp is None else sharp
        self._most_parts = SOFTWARE_PARTS if is_software and not precise else MAX_PARTS
        self._texture_dtype = "f2" if precise else "f1"
        self.max_texture_size: int = ctx.info["GL_MAX_TEXTURE_SIZE"]
        self._premultiply = load_program(ctx, "fullscreen.vert", "premultiply.frag")
        self._mesh_program = load_program(ctx, "mesh.vert", "mesh_sharp.frag" if sharp else "mesh.frag")
        self._edge_program = load_program(ctx, "lines.vert", "mesh_edges.geom", "mesh_edges.frag")
        self._checker_program = load_program(ctx, "checkerboard.vert", "checkerboard.frag")
        self._face_colors = FaceColorPainter(ctx)
        self._lines = LinePainter(ctx)
        self._premultiply_pass = ctx.vertex_array(self._premultiply, [])
        self._checker = ctx.vertex_array(self._checker_program, [])
        self._drawing: Drawing | None = None
        self._runs: tuple[LayerRun, ...] = ()
        self._cut_runs: tuple[LayerRun, ...] = ()
        self._positions: Floats | None = None
        self._order: Ints | None = None
        self._cut: CutMesh | None = None
        self._cut_positions: Floats | None = None
        self._refined_cut: RefinedCut | None = None
        self._cut_refinement: Refinement | None = None
        self._smooth: SmoothMesh | None = None
        self._shows_smooth = False
        self._cut_objects: list[moderngl.Buffer | moderngl.VertexArray] = []
        self._drawing_objects: list[moderngl.Buffer | moderngl.Texture | moderngl.VertexArray] = []
        self._reference: Reference | None = None
        self._reference_objects: list[moderngl.Buffer | moderngl.Texture | moderngl.VertexArray] = []

    def show(
        self,
        drawing: Drawing,
        positions: Floats,
        order: Ints | CutMesh | None = None,
        smooth: bool = False,
        scale: float = inf,
    ) -> None:
        """Upload the drawing in the pose ``positions``, (n, 2) float64 in drawing units.

        order: (m,) the faces in drawing order, the last one in front, or the mesh cut along seams; by default
        the order of the mesh; smooth: draw curved faces, see `refinement`, unless the pose is that of rest;
        scale: pixels per drawing unit, so that faces whose curves nobody sees are drawn flat. Arguments are
        compared by identity with those of the last call, and only what changed is uploaded. Raises InputError
        if the shape of ``positions`` does not fit the drawing.
        """
        expected = drawing.mesh.vertices.shape
        if positions.shape != expected:
            raise InputError(f"positions: expected shape {expected}, got {positions.shape}")
        if not self._has_uploaded(drawing):
            self._upload_drawing(drawing)
        if positions is not self._positions:
            self._position_buffer.orphan()  # otherwise the driver waits until the last frame is drawn
            self._position_buffer.write(np.ascontiguousarray(positions, dtype=np.float32))
            self._positions = positions
        cut = order if isinstance(order, CutMesh) else None
        refined = self._refinement_of(drawing, positions, scale) if smooth and self._parts > 1 else None
        is_cut_changed = cut is not self._cut or positions is not self._cut_positions
        if cut is not None and (is_cut_changed or refined is not self._cut_refinement):
            self._upload_cut(drawing, positions, cut, refined)
        self._cut, self._cut_positions = cut, positions if cut is not None else None
        order = order.order if isinstance(order, CutMesh) else order
        if order is not self._order:
            faces = drawing.mesh.faces if order is None else drawing.mesh.faces[order]
            self._face_buffer.orphan()
            self._face_buffer.write(faces.astype(np.uint32))
        if order is not self._order or drawing is not self._drawing or cut is not None:
            self._arrange_layers(drawing, order, cut)
        self._order, self._drawing = order, drawing
        self._shows_smooth = refined is not None and cut is None
        if self._shows_smooth and self._smooth is not None:
            self._smooth.show(positions, order)

    def _refinement_of(self, drawing: Drawing, positions: Floats, scale: float) -> Refinement | None:
        """The refinement that shows all curves of a pose; None if flat faces do."""
        if np.array_equal(positions, drawing.mesh.vertices):
            return None
        if self._smooth is None:
            self._smooth = SmoothMesh(self._ctx, self._mesh_program, drawing, self._parts)
        self._smooth.fit(positions, scale)
        return self._smooth.refinement if self._smooth.refinement.parts > 1 else None

    def _has_uploaded(self, drawing: Drawing) -> bool:
        """Whether mesh and texture are those of a drawing; its layer list may differ."""
        old = self._drawing
        return old is not None and all(
            a is b for a, b in ((old.mesh, drawing.mesh), (old.image, drawing.image), (old.uv, drawing.uv))
        )

    def _arrange_layers(self, drawing: Drawing, order: Ints | None, cut: CutMesh | None) -> None:
        """Divide the faces into runs, and leave out the edges of hidden layers."""
        face_layers, layers = drawing.face_layers, drawing.layers
        self._runs = layer_runs(face_layers if order is None else face_layers[order], layers)
        self._cut_runs = () if cut is None else layer_runs(face_layers[cut.sources], layers)
        if self._refined_cut is not None:
            self._cut_runs = self._refined_cut.runs(self._cut_runs)
        edges = drawing.mesh.edges
        if layers:
            assert drawing.mesh.layers is not None
            edges = edges[shown_layers(layers)[drawing.mesh.layers[edges[:, 0]]]]
            self._edge_buffer.write(edges.astype(np.uint32))
        self._edge_count = len(edges)

    def _upload_cut(
        self, drawing: Drawing, positions: Floats, cut: CutMesh, refined: Refinement | None
    ) -> None:
        """Upload a mesh cut along seams; it differs in every pose, so nothing of it is kept."""
        self._release_cut()
        ctx, self._cut_refinement = self._ctx, refined
        shown: CutMesh | RefinedCut = cut
        corners = drawing.uv.astype(np.float64)
        if refined is not None and self._smooth is not None:
            shown = self._refined_cut = refined_cut(drawing.mesh, refined, cut)
            positions, corners = refined.smooth @ positions, self._smooth.uv
        places = ctx.buffer(np.ascontiguousarray(shown.values(positions), dtype=np.float32))
        uv = ctx.buffer(np.ascontiguousarray(shown.values(corners), dtype=np.float32))
        faces = ctx.buffer(shown.faces.astype(np.uint32))
        self._cut_mesh = ctx.vertex_array(
            self._mesh_program, [(places, "2f", "in_position"), (uv, "2f", "in_uv")], faces
        )
        self._cut_objects = [self._cut_mesh, places, uv, faces]

    def _release_cut(self) -> None:
        for item in self._cut_objects:
            item.release()
        self._cut_objects, self._cut, self._cut_positions, self._refined_cut = [], None, None, None

    def hide(self) -> None:
        """Draw no drawing until the next `show`."""
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
        """Draw into ``framebuffer``, in premultiplied colors; without a drawing only the background's color.

        size: width and height in framebuffer pixels; view: (sx, sy, tx, ty) with ndc = s * position + t, see
        `Camera.view`; region: (x, y, width, height) in framebuffer pixels from the bottom left, the only part
        that is drawn; by default all of it.
        """
        framebuffer.use()
        self._ctx.viewport = (0, 0, *size)
        self._ctx.scissor = region
        self._ctx.clear(*((0.0, 0.0, 0.0, 0.0) if background.color is None else (*background.color, 1.0)))
        if self._drawing is None:
            return
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = OVER
        if background.checker is not None:
            self._draw_checker(background.checker, background.cell, self._drawing.size, size, view)
        if overlays.reference is not None:
            self._draw_reference(overlays.reference, self._drawing.size, view)
        self._texture.use(0)
        if overlays.rest_pose_opacity > 0:
            self._draw_textured(self._rest_mesh, overlays.rest_pose_opacity, view, runs=self._runs)
        for pose in overlays.onion_poses:
            self._onion_buffer.orphan()
            self._onion_buffer.write(np.ascontiguousarray(pose.positions, dtype=np.float32))
            self._draw_textured(self._onion_mesh, pose.opacity, view, pose.tint, self._runs)
        if overlays.face_colors is not None:
            self._face_colors.draw(self._face_color_mesh, overlays.face_colors, self._order, view)
        elif self._shows_smooth and self._smooth is not None:
            runs = self._smooth.runs(self._runs)
            self._draw_textured(self._smooth.vertex_array, 1.0, view, runs=runs)
        elif self._cut is None:
            self._draw_textured(self._mesh, 1.0, view, runs=self._runs)
        else:
            self._draw_textured(self._cut_mesh, 1.0, view, runs=self._cut_runs)
        if overlays.mesh_lines:
            self._edge_program["view"] = view
            self._edge_program["viewport"] = size
            self._edges.render(moderngl.LINES, vertices=2 * self._edge_count)
        self._lines.draw(overlays.lines, size, view)

    def release(self) -> None:
        """Free every OpenGL object; the renderer cannot be used afterwards."""
        self._release_drawing()
        self._release_reference()
        for item in (
            self._face_colors,
            self._lines,
            self._premultiply_pass,
            self._checker,
            self._premultiply,
            self._mesh_program,
            self._edge_program,
            self._checker_program,
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
        program = self._checker_program
        program["view"] = view
        program["frame"] = frame
        program["origin"] = round((view[2] + 1) / 2 * size[0]), round((view[3] + 1) / 2 * size[1])
        program["cell"] = cell
        program["even"], program["odd"] = colors
        self._checker.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _draw_textured(
        self,
        mesh: moderngl.VertexArray,
        opacity: float,
        view: View,
        tint: Rgba = NO_TINT,
        runs: tuple[LayerRun, ...] | None = None,
    ) -> None:
        """Draw a mesh with the texture that is bound to unit 0, run by run; without runs all of it."""
        self._mesh_program["view"] = view
        self._mesh_program["tint"] = tint
        self._mesh_program["inverted"] = False
        self._mesh_program["opacity"] = opacity
        if runs is None:
            mesh.render()
        for run in runs or ():
            self._mesh_program["opacity"] = opacity * run.opacity
            for blending in BLEND_PASSES[run.blend]:
                self._ctx.blend_func = blending.func
                self._mesh_program["inverted"] = blending.inverted
                self._draw_triangles(mesh, 3 * run.first, 3 * run.count)
        self._mesh_program["inverted"] = False
        self._ctx.blend_func = OVER

    def _draw_reference(self, reference: Reference, frame: tuple[int, int], view: View) -> None:
        """Draw the picture in the middle of the frame, as large as it fits."""
        if self._reference is None or self._reference.image is not reference.image:
            self._release_reference()
            height, width = reference.image.shape[:2]
            half = np.array([width, height]) * min(frame[0] / width, frame[1] / height) / 2
            corners = np.array([(0, 0), (1, 0), (0, 1), (1, 1)], dtype=np.float32)
            positions = self._ctx.buffer((np.array(frame) / 2 + (2 * corners - 1) * half).astype(np.float32))
            uv = self._ctx.buffer(corners)
            faces = self._ctx.buffer(np.array([0, 1, 3, 0, 3, 2], dtype=np.uint32))
            self._reference_texture = self._make_texture(reference.image)
            self._reference_quad = self._ctx.vertex_array(
                self._mesh_program, [(positions, "2f", "in_position"), (uv, "2f", "in_uv")], faces
            )
            self._reference_objects = [self._reference_quad, positions, uv, faces, self._reference_texture]
            self._reference = reference
        self._reference_texture.use(0)
        self._draw_textured(self._reference_quad, reference.opacity, view)

    def _release_reference(self) -> None:
        for item in self._reference_objects:
            item.release()
        self._reference_objects, self._reference = [], None

    def _upload_drawing(self, drawing: Drawing) -> None:
        self._release_drawing()
        ctx, mesh = self._ctx, drawing.mesh
        self._parts = suitable_parts(mesh, self._most_parts)
        self._texture = self._make_texture(drawing.image)
        self._position_buffer = ctx.buffer(reserve=mesh.vertices.size * 4, dynamic=True)
        self._onion_buffer = ctx.buffer(reserve=mesh.vertices.size * 4, dynamic=True)
        uv = ctx.buffer(drawing.uv)
        rest = ctx.buffer(mesh.vertices.astype(np.float32))
        faces = self._face_buffer = ctx.buffer(mesh.faces.astype(np.uint32))
        edges = self._edge_buffer = ctx.buffer(mesh.edges.astype(np.uint32))
        positions = (self._position_buffer, "2f", "in_position")
        corners = (uv, "2f", "in_uv")
        self._mesh = ctx.vertex_array(self._mesh_program, [positions, corners], faces)
        self._face_color_mesh = ctx.vertex_array(self._face_colors.program, [positions, corners], faces)
        onion = (self._onion_buffer, "2f", "in_position")
        self._onion_mesh = ctx.vertex_array(self._mesh_program, [onion, corners], faces)
        self._rest_mesh = ctx.vertex_array(self._mesh_program, [(rest, "2f", "in_position"), corners], faces)
        self._edges = ctx.vertex_array(self._edge_program, [positions], edges)
        self._drawing_objects = [self._mesh, self._face_color_mesh, self._rest_mesh, self._edges]
        self._drawing_objects += [
            self._onion_mesh,
            self._onion_buffer,
            self._position_buffer,
            uv,
            rest,
            faces,
            edges,
            self._texture,
        ]

    def _release_drawing(self) -> None:
        for item in self._drawing_objects:
            item.release()
        self._drawing_objects = []
        self._release_cut()
        if self._smooth is not None:
            self._smooth.release()
        self._smooth, self._shows_smooth = None, False
        self._drawing = self._positions = self._order = None

    def _make_texture(self, image: NDArray[np.uint8]) -> moderngl.Texture:
        """The picture as a premultiplied texture, scaled down if it is larger than the driver allows.

        Its mip levels are made from premultiplied colors, so that edges do not darken.
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


def _is_software(ctx: moderngl.Context) -> bool:
    """Whether the processor computes what a graphics card would."""
    return any(name in ctx.info["GL_RENDERER"].lower() for name in _SOFTWARE_RENDERERS)
