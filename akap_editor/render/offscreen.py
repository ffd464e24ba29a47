"""Renders a posed drawing to an array, without a window."""

import sys
from contextlib import AbstractContextManager, nullcontext
from typing import Any, Self

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..editor.document.drawing import Drawing
from ..editor.framing import Box, Color, frame_box, output_size
from ..errors import GraphicsError
from ..geometry.validation import Ints, as_points
from ..layers.drawing_layer import stacked_faces
from ..overlap.seams import CutMesh
from .renderer import Background, Renderer
from .shaders import load_program

TILE_SIZE = 2048  # pixels, of the squares that are drawn one by one: bounds the memory of the graphics card
_MAX_KEPT_TARGETS = 4  # the whole tiles of a picture, and those at its right, its bottom and its corner
SAMPLES = 4  # per pixel along edges of the mesh; inside, the texture is sampled once and stays exact


def standalone_context() -> moderngl.Context:
    """An OpenGL 3.3 context that needs no window and no display server. Raises GraphicsError."""
    backend: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    try:
        return moderngl.create_context(standalone=True, require=330, **backend)
    except Exception as error:  # moderngl raises nothing more specific
        raise GraphicsError(
            "OpenGL 3.3 without a window is not available: on Debian and Ubuntu, install the packages "
            f"libegl1 and libgl1 ({error})"
        ) from error


class _Targets:
    """Framebuffers of one size: with samples, then one value a pixel, then straight 8-bit colors."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]) -> None:
        samples = ctx.renderbuffer(size, 4, samples=min(SAMPLES, ctx.max_samples), dtype="f2")
        self.texture = ctx.texture(size, 4, dtype="f2")
        pixels = ctx.renderbuffer(size, 4)
        self.sampled, self.resolved, self.straight = map(
            ctx.framebuffer, ([samples], [self.texture], [pixels])
        )
        self._items: tuple[Any, ...] = (
            self.sampled,
            self.resolved,
            self.straight,
            samples,
            self.texture,
            pixels,
        )

    def release(self) -> None:
        """Free every OpenGL object."""
        for item in self._items:
            item.release()


class OffscreenRenderer:
    """Renders drawings to arrays. Use it as a context manager, or call `release` in the end.

    context: an OpenGL context that is current in all calls, for example the window's. By default it makes its
    own one on first use, which needs no display server. is_smooth: whether faces of bent poses are curved,
    see `refinement`; off for comparisons with the mesh itself.
    """

    def __init__(self, context: moderngl.Context | None = None, is_smooth: bool = True) -> None:
        self._context = context
        self.is_smooth = is_smooth
        self._owns_context = context is None
        self._renderer: Renderer | None = None
        self._targets: dict[tuple[int, int], _Targets] = {}  # by size in pixels

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.release()

    def release(self) -> None:
        """Free every OpenGL object, and the context if it is its own."""
        if self._renderer is not None:
            with self._current():
                for targets in self._targets.values():
                    targets.release()
                for item in (self._unpremultiply_pass, self._unpremultiply, self._renderer):
                    item.release()
            self._renderer = None
            self._targets.clear()
        if self._owns_context and self._context is not None:
            self._context.release()
            self._context = None

    def render(
        self,
        drawing: Drawing,
        positions: ArrayLike,
        box: Box | None = None,
        scale: float = 1.0,
        background: Color | None = None,
        order: Ints | CutMesh | None = None,
    ) -> NDArray[np.uint8]:
        """Render the drawing in a pose to (h, w, 4) uint8, straight alpha; transparent pixels are black.

        positions: (n, 2) drawing units; box: the part of the drawing plane to show, by default `frame_box` of
        the pose; scale: pixels per drawing unit, the size is rounded up (see `output_size`); background: None
        for transparent; order: (m,) the faces in drawing order, the last one in front, see
        `Document.draw_order`; by default that of the layers. In the rest pose the result equals the
        drawing's picture wherever the mesh covers it. The picture may be larger than the driver's limit.
        Raises InputError for a bad argument or a picture that is too large, GraphicsError without OpenGL 3.3.
        """
        pose = as_points(positions, "positions", len(drawing.mesh.vertices))
        box = frame_box(drawing, [pose]) if box is None else box
        if order is None and drawing.layers:
            order = stacked_faces(None, drawing.face_layers, drawing.layers, drawing.layer_order)
        width, height = output_size(box, scale)
        if self._context is None:
            self._context = standalone_context()
        with self._current():
            renderer = self._prepared_renderer(self._context)
            renderer.show(drawing, pose, order, self.is_smooth, scale)
            side = min(TILE_SIZE, renderer.max_texture_size)
            picture = np.empty((height, width, 4), dtype=np.uint8)
            for top in range(0, height, side):
                for left in range(0, width, side):
                    tile = picture[top : top + side, left : left + side]
                    corner = box[0] + left / scale, box[1] + top / scale
                    tile[...] = self._draw(renderer, tile.shape[1::-1], corner, scale, Background(background))
        return picture

    def _draw(
        self,
        renderer: Renderer,
        size: tuple[int, int],
        corner: tuple[float, float],
        scale: float,
        background: Background,
    ) -> NDArray[np.uint8]:
        """Render one tile, ``size`` in pixels; ``corner`` is its top left corner in drawing units.

        It is drawn in 16-bit floats, so that the graphics card can divide it by alpha exactly.
        """
        assert self._context is not None
        ctx = self._context
        # y is not flipped: the bottom row of the target is read first and is the top row of the result
        sx, sy = 2 * scale / size[0], 2 * scale / size[1]
        view = sx, sy, -1 - sx * corner[0], -1 - sy * corner[1]
        targets = self._targets_of(size)
        with ctx.scope(targets.sampled):
            renderer.draw(targets.sampled, size, view, background=background)
        ctx.copy_framebuffer(targets.resolved, targets.sampled)
        targets.texture.use(0)
        with ctx.scope(targets.straight, moderngl.NOTHING):
            self._unpremultiply_pass.render(moderngl.TRIANGLES, vertices=3)
        pixels = np.empty((size[1], size[0], 4), dtype=np.uint8)
        targets.straight.read_into(pixels, components=4, alignment=1)
        return pixels

    def _targets_of(self, size: tuple[int, int]) -> "_Targets":
        """What tiles of this size are drawn into; kept, because drivers free memory late."""
        assert self._context is not None
        if size not in self._targets:
            while len(self._targets) >= _MAX_KEPT_TARGETS:
                self._targets.pop(next(iter(self._targets))).release()
            self._targets[size] = _Targets(self._context, size)
        return self._targets[size]

    def _prepared_renderer(self, ctx: moderngl.Context) -> Renderer:
        if self._renderer is None:
            self._renderer = Renderer(ctx, precise=True, sharp=True)
            self._unpremultiply = load_program(ctx, "fullscreen.vert", "unpremultiply.frag")
            self._unpremultiply_pass = ctx.vertex_array(self._unpremultiply, [])
        return self._renderer

    def _current(self) -> AbstractContextManager[object]:
        """Makes its own context current; a given one is current already."""
        return self._context if self._owns_context and self._context is not None else nullcontext()
